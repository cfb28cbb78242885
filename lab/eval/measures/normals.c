/* Normal error against truth. */
#include "eval/measures/normals.h"

#include "eval/measures/angles.h"

#define BAND_PIXELS 6
#define JUMP_SHARE 0.04
#define SHOWN_PIXELS 4
#define SHOWN_SIGMAS 3.0
#define SHOWN_SHARE 0.02 /* of the depth */

static bool is_jump(float a, float b)
{
    float near = a < b ? a : b;
    float step = a < b ? b - a : a - b;
    return near > 0.0f && step > (float)JUMP_SHARE * near;
}

/* Square dilation by BAND_PIXELS along one axis. */
static void dilate(const uint8_t *in, uint8_t *out, int32_t count, int32_t step)
{
    int32_t last = -BAND_PIXELS - 1;
    for (int32_t i = 0; i < count; i++) {
        last = in[i * step] ? i : last;
        out[i * step] = i - last <= BAND_PIXELS;
    }
    last = count + BAND_PIXELS;
    for (int32_t i = count - 1; i >= 0; i--) {
        last = in[i * step] ? i : last;
        out[i * step] |= last - i <= BAND_PIXELS;
    }
}

void eval_mark_band(const float *depth, int32_t width, int32_t height, uint8_t *out,
                    uint8_t *scratch)
{
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            int32_t i = y * width + x;
            bool right = x + 1 < width && is_jump(depth[i], depth[i + 1]);
            bool left = x > 0 && is_jump(depth[i], depth[i - 1]);
            bool below = y + 1 < height && is_jump(depth[i], depth[i + width]);
            bool above = y > 0 && is_jump(depth[i], depth[i - width]);
            out[i] = right || left || below || above;
        }
    }
    for (int32_t y = 0; y < height; y++) {
        dilate(out + (ptrdiff_t)y * width, scratch + (ptrdiff_t)y * width, width, 1);
    }
    for (int32_t x = 0; x < width; x++) {
        dilate(scratch + x, out + x, height, width);
    }
}

static bool is_shown(const rlf_rig *rig, float depth, float truth)
{
    double most =
        rlf_max(SHOWN_SHARE * depth, SHOWN_SIGMAS * rlf_depth_noise_sigma(&rig->noise, depth));
    double off = (double)depth - truth;
    return truth > 0.0f && off <= most && off >= -most;
}

/* The pixel nearest to (x, y) whose true surface a measured depth shows: stereo spreads what is
 * near over the pixels beside it. (x, y) itself when there is none. */
static int32_t find_shown(const rlf_truth *truth, const rlf_rig *rig, int32_t x, int32_t y,
                          float depth)
{
    int32_t width = rig->depth.width, height = rig->depth.height;
    int32_t best = y * width + x, least = 2 * SHOWN_PIXELS * SHOWN_PIXELS + 1;
    for (int32_t dy = -SHOWN_PIXELS; dy <= SHOWN_PIXELS; dy++) {
        for (int32_t dx = -SHOWN_PIXELS; dx <= SHOWN_PIXELS; dx++) {
            int32_t square = dx * dx + dy * dy, at = (y + dy) * width + x + dx;
            bool inside = x + dx >= 0 && x + dx < width && y + dy >= 0 && y + dy < height;
            if (inside && square < least && is_shown(rig, depth, truth->depth[at])) {
                best = at;
                least = square;
            }
        }
    }
    return best;
}

static double off_by(const rlf_surface *s, int32_t i, const rlf_truth *truth, int32_t t)
{
    double dot = (double)s->normal_x[i] * truth->normal_x[t] +
                 (double)s->normal_y[i] * truth->normal_y[t] +
                 (double)s->normal_z[i] * truth->normal_z[t];
    return rlf_acos(dot) * 180.0 / RLF_PI;
}

void eval_normals_add(eval_normals *e, const rlf_surface *s, const rlf_truth *truth,
                      const rlf_rig *rig, const uint8_t *band)
{
    for (int32_t y = 0; y < s->height; y++) {
        for (int32_t x = 0; x < s->width; x++) {
            int32_t i = y * s->width + x;
            int32_t t = y * s->scale_factor * rig->depth.width + x * s->scale_factor;
            if (!(truth->depth[t] >= rig->depth_min_m && truth->depth[t] <= rig->depth_max_m)) {
                continue;
            }
            eval_angles *angles = band[t] ? &e->band : &e->interior;
            if (s->normal_x[i] == 0.0f && s->normal_y[i] == 0.0f && s->normal_z[i] == 0.0f) {
                angles->missing++;
                e->seen.missing += band[t] && s->reason[i] == RLF_REASON_OK;
                continue;
            }
            double degrees = off_by(s, i, truth, t);
            eval_add_angle(angles, degrees);
            if (band[t]) {
                int32_t shown =
                    find_shown(truth, rig, x * s->scale_factor, y * s->scale_factor, s->depth[i]);
                eval_add_angle(&e->shown, off_by(s, i, truth, shown));
            }
            if (band[t] && s->reason[i] == RLF_REASON_OK) {
                eval_add_angle(&e->seen, degrees);
            }
        }
    }
}
