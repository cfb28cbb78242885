/* Random numbers, a Kinect v2 and a surface stage. */
#include "eval/analytic.h"

#include "command.h"

#include <string.h>

eval_random eval_random_start(uint64_t seed)
{
    eval_random r = {seed * UINT64_C(0x9e3779b97f4a7c15) + 1};
    return r;
}

/* xorshift64* (Vigna 2016). */
double eval_random_uniform(eval_random *r)
{
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return (double)((r->state * UINT64_C(2685821657736338717)) >> 11) / 9007199254740992.0;
}

double eval_random_range(eval_random *r, double low, double high)
{
    return low + (high - low) * eval_random_uniform(r);
}

/* Twelve uniform numbers have variance 1. */
double eval_random_normal(eval_random *r)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += eval_random_uniform(r);
    }
    return sum;
}

/* Drawn in order: a compiler may evaluate a call's arguments in any. */
rlf_vec3 eval_random_in_box(eval_random *r, rlf_vec3 low, rlf_vec3 high)
{
    rlf_vec3 v;
    v.x = eval_random_range(r, low.x, high.x);
    v.y = eval_random_range(r, low.y, high.y);
    v.z = eval_random_range(r, low.z, high.z);
    return v;
}

rlf_rig eval_kinect_rig(void)
{
    rlf_rig rig;
    memset(&rig, 0, sizeof(rig));
    rig.depth.width = 512;
    rig.depth.height = 424;
    rig.depth.fx = rig.depth.fy = 365.5;
    rig.depth.cx = 255.5;
    rig.depth.cy = 211.5;
    rig.T_color_depth = rlf_pose_identity();
    rig.depth_min_m = 0.5;
    rig.depth_max_m = 4.5;
    rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    return rig;
}

double eval_plane_depth(rlf_vec3 n, double d, rlf_vec3 ray)
{
    double slope = rlf_dot(n, ray);
    double z = slope < -1e-4 || slope > 1e-4 ? d / slope : 0.0;
    return z > 0.0 ? z : 0.0;
}

static rlf_result open_all(rlf_profile profile, eval_stage *s)
{
    s->rig = eval_kinect_rig();
    const rlf_camera *camera = &s->rig.depth;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    s->depth = rlf_alloc_array(pixels, sizeof(*s->depth));
    s->rays = rlf_alloc_array(pixels, sizeof(*s->rays));
    if (s->depth == NULL || s->rays == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < (int32_t)pixels; i++) {
        rlf_camera_unproject(camera, i % camera->width, i / camera->width, &s->rays[i]);
    }
    rlf_reconstruct_def def = rlf_reconstruct_def_default(profile, &s->rig);
    return rlf_reconstruct_create(&def, &s->reconstruct);
}

rlf_result eval_stage_open(rlf_profile profile, eval_stage *out)
{
    memset(out, 0, sizeof(*out));
    rlf_result result = open_all(profile, out);
    if (result != RLF_OK) {
        eval_stage_close(out);
    }
    return result;
}

void eval_stage_close(eval_stage *s)
{
    rlf_reconstruct_destroy(&s->reconstruct);
    rlf_free(s->depth);
    rlf_free(s->rays);
    memset(s, 0, sizeof(*s));
}

rlf_result eval_stage_process(eval_stage *s, const rlf_surface **out)
{
    rlf_frame frame;
    memset(&frame, 0, sizeof(frame));
    frame.sequence = (uint64_t)s->frame;
    frame.time_ns = s->frame++ * INT64_C(33333333);
    frame.rig = &s->rig;
    frame.depth_f32 = s->depth;
    frame.depth_stride = s->rig.depth.width * (ptrdiff_t)sizeof(float);
    return command_interrupted ? RLF_END : rlf_reconstruct_process(s->reconstruct, &frame, out);
}

void eval_stage_restart(eval_stage *s)
{
    rlf_reconstruct_reset(s->reconstruct);
    s->frame = 0;
}
