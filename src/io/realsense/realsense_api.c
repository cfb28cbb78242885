/* librealsense2, opened when it is first asked for. */
#include "io/realsense/realsense.h"

#include "io/live/driver.h"

#include <pthread.h>
#include <stdio.h>

/* The library's name carries its minor version, and one package has one version. */
#define MINOR_NEWEST 80
#define MINOR_OLDEST 17
#define NAME_COUNT (MINOR_NEWEST - MINOR_OLDEST + 2)

static realsense_api functions;
static char reason[256];
static bool is_loaded;
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void load(void)
{
    static const io_symbol symbols[] = {
#define SYMBOL(result, name, parameters) {"rs2_" #name, offsetof(realsense_api, name), false},
#define OPTIONAL(result, name, parameters) {"rs2_" #name, offsetof(realsense_api, name), true},
        IO_REALSENSE_FUNCTIONS(SYMBOL) IO_REALSENSE_OPTIONAL_FUNCTIONS(OPTIONAL)
#undef SYMBOL
#undef OPTIONAL
    };
    char texts[NAME_COUNT][32];
    const char *names[NAME_COUNT + 1];
    for (int i = 0; i < NAME_COUNT; i++) {
        snprintf(texts[i], sizeof(texts[i]), "librealsense2.so.2.%d", MINOR_NEWEST - i);
        names[i] = texts[i];
    }
    names[NAME_COUNT - 1] = "librealsense2.so";
    names[NAME_COUNT] = NULL;
    const io_library_def def = {
        .variable = "RELIEF_REALSENSE2_LIBRARY",
        .names = names,
        .cure = "install Intel's librealsense2, or name its file in RELIEF_REALSENSE2_LIBRARY",
        .symbols = symbols,
        .symbol_count = (int32_t)(sizeof(symbols) / sizeof(symbols[0]))};
    is_loaded = io_library_load(&def, &functions, reason, sizeof(reason));
}

const realsense_api *io_realsense_api(const char **out_reason)
{
    pthread_once(&once, load);
    *out_reason = is_loaded ? NULL : reason;
    return is_loaded ? &functions : NULL;
}

rlf_result io_realsense_check(const realsense_api *api, rs2_error **error, rlf_result result,
                              const char *source, const char *cure)
{
    if (*error == NULL) {
        return RLF_OK;
    }
    const char *message = api->get_error_message(*error);
    rlf_fail(result, "%s: librealsense2 says \"%.200s\": %s", source,
             message != NULL ? message : "nothing", cure);
    api->free_error(*error);
    *error = NULL;
    return result;
}

bool io_realsense_forget(const realsense_api *api, rs2_error **error)
{
    const bool had_error = *error != NULL;
    if (had_error) {
        api->free_error(*error);
        *error = NULL;
    }
    return had_error;
}
