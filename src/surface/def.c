/* Settings of the surface stage: the two profiles and the check of a caller's def. */
#include "surface/stage.h"

#include "base/checks.h"
#include "camera/checks.h"

#define LENGTH_MAX 1000.0 /* metres, of any setting */

/* tan of the steepest incidence that the thesis's threshold still joins: 60 degrees. */
static const double joined_slope = 1.7320508;

/* Eq. 4.4 has no number for tau. Neighbours of one surface differ by noise and by its slope:
 * 6 sigma plus the step of a surface at 60 degrees, both at the middle of the range. 107 mm for a
 * Kinect v2 at scale factor 8. */
static double default_tau(const rlf_reconstruct_def *def)
{
    double z = 0.5 * (def->depth_min_m + def->depth_max_m);
    double step = def->scale_factor * z / rlf_max(def->rig.depth.fx, 1e-9);
    return rlf_min(6.0 * rlf_depth_noise_sigma(&def->rig.noise, z) + joined_slope * step,
                   LENGTH_MAX);
}

/* 6 sigma of the difference between one sample and the mean of n, at the far end of the range; at
 * least 50 mm, because mixed pixels and multipath are not part of sigma. */
static double default_foreground_threshold(const rlf_reconstruct_def *def)
{
    double sigma = rlf_depth_noise_sigma(&def->rig.noise, def->depth_max_m);
    return rlf_clamp(6.0 * sigma * sqrt(1.0 + 1.0 / def->background_frames), 0.05, LENGTH_MAX);
}

static void set_thesis(rlf_reconstruct_def *def)
{
    def->scale_factor = 8;
    def->normal_method = RLF_NORMALS_THESIS;
    def->normals_face_camera = true;
    def->background_segment = RLF_SEGMENT_THESIS;
    def->foreground_segment = RLF_SEGMENT_OFF;
    def->enable_dilation = true;
    def->min_region_points = 4;
    def->keep_region_points = true;
    def->background_method = RLF_BACKGROUND_AVERAGE;
}

static void set_live(rlf_reconstruct_def *def)
{
    def->scale_factor = 1;
    def->normal_method = RLF_NORMALS_INVERSE_DEPTH;
    def->normals_face_camera = true;
    def->background_segment = RLF_SEGMENT_OBJECTS;
    def->foreground_segment = RLF_SEGMENT_NOISE;
    def->min_region_points = 150;
    def->background_method = RLF_BACKGROUND_ADAPTIVE;
    def->enable_flying_removal = true;
    def->enable_fill = true;
    def->enable_smoothing = true;
    def->enable_wide_planes = true;
    def->enable_steadying = true;
    def->enable_hold = true;
    def->enable_edge_normals = true;
    def->enable_velocity = true;
    def->enable_thickness = true;
    def->enable_coast = true;
    def->enable_color_sides = true;
}

rlf_reconstruct_def rlf_reconstruct_def_default(rlf_profile profile, const rlf_rig *rig)
{
    rlf_reconstruct_def def = {0};
    if (!RLF_ASSERT(rig != NULL)) {
        return def;
    }
    def.cookie = RLF_DEF_COOKIE;
    def.rig = *rig;
    def.depth_min_m = rig->depth_min_m;
    def.depth_max_m = rig->depth_max_m;
    def.region_capacity = 256;
    def.background_frames = 5;
    def.foreground_sigmas = 6.0;
    def.foreground_min_m = 0.02;
    def.absorb_after_s = 20.0;
    if (profile == RLF_PROFILE_THESIS) {
        set_thesis(&def);
    } else {
        set_live(&def);
    }
    def.segment_tau_m = default_tau(&def);
    def.foreground_threshold_m = default_foreground_threshold(&def);
    return def;
}

/* One number of a def and what it may be. */
typedef struct limit {
    const char *name;
    double value, low, high;
} limit;

static rlf_result check_limits(const limit *limits, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        const limit *l = &limits[i];
        if (!(l->value >= l->low) || !(l->value <= l->high)) {
            return rlf_fail(RLF_ERROR_INVALID, "reconstruct: %s is %g; use %g to %g", l->name,
                            l->value, l->low, l->high);
        }
    }
    return RLF_OK;
}

rlf_result rlf_reconstruct_def_check(const rlf_reconstruct_def *def)
{
    rlf_result result = rig_check(&def->rig, "reconstruct");
    if (def->background_method == RLF_BACKGROUND_GIVEN && def->give_background == NULL) {
        result = rlf_fail(RLF_ERROR_INVALID, "reconstruct: a given background needs "
                                             "give_background");
    }
    if (result != RLF_OK) {
        return result;
    }
    const rlf_depth_noise *noise = &def->rig.noise;
    const limit limits[] = {
        {"scale_factor", def->scale_factor, 1, 64},
        {"depth_min_m", def->depth_min_m, 0, 1000},
        {"depth_max_m", def->depth_max_m, 0.001, 1000},
        {"depth_max_m - depth_min_m", def->depth_max_m - def->depth_min_m, 1e-6, 1000},
        {"normal_method", def->normal_method, RLF_NORMALS_SIX_FACES, RLF_NORMALS_INVERSE_DEPTH},
        {"background_segment", def->background_segment, RLF_SEGMENT_OFF, RLF_SEGMENT_OBJECTS},
        {"foreground_segment", def->foreground_segment, RLF_SEGMENT_OFF, RLF_SEGMENT_NOISE},
        {"segment_tau_m", def->segment_tau_m, 0, 1000},
        {"min_region_points", def->min_region_points, 0, 1e9},
        {"region_capacity", def->region_capacity, 1, 4096},
        {"background_method", def->background_method, RLF_BACKGROUND_OFF, RLF_BACKGROUND_GIVEN},
        {"background_frames", def->background_frames, 1, 255},
        {"foreground_threshold_m", def->foreground_threshold_m, 0, 1000},
        {"foreground_sigmas", def->foreground_sigmas, 0, 1000},
        {"foreground_min_m", def->foreground_min_m, 0, 1000},
        {"absorb_after_s", def->absorb_after_s, 0, 60},
        {"rig.noise.c0", noise->c0, -1, 1},
        {"rig.noise.c1", noise->c1, -1, 1},
        {"rig.noise.c2", noise->c2, -1, 1},
    };
    return check_limits(limits, (int32_t)(sizeof limits / sizeof limits[0]));
}
