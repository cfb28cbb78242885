/* Whether a calibration still holds, by any room and without a board: depth's edges in colour; and
 * how the camera stands, by the room's floor. */
#include "calibrate/calibrate.h"

#include "command.h"
#include "info/info.h"
#include "relief/io.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEGREES (180.0 / RLF_PI)
#define SECONDS 5         /* of a camera */
#define FRAMES_ENDLESS 60 /* of a source that has no end and is not live */
#define STAND_FRAMES 20   /* that tell how the camera stands */
#define LEVEL_COS 0.985   /* 10 degrees: what lies so level may be the floor */
#define BIN_M 0.02
#define FLOOR_SHARE 0.1 /* of the level pixels; fewer are a step or a shelf */

static void add_level(calibrate_stand *s, const rlf_surface *surface, rlf_vec3 up)
{
    const int32_t count = surface->width * surface->height;
    for (int32_t i = 0; i < count; i++) {
        const rlf_vec3 n = {surface->normal_x[i], surface->normal_y[i], surface->normal_z[i]};
        const double z = surface->depth[i];
        if (z <= 0.0 || rlf_dot(n, up) < LEVEL_COS) {
            continue;
        }
        const rlf_vec3 p = {z * surface->ray_x[i], z * surface->ray_y[i], z};
        const double below = -rlf_dot(p, up) / BIN_M;
        if (below >= 0.0 && below < CALIBRATE_STAND_BINS) {
            s->count[(int)below]++;
            s->below_m[(int)below] += BIN_M * below;
            s->level++;
        }
    }
}

void calibrate_stand_add(calibrate_stand *s, const rlf_surface *surface)
{
    rlf_vec3 up;
    const double confidence = rlf_surface_find_up(surface, &up);
    const bool is_sure = confidence >= RLF_UP_SURE;
    if (is_sure && s->sure == 0) { /* what guesses gave is worth nothing any more */
        *s = (calibrate_stand){.frames = s->frames};
    }
    s->frames++;
    if (is_sure || (s->sure == 0 && confidence > 0.0)) {
        s->sure += is_sure ? 1 : 0;
        s->up = rlf_add(s->up, up);
        add_level(s, surface, up);
    }
}

/* The lowest level face that is large: its two best bins' neighbours are of it too. */
bool calibrate_stand_floor(const calibrate_stand *s, double *out_below_m)
{
    for (int i = CALIBRATE_STAND_BINS - 2; i >= 1; i--) {
        const int64_t near = s->count[i - 1] + s->count[i] + s->count[i + 1];
        const bool is_peak = s->count[i] >= s->count[i - 1] && s->count[i] >= s->count[i + 1];
        if (is_peak && s->count[i] > 0 && (double)near >= FLOOR_SHARE * (double)s->level) {
            *out_below_m = (s->below_m[i - 1] + s->below_m[i] + s->below_m[i + 1]) / (double)near;
            return true;
        }
    }
    return false;
}

static rlf_result look(rlf_source *source, calibrate_stand *s)
{
    const rlf_reconstruct_def def =
        rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rlf_source_get_info(source)->rig);
    rlf_reconstruct *stage = NULL;
    rlf_result result = rlf_reconstruct_create(&def, &stage);
    while (result >= RLF_OK && result != RLF_END && s->frames < STAND_FRAMES &&
           !command_interrupted) {
        rlf_frame frame;
        const rlf_surface *surface;
        result = rlf_source_next(source, &frame);
        if (result == RLF_OK) {
            result = rlf_reconstruct_process(stage, &frame, &surface);
        }
        if (result == RLF_OK) {
            calibrate_stand_add(s, surface);
        }
    }
    rlf_reconstruct_destroy(&stage);
    return result < RLF_OK ? result : RLF_OK;
}

/* ---- in words ------------------------------------------------------------------------------- */

static void print_fit(const survey *s, bool is_stale)
{
    const color_fit_result *r = &s->fit;
    if (!s->has_fit) {
        printf("edges   there is no colour to compare depth with\n");
    } else if (!r->is_known) {
        printf(
            "edges   cannot be told: %lld edge points do not agree (+- %.1f px). Colour is off by "
            "more than %.0f px, or the room has too few clear steps in depth\n",
            (long long)r->edges, color_fit_error(r), COLOR_FIT_REACH * r->pixel);
    } else {
        printf("edges   colour is %.1f px %s and %.1f px %s of where depth puts it (together %.1f "
               "+- %.1f px; %lld edge points of %d frames)\n",
               fabs(r->x), r->x >= 0.0 ? "right" : "left", fabs(r->y),
               r->y >= 0.0 ? "below" : "above", color_fit_length(r), color_fit_error(r),
               (long long)r->edges, (int)r->frames);
        if (isfinite(r->near_x) && isfinite(r->far_x)) {
            printf("        near things by (%.1f, %.1f), far ones by (%.1f, %.1f) px; their "
                   "difference is sure to (%.1f, %.1f)\n",
                   r->near_x, r->near_y, r->far_x, r->far_y, r->apart_x, r->apart_y);
        }
    }
    if (s->has_fit && color_fit_is_parallax_wrong(r)) {
        printf("        that they differ speaks against the transform from depth to colour\n");
    }
    if (is_stale) {
        printf("stale   the calibration no longer fits: calibrate again\n");
    } else if (s->has_fit && r->is_known) {
        printf("holds   within a pixel of the coarser picture (%.1f px) and what is sure\n",
               r->pixel);
    }
}

/* Without a minus before a zero, at so many decimals. */
static double tidy(double x, int decimals)
{
    return fabs(x) < 0.5 * pow(10.0, -decimals) ? 0.0 : x;
}

static void print_stand(const calibrate_stand *s)
{
    double below = 0.0;
    if (!(rlf_length(s->up) > 0.0)) {
        printf("mount   cannot be told: no floor, table or wall is seen\n");
        return;
    }
    const rlf_vec3 up = rlf_normalize(s->up);
    printf("gravity (%.3f, %.3f, %.3f) in the depth camera's frame, %s (sure in %d of %d frames)\n",
           tidy(-up.x, 3), tidy(-up.y, 3), tidy(-up.z, 3),
           s->sure > 0 ? "as the room tells" : "only a guess", (int)s->sure, (int)s->frames);
    const bool has_floor = calibrate_stand_floor(s, &below);
    if (has_floor) {
        printf("floor   %.3f x + %.3f y + %.3f z + %.3f = 0, the lowest level face seen\n",
               tidy(up.x, 3), tidy(up.y, 3), tidy(up.z, 3), below);
    } else {
        printf("floor   none is seen\n");
    }
    printf("mount   ");
    printf(has_floor ? "%.2f m above the floor, " : "", below);
    printf("looks down by %.1f degrees, rolled by %.1f\n",
           tidy(DEGREES * rlf_atan2(-up.z, -up.y), 1), tidy(DEGREES * rlf_atan2(up.x, -up.y), 1));
}

rlf_result calibrate_check(const char *name, bool *out_is_stale)
{
    static survey s;
    static calibrate_stand stand;
    memset(&stand, 0, sizeof(stand));
    rlf_source *source = NULL;
    rlf_result result = rlf_open_source(name, NULL, &source);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_source_info *info = rlf_source_get_info(source);
    const survey_options limits = {
        .seconds = SECONDS,
        .frame_limit = info->frame_count < 0 && !info->is_live ? FRAMES_ENDLESS : 0};
    result = survey_run(source, &limits, &s);
    if (result == RLF_OK && s.frames == 0 && !command_interrupted) {
        result = rlf_fail(RLF_ERROR_INVALID, "%s: has no frames", name);
    }
    if (result == RLF_OK && !info->is_live) {
        result = rlf_source_restart(source);
    }
    result = result == RLF_OK ? look(source, &stand) : result;
    if (result == RLF_OK && !command_interrupted) {
        *out_is_stale = s.has_fit && color_fit_is_off(&s.fit);
        print_fit(&s, *out_is_stale);
        print_stand(&stand);
    }
    rlf_source_destroy(&source);
    return result;
}
