/* OpenNI2, found at run time. */
#define _POSIX_C_SOURCE 200809L
#include "io/openni2/api.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The library and its drivers are never unloaded: some leave threads behind. */
static openni2_api api;
static bool is_loaded;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static const struct {
    const char *name;
    size_t offset;
} symbols[] = {
    {"oniInitialize", offsetof(openni2_api, initialize)},
    {"oniShutdown", offsetof(openni2_api, shutdown)},
    {"oniGetExtendedError", offsetof(openni2_api, error)},
    {"oniGetDeviceList", offsetof(openni2_api, get_devices)},
    {"oniReleaseDeviceList", offsetof(openni2_api, release_devices)},
    {"oniRegisterDeviceCallbacks", offsetof(openni2_api, add_callbacks)},
    {"oniUnregisterDeviceCallbacks", offsetof(openni2_api, remove_callbacks)},
    {"oniWaitForAnyStream", offsetof(openni2_api, wait_any)},
    {"oniDeviceOpen", offsetof(openni2_api, device_open)},
    {"oniDeviceClose", offsetof(openni2_api, device_close)},
    {"oniDeviceGetInfo", offsetof(openni2_api, device_info)},
    {"oniDeviceGetSensorInfo", offsetof(openni2_api, device_sensor)},
    {"oniDeviceCreateStream", offsetof(openni2_api, device_stream)},
    {"oniDeviceSetProperty", offsetof(openni2_api, device_set)},
    {"oniDeviceGetProperty", offsetof(openni2_api, device_get)},
    {"oniDeviceIsImageRegistrationModeSupported", offsetof(openni2_api, device_can_register)},
    {"oniStreamDestroy", offsetof(openni2_api, stream_destroy)},
    {"oniStreamStart", offsetof(openni2_api, stream_start)},
    {"oniStreamStop", offsetof(openni2_api, stream_stop)},
    {"oniStreamReadFrame", offsetof(openni2_api, stream_read)},
    {"oniStreamSetProperty", offsetof(openni2_api, stream_set)},
    {"oniStreamGetProperty", offsetof(openni2_api, stream_get)},
    {"oniFrameRelease", offsetof(openni2_api, frame_release)},
};

/* OPENNI2_REDIST is what the installers of vendors set: their folder with the library and the
 * drivers. */
static void *open_library(void)
{
    static const char *const names[2] = {"libOpenNI2.so.0", "libOpenNI2.so"};
    const char *folder = getenv("OPENNI2_REDIST");
    void *library = NULL;
    for (int i = 0; i < 2 && library == NULL && folder != NULL; i++) {
        char path[4096];
        int length = snprintf(path, sizeof(path), "%s/%s", folder, names[i]);
        if (length > 0 && (size_t)length < sizeof(path)) {
            library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        }
    }
    for (int i = 0; i < 2 && library == NULL; i++) {
        library = dlopen(names[i], RTLD_NOW | RTLD_LOCAL);
    }
    return library;
}

static bool load(void)
{
    if (is_loaded) {
        return true;
    }
    void *library = open_library();
    if (library == NULL) {
        return false;
    }
    for (size_t i = 0; i < sizeof(symbols) / sizeof(symbols[0]); i++) {
        void *symbol = dlsym(library, symbols[i].name);
        if (symbol == NULL) {
            dlclose(library);
            return false;
        }
        memcpy((char *)&api + symbols[i].offset, &symbol, sizeof(symbol));
    }
    is_loaded = true;
    return true;
}

const char *openni2_unavailable(void)
{
    pthread_mutex_lock(&lock);
    const bool is_there = load();
    pthread_mutex_unlock(&lock);
    return is_there ? NULL
                    : "libOpenNI2.so.0 is not installed: apt install libopenni2-0, or set "
                      "OPENNI2_REDIST to the folder of the vendor's own";
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
