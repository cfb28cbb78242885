/* OpenNI2, found at run time. */
#define _POSIX_C_SOURCE 200809L
#include "io/openni2/openni2.h"

#include "io/live/driver.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

static openni2_api api;
static bool is_loaded;
static char reason[320];
static pthread_once_t once = PTHREAD_ONCE_INIT;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static const io_symbol symbols[] = {
    {"oniInitialize", offsetof(openni2_api, initialize), false},
    {"oniShutdown", offsetof(openni2_api, shutdown), false},
    {"oniGetExtendedError", offsetof(openni2_api, error), false},
    {"oniGetDeviceList", offsetof(openni2_api, get_devices), false},
    {"oniReleaseDeviceList", offsetof(openni2_api, release_devices), false},
    {"oniRegisterDeviceCallbacks", offsetof(openni2_api, add_callbacks), false},
    {"oniUnregisterDeviceCallbacks", offsetof(openni2_api, remove_callbacks), false},
    {"oniWaitForAnyStream", offsetof(openni2_api, wait_any), false},
    {"oniDeviceOpen", offsetof(openni2_api, device_open), false},
    {"oniDeviceClose", offsetof(openni2_api, device_close), false},
    {"oniDeviceGetInfo", offsetof(openni2_api, device_info), false},
    {"oniDeviceGetSensorInfo", offsetof(openni2_api, device_sensor), false},
    {"oniDeviceCreateStream", offsetof(openni2_api, device_stream), false},
    {"oniDeviceSetProperty", offsetof(openni2_api, device_set), false},
    {"oniDeviceGetProperty", offsetof(openni2_api, device_get), false},
    {"oniDeviceIsImageRegistrationModeSupported", offsetof(openni2_api, device_can_register),
     false},
    {"oniStreamDestroy", offsetof(openni2_api, stream_destroy), false},
    {"oniStreamStart", offsetof(openni2_api, stream_start), false},
    {"oniStreamStop", offsetof(openni2_api, stream_stop), false},
    {"oniStreamReadFrame", offsetof(openni2_api, stream_read), false},
    {"oniStreamSetProperty", offsetof(openni2_api, stream_set), false},
    {"oniStreamGetProperty", offsetof(openni2_api, stream_get), false},
    {"oniFrameRelease", offsetof(openni2_api, frame_release), false},
};

/* OPENNI2_REDIST is what the installers of vendors set: their folder with the library and the
 * drivers. */
static void load(void)
{
    static char paths[2][1024];
    const char *folder = getenv("OPENNI2_REDIST");
    const char *names[5] = {"libOpenNI2.so.0", "libOpenNI2.so", NULL, NULL, NULL};
    if (folder != NULL && folder[0] != '\0') {
        for (int i = 0; i < 2; i++) {
            snprintf(paths[i], sizeof(paths[i]), "%.900s/%s", folder, names[i]);
            names[i + 2] = names[i];
            names[i] = paths[i];
        }
    }
    const io_library_def def = {.variable = "RELIEF_OPENNI2_LIBRARY",
                                .names = names,
                                .cure = "apt install libopenni2-0, or set OPENNI2_REDIST to the "
                                        "folder of the vendor's own",
                                .symbols = symbols,
                                .symbol_count = (int32_t)(sizeof(symbols) / sizeof(symbols[0]))};
    is_loaded = io_library_load(&def, &api, reason, sizeof(reason));
}

const char *openni2_unavailable(void)
{
    (void)pthread_once(&once, load);
    return is_loaded ? NULL : reason;
}

rlf_result openni2_begin(const char *who, const openni2_api **out)
{
    if (openni2_unavailable() != NULL) {
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
