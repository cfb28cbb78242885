/* Stands in for libfreenect: a Kinect with a factory calibration that a test knows. A test plays
 * pictures through freenect_stub_control, found in the same shared object. */
#include "freenect_stub.h"

#include <stdlib.h>
#include <string.h>

/* Called by name: no header declares these functions. */
#define EXPORT __attribute__((visibility("default")))

static struct {
    void *user;
    freenect_picture_fn on_depth, on_video;
    int32_t (*table)[2];
    int32_t *shift;
    uint16_t picture[FREENECT_WIDTH * FREENECT_HEIGHT];
    uint8_t video[FREENECT_WIDTH * FREENECT_HEIGHT * 3];
} stub;

static freenect_stub_control control;
EXPORT freenect_stub_control *freenect_stub_get(void)
{
    return &control;
}

EXPORT int freenect_init(void **context, void *usb)
{
    (void)usb;
    *context = &stub;
    return 0;
}

EXPORT int freenect_shutdown(void *context)
{
    (void)context;
    return 0;
}

EXPORT void freenect_set_log_callback(void *context, freenect_log_fn fn)
{
    fn(context, 4, "stand-in\n");
}

EXPORT void freenect_select_subdevices(void *context, int flags)
{
    (void)context;
    control.subdevices = flags;
}

EXPORT int freenect_num_devices(void *context)
{
    (void)context;
    return control.is_absent ? 0 : 1;
}

EXPORT int freenect_open_device(void *context, void **device, int index)
{
    (void)context;
    *device = &stub;
    return index == 0 && !control.is_absent ? 0 : -1;
}

EXPORT int freenect_open_device_by_camera_serial(void *context, void **device, const char *serial)
{
    return freenect_open_device(context, device, strcmp(serial, STUB_SERIAL) == 0 ? 0 : 1);
}

EXPORT int freenect_close_device(void *device)
{
    (void)device;
    return 0;
}

EXPORT void freenect_set_user(void *device, void *user)
{
    (void)device;
    stub.user = user;
}

EXPORT void *freenect_get_user(void *device)
{
    (void)device;
    return stub.user;
}

EXPORT void freenect_set_depth_callback(void *device, freenect_picture_fn fn)
{
    (void)device;
    stub.on_depth = fn;
}

EXPORT void freenect_set_video_callback(void *device, freenect_picture_fn fn)
{
    (void)device;
    stub.on_video = fn;
}

static freenect_mode mode(int format)
{
    return (freenect_mode){.resolution = FREENECT_MEDIUM,
                           .format = format,
                           .width = FREENECT_WIDTH,
                           .height = FREENECT_HEIGHT,
                           .rate = 30,
                           .is_valid = 1};
}

EXPORT freenect_mode freenect_find_depth_mode(int resolution, int format)
{
    (void)resolution;
    return mode(format);
}

EXPORT freenect_mode freenect_find_video_mode(int resolution, int format)
{
    (void)resolution;
    return mode(format);
}

EXPORT int freenect_set_depth_mode(void *device, freenect_mode wanted)
{
    (void)device;
    control.depth_format = wanted.format;
    return 0;
}

EXPORT int freenect_set_video_mode(void *device, freenect_mode wanted)
{
    (void)device;
    return wanted.format == FREENECT_RGB ? 0 : -1;
}

EXPORT int freenect_start_depth(void *device)
{
    (void)device;
    return control.does_not_start ? -1 : 0;
}

EXPORT int freenect_start_video(void *device)
{
    (void)device;
    control.has_video = true;
    return 0;
}

EXPORT int freenect_stop_depth(void *device)
{
    (void)device;
    return 0;
}

EXPORT int freenect_stop_video(void *device)
{
    (void)device;
    control.has_video = false;
    return 0;
}

/* Gives the next picture of the play list. */
EXPORT int freenect_process_events_timeout(void *context, struct timeval *timeout)
{
    (void)context;
    (void)timeout;
    if (control.is_unplugged) {
        return -1;
    }
    if (control.next >= control.count) {
        return 0;
    }
    const freenect_stub_event *e = &control.events[control.next++];
    if (e->is_depth) {
        for (int i = 0; i < FREENECT_WIDTH * FREENECT_HEIGHT; i++) {
            stub.picture[i] = stub_raw(e->picture, i % FREENECT_WIDTH, i / FREENECT_WIDTH);
        }
        stub.on_depth(&stub, stub.picture, e->ticks);
    } else if (control.has_video) {
        for (int i = 0; i < FREENECT_WIDTH * FREENECT_HEIGHT * 3; i++) {
            stub.video[i] = (uint8_t)(i + e->picture);
        }
        stub.on_video(&stub, stub.video, e->ticks);
    }
    return 0;
}

EXPORT int freenect_list_device_attributes(void *context, freenect_attributes **out)
{
    (void)context;
    static freenect_attributes list = {NULL, STUB_SERIAL};
    *out = &list;
    return 1;
}

EXPORT void freenect_free_device_attributes(freenect_attributes *list)
{
    (void)list;
}

/* The tables as a Kinect with this colour camera would have them. */
EXPORT freenect_registration freenect_copy_registration(void *device)
{
    (void)device;
    stub.table = calloc(FREENECT_WIDTH * FREENECT_HEIGHT, sizeof(stub.table[0]));
    stub.shift = calloc(FREENECT_MM_COUNT, sizeof(stub.shift[0]));
    freenect_registration r = {.emitter_cm = 7.5f,
                               .color_cm = STUB_COLOR_CM,
                               .reference_cm = 120.0f,
                               .pixel_mm = STUB_PIXEL_MM,
                               .const_shift = 200.0,
                               .depth_to_rgb_shift = stub.shift,
                               .table = stub.table};
    const double f = 120.0 / (2.0 * (double)STUB_PIXEL_MM);
    const double slope = STUB_FX * STUB_COLOR_CM / 100.0; /* pixels times metres */
    for (int mm = 1; mm < FREENECT_MM_COUNT; mm++) {
        stub.shift[mm] = (int32_t)((slope / 1.2 - slope * 1000.0 / mm) * FREENECT_TABLE_SCALE);
    }
    for (int i = 0; i < FREENECT_WIDTH * FREENECT_HEIGHT; i++) {
        const double ray_x = (i % FREENECT_WIDTH - 319.5) / f;
        const double ray_y = (i / FREENECT_WIDTH - 239.5) / f;
        const double bend = 1.0 + STUB_K1 * (ray_x * ray_x + ray_y * ray_y);
        const double x = ray_x * bend;
        const double y = ray_y * bend;
        const double far_x = STUB_FX * (STUB_COS * x - STUB_SIN * y) + STUB_CX;
        const double far_y = STUB_FY * (STUB_SIN * x + STUB_COS * y) + STUB_CY;
        stub.table[i][0] = (int32_t)((far_x + 0.5 - slope / 1.2) * FREENECT_TABLE_SCALE);
        stub.table[i][1] = far_y > 0.0 ? (int32_t)(far_y + 0.5) : 0;
        if (far_y < 0.0 || far_y >= FREENECT_HEIGHT - 1) {
            stub.table[i][0] = (int32_t)(2 * FREENECT_WIDTH * FREENECT_TABLE_SCALE);
        }
    }
    return r;
}

EXPORT int freenect_destroy_registration(freenect_registration *r)
{
    free(r->table);
    free(r->depth_to_rgb_shift);
    return 0;
}
