/* A plate of half a metre that moves along its normal at 0.5 m/s, 2 m away, before a still wall,
 * seen with a Kinect's noise: its velocity, and that of the wall. */
#include "eval/analytic.h"
#include "eval/measures/percent.h"
#include "eval/sections.h"
#include "eval/table.h"

#define SPEED 0.5 /* m/s */
#define WALL_M 3.2
#define EMPTY_FRAMES 8
#define PLATE_FRAMES 8 /* the last of them is measured */

static const rlf_vec3 plate_normal = {0.4, 0.0, -0.9165151389911680}; /* unit, slanted by 24 deg */

static double plate_depth(rlf_vec3 ray, double time_s)
{
    rlf_vec3 centre = rlf_mad(rlf_vec3_make(0, 0, 2.0), plate_normal, SPEED * time_s);
    double z = eval_plane_depth(plate_normal, rlf_dot(plate_normal, centre), ray);
    rlf_vec3 p = rlf_scale(ray, z);
    bool is_on = p.x < 0.25 && p.x > -0.25 && p.y < 0.25 && p.y > -0.25;
    return is_on ? z : 0.0;
}

/* What the camera sees, with noise. */
static void draw(eval_stage *s, eval_random *r, bool has_plate, double time_s)
{
    for (int32_t i = 0; i < s->rig.depth.width * s->rig.depth.height; i++) {
        double z = has_plate ? plate_depth(s->rays[i], time_s) : 0.0;
        z = z > 0.0 ? z : WALL_M;
        s->depth[i] = (float)(z + rlf_depth_noise_sigma(&s->rig.noise, z) * eval_random_normal(r));
    }
}

static void report(eval_table *table, const eval_stage *s, const rlf_surface *f, double time_s,
                   rlf_profile profile)
{
    int64_t count = 0, wall = 0, moving = 0;
    double sum = 0.0;
    for (int32_t i = 0; i < f->width * f->height; i++) {
        int32_t t =
            i / f->width * f->scale_factor * s->rig.depth.width + i % f->width * f->scale_factor;
        rlf_vec3 v = {f->velocity_x[i], f->velocity_y[i], f->velocity_z[i]};
        if (plate_depth(s->rays[t], time_s) > 0.0) {
            sum += rlf_dot(v, plate_normal);
            count++;
        } else {
            wall++;
            moving += v.x != 0.0 || v.y != 0.0 || v.z != 0.0;
        }
    }
    double error = count > 0 ? sum / (double)count - SPEED : NAN;
    eval_table_add(table, "plate", "plate_speed_error_percent",
                   "plate at 0.5 m/s: error of its speed, %", profile,
                   100.0 * (error < 0.0 ? -error : error) / SPEED);
    eval_table_add(table, "plate", "wall_moving_percent", "wall behind it, not exactly still, %",
                   profile, eval_percent(moving, wall));
}

static rlf_result run_profile(eval_table *table, int64_t seed, rlf_profile profile)
{
    eval_stage stage;
    eval_random random = eval_random_start((uint64_t)seed);
    rlf_result result = eval_stage_open(profile, &stage);
    const rlf_surface *surface = NULL;
    double time_s = 0.0;
    for (int k = 0; k < EMPTY_FRAMES + PLATE_FRAMES && result == RLF_OK; k++) {
        time_s = (k - EMPTY_FRAMES) / 30.0;
        draw(&stage, &random, k >= EMPTY_FRAMES, time_s);
        result = eval_stage_process(&stage, &surface);
    }
    if (result == RLF_OK) {
        report(table, &stage, surface, time_s, profile);
    }
    eval_stage_close(&stage);
    return result;
}

rlf_result eval_plate_run(eval_table *table, int64_t seed, int profile_mask)
{
    rlf_result result = RLF_OK;
    for (int profile = 0; profile < EVAL_PROFILES && result == RLF_OK; profile++) {
        if (profile_mask & (1 << profile)) {
            result = run_profile(table, seed, (rlf_profile)profile);
        }
    }
    return result;
}
