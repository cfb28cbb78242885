/* libfreenect, found at run time. */
#define _POSIX_C_SOURCE 200809L
#include "io/freenect/api.h"

#include <dlfcn.h>
#include <pthread.h>
#include <string.h>

static freenect_api api;
static bool is_loaded;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static const struct {
    const char *name;
    size_t offset;
    bool is_optional;
} symbols[] = {
    {"freenect_init", offsetof(freenect_api, init), false},
    {"freenect_shutdown", offsetof(freenect_api, shutdown), false},
    {"freenect_set_log_callback", offsetof(freenect_api, set_log), false},
    {"freenect_select_subdevices", offsetof(freenect_api, select_subdevices), false},
    {"freenect_num_devices", offsetof(freenect_api, count_devices), false},
    {"freenect_open_device", offsetof(freenect_api, open), false},
    {"freenect_open_device_by_camera_serial", offsetof(freenect_api, open_serial), false},
    {"freenect_close_device", offsetof(freenect_api, close), false},
    {"freenect_set_user", offsetof(freenect_api, set_user), false},
    {"freenect_get_user", offsetof(freenect_api, get_user), false},
    {"freenect_set_depth_callback", offsetof(freenect_api, on_depth), false},
    {"freenect_set_video_callback", offsetof(freenect_api, on_video), false},
    {"freenect_find_depth_mode", offsetof(freenect_api, find_depth), false},
    {"freenect_find_video_mode", offsetof(freenect_api, find_video), false},
    {"freenect_set_depth_mode", offsetof(freenect_api, set_depth), false},
    {"freenect_set_video_mode", offsetof(freenect_api, set_video), false},
    {"freenect_start_depth", offsetof(freenect_api, start_depth), false},
    {"freenect_start_video", offsetof(freenect_api, start_video), false},
    {"freenect_stop_depth", offsetof(freenect_api, stop_depth), false},
    {"freenect_stop_video", offsetof(freenect_api, stop_video), false},
    {"freenect_process_events_timeout", offsetof(freenect_api, process), false},
    {"freenect_list_device_attributes", offsetof(freenect_api, list_attributes), true},
    {"freenect_free_device_attributes", offsetof(freenect_api, free_attributes), true},
    {"freenect_copy_registration", offsetof(freenect_api, copy_registration), true},
    {"freenect_destroy_registration", offsetof(freenect_api, destroy_registration), true},
};

static void load(void)
{
    static const char *const names[] = {"libfreenect.so.0.5", "libfreenect.so.0"};
    void *library = NULL;
    /* Lazily bound: stand-ins of the library lack functions that it names. */
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]) && library == NULL; i++) {
        library = dlopen(names[i], RTLD_LAZY | RTLD_LOCAL);
    }
    if (library == NULL) {
        return;
    }
    for (size_t i = 0; i < sizeof(symbols) / sizeof(symbols[0]); i++) {
        void *symbol = dlsym(library, symbols[i].name);
        if (symbol == NULL && !symbols[i].is_optional) {
            dlclose(library);
            return;
        }
        memcpy((char *)&api + symbols[i].offset, &symbol, sizeof(symbol));
    }
    is_loaded = true;
}

const freenect_api *freenect_get_api(void)
{
    pthread_mutex_lock(&lock);
    if (!is_loaded) {
        load();
    }
    const bool is_there = is_loaded;
    pthread_mutex_unlock(&lock);
    return is_there ? &api : NULL;
}

const char *freenect_unavailable(void)
{
    return freenect_get_api() != NULL ? NULL
                                      : "libfreenect.so.0.5 is not installed: apt install "
                                        "libfreenect0.5";
}
