/* Recordings that are one long list of frames. */
#include "io/formats/frame_log.h"
#include "io/picture/picture.h"
#include "io/picture/pixels.h"
#include "io/clip/clip.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Unpacks `in` into exactly out_size bytes, never more; another size is an error. */
static rlf_result inflate_all(const io_bytes *in, void *out, size_t out_size)
{
    uLongf size = (uLongf)out_size;
    const int code = uncompress(out, &size, in->data, (uLong)in->size);
    if (code == Z_MEM_ERROR) {
        return rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory while reading it", in->name);
    }
    if (code != Z_OK || size != out_size) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: packed depth is damaged or of another size than %zu bytes: copy the "
                        "file again, or check the calibration's size",
                        in->name, out_size);
    }
    return RLF_OK;
}

#define FRAMES_MAX (4 << 20) /* nearly two days at 30 per second */
#define NS_PER_S 1000000000
#define RATE_DEFAULT 30

rlf_result io_log_open(const char *path, io_log **out)
{
    *out = NULL;
    io_log *log = rlf_alloc(sizeof(*log));
    if (log == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = io_file_open(&log->file, path, "check the name");
    if (result != RLF_OK) {
        rlf_free(log);
        return result;
    }
    *out = log;
    return RLF_OK;
}

void io_log_free(void *context)
{
    io_log *log = context;
    io_file_close(&log->file);
    rlf_free(log->frames);
    io_shots_free(&log->color);
    io_buffer_free(&log->buffer);
    rlf_free(log);
}

bool io_log_read(const io_log *log, int64_t position, void *out, size_t size)
{
    return io_file_read_at(&log->file, position, out, size) == size;
}

rlf_result io_log_add(io_log *log, const io_log_frame *frame, int64_t position, bool is_color_first,
                      int64_t *out_end)
{
    const int64_t size = (int64_t)frame->depth_size + frame->color_size;
    if (size > log->file.size - position) {
        return RLF_END;
    }
    if (log->count >= FRAMES_MAX) {
        return rlf_fail(RLF_ERROR_CAPACITY, "%s: holds more than %d frames: cut it", log->file.path,
                        FRAMES_MAX);
    }
    rlf_result result = io_list_grow((void **)(void *)&log->frames, log->count, 1, &log->room,
                                     sizeof(log->frames[0]));
    if (result == RLF_OK) {
        io_log_frame *f = &log->frames[log->count++];
        *f = *frame;
        /* No clock shows such a time, and differences of two of them would not fit. */
        f->time_ns = f->time_ns >= 0 && f->time_ns < INT64_MAX / 4 ? f->time_ns : 0;
        f->depth_position = position + (is_color_first ? frame->color_size : 0);
        f->color_position = position + (is_color_first ? 0 : frame->depth_size);
        *out_end = position + size;
    }
    return result;
}

static rlf_result read_depth(void *context, int32_t index, void *out)
{
    io_log *log = context;
    const io_log_frame *f = &log->frames[index];
    const size_t size = (size_t)log->rig.depth.width * (size_t)log->rig.depth.height * 2;
    io_bytes bytes;
    if (f->depth_size == size) {
        return io_log_read(log, f->depth_position, out, size)
                   ? RLF_OK
                   : rlf_fail(RLF_ERROR_IO, "%s: cannot be read: check the disk", log->file.path);
    }
    rlf_result result =
        io_file_read_bytes(&log->file, f->depth_position, f->depth_size, &log->buffer, &bytes);
    return result == RLF_OK ? inflate_all(&bytes, out, size) : result;
}

static void swap_red_and_blue(const rlf_image_rgba8 *image)
{
    for (int32_t y = 0; y < image->height; y++) {
        uint8_t *row = rlf_rgba8_row(image, y);
        for (int32_t x = 0; x < image->width; x++, row += 4) {
            const uint8_t red = row[0];
            row[0] = row[2];
            row[2] = red;
        }
    }
}

static rlf_result decode_color(const io_bytes *bytes, const rlf_image_rgba8 *out)
{
    const size_t raw_size = (size_t)out->width * (size_t)out->height * 3;
    const bool is_jpeg = bytes->size >= 2 && bytes->data[0] == 0xFF && bytes->data[1] == 0xD8;
    if (bytes->size == raw_size && !is_jpeg && !io_png_is(bytes)) {
        const io_pixels pixels = {.name = bytes->name,
                                  .encoding = "rgb8",
                                  .width = out->width,
                                  .height = out->height,
                                  .step = (int64_t)out->width * 3,
                                  .data = bytes->data,
                                  .size = bytes->size};
        return io_pixels_to_rgba(&pixels, out);
    }
    io_picture picture = {
        .width = out->width, .height = out->height, .data = out->data, .is_opaque = true};
    return io_picture_decode(bytes, &picture);
}

static rlf_result read_color(void *context, int32_t index, const rlf_image_rgba8 *out)
{
    io_log *log = context;
    const io_shot *shot = &log->color.items[index];
    io_bytes bytes;
    rlf_result result =
        io_file_read_bytes(&log->file, shot->position, shot->size, &log->buffer, &bytes);
    result = result == RLF_OK ? decode_color(&bytes, out) : result;
    if (result == RLF_OK && log->is_bgr) {
        swap_red_and_blue(out);
    }
    return result;
}

static int compare_frames(const void *a, const void *b)
{
    const io_log_frame *x = a;
    const io_log_frame *y = b;
    if (x->time_ns != y->time_ns) {
        return x->time_ns < y->time_ns ? -1 : 1;
    }
    return (x->depth_position > y->depth_position) - (x->depth_position < y->depth_position);
}

/* Programs count in microseconds, nanoseconds or milliseconds and do not say which: the unit that
 * makes the median interval one of a camera is taken. 0 = none does. */
static int64_t ns_per_tick(int64_t interval)
{
    static const int64_t units[] = {1000, 1, 1000000};
    for (size_t i = 0; i < sizeof(units) / sizeof(units[0]); i++) {
        if (interval >= 2000000 / units[i] && interval > 0 && interval <= 2 * NS_PER_S / units[i]) {
            return units[i];
        }
    }
    return 0;
}

static rlf_result set_times(io_log *log)
{
    io_log_frame *f = log->frames;
    for (int32_t i = 1; i < log->count; i++) {
        if (f[i].time_ns < f[i - 1].time_ns) {
            rlf_log(RLF_LOG_WARNING,
                    "%s: frame %d: the time goes back: the frames are sorted by time",
                    log->file.path, (int)i);
            qsort(f, (size_t)log->count, sizeof(f[0]), compare_frames);
            break;
        }
    }
    /* Counted from the first, so that no product overflows. */
    const int64_t first = log->count > 0 ? f[0].time_ns : 0;
    const int64_t span = log->count > 0 ? f[log->count - 1].time_ns - first : 0;
    const io_times times = {f, sizeof(f[0]), log->count};
    int64_t interval = 0;
    rlf_result result = io_time_interval(&times, &interval);
    const int64_t unit = ns_per_tick(interval);
    const bool is_timed = unit > 0 && span < INT64_MAX / 4 / unit;
    if (!is_timed && log->count > 1) {
        rlf_log(RLF_LOG_WARNING,
                "%s: its times are none of a camera: %d frames per second are taken",
                log->file.path, RATE_DEFAULT);
    }
    for (int32_t i = 0; i < log->count; i++) {
        f[i].time_ns =
            is_timed ? (f[i].time_ns - first) * unit : (int64_t)i * NS_PER_S / RATE_DEFAULT;
    }
    return result;
}

/* Colour has the times of its depth; poses go where the clip copies them. */
static rlf_result list_frames(io_log *log, rlf_pose *poses)
{
    rlf_result result = poses != NULL ? set_times(log) : RLF_ERROR_MEMORY;
    for (int32_t i = 0; i < log->count && result == RLF_OK; i++) {
        const io_log_frame *f = &log->frames[i];
        const io_shot color = {f->time_ns, f->color_position, f->color_size};
        poses[i] = f->pose;
        result = f->color_size > 0 ? io_shots_add(&log->color, log->file.path, color) : RLF_OK;
    }
    return result;
}

rlf_result io_log_to_clip(io_log *log, const char *device, rlf_opened *out)
{
    rlf_pose *poses = rlf_alloc_array((size_t)log->count, sizeof(poses[0]));
    rlf_result result = list_frames(log, poses);
    if (result == RLF_OK) {
        const io_clip_def def = {.name = log->file.path,
                                 .device = device,
                                 .rig = log->rig,
                                 .units_per_metre = log->units_per_metre,
                                 .depth = {log->frames, sizeof(log->frames[0]), log->count},
                                 .color = io_shots_times(&log->color),
                                 .poses = log->has_poses ? poses : NULL,
                                 .read_depth = read_depth,
                                 .read_color = read_color,
                                 .destroy = io_log_free,
                                 .self = log};
        result = io_clip_open(&def, out);
    }
    rlf_free(poses);
    return result;
}
