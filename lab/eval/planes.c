/* Planes without noise, of which every normal is known: any slope, anywhere in the view; and a
 * plane of which one pixel in a hundred is missing. */
#include "eval/analytic.h"
#include "eval/measures/angles.h"
#include "eval/measures/percent.h"
#include "eval/sections.h"
#include "eval/table.h"

#include <string.h>

#define PLANES 30
#define INCIDENCE_COSINE 0.2588190451025207 /* 75 degrees: steeper is hardly seen */
#define HOLE_SHARE 0.01
#define SPOILT_DEG 10.0

/* Angle accurate near 0, where the arc cosine is not. */
static double angle_deg(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_atan2(rlf_length(rlf_cross(a, b)), rlf_dot(a, b)) * 180.0 / RLF_PI;
}

/* A plane that a random pixel sees at less than 75 degrees, 1 to 3.5 m away there. */
static void random_plane(eval_random *r, const eval_stage *s, rlf_vec3 *out_n, double *out_d)
{
    const rlf_camera *c = &s->rig.depth;
    int32_t pixel = (int32_t)(eval_random_uniform(r) * (double)(c->width * c->height));
    rlf_vec3 ray = s->rays[pixel];
    rlf_vec3 n;
    do {
        n.x = eval_random_normal(r);
        n.y = eval_random_normal(r);
        n.z = eval_random_normal(r);
        n = rlf_normalize(n);
    } while (!(rlf_dot(n, rlf_normalize(ray)) < -INCIDENCE_COSINE));
    *out_n = n;
    *out_d = eval_random_range(r, 1.0, 3.5) * rlf_dot(n, ray);
}

static void draw_plane(eval_stage *s, rlf_vec3 n, double d)
{
    for (int32_t i = 0; i < s->rig.depth.width * s->rig.depth.height; i++) {
        s->depth[i] = (float)eval_plane_depth(n, d, s->rays[i]);
    }
}

/* Every pixel that sees the plane in range and at less than 75 degrees. */
static void add_plane(eval_angles *angles, const eval_stage *s, const rlf_surface *f, rlf_vec3 n)
{
    for (int32_t i = 0; i < f->width * f->height; i++) {
        int32_t t =
            i / f->width * f->scale_factor * s->rig.depth.width + i % f->width * f->scale_factor;
        bool is_in_range = s->depth[t] >= s->rig.depth_min_m && s->depth[t] <= s->rig.depth_max_m;
        if (!is_in_range || !(rlf_dot(n, rlf_normalize(s->rays[t])) < -INCIDENCE_COSINE)) {
            continue;
        }
        rlf_vec3 found = {f->normal_x[i], f->normal_y[i], f->normal_z[i]};
        if (rlf_length(found) > 0.5) {
            eval_add_angle(angles, angle_deg(found, n));
        } else {
            angles->missing++;
        }
    }
}

static rlf_result run_planes(eval_table *table, eval_stage *s, eval_random *r, rlf_profile profile)
{
    eval_angles *angles = rlf_alloc(sizeof(*angles));
    rlf_result result = angles != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (int k = 0; k < PLANES && result == RLF_OK; k++) {
        rlf_vec3 n;
        double d;
        const rlf_surface *surface = NULL;
        random_plane(r, s, &n, &d);
        draw_plane(s, n, d);
        eval_stage_restart(s);
        result = eval_stage_process(s, &surface);
        if (result == RLF_OK) {
            add_plane(angles, s, surface, n);
        }
    }
    if (result == RLF_OK) {
        eval_table_add(table, "planes", "normals_mean_deg",
                       "planes without noise: normals, mean, deg", profile, eval_mean_deg(angles));
        eval_table_add(table, "planes", "normals_over_30_percent",
                       "planes without noise: > 30 deg off, %", profile,
                       eval_wrong_percent(angles));
        eval_table_add(table, "planes", "normals_missing_percent",
                       "planes without noise: missing, %", profile, eval_missing_percent(angles));
    }
    rlf_free(angles);
    return result;
}

/* A wall across the view with holes: what becomes of the pixels beside them and in them. */
static rlf_result run_holes(eval_table *table, eval_stage *s, eval_random *r, rlf_profile profile)
{
    const rlf_vec3 n = {0, 0, -1};
    draw_plane(s, n, -2.0);
    for (int32_t i = 0; i < s->rig.depth.width * s->rig.depth.height; i++) {
        s->depth[i] = eval_random_uniform(r) < HOLE_SHARE ? 0.0f : s->depth[i];
    }
    const rlf_surface *f = NULL;
    eval_stage_restart(s);
    rlf_result result = eval_stage_process(s, &f);
    if (result != RLF_OK) {
        return result;
    }
    int64_t valid = 0, lost = 0, spoilt = 0, holes = 0, invented = 0;
    for (int32_t i = 0; i < f->width * f->height; i++) {
        int32_t t =
            i / f->width * f->scale_factor * s->rig.depth.width + i % f->width * f->scale_factor;
        rlf_vec3 found = {f->normal_x[i], f->normal_y[i], f->normal_z[i]};
        bool has_normal = rlf_length(found) > 0.5;
        if (s->depth[t] > 0.0f) {
            valid++;
            lost += !has_normal;
            spoilt += has_normal && angle_deg(found, n) > SPOILT_DEG;
        } else {
            holes++;
            invented += has_normal && f->reason[i] != RLF_REASON_FILLED;
        }
    }
    eval_table_add(table, "planes", "holes_lost_percent", "1 % holes: valid without a normal, %",
                   profile, eval_percent(lost, valid));
    eval_table_add(table, "planes", "holes_spoilt_percent", "1 % holes: valid, > 10 deg off, %",
                   profile, eval_percent(spoilt, valid));
    eval_table_add(table, "planes", "holes_invented_percent",
                   "1 % holes: unmarked normal in a hole, %", profile,
                   eval_percent(invented, holes));
    return RLF_OK;
}

rlf_result eval_planes_run(eval_table *table, int64_t seed, int profile_mask)
{
    rlf_result result = RLF_OK;
    for (int profile = 0; profile < EVAL_PROFILES && result == RLF_OK; profile++) {
        if (!(profile_mask & (1 << profile))) {
            continue;
        }
        eval_stage stage;
        eval_random random = eval_random_start((uint64_t)seed);
        result = eval_stage_open((rlf_profile)profile, &stage);
        if (result == RLF_OK) {
            result = run_planes(table, &stage, &random, (rlf_profile)profile);
        }
        if (result == RLF_OK) {
            result = run_holes(table, &stage, &random, (rlf_profile)profile);
        }
        eval_stage_close(&stage);
    }
    return result;
}
