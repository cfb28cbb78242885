/* libfreenect, found at run time. */
#define _POSIX_C_SOURCE 200809L
#include "io/freenect/freenect.h"

#include "io/live/driver.h"

#include <pthread.h>

static freenect_api api;
static bool is_loaded;
static char reason[320];
static pthread_once_t once = PTHREAD_ONCE_INIT;

static const io_symbol symbols[] = {
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
    static const char *const names[] = {"libfreenect.so.0.5", "libfreenect.so.0", NULL};
    static const io_library_def def = {
        .variable = "RELIEF_FREENECT_LIBRARY",
        .names = names,
        .cure = "apt install libfreenect0.5, or name its file in RELIEF_FREENECT_LIBRARY",
        .symbols = symbols,
        .symbol_count = (int32_t)(sizeof(symbols) / sizeof(symbols[0]))};
    is_loaded = io_library_load(&def, &api, reason, sizeof(reason));
}

const freenect_api *freenect_get_api(void)
{
    (void)pthread_once(&once, load);
    return is_loaded ? &api : NULL;
}

const char *freenect_unavailable(void)
{
    return freenect_get_api() != NULL ? NULL : reason;
}
