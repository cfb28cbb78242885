/* Frames of a Kinect v2. */
#include "io/clip/clip.h"
#include "io/freenect2/freenect2.h"

#include <string.h>

#define TICK_NS 125000 /* of the device's time */
/* libfreenect2 never says that the plug was pulled: the frames end. */
#define SILENCE_MAX_NS 2000000000

static float to_metres(float depth_mm)
{
    return depth_mm > 0.0F ? depth_mm / 1000.0F : 0.0F;
}

/* Millimetres of a mirrored picture to metres of one that is not. */
static void fill_depth(freenect2 *k, const float *depth_mm)
{
    for (int32_t v = 0; v < KINECT2_DEPTH_HEIGHT; v++) {
        const float *in = depth_mm + v * KINECT2_DEPTH_WIDTH + KINECT2_DEPTH_WIDTH - 1;
        float *out = k->depth + v * KINECT2_DEPTH_WIDTH;
        for (int32_t u = 0; u < KINECT2_DEPTH_WIDTH; u++) {
            out[u] = to_metres(in[-u]);
        }
    }
}

/* BGRX or RGBX of a mirrored picture to RGBA of one that is not. */
static void fill_color(const rlf_image_rgba8 *out, const uint8_t *color, bool is_rgbx)
{
    const int red = is_rgbx ? 0 : 2;
    for (int32_t v = 0; v < out->height; v++) {
        const uint8_t *in = color + (ptrdiff_t)v * out->width * 4;
        uint8_t *to = rlf_rgba8_row(out, v) + (ptrdiff_t)(out->width - 1) * 4;
        for (int32_t u = 0; u < out->width; u++, in += 4, to -= 4) {
            to[0] = in[red];
            to[1] = in[1];
            to[2] = in[2 - red];
            to[3] = 255;
        }
    }
}

static void fill_aligned(freenect2 *k, const relief_freenect2_frame *in)
{
    k->api->registration(k->device, k->undistorted, k->registered);
    fill_depth(k, k->undistorted);
    fill_color(&k->color, (const uint8_t *)k->registered, in->color_is_rgbx != 0);
}

static void fill_raw(freenect2 *k, const relief_freenect2_frame *in, bool has_color)
{
    fill_depth(k, in->depth);
    if (has_color) {
        fill_color(&k->color, in->color, in->color_is_rgbx != 0);
    }
}

static int64_t unwrap(freenect2 *k, uint32_t time)
{
    k->time_ns = k->has_time ? k->time_ns + (int32_t)(time - k->time_last) * (int64_t)TICK_NS
                             : (int64_t)time * TICK_NS;
    k->has_time = true;
    k->time_last = time;
    return k->time_ns;
}

static bool is_paired(const relief_freenect2_frame *in, int64_t gap_ns)
{
    return in->color != NULL && gap_ns < IO_COLOR_GAP_MAX_NS && gap_ns > -IO_COLOR_GAP_MAX_NS;
}

static rlf_result fill(freenect2 *k, const relief_freenect2_frame *in, rlf_frame *out)
{
    memset(out, 0, sizeof(*out));
    /* Registration has nothing to look at before the first colour picture. */
    if (k->is_aligned && in->color == NULL) {
        k->count.unpaired++;
        return RLF_NO_FRAME;
    }
    const int64_t gap_ns = (int32_t)(in->color_time - in->depth_time) * (int64_t)TICK_NS;
    if (!io_live_count_frame(&k->count, in->depth_sequence, unwrap(k, in->depth_time), out)) {
        return RLF_NO_FRAME;
    }
    const bool has_color = k->rig.has_color && is_paired(in, gap_ns);
    if (k->is_aligned) {
        fill_aligned(k, in);
    } else {
        fill_raw(k, in, has_color);
    }
    k->count.unpaired += k->rig.has_color && !has_color ? 1 : 0;
    out->color = has_color ? k->color : (rlf_image_rgba8){0};
    out->color_time_ns = has_color ? out->time_ns + gap_ns : 0;
    out->depth_f32 = k->depth;
    out->depth_stride = KINECT2_DEPTH_WIDTH * (ptrdiff_t)sizeof(float);
    out->flags |= RLF_FRAME_UNMIRRORED | (k->is_aligned ? (uint32_t)RLF_FRAME_ALIGNED : 0u);
    return RLF_OK;
}

rlf_result io_freenect2_next(void *self, rlf_frame *out)
{
    freenect2 *k = self;
    relief_freenect2_frame in;
    const int state = k->api->wait(k->device, IO_LIVE_WAIT_MS, &in);
    const int64_t now_ns = rlf_clock_ns();
    if (state < 0 || (state == 0 && now_ns - k->last_frame_ns > SILENCE_MAX_NS)) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: the Kinect v2 gives no pictures any more: plug it in again",
                        k->source);
    }
    if (state == 0) {
        return RLF_NO_FRAME;
    }
    k->last_frame_ns = now_ns;
    rlf_result result = fill(k, &in, out);
    out->host_time_ns = now_ns;
    return result;
}
