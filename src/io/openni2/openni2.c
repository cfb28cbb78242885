/* Cameras through OpenNI2: PrimeSense, Asus Xtion, older Orbbec. */
#define _POSIX_C_SOURCE 200809L
#include "io/openni2/openni2.h"
#include "io/source/backends.h"
#include "io/live/driver.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

/* ---- the library ------------------------------------------------------------------------- */

static openni2_api functions;
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
    .table = &functions};

static const char *unavailable(void)
{
    return io_library_fault(&library);
}

rlf_result openni2_begin(const char *who, const openni2_api **out)
{
    const char *fault = io_library_fault(&library);
    if (fault != NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: %s", who, fault);
    }
    pthread_mutex_lock(&lock);
    const int status = functions.initialize(OPENNI2_VERSION);
    if (status != OPENNI2_OK) {
        functions.shutdown(); /* a failed call was counted all the same */
    }
    pthread_mutex_unlock(&lock);
    if (status != OPENNI2_OK) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: OpenNI2 cannot start (status %d): check that its drivers lie in the "
                        "folder OpenNI2/Drivers beside libOpenNI2.so.0",
                        who, status);
    }
    *out = &functions;
    return RLF_OK;
}

void openni2_end(void)
{
    pthread_mutex_lock(&lock);
    functions.shutdown();
    pthread_mutex_unlock(&lock);
}

typedef struct camera {
    char source[512]; /* as the user gave it, for error lines */
    openni2_wish wish;
    openni2_device device;
    rlf_rig rig;
    io_stream_pair pair;
    void *callbacks;
    atomic_bool is_gone; /* it was unplugged, or failed */
} camera;

static void on_disconnected(const openni2_info *info, void *cookie)
{
    camera *c = cookie;
    if (strcmp(info->uri, c->device.info.uri) == 0) {
        atomic_store(&c->is_gone, true);
    }
}

static void on_state(const openni2_info *info, int state, void *cookie)
{
    camera *c = cookie;
    if (strcmp(info->uri, c->device.info.uri) != 0) {
        return;
    }
    if (state == OPENNI2_STATE_ERROR) {
        atomic_store(&c->is_gone, true);
    }
}

/* A frame must have the size that the stream was opened with, and hold all its rows. */
static bool is_whole(const openni2_frame *f, const openni2_stream *stream, int pixel_size)
{
    return f->data != NULL && f->width == stream->mode.width && f->height == stream->mode.height &&
           f->is_cropped == 0 && f->stride >= f->width * pixel_size &&
           (int64_t)f->stride * (f->height - 1) + (int64_t)f->width * pixel_size <= f->data_size;
}

static void push_depth(camera *c, const openni2_frame *f)
{
    uint16_t *out = io_stream_pair_depth(&c->pair);
    for (int y = 0; y < f->height; y++) {
        const char *row = (const char *)f->data + (ptrdiff_t)y * f->stride;
        io_depth_row((const void *)row, f->width, c->device.depth.flips,
                     out + (ptrdiff_t)y * f->width);
    }
    io_stream_pair_push_depth(&c->pair, io_live_time(f->time_us), f->index > 0 ? f->index : -1);
}

static void push_color(camera *c, const openni2_frame *f)
{
    const rlf_image_rgba8 out = io_stream_pair_color(&c->pair);
    for (int y = 0; y < f->height; y++) {
        io_rgb_row((const uint8_t *)f->data + (ptrdiff_t)y * f->stride, f->width,
                   c->device.color.flips, rlf_rgba8_row(&out, y));
    }
    io_stream_pair_push_color(&c->pair, io_live_time(f->time_us));
}

/* Takes a frame from the stream that has one. */
static rlf_result read_stream(camera *c, bool is_depth)
{
    const openni2_api *api = c->device.api;
    const openni2_stream *stream = is_depth ? &c->device.depth : &c->device.color;
    openni2_frame *frame = NULL;
    if (api->stream_read(stream->handle, &frame) != OPENNI2_OK || frame == NULL) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: a frame cannot be read: %.300s", c->source,
                        api->error());
    }
    if (!is_whole(frame, stream, is_depth ? 2 : 3)) {
        c->pair.status.damaged++;
    } else if (is_depth) {
        push_depth(c, frame);
    } else {
        push_color(c, frame);
    }
    api->frame_release(frame);
    return RLF_OK;
}

static rlf_result wait_for_frame(camera *c, int timeout_ms)
{
    void *streams[2] = {c->device.depth.handle, c->device.color.handle};
    const int count = streams[1] != NULL ? 2 : 1;
    int index = 0;
    const int status = c->device.api->wait_any(streams, count, &index, timeout_ms);
    if (status == OPENNI2_TIME_OUT) {
        return RLF_NO_FRAME;
    }
    if (status != OPENNI2_OK || index < 0 || index >= count) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: OpenNI2 stops giving frames: %.300s", c->source,
                        c->device.api->error());
    }
    return read_stream(c, index == 0);
}

static rlf_result pump(void *self, int32_t wait_ms)
{
    camera *c = self;
    rlf_result result = atomic_load(&c->is_gone) ? RLF_NO_FRAME : wait_for_frame(c, wait_ms);
    if (!atomic_load(&c->is_gone)) {
        return result;
    }
    c->pair.status.is_connected = false;
    return rlf_fail(RLF_ERROR_DEVICE, "%s: the camera is gone: plug it in again", c->source);
}

static rlf_result next_frame(void *self, rlf_frame *out)
{
    return io_stream_pair_next(&((camera *)self)->pair, pump, self, out);
}

static void status(void *self, rlf_source_status *out)
{
    const camera *c = self;
    *out = c->pair.status;
}

static void close_device(camera *c)
{
    const openni2_api *api = c->device.api;
    if (api != NULL) {
        openni2_device_close(&c->device);
        if (c->callbacks != NULL) {
            api->remove_callbacks(c->callbacks);
            c->callbacks = NULL;
        }
        openni2_end();
        c->device.api = NULL;
    }
}

static void destroy(void *self)
{
    camera *c = self;
    close_device(c);
    io_stream_pair_finish(&c->pair);
    rlf_free(c);
}

/* Opens the device and asks to be told when it goes. */
static rlf_result open_device(camera *c, const rlf_address *address)
{
    openni2_callbacks callbacks = {.disconnected = on_disconnected, .state_changed = on_state};
    rlf_result result = openni2_begin(address->source, &c->device.api);
    result = result == RLF_OK ? openni2_device_open(address, &c->wish, &c->device) : result;
    if (result == RLF_OK &&
        c->device.api->add_callbacks(&callbacks, c, &c->callbacks) != OPENNI2_OK) {
        c->callbacks = NULL;
        result = rlf_fail(RLF_ERROR_DEVICE, "%s: OpenNI2 refuses to tell when it is unplugged",
                          address->source);
    }
    return result;
}

static uint32_t flags_of(const openni2_device *device)
{
    const bool flips = device->depth.flips || (device->color.handle != NULL && device->color.flips);
    return (flips ? (uint32_t)RLF_FRAME_UNMIRRORED : 0u) |
           (device->is_aligned ? (uint32_t)RLF_FRAME_ALIGNED : 0u);
}

static rlf_result open_all(camera *c, const rlf_address *address)
{
    rlf_result result = open_device(c, address);
    result = result == RLF_OK ? openni2_make_rig(address, &c->device, &c->rig) : result;
    if (result == RLF_OK) {
        result = io_stream_pair_init(&c->pair, &c->rig, openni2_units(&c->device),
                                     c->device.depth.mode.fps);
        c->pair.flags = flags_of(&c->device);
    }
    return result == RLF_OK ? openni2_device_start(address, &c->device) : result;
}

static rlf_result open_camera(const rlf_address *address, rlf_opened *out)
{
    static const rlf_source_methods methods = {
        .next = next_frame, .destroy = destroy, .status = status};
    camera *c = rlf_alloc(sizeof(*c));
    if (c == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const openni2_device *d = &c->device;
    snprintf(c->source, sizeof(c->source), "%.511s", address->source);
    rlf_result result = openni2_read_wish(address, &c->wish);
    result = result == RLF_OK ? open_all(c, address) : result;
    io_live_opened(&methods, c, c->source, &c->rig, d->depth.mode.fps, out);
    snprintf(out->info.device, sizeof(out->info.device), "OpenNI2: %.30s %.30s%s%.30s",
             d->info.vendor, d->info.name, d->serial[0] != '\0' ? ", serial " : "", d->serial);
    return io_open_end(result, c, destroy);
}

static int32_t list(rlf_source_entry *out, int32_t capacity)
{
    const openni2_api *api = NULL;
    openni2_info *devices = NULL;
    int device_count = 0;
    int32_t count = 0;
    if (openni2_begin("openni2:", &api) != RLF_OK) {
        return 0;
    }
    if (api->get_devices(&devices, &device_count) == OPENNI2_OK) {
        for (int i = 0; i < device_count; i++) {
            if (openni2_is_test_device(&devices[i])) {
                continue;
            }
            if (count < capacity) {
                rlf_source_entry *e = &out[count];
                snprintf(e->source, sizeof(e->source), "openni2:%.240s", devices[i].uri);
                snprintf(e->description, sizeof(e->description), "%.60s %.60s", devices[i].vendor,
                         devices[i].name);
            }
            count++;
        }
        api->release_devices(devices);
    }
    openni2_end();
    return count;
}

const rlf_backend io_backend_openni2 = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "openni2",
    .keys = "mode color aligned mirror",
    .summary = "a camera of PrimeSense, Asus Xtion or older Orbbec: URI or serial number",
    .is_live = true,
    .unavailable = unavailable,
    .list = list,
    .open = open_camera,
};
