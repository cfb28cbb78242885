/* Depth and colour pictures of a live device, paired by their times. */
#include "io/live/driver.h"

#include "io/clip/clip.h"

#include <string.h>

#define NS_PER_S 1000000000.0
#define RATE_DEFAULT 30.0

rlf_result io_stream_pair_init(io_stream_pair *pair, const rlf_rig *rig, double units_per_metre,
                               double frames_per_second)
{
    memset(pair, 0, sizeof(*pair));
    pair->rig = rig;
    pair->units_per_metre = units_per_metre;
    pair->interval_ns =
        (int64_t)(NS_PER_S / (frames_per_second > 0.0 ? frames_per_second : RATE_DEFAULT));
    pair->shown_depth = -1;
    pair->shown_color = -1;
    pair->status.is_connected = true;
    for (int32_t i = 0; i < IO_STREAM_SLOTS; i++) {
        pair->depth[i].data =
            rlf_alloc_array((size_t)rig->depth.width * (size_t)rig->depth.height, 2);
        if (rig->has_color) {
            pair->color[i].data =
                rlf_alloc_array((size_t)rig->color.width * (size_t)rig->color.height, 4);
        }
        if (pair->depth[i].data == NULL || (rig->has_color && pair->color[i].data == NULL)) {
            io_stream_pair_finish(pair);
            return RLF_ERROR_MEMORY;
        }
    }
    return RLF_OK;
}

void io_stream_pair_finish(io_stream_pair *pair)
{
    for (int32_t i = 0; i < IO_STREAM_SLOTS; i++) {
        rlf_free(pair->depth[i].data);
        rlf_free(pair->color[i].data);
        pair->depth[i].data = NULL;
        pair->color[i].data = NULL;
    }
}

/* A slot that neither the last frame nor a list points to. */
static int32_t free_slot(int32_t shown, const int32_t *list, int32_t count)
{
    for (int32_t i = 0; i < IO_STREAM_SLOTS; i++) {
        bool is_used = i == shown;
        for (int32_t k = 0; k < count; k++) {
            is_used = is_used || list[k] == i;
        }
        if (!is_used) {
            return i;
        }
    }
    return 0;
}

uint16_t *io_stream_pair_depth(io_stream_pair *pair)
{
    return pair->depth[free_slot(pair->shown_depth, pair->waiting, pair->waiting_count)].data;
}

rlf_image_rgba8 io_stream_pair_color(io_stream_pair *pair)
{
    const int32_t slot = free_slot(pair->shown_color, pair->colors, pair->color_count);
    const rlf_camera *camera = &pair->rig->color;
    return (rlf_image_rgba8){pair->color[slot].data, camera->width, camera->height,
                             (ptrdiff_t)camera->width * 4};
}

/* How many depth pictures the device made since the last one; 0 = this is the last one again. */
static uint64_t count_steps(io_stream_pair *pair, int64_t time_ns, int64_t index)
{
    const int64_t gap = time_ns - pair->last_time_ns;
    if (!pair->has_last) {
        return 1;
    }
    if (gap == 0) {
        return 0;
    }
    if (gap < 0) {
        /* The device's clock started again: time here goes on. */
        pair->shift_ns = io_time_sum(pair->shift_ns, pair->interval_ns - gap);
        pair->is_broken = true;
        return 1;
    }
    if (index > pair->last_index && pair->last_index >= 0) {
        return (uint64_t)(index - pair->last_index);
    }
    return 1 + (uint64_t)io_time_lost(gap, pair->interval_ns);
}

void io_stream_pair_push_depth(io_stream_pair *pair, int64_t time_ns, int64_t index)
{
    const uint64_t steps = count_steps(pair, time_ns, index);
    if (steps == 0) {
        pair->status.doubled++;
        return;
    }
    const int32_t slot = free_slot(pair->shown_depth, pair->waiting, pair->waiting_count);
    pair->status.lost += steps - 1;
    pair->sequence += pair->has_last || pair->is_broken ? steps : 0;
    pair->has_last = true;
    pair->last_time_ns = time_ns;
    pair->last_index = index;
    pair->depth[slot].time_ns = time_ns;
    pair->depth[slot].host_time_ns = rlf_clock_ns();
    pair->depth[slot].sequence = pair->sequence;
    if (pair->waiting_count == 2) {
        pair->waiting[0] = pair->waiting[1];
        pair->waiting_count = 1;
        pair->status.lost++;
    }
    pair->waiting[pair->waiting_count++] = slot;
}

void io_stream_pair_push_color(io_stream_pair *pair, int64_t time_ns)
{
    const int32_t slot = free_slot(pair->shown_color, pair->colors, pair->color_count);
    pair->color[slot].time_ns = time_ns;
    if (pair->color_count == 2) {
        pair->colors[0] = pair->colors[1];
        pair->color_count = 1;
    }
    pair->colors[pair->color_count++] = slot;
}

static int64_t distance(int64_t a, int64_t b)
{
    return a > b ? a - b : b - a;
}

/* The colour picture of a time, or -1. */
static int32_t nearest_color(const io_stream_pair *pair, int64_t time_ns)
{
    int32_t best = -1;
    for (int32_t i = 0; i < pair->color_count; i++) {
        const int32_t slot = pair->colors[i];
        const int64_t gap = distance(pair->color[slot].time_ns, time_ns);
        if (gap <= pair->interval_ns / 2 &&
            (best < 0 || gap < distance(pair->color[best].time_ns, time_ns))) {
            best = slot;
        }
    }
    return best;
}

/* Whether a colour picture for this time may still arrive. */
static bool may_come(const io_stream_pair *pair, int64_t time_ns)
{
    if (pair->waiting_count > 1) {
        return false;
    }
    if (pair->color_count == 0) {
        return true;
    }
    const int64_t newest = pair->color[pair->colors[pair->color_count - 1]].time_ns;
    return newest <= time_ns + pair->interval_ns / 2;
}

static void fill_frame(io_stream_pair *pair, const io_stream_slot *depth, int32_t color,
                       rlf_frame *out)
{
    const rlf_rig *rig = pair->rig;
    memset(out, 0, sizeof(*out));
    out->sequence = depth->sequence;
    out->time_ns = io_time_sum(depth->time_ns, pair->shift_ns);
    out->host_time_ns = depth->host_time_ns;
    out->flags = pair->flags | (pair->is_broken ? (uint32_t)RLF_FRAME_DISCONTINUITY : 0u);
    out->depth_u16 = depth->data;
    out->depth_stride = (ptrdiff_t)rig->depth.width * 2;
    out->depth_units_per_metre = pair->units_per_metre;
    if (color >= 0) {
        out->color_time_ns = pair->color[color].time_ns + pair->shift_ns;
        out->color = (rlf_image_rgba8){pair->color[color].data, rig->color.width, rig->color.height,
                                       (ptrdiff_t)rig->color.width * 4};
    }
}

/* Fills *out when a frame is ready: its colour is within half a frame's time, or can no longer
 * come. `is_last`: nothing more is waited for. */
static bool take_frame(io_stream_pair *pair, bool is_last, rlf_frame *out)
{
    if (pair->waiting_count == 0) {
        return false;
    }
    const int32_t slot = pair->waiting[0];
    const io_stream_slot *depth = &pair->depth[slot];
    const int32_t color = nearest_color(pair, depth->time_ns);
    if (color < 0 && pair->rig->has_color && !is_last && may_come(pair, depth->time_ns)) {
        return false;
    }
    pair->status.unpaired += color < 0 && pair->rig->has_color ? 1 : 0;
    fill_frame(pair, depth, color, out);
    pair->is_broken = false;
    pair->shown_depth = slot;
    pair->shown_color = color;
    pair->waiting[0] = pair->waiting[1];
    pair->waiting_count--;
    return true;
}

rlf_result io_stream_pair_next(io_stream_pair *pair,
                               rlf_result (*pump)(void *self, int32_t wait_ms), void *self,
                               rlf_frame *out)
{
    const int64_t end_ns = rlf_clock_ns() + IO_LIVE_WAIT_MS * INT64_C(1000000);
    for (;;) {
        if (take_frame(pair, false, out)) {
            return RLF_OK;
        }
        const int64_t left_ms = (end_ns - rlf_clock_ns()) / 1000000;
        if (left_ms <= 0) {
            return take_frame(pair, true, out) ? RLF_OK : RLF_NO_FRAME;
        }
        rlf_result result = pump(self, (int32_t)left_ms);
        if (result < 0) {
            return result;
        }
    }
}

void io_rgb_row(const uint8_t *rgb, int32_t width, bool flips, uint8_t *out_rgba)
{
    for (int32_t x = 0; x < width; x++) {
        const uint8_t *p = rgb + (ptrdiff_t)3 * (flips ? width - 1 - x : x);
        out_rgba[4 * x + 0] = p[0];
        out_rgba[4 * x + 1] = p[1];
        out_rgba[4 * x + 2] = p[2];
        out_rgba[4 * x + 3] = 255;
    }
}

void io_depth_row(const uint16_t *depth, int32_t width, bool flips, uint16_t *out)
{
    if (!flips) {
        memcpy(out, depth, (size_t)width * 2);
        return;
    }
    for (int32_t x = 0; x < width; x++) {
        out[x] = depth[width - 1 - x];
    }
}
