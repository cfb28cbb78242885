/* Background behind the foreground against truth. */
#include "eval/measures/behind.h"

#include "eval/measures/angles.h"
#include "eval/measures/percent.h"

#define OFF_M 0.04

rlf_result eval_behind_init(eval_behind *e, rlf_source *source)
{
    const rlf_camera *camera = &rlf_source_get_info(source)->rig.depth;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    e->source = source;
    e->depth = rlf_alloc_array(pixels, sizeof(*e->depth));
    e->normal = rlf_alloc_array(pixels, sizeof(*e->normal));
    return e->depth != NULL && e->normal != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void eval_behind_finish(eval_behind *e)
{
    rlf_free(e->depth);
    rlf_free(e->normal);
    e->depth = NULL;
    e->normal = NULL;
}

/* The room's normal at pixel t, whose ray is (x, y, 1), at depth z. The nearest surface to a point
 * of the room is the room's: the simulator is asked once, as long as nothing is moved there. */
static rlf_vec3 true_normal(eval_behind *e, int32_t t, float x, float y, float z)
{
    if (e->depth[t] < z || e->depth[t] > z) {
        rlf_vec3 n = {0, 0, 0}, p = {z * x, z * y, z};
        double distance;
        int32_t label;
        (void)rlf_synthetic_distance(e->source, p, &distance, &n, &label);
        e->depth[t] = z;
        e->normal[t][0] = (float)n.x;
        e->normal[t][1] = (float)n.y;
        e->normal[t][2] = (float)n.z;
    }
    return rlf_vec3_make(e->normal[t][0], e->normal[t][1], e->normal[t][2]);
}

static void add_pixel(eval_behind *e, const rlf_surface *s, int32_t i, int32_t t, float real)
{
    float found = s->background_depth[i];
    e->pixels++;
    if (!(found > 0.0f)) {
        e->missing++;
        return;
    }
    double error = (double)found - real;
    if (error > OFF_M || error < -OFF_M) {
        e->off++;
        return;
    }
    e->square_sum += error * error;
    e->count++;
    rlf_vec3 n = {s->background_normal_x[i], s->background_normal_y[i], s->background_normal_z[i]};
    if (rlf_dot(n, n) > 0.0) {
        rlf_vec3 truth = true_normal(e, t, s->ray_x[i], s->ray_y[i], real);
        eval_add_angle(&e->angles, rlf_acos(rlf_dot(n, truth)) * 180.0 / RLF_PI);
    } else {
        e->angles.missing++;
    }
}

void eval_behind_add(eval_behind *e, const rlf_surface *s, const rlf_truth *truth)
{
    const rlf_rig *rig = &rlf_source_get_info(e->source)->rig;
    if (s->background_state != RLF_BACKGROUND_READY) {
        return;
    }
    for (int32_t y = 0; y < s->height; y++) {
        for (int32_t x = 0; x < s->width; x++) {
            int32_t i = y * s->width + x;
            int32_t t = (y * rig->depth.width + x) * s->scale_factor;
            float real = truth->background_depth[t];
            if (truth->foreground[t] && real >= rig->depth_min_m && real <= rig->depth_max_m) {
                add_pixel(e, s, i, t, real);
            }
        }
    }
}

double eval_behind_rms_mm(const eval_behind *e)
{
    return e->count > 0 ? 1000.0 * sqrt(e->square_sum / (double)e->count) : NAN;
}

double eval_behind_off_percent(const eval_behind *e)
{
    return eval_percent(e->off, e->pixels - e->missing);
}

double eval_behind_missing_percent(const eval_behind *e)
{
    return eval_percent(e->missing, e->pixels);
}
