/* An open OpenNI2 device or recording: reading, being told that it is gone. */
#include "io/openni2/player.h"

#include <stdio.h>
#include <string.h>

static void on_disconnected(const openni2_info *info, void *cookie)
{
    openni2_player *o = cookie;
    if (strcmp(info->uri, o->device.info.uri) == 0) {
        atomic_store(&o->is_gone, true);
    }
}

static void on_state(const openni2_info *info, int state, void *cookie)
{
    openni2_player *o = cookie;
    if (strcmp(info->uri, o->device.info.uri) != 0) {
        return;
    }
    if (state == OPENNI2_STATE_ERROR) {
        atomic_store(&o->is_gone, true);
    } else if (state == OPENNI2_STATE_END_OF_FILE) {
        atomic_store(&o->is_ended, true);
    }
}

/* A frame must have the size that the stream was opened with, and hold all its rows. */
static bool is_whole(const openni2_frame *f, const openni2_stream *stream, int pixel_size)
{
    return f->data != NULL && f->width == stream->mode.width && f->height == stream->mode.height &&
           f->is_cropped == 0 && f->stride >= f->width * pixel_size &&
           (int64_t)f->stride * (f->height - 1) + (int64_t)f->width * pixel_size <= f->data_size;
}

static void push_depth(openni2_player *o, const openni2_frame *f)
{
    uint16_t *out = io_stream_pair_depth(&o->pair);
    for (int y = 0; y < f->height; y++) {
        const char *row = (const char *)f->data + (ptrdiff_t)y * f->stride;
        io_depth_row((const void *)row, f->width, o->device.depth.flips,
                     out + (ptrdiff_t)y * f->width);
    }
    io_stream_pair_push_depth(&o->pair, (int64_t)f->time_us * 1000, f->index > 0 ? f->index : -1);
}

static void push_color(openni2_player *o, const openni2_frame *f)
{
    const rlf_image_rgba8 out = io_stream_pair_color(&o->pair);
    for (int y = 0; y < f->height; y++) {
        io_rgb_row((const uint8_t *)f->data + (ptrdiff_t)y * f->stride, f->width,
                   o->device.color.flips, rlf_rgba8_row(&out, y));
    }
    io_stream_pair_push_color(&o->pair, (int64_t)f->time_us * 1000);
}

/* Takes a frame from the stream that has one. */
static rlf_result read_stream(openni2_player *o, bool is_depth)
{
    const openni2_api *api = o->device.api;
    const openni2_stream *stream = is_depth ? &o->device.depth : &o->device.color;
    openni2_frame *frame = NULL;
    if (api->stream_read(stream->handle, &frame) != OPENNI2_OK || frame == NULL) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: a frame cannot be read: %.300s", o->source,
                        api->error());
    }
    if (!is_whole(frame, stream, is_depth ? 2 : 3)) {
        o->pair.status.damaged++;
    } else if (is_depth) {
        push_depth(o, frame);
    } else {
        push_color(o, frame);
    }
    api->frame_release(frame);
    return RLF_OK;
}

rlf_result openni2_player_wait(openni2_player *o, int timeout_ms)
{
    void *streams[2] = {o->device.depth.handle, o->device.color.handle};
    const int count = streams[1] != NULL ? 2 : 1;
    int index = 0;
    const int status = o->device.api->wait_any(streams, count, &index, timeout_ms);
    if (status == OPENNI2_TIME_OUT) {
        return RLF_NO_FRAME;
    }
    if (status != OPENNI2_OK || index < 0 || index >= count) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: OpenNI2 stops giving frames: %.300s", o->source,
                        o->device.api->error());
    }
    return read_stream(o, index == 0);
}

void openni2_player_status(void *self, rlf_source_status *out)
{
    const openni2_player *o = self;
    *out = o->pair.status;
}

void openni2_player_close(openni2_player *o)
{
    const openni2_api *api = o->device.api;
    if (api != NULL) {
        openni2_device_close(&o->device);
        if (o->callbacks != NULL) {
            api->remove_callbacks(o->callbacks);
            o->callbacks = NULL;
        }
        openni2_end();
        o->device.api = NULL;
    }
}

void openni2_player_destroy(void *self)
{
    openni2_player *o = self;
    openni2_player_close(o);
    io_stream_pair_finish(&o->pair);
    rlf_free(o);
}

static rlf_result set_speed(openni2_player *o)
{
    const float each_when_asked = -1.0f;
    const int off = 0;
    const openni2_api *api = o->device.api;
    if (api->device_set(o->device.handle, OPENNI2_DEVICE_REPEAT, &off, sizeof(off)) !=
            OPENNI2_OK ||
        api->device_set(o->device.handle, OPENNI2_DEVICE_SPEED, &each_when_asked,
                        sizeof(each_when_asked)) != OPENNI2_OK) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: OpenNI2 does not play it frame by frame", o->source);
    }
    return RLF_OK;
}

/* Opens the device and asks to be told when it goes. */
static rlf_result open_device(openni2_player *o, const rlf_address *address)
{
    openni2_callbacks callbacks = {.disconnected = on_disconnected, .state_changed = on_state};
    o->device.api = openni2_begin(address->source);
    if (o->device.api == NULL) {
        return rlf_error_text()[0] != '\0' ? RLF_ERROR_UNSUPPORTED : RLF_ERROR_DEVICE;
    }
    rlf_result result = openni2_device_open(address, &o->wish, &o->device);
    if (result == RLF_OK && o->wish.is_file) {
        result = set_speed(o);
    }
    if (result == RLF_OK &&
        o->device.api->add_callbacks(&callbacks, o, &o->callbacks) != OPENNI2_OK) {
        o->callbacks = NULL;
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

rlf_result openni2_player_reopen(openni2_player *o)
{
    const rlf_address address = {.source = o->source, .place = o->place};
    openni2_player_close(o);
    io_stream_pair_clear(&o->pair);
    atomic_store(&o->is_ended, false);
    rlf_result result = open_device(o, &address);
    return result == RLF_OK ? openni2_device_start(&address, &o->device) : result;
}

static rlf_result open_all(openni2_player *o, const rlf_address *address)
{
    rlf_result result = open_device(o, address);
    if (result == RLF_OK) {
        result = openni2_make_rig(address, &o->device, &o->rig);
    }
    if (result == RLF_OK) {
        result = io_stream_pair_init(&o->pair, &o->rig, openni2_units(&o->device),
                                     o->device.depth.mode.fps);
        o->pair.flags = flags_of(&o->device);
    }
    if (o->wish.is_file) {
        o->frame_count =
            openni2_stream_int(&o->device, &o->device.depth, OPENNI2_STREAM_COUNT, -1);
    }
    return result == RLF_OK ? openni2_device_start(address, &o->device) : result;
}

void openni2_player_describe(openni2_player *o, const rlf_source_methods *methods, rlf_opened *out)
{
    const openni2_device *d = &o->device;
    memset(out, 0, sizeof(*out));
    out->methods = *methods;
    snprintf(out->info.name, sizeof(out->info.name), "%.127s", o->source);
    out->info.rig = o->rig;
    out->info.frame_count = o->wish.is_file ? o->frame_count : -1;
    out->info.frames_per_second = d->depth.mode.fps;
    out->self = o;
    out->info.is_live = !o->wish.is_file;
    out->info.can_seek = o->wish.is_file;
    if (o->wish.is_file) {
        snprintf(out->info.device, sizeof(out->info.device), "OpenNI recording");
    } else {
        snprintf(out->info.device, sizeof(out->info.device), "OpenNI2: %.30s %.30s%s%.30s",
                 d->info.vendor, d->info.name, d->serial[0] != '\0' ? ", serial " : "", d->serial);
    }
}

rlf_result openni2_player_create(const rlf_address *address, bool is_file, openni2_player **out)
{
    openni2_wish wish;
    rlf_result result = openni2_read_wish(address, is_file, &wish);
    if (result != RLF_OK) {
        return result;
    }
    openni2_player *o = rlf_alloc(sizeof(*o));
    if (o == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (strlen(address->source) >= sizeof(o->source)) {
        rlf_free(o);
        return rlf_fail(RLF_ERROR_INVALID, "%.100s...: the path is too long: use a shorter one",
                        address->source);
    }
    snprintf(o->source, sizeof(o->source), "%s", address->source);
    snprintf(o->place, sizeof(o->place), "%s", address->place);
    o->wish = wish;
    result = open_all(o, address);
    if (result != RLF_OK) {
        openni2_player_destroy(o);
        return result;
    }
    *out = o;
    return RLF_OK;
}

