/* Depth error against truth, of the raw frame and of the surface made from it. */
#include "eval/measures/depth.h"

#include "eval/measures/percent.h"

#define FLYING_M 0.04f
#define STILL_NS 1000000000

rlf_result eval_depth_init(eval_depth *e, const rlf_camera *camera)
{
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    e->last = rlf_alloc_array(pixels, sizeof(*e->last));
    e->since_ns = rlf_alloc_array(pixels, sizeof(*e->since_ns));
    return e->last != NULL && e->since_ns != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void eval_depth_finish(eval_depth *e)
{
    rlf_free(e->last);
    rlf_free(e->since_ns);
    e->last = NULL;
    e->since_ns = NULL;
}

/* The smallest distance of z from the true depths of the 3x3 pixels about (x, y). */
static float distance(const rlf_truth *truth, const rlf_camera *camera, int32_t x, int32_t y,
                      float z)
{
    float least = 1e9f;
    for (int32_t ny = y > 0 ? y - 1 : 0; ny <= y + 1 && ny < camera->height; ny++) {
        for (int32_t nx = x > 0 ? x - 1 : 0; nx <= x + 1 && nx < camera->width; nx++) {
            float d = z - truth->depth[ny * camera->width + nx];
            d = d < 0.0f ? -d : d;
            least = d < least ? d : least;
        }
    }
    return least;
}

/* Mixed pixels are counted; so are those that show the other side of an edge, which is a matter of
 * where the edge lies: neither takes part in the RMS error. */
static void add(eval_depth_errors *e, float z, float truth, float least)
{
    e->pixels++;
    if (!(z > 0.0f)) {
        e->missing++;
        return;
    }
    double error = (double)z - truth;
    e->flying += least > FLYING_M;
    if (error < FLYING_M && error > -FLYING_M) {
        e->square_sum += error * error;
        e->count++;
    } else {
        e->other_side++;
    }
}

float eval_raw_depth(const rlf_frame *frame, int32_t x, int32_t y)
{
    if (frame->depth_u16 == NULL) {
        const char *row = (const char *)frame->depth_f32 + y * frame->depth_stride;
        return ((const float *)(const void *)row)[x];
    }
    const char *row = (const char *)frame->depth_u16 + y * frame->depth_stride;
    return (float)(((const uint16_t *)(const void *)row)[x] / frame->depth_units_per_metre);
}

void eval_depth_add(eval_depth *e, const rlf_surface *s, const rlf_frame *frame,
                    const rlf_truth *truth)
{
    const rlf_camera *camera = &frame->rig->depth;
    for (int32_t i = 0; i < s->width * s->height; i++) {
        int32_t x = i % s->width * s->scale_factor, y = i / s->width * s->scale_factor;
        int32_t t = y * camera->width + x;
        float real = truth->depth[t];
        bool changed = frame->sequence == 0 || real < e->last[t] || real > e->last[t];
        e->since_ns[t] = changed ? frame->time_ns : e->since_ns[t];
        e->last[t] = real;
        bool still = frame->time_ns - e->since_ns[t] >= STILL_NS;
        if (!(real >= frame->rig->depth_min_m && real <= frame->rig->depth_max_m) ||
            (!still && !changed)) {
            continue;
        }
        eval_depth_group *group = still ? &e->still : &e->moving;
        float raw = eval_raw_depth(frame, x, y), z = s->depth[i];
        add(&group->raw, raw, real, raw > 0.0f ? distance(truth, camera, x, y, raw) : 0.0f);
        float least = z > 0.0f ? distance(truth, camera, x, y, z) : 0.0f;
        if (s->reason[i] == RLF_REASON_FILLED) {
            add(&group->filled, z, real, least);
        } else {
            add(&group->seen, z, real, least);
        }
    }
}

double eval_depth_rms_mm(const eval_depth_errors *e)
{
    return e->count > 0 ? 1000.0 * sqrt(e->square_sum / (double)e->count) : NAN;
}

double eval_depth_flying_percent(const eval_depth_errors *e)
{
    return eval_percent(e->flying, e->pixels - e->missing);
}

double eval_depth_other_side_percent(const eval_depth_errors *e)
{
    return eval_percent(e->other_side, e->pixels - e->missing);
}

double eval_depth_raw_missing_percent(const eval_depth_group *g)
{
    return eval_percent(g->raw.missing, g->raw.pixels);
}

double eval_depth_missing_percent(const eval_depth_group *g)
{
    return eval_percent(g->seen.missing, g->seen.pixels + g->filled.pixels);
}

double eval_depth_filled_percent(const eval_depth_group *g)
{
    return eval_percent(g->filled.pixels, g->seen.pixels + g->filled.pixels);
}
