/* The thesis's grid, whatever grid the surface has. */
#include "eval/measures/centre.h"

#define STEP 8     /* the thesis's scale factor */
#define MARGIN_X 4 /* of 64 columns: table 5.1's centre is 77.59 % */
#define MARGIN_Y 3 /* of 53 rows */
#define MOVING_SHARE 0.003
#define WRONG_COSINE 0.86602540378443864676 /* cos 30 degrees */

static bool is_moving(const rlf_truth *truth, int64_t pixels)
{
    int64_t count = 0;
    for (int64_t i = 0; i < pixels; i++) {
        count += truth->foreground[i] != 0;
    }
    return (double)count > MOVING_SHARE * (double)pixels;
}

static void add_point(eval_centre *e, const rlf_surface *s, int32_t i, const rlf_truth *truth,
                      int32_t t)
{
    rlf_vec3 found = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
    rlf_vec3 real = {truth->normal_x[t], truth->normal_y[t], truth->normal_z[t]};
    bool is_missing = found.x == 0.0 && found.y == 0.0 && found.z == 0.0;
    e->points++;
    e->missing += is_missing;
    e->wrong += !is_missing && !(rlf_dot(found, real) >= WRONG_COSINE);
}

void eval_centre_add(eval_centre *e, const rlf_surface *s, const rlf_truth *truth,
                     const rlf_rig *rig)
{
    int32_t width = rig->depth.width, height = rig->depth.height;
    if (s->background_state != RLF_BACKGROUND_READY || STEP % s->scale_factor != 0 ||
        !is_moving(truth, (int64_t)width * height)) {
        return;
    }
    for (int32_t y = MARGIN_Y; y < height / STEP - MARGIN_Y; y++) {
        for (int32_t x = MARGIN_X; x < width / STEP - MARGIN_X; x++) {
            int32_t t = y * STEP * width + x * STEP;
            bool is_in_range =
                truth->depth[t] >= rig->depth_min_m && truth->depth[t] <= rig->depth_max_m;
            if (is_in_range) {
                int32_t ratio = STEP / s->scale_factor;
                add_point(e, s, y * ratio * s->width + x * ratio, truth, t);
            }
        }
    }
}
