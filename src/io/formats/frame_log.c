/* Recordings that are one long list of frames. */
#include "io/formats/frame_log.h"

#include "io/picture/picture.h"
#include "io/picture/inflate.h"
#include "io/picture/pixels.h"
#include "io/clip/clip.h"

#include <stdlib.h>
#include <string.h>

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
    rlf_free(log->colored);
    io_buffer_free(&log->buffer);
    rlf_free(log);
}

bool io_log_read(const io_log *log, int64_t position, void *out, size_t size)
{
    return io_file_read_at(&log->file, position, out, size) == size;
}

static rlf_result grow(io_log *log)
{
    if (log->count < log->capacity) {
        return RLF_OK;
    }
    if (log->count >= FRAMES_MAX) {
        return rlf_fail(RLF_ERROR_CAPACITY, "%s: holds more than %d frames: cut it", log->file.path,
                        FRAMES_MAX);
    }
    const int32_t capacity = log->capacity < 64 ? 64 : log->capacity * 2;
    io_log_frame *frames = rlf_alloc_array((size_t)capacity, sizeof(frames[0]));
    if (frames == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (log->count > 0) {
        memcpy(frames, log->frames, (size_t)log->count * sizeof(frames[0]));
    }
    rlf_free(log->frames);
    log->frames = frames;
    log->capacity = capacity;
    return RLF_OK;
}

rlf_result io_log_add(io_log *log, const io_log_frame *frame, int64_t position, bool is_color_first,
                      int64_t *out_end)
{
    const int64_t size = (int64_t)frame->depth_size + frame->color_size;
    if (size > log->file.size - position) {
        return RLF_END;
    }
    rlf_result result = grow(log);
    if (result == RLF_OK) {
        io_log_frame *f = &log->frames[log->count++];
        *f = *frame;
        /* No clock shows such a time, and differences of two of them would not fit. */
        f->ticks = f->ticks >= 0 && f->ticks < INT64_MAX / 4 ? f->ticks : 0;
        f->depth_position = position + (is_color_first ? frame->color_size : 0);
        f->color_position = position + (is_color_first ? 0 : frame->depth_size);
        *out_end = position + size;
    }
    return result;
}

static rlf_result read_bytes(io_log *log, int64_t position, uint32_t size, io_bytes *out)
{
    rlf_result result = io_buffer_reserve(&log->buffer, size);
    if (result == RLF_OK && !io_log_read(log, position, log->buffer.data, size)) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be read: check the disk", log->file.path);
    }
    *out = (io_bytes){log->file.path, log->buffer.data, size};
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
    rlf_result result = read_bytes(log, f->depth_position, f->depth_size, &bytes);
    return result == RLF_OK ? io_inflate(&bytes, out, size) : result;
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
    const io_log_frame *f = &log->frames[log->colored[index]];
    io_bytes bytes;
    rlf_result result = read_bytes(log, f->color_position, f->color_size, &bytes);
    if (result == RLF_OK) {
        result = decode_color(&bytes, out);
    }
    if (result == RLF_OK && log->is_bgr) {
        swap_red_and_blue(out);
    }
    return result;
}

static int compare_frames(const void *a, const void *b)
{
    const io_log_frame *x = a;
    const io_log_frame *y = b;
    if (x->ticks != y->ticks) {
        return x->ticks < y->ticks ? -1 : 1;
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

static void set_times(io_log *log, int64_t *ticks, int64_t *scratch)
{
    for (int32_t i = 1; i < log->count; i++) {
        if (log->frames[i].ticks < log->frames[i - 1].ticks) {
            rlf_log(RLF_LOG_WARNING,
                    "%s: frame %d: the time goes back: the frames are sorted by "
                    "time",
                    log->file.path, (int)i);
            qsort(log->frames, (size_t)log->count, sizeof(log->frames[0]), compare_frames);
            break;
        }
    }
    for (int32_t i = 0; i < log->count; i++) {
        ticks[i] = log->frames[i].ticks;
    }
    /* Counted from the first, so that no product overflows. */
    const uint64_t span = log->count > 0 ? (uint64_t)ticks[log->count - 1] - (uint64_t)ticks[0] : 0;
    const bool is_near = span < INT64_MAX / 4;
    const int64_t unit = is_near ? ns_per_tick(io_time_interval(ticks, log->count, scratch)) : 0;
    const bool is_timed = unit > 0 && (int64_t)span < INT64_MAX / 4 / unit;
    if (!is_timed && log->count > 1) {
        rlf_log(RLF_LOG_WARNING,
                "%s: its times are none of a camera: %d frames per second are "
                "taken",
                log->file.path, RATE_DEFAULT);
    }
    for (int32_t i = 0; i < log->count; i++) {
        log->frames[i].time_ns =
            is_timed ? (ticks[i] - ticks[0]) * unit : (int64_t)i * NS_PER_S / RATE_DEFAULT;
    }
}

/* Arrays that the clip copies. */
typedef struct lists {
    int64_t *times, *color_times;
    rlf_pose *poses;
} lists;

static void fill_lists(io_log *log, lists *out)
{
    set_times(log, out->times, out->color_times);
    log->colored_count = 0;
    for (int32_t i = 0; i < log->count; i++) {
        const io_log_frame *f = &log->frames[i];
        out->times[i] = f->time_ns;
        out->poses[i] = f->pose;
        if (f->color_size > 0) {
            out->color_times[log->colored_count] = f->time_ns;
            log->colored[log->colored_count++] = i;
        }
    }
}

static rlf_result make_clip(io_log *log, const lists *l, rlf_opened *out)
{
    const io_clip_def def = {.name = log->file.path,
                             .rig = log->rig,
                             .units_per_metre = log->units_per_metre,
                             .depth_times = l->times,
                             .color_times = l->color_times,
                             .depth_count = log->count,
                             .color_count = log->colored_count,
                             .poses = log->has_poses ? l->poses : NULL,
                             .read_depth = read_depth,
                             .read_color = read_color,
                             .destroy = io_log_free,
                             .self = log};
    return io_clip_open(&def, out);
}

rlf_result io_log_to_clip(io_log *log, rlf_opened *out)
{
    const size_t count = (size_t)log->count;
    lists l = {rlf_alloc_array(count, sizeof(int64_t)), rlf_alloc_array(count, sizeof(int64_t)),
               rlf_alloc_array(count, sizeof(rlf_pose))};
    log->colored = rlf_alloc_array(count, sizeof(log->colored[0]));
    rlf_result result = RLF_ERROR_MEMORY;
    if (l.times != NULL && l.color_times != NULL && l.poses != NULL && log->colored != NULL) {
        fill_lists(log, &l);
        result = make_clip(log, &l, out);
    }
    rlf_free(l.times);
    rlf_free(l.color_times);
    rlf_free(l.poses);
    return result;
}
