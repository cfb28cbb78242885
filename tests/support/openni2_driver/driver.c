/* A driver for OpenNI2 without a device: it serves pictures that a test knows, when the test asks
 * for them. With RELIEF_OPENNI2_TEST_RUN=1 in the environment it sends 30 a second by itself. */
#define _POSIX_C_SOURCE 200809L
#include "control.h"

#include "io/openni2/openni2.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Called by name: no header declares these functions. */
#define EXPORT __attribute__((visibility("default")))

/* Functions that OpenNI2 gives to a stream of a driver. */
typedef struct stream_services {
    void *self;
    int (*frame_size)(void *self);
    openni2_frame *(*acquire)(void *self);
    void (*add_ref)(void *self, openni2_frame *frame);
    void (*release)(void *self, openni2_frame *frame);
} stream_services;

typedef struct stream {
    openni2_mode mode;
    int type, mirror;
    atomic_bool is_started;
    stream_services *services;
    void (*on_frame)(void *stream, openni2_frame *frame, void *cookie);
    void *frame_cookie;
    void (*on_property)(void *stream, int id, const void *data, int size, void *cookie);
    void *property_cookie;
} stream;

static openni2_mode depth_modes[] = {{OPENNI2_DEPTH_1_MM, 320, 240, 60},
                                     {OPENNI2_DEPTH_1_MM, 640, 480, 30},
                                     {OPENNI2_DEPTH_100_UM, 640, 480, 30},
                                     {OPENNI2_DEPTH_100_UM, 512, 424, 30},
                                     {102, 1280, 1024, 30}};
static openni2_mode color_modes[] = {{203, 640, 480, 30},
                                     {OPENNI2_RGB888, 320, 240, 60},
                                     {OPENNI2_RGB888, 640, 480, 30},
                                     {OPENNI2_RGB888, 960, 540, 30}};
static openni2_sensor sensors[2] = {{OPENNI2_DEPTH, 5, depth_modes},
                                    {OPENNI2_COLOR, 4, color_modes}};
static const openni2_info info = {DRIVER_URI, "Relief", "Test camera", 0x1d27, 0x0609};

static struct {
    void (*connected)(const openni2_info *info, void *cookie);
    void (*disconnected)(const openni2_info *info, void *cookie);
    void (*changed)(const openni2_info *info, int state, void *cookie);
    void *cookie;
    stream depth, color;
    pthread_t thread;
    atomic_bool is_running;
    int device; /* its address is the device */
} driver;

EXPORT openni2_test_control openni2_test_control_block;

static void fill_row(const stream *s, int n, int y, uint8_t *row)
{
    const int w = s->mode.width;
    for (int x = 0; x < w; x++) {
        const int real_x = s->mirror != 0 ? w - 1 - x : x;
        if (s->type == OPENNI2_DEPTH) {
            const int unit = s->mode.format == OPENNI2_DEPTH_100_UM ? 10 : 1;
            const uint16_t z = (uint16_t)(driver_depth(n, real_x, y) * unit);
            memcpy(row + (ptrdiff_t)2 * x, &z, 2);
        } else {
            for (int c = 0; c < 3; c++) {
                row[3 * x + c] = driver_color(n, real_x, y, c);
            }
        }
    }
}

static bool send_frame(bool is_depth, int n, uint64_t time_us, int index)
{
    stream *s = is_depth ? &driver.depth : &driver.color;
    openni2_frame *f = s->is_started ? s->services->acquire(s->services->self) : NULL;
    if (f == NULL) {
        return false;
    }
    const int pixel_size = is_depth ? 2 : 3;
    f->sensor = s->type;
    f->time_us = time_us;
    f->index = index;
    f->width = s->mode.width;
    f->height = s->mode.height;
    f->mode = s->mode;
    f->is_cropped = 0;
    f->crop_x = f->crop_y = 0;
    f->stride = s->mode.width * pixel_size;
    f->data_size = f->stride * f->height;
    for (int y = 0; y < f->height; y++) {
        fill_row(s, n, y, (uint8_t *)f->data + (ptrdiff_t)y * f->stride);
    }
    s->on_frame(s, f, s->frame_cookie);
    s->services->release(s->services->self, f);
    return true;
}

static void *run(void *unused)
{
    (void)unused;
    for (int n = 0; driver.is_running; n++) {
        const struct timespec pause = {0, 33333333};
        nanosleep(&pause, NULL);
        send_frame(true, n, (uint64_t)n * 33333, n + 1);
        send_frame(false, n, (uint64_t)n * 33333 + 4000, n + 1);
    }
    return NULL;
}

static void plug(void)
{
    driver.connected(&info, driver.cookie);
}

static void unplug(void)
{
    driver.disconnected(&info, driver.cookie);
}

EXPORT void oniDriverCreate(void *services)
{
    (void)services;
    openni2_test_control_block.send = send_frame;
    openni2_test_control_block.plug = plug;
    openni2_test_control_block.unplug = unplug;
}

EXPORT int oniDriverInitialize(void (*connected)(const openni2_info *, void *),
                               void (*disconnected)(const openni2_info *, void *),
                               void (*changed)(const openni2_info *, int, void *), void *cookie)
{
    driver.connected = connected;
    driver.disconnected = disconnected;
    driver.changed = changed;
    driver.cookie = cookie;
    plug();
    return OPENNI2_OK;
}

EXPORT void oniDriverDestroy(void) {}

EXPORT int oniDriverTryDevice(const char *uri)
{
    (void)uri;
    return 1;
}

/* ---- device ---- */

EXPORT void *oniDriverDeviceOpen(const char *uri, const char *mode)
{
    (void)uri;
    (void)mode;
    openni2_test_control_block.open_count++;
    return &driver.device;
}

EXPORT void oniDriverDeviceClose(void *device)
{
    (void)device;
    openni2_test_control_block.open_count--;
}

EXPORT int oniDriverDeviceGetSensorInfoList(void *device, openni2_sensor **out, int *out_count)
{
    (void)device;
    *out = sensors;
    *out_count = 2;
    return OPENNI2_OK;
}

EXPORT void *oniDriverDeviceCreateStream(void *device, int type)
{
    (void)device;
    stream *s = type == OPENNI2_DEPTH ? &driver.depth : &driver.color;
    s->type = type;
    s->mode = type == OPENNI2_DEPTH ? depth_modes[0] : color_modes[1];
    s->mirror = 1;
    return s;
}

EXPORT void oniDriverDeviceDestroyStream(void *device, void *handle)
{
    (void)device;
    (void)handle;
}

EXPORT int oniDriverDeviceSetProperty(void *device, int id, const void *data, int size)
{
    (void)device;
    if (id != OPENNI2_DEVICE_REGISTRATION || size != (int)sizeof(int) ||
        openni2_test_control_block.cannot_register) {
        return 3;
    }
    openni2_test_control_block.is_registered = *(const int *)data != 0;
    return OPENNI2_OK;
}

EXPORT int oniDriverDeviceGetProperty(void *device, int id, void *data, int *size)
{
    (void)device;
    if (id != OPENNI2_DEVICE_SERIAL || *size < (int)sizeof(DRIVER_SERIAL)) {
        return 3;
    }
    memcpy(data, DRIVER_SERIAL, sizeof(DRIVER_SERIAL));
    *size = sizeof(DRIVER_SERIAL);
    return OPENNI2_OK;
}

EXPORT int oniDriverDeviceIsPropertySupported(void *device, int id)
{
    (void)device;
    return id == OPENNI2_DEVICE_SERIAL || id == OPENNI2_DEVICE_REGISTRATION;
}

EXPORT void oniDriverDeviceSetPropertyChangedCallback(void *device, void *handler, void *cookie)
{
    (void)device;
    (void)handler;
    (void)cookie;
}

EXPORT void oniDriverDeviceNotifyAllProperties(void *device)
{
    (void)device;
}

EXPORT int oniDriverDeviceInvoke(void *device, int command, void *data, int size)
{
    (void)device;
    (void)command;
    (void)data;
    (void)size;
    return 3;
}

EXPORT int oniDriverDeviceIsCommandSupported(void *device, int command)
{
    (void)device;
    (void)command;
    return 0;
}

EXPORT int oniDriverDeviceTryManualTrigger(void *device)
{
    (void)device;
    return OPENNI2_OK;
}

EXPORT int oniDriverDeviceIsImageRegistrationModeSupported(void *device, int mode)
{
    (void)device;
    return mode == 0 || !openni2_test_control_block.cannot_register;
}

/* ---- streams ---- */

EXPORT void oniDriverStreamSetServices(void *handle, void *services)
{
    ((stream *)handle)->services = services;
}

EXPORT int oniDriverStreamSetProperty(void *handle, int id, const void *data, int size)
{
    stream *s = handle;
    if (id == OPENNI2_STREAM_MODE && size == (int)sizeof(s->mode)) {
        memcpy(&s->mode, data, sizeof(s->mode));
        return OPENNI2_OK;
    }
    if (id == OPENNI2_STREAM_MIRROR && size == (int)sizeof(int) &&
        !openni2_test_control_block.mirror_is_stuck) {
        memcpy(&s->mirror, data, sizeof(int));
        return OPENNI2_OK;
    }
    return 3;
}

static int give(const void *value, int value_size, void *data, int *size)
{
    if (*size < value_size) {
        return 4;
    }
    memcpy(data, value, (size_t)value_size);
    *size = value_size;
    return OPENNI2_OK;
}

EXPORT int oniDriverStreamIsPropertySupported(void *handle, int id)
{
    const bool is_depth = ((stream *)handle)->type == OPENNI2_DEPTH;
    const bool has_fov = is_depth && !openni2_test_control_block.has_no_fov;
    return id == OPENNI2_STREAM_MODE || id == OPENNI2_STREAM_MIRROR ||
           (is_depth && id == OPENNI2_STREAM_MAX) ||
           (has_fov && (id == OPENNI2_STREAM_FOV_X || id == OPENNI2_STREAM_FOV_Y));
}

EXPORT int oniDriverStreamGetProperty(void *handle, int id, void *data, int *size)
{
    const stream *s = handle;
    const float fov[2] = {DRIVER_FOV_X, DRIVER_FOV_Y};
    const int max = DRIVER_MAX_DEPTH * (s->mode.format == OPENNI2_DEPTH_100_UM ? 6 : 1);
    if (oniDriverStreamIsPropertySupported(handle, id) == 0) {
        return 3;
    }
    switch (id) {
    case OPENNI2_STREAM_MODE: return give(&s->mode, sizeof(s->mode), data, size);
    case OPENNI2_STREAM_MIRROR: return give(&s->mirror, sizeof(int), data, size);
    case OPENNI2_STREAM_MAX: return give(&max, sizeof(int), data, size);
    default: return give(&fov[id - OPENNI2_STREAM_FOV_X], sizeof(float), data, size);
    }
}

EXPORT void oniDriverStreamSetPropertyChangedCallback(
    void *handle, void (*handler)(void *, int, const void *, int, void *), void *cookie)
{
    stream *s = handle;
    s->on_property = handler;
    s->property_cookie = cookie;
}

/* A recorder writes down what is told here. */
EXPORT void oniDriverStreamNotifyAllProperties(void *handle)
{
    stream *s = handle;
    static const int ids[5] = {OPENNI2_STREAM_MODE, OPENNI2_STREAM_FOV_X, OPENNI2_STREAM_FOV_Y,
                               OPENNI2_STREAM_MAX, OPENNI2_STREAM_MIRROR};
    for (int i = 0; i < 5; i++) {
        char data[64];
        int size = sizeof(data);
        if (oniDriverStreamGetProperty(handle, ids[i], data, &size) == OPENNI2_OK) {
            s->on_property(s, ids[i], data, size, s->property_cookie);
        }
    }
}

EXPORT int oniDriverStreamInvoke(void *handle, int command, void *data, int size)
{
    return oniDriverDeviceInvoke(handle, command, data, size);
}

EXPORT int oniDriverStreamIsCommandSupported(void *handle, int command)
{
    (void)handle;
    (void)command;
    return 0;
}

EXPORT int oniDriverStreamStart(void *handle)
{
    stream *s = handle;
    atomic_store(&s->is_started, true);
    if (s == &driver.depth && getenv("RELIEF_OPENNI2_TEST_RUN") != NULL) {
        atomic_store(&driver.is_running, true);
        return pthread_create(&driver.thread, NULL, run, NULL) == 0 ? OPENNI2_OK : 1;
    }
    return OPENNI2_OK;
}

EXPORT void oniDriverStreamStop(void *handle)
{
    stream *s = handle;
    if (s == &driver.depth && driver.is_running) {
        atomic_store(&driver.is_running, false);
        pthread_join(driver.thread, NULL);
    }
    atomic_store(&s->is_started, false);
}

EXPORT int oniDriverStreamGetRequiredFrameSize(void *handle)
{
    const stream *s = handle;
    return s->services->frame_size(s->services->self);
}

EXPORT void oniDriverStreamSetNewFrameCallback(void *handle,
                                               void (*handler)(void *, openni2_frame *, void *),
                                               void *cookie)
{
    stream *s = handle;
    s->on_frame = handler;
    s->frame_cookie = cookie;
}

EXPORT int oniDriverStreamConvertDepthToColorCoordinates(void)
{
    return 3;
}

EXPORT void *oniDriverEnableFrameSync(void **streams, int count)
{
    (void)streams;
    (void)count;
    return NULL;
}

EXPORT void oniDriverDisableFrameSync(void *group)
{
    (void)group;
}
