/* OpenNI2, found at run time. */
#define _POSIX_C_SOURCE 200809L
#include "io/openni2/openni2.h"

#include "io/live/driver.h"

#include <pthread.h>

static openni2_api api;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static const io_symbol symbols[] = {
#define SYMBOL(result, member, name, parameters) {"oni" name, offsetof(openni2_api, member), false},
    OPENNI2_FUNCTIONS(SYMBOL)
#undef SYMBOL
};

/* OPENNI2_REDIST is what the installers of vendors set: their folder with the library and the
 * drivers. */
static const char *const names[] = {"libOpenNI2.so.0", "libOpenNI2.so", NULL};
static io_library library = {
    .variable = "RELIEF_OPENNI2_LIBRARY",
    .folder = "OPENNI2_REDIST",
    .names = names,
    .cure = "apt install libopenni2-0, or set OPENNI2_REDIST to the folder of the vendor's own",
    .symbols = symbols,
    .symbol_count = (int32_t)(sizeof(symbols) / sizeof(symbols[0])),
    .table = &api};

const char *openni2_unavailable(void)
{
    const char *reason;
    (void)io_library_get(&library, &reason);
    return reason;
}

rlf_result openni2_begin(const char *who, const openni2_api **out)
{
    const char *reason = openni2_unavailable();
    if (reason != NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: %s", who, reason);
    }
    pthread_mutex_lock(&lock);
    const int status = api.initialize(OPENNI2_VERSION);
    if (status != OPENNI2_OK) {
        api.shutdown(); /* a failed call was counted all the same */
    }
    pthread_mutex_unlock(&lock);
    if (status != OPENNI2_OK) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: OpenNI2 cannot start (status %d): check that its drivers lie in the "
                        "folder OpenNI2/Drivers beside libOpenNI2.so.0",
                        who, status);
    }
    *out = &api;
    return RLF_OK;
}

void openni2_end(void)
{
    pthread_mutex_lock(&lock);
    api.shutdown();
    pthread_mutex_unlock(&lock);
}
