/* libk4a, opened when it is first asked for. */
#include "io/k4a/k4a.h"

#include "io/live/driver.h"

#include <pthread.h>

static k4a_api functions;
static char reason[256];
static bool is_loaded;
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void load(void)
{
    static const io_symbol symbols[] = {
#define SYMBOL(result, name, parameters) {"k4a_" #name, offsetof(k4a_api, name), false},
        IO_K4A_FUNCTIONS(SYMBOL)
#undef SYMBOL
    };
    static const char *const names[] = {"libk4a.so.1.4", "libk4a.so.1.3", "libk4a.so", NULL};
    static const io_library_def def = {
        .variable = "RELIEF_K4A_LIBRARY",
        .names = names,
        .cure = "install the Azure Kinect SDK, or Orbbec's K4A wrapper for Femto Bolt and Mega, or "
                "name its file in RELIEF_K4A_LIBRARY",
        .symbols = symbols,
        .symbol_count = (int32_t)(sizeof(symbols) / sizeof(symbols[0]))};
    is_loaded = io_library_load(&def, &functions, reason, sizeof(reason));
}

const k4a_api *io_k4a_api(const char **out_reason)
{
    pthread_once(&once, load);
    *out_reason = is_loaded ? NULL : reason;
    return is_loaded ? &functions : NULL;
}
