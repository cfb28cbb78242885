/* Still clips: how steady normals and matte are, and how true normals are to large planes. */
#include "command.h"
#include "eval/measures/depth.h"
#include "eval/measures/band.h"
#include "eval/measures/percent.h"
#include "eval/real/clip.h"
#include "eval/real/fit.h"
#include "eval/real/matte.h"
#include "eval/real/parts.h"
#include "eval/real/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREES (180.0 / RLF_PI)
#define PLANES_MAX 4
#define PLANE_SHARE 0.05 /* of the pixels with depth: less is no large plane */
#define AROUND 6         /* pixels */
#define ALPHA_CHANGE 127 /* of 255 */
#define PICTURE_PIXELS 76800.0

typedef struct still_clip {
    const char *name, *part;
    int32_t count, last; /* frames; the last of them are judged */
} still_clip;

static const still_clip clips[] = {
    {"hands_toys", "hands_toys, still 0-79", 80, 20},
    {"room_still", "room_still", 12, 6},
};

/* Relief [0], and a plane fitted to 5x5 pixels of the mean of all frames so far [1]. */
typedef struct still_run {
    int32_t pixels, count, last, seen;
    rlf_depth_noise noise;
    float *sum, *mean;          /* of the raw depth */
    uint16_t *hits;             /* frames with depth */
    float *normals[2];          /* [judged frame][pixel][3] */
    const float *ray_x, *ray_y; /* the last surface's */
    uint8_t *band, *scratch,
        *is_interior; /* interior: no edge near, normals in all judged frames */
    int32_t width, height;
} still_run;

static rlf_result allocate(still_run *r, const real_clip *clip, int32_t last)
{
    size_t n = (size_t)real_clip_pixels(clip);
    r->pixels = (int32_t)n;
    r->width = clip->rig.depth.width;
    r->height = clip->rig.depth.height;
    r->count = clip->count;
    r->last = last < clip->count ? last : clip->count;
    r->noise = clip->rig.noise;
    r->sum = rlf_alloc_array(n, sizeof(float));
    r->mean = rlf_alloc_array(n, sizeof(float));
    r->hits = rlf_alloc_array(n, sizeof(uint16_t));
    r->band = rlf_alloc_array(n, 1);
    r->scratch = rlf_alloc_array(n, 1);
    r->is_interior = rlf_alloc_array(n, 1);
    bool is_ready = r->sum != NULL && r->mean != NULL && r->hits != NULL && r->band != NULL &&
                    r->scratch != NULL && r->is_interior != NULL;
    for (int k = 0; k < 2; k++) {
        r->normals[k] = rlf_alloc_array(n * (size_t)r->last, 3 * sizeof(float));
        is_ready = is_ready && r->normals[k] != NULL;
    }
    return is_ready ? RLF_OK : RLF_ERROR_MEMORY;
}

static void release(still_run *r)
{
    rlf_free(r->sum);
    rlf_free(r->mean);
    rlf_free(r->hits);
    rlf_free(r->band);
    rlf_free(r->scratch);
    rlf_free(r->is_interior);
    rlf_free(r->normals[0]);
    rlf_free(r->normals[1]);
}

static float *normal_at(const still_run *r, int method, int32_t frame, int32_t i)
{
    return r->normals[method] + 3 * ((size_t)frame * (size_t)r->pixels + (size_t)i);
}

static rlf_vec3 get_normal(const still_run *r, int method, int32_t frame, int32_t i)
{
    const float *n = normal_at(r, method, frame, i);
    return rlf_vec3_make(n[0], n[1], n[2]);
}

static void put_normal(const still_run *r, int method, int32_t frame, int32_t i, rlf_vec3 n)
{
    float *out = normal_at(r, method, frame, i);
    out[0] = (float)n.x;
    out[1] = (float)n.y;
    out[2] = (float)n.z;
}

/* ---- normals --------------------------------------------------------------------------------- */

static rlf_result take_surface(void *context, const rlf_frame *frame, const rlf_surface *s,
                               int32_t index)
{
    still_run *r = context;
    for (int32_t i = 0; i < r->pixels; i++) {
        float z = eval_raw_depth(frame, i % s->width, i / s->width);
        r->sum[i] += z;
        r->hits[i] = (uint16_t)(r->hits[i] + (z > 0.0f));
        r->mean[i] = r->hits[i] > 0 ? r->sum[i] / (float)r->hits[i] : 0.0f;
    }
    int32_t judged = index - (r->count - r->last);
    const real_points mean = {s->width, s->height, s->ray_x, s->ray_y, r->mean};
    for (int32_t i = 0; i < r->pixels && judged >= 0; i++) {
        put_normal(r, 0, judged, i, rlf_vec3_make(s->normal_x[i], s->normal_y[i], s->normal_z[i]));
        put_normal(r, 1, judged, i, real_window_normal(&mean, i));
    }
    r->seen = judged + 1;
    return RLF_OK;
}

/* No edge near, seen in nine frames of ten, and with both normals in every judged frame. */
static void find_interior(still_run *r)
{
    eval_mark_band(r->mean, r->width, r->height, r->band, r->scratch);
    for (int32_t i = 0; i < r->pixels; i++) {
        bool is_in = !r->band[i] && 10 * r->hits[i] >= 9 * r->count;
        for (int32_t f = 0; f < r->last && is_in; f++) {
            is_in = rlf_length(get_normal(r, 0, f, i)) > 0.5 &&
                    rlf_length(get_normal(r, 1, f, i)) > 0.5;
        }
        r->is_interior[i] = is_in;
    }
}

static double angle_deg(rlf_vec3 a, rlf_vec3 b)
{
    return DEGREES * rlf_acos(rlf_clamp(rlf_dot(a, b), -1.0, 1.0));
}

/* Mean angle of a frame's normal to the mean of all judged ones. */
static double temporal_noise(const still_run *r, int method)
{
    double sum = 0.0;
    int64_t count = 0;
    for (int32_t i = 0; i < r->pixels; i++) {
        rlf_vec3 mean = {0, 0, 0};
        for (int32_t f = 0; f < r->last && r->is_interior[i]; f++) {
            mean = rlf_add(mean, get_normal(r, method, f, i));
        }
        for (int32_t f = 0; f < r->last && r->is_interior[i]; f++) {
            sum += angle_deg(get_normal(r, method, f, i), rlf_normalize(mean));
            count++;
        }
    }
    return count > 0 ? sum / (double)count : NAN;
}

/* All pixels around are on the plane as well: what merely crosses it is not. */
static bool is_within(const still_run *r, const uint8_t *is_on, int32_t i)
{
    int32_t x = i % r->width, y = i / r->width;
    bool is_in = x >= AROUND && y >= AROUND && x < r->width - AROUND && y < r->height - AROUND;
    for (int32_t dy = -AROUND; dy <= AROUND && is_in; dy++) {
        for (int32_t dx = -AROUND; dx <= AROUND && is_in; dx++) {
            is_in = is_on[i + dy * r->width + dx];
        }
    }
    return is_in;
}

typedef struct plane_figures {
    double angle_sum[2];
    int64_t samples, over[2];
    int32_t planes;
} plane_figures;

/* The last frame's normals against large planes of the mean of all frames. */
static void compare_planes(const still_run *r, const real_points *mean, uint8_t *is_free,
                           uint8_t *is_on, plane_figures *out)
{
    int32_t with_depth = 0;
    for (int32_t i = 0; i < r->pixels; i++) {
        is_free[i] = r->mean[i] > 0.0f;
        with_depth += is_free[i];
    }
    for (int p = 0; p < PLANES_MAX; p++) {
        real_plane plane;
        if (!real_plane_find(mean, is_free, &r->noise, &plane) ||
            plane.inliers < PLANE_SHARE * with_depth) {
            return;
        }
        out->planes++;
        for (int32_t i = 0; i < r->pixels; i++) {
            is_on[i] = is_free[i] && real_plane_holds(mean, &plane, &r->noise, i);
            is_free[i] = is_free[i] && !is_on[i];
        }
        for (int32_t i = 0; i < r->pixels; i++) {
            for (int k = 0; k < 2 && r->is_interior[i] && is_within(r, is_on, i); k++) {
                double angle = angle_deg(get_normal(r, k, r->last - 1, i), plane.n);
                out->angle_sum[k] += angle;
                out->over[k] += angle > 30.0;
                out->samples += k == 0;
            }
        }
    }
}

/* ---- matte ----------------------------------------------------------------------------------- */

static int compare_depths(const void *a, const void *b)
{
    uint16_t x = *(const uint16_t *)a, y = *(const uint16_t *)b;
    return (x > y) - (x < y);
}

/* The middle one of the first frame's depths. */
static double middle_depth(const real_clip *clip, uint16_t *scratch)
{
    int32_t count = 0;
    for (int32_t i = 0; i < real_clip_pixels(clip); i++) {
        scratch[count] = real_clip_depth(clip, 0)[i];
        count += scratch[count] > 0;
    }
    qsort(scratch, (size_t)count, sizeof(*scratch), compare_depths);
    return count > 0 ? scratch[count / 2] / clip->units_per_metre : 1.0;
}

/* Pixels per frame, of a picture of PICTURE_PIXELS, whose alpha changes by more than half. */
static rlf_result measure_flicker(const real_clip *clip, int32_t last, double out[2])
{
    int32_t pixels = real_clip_pixels(clip), width = clip->rig.depth.width;
    uint8_t *alpha[2] = {rlf_alloc_array((size_t)pixels, 1), rlf_alloc_array((size_t)pixels, 1)};
    uint16_t *scratch = rlf_alloc_array((size_t)pixels, sizeof(*scratch));
    int64_t changes[2] = {0, 0};
    real_matte matte;
    rlf_result result = RLF_ERROR_MEMORY;
    if (alpha[0] != NULL && alpha[1] != NULL && scratch != NULL) {
        double z = middle_depth(clip, scratch);
        result = real_matte_open(clip, z, &matte);
        for (int32_t f = 0; f < clip->count && result == RLF_OK && !command_interrupted; f++) {
            rlf_pipeline_output frame;
            rlf_plane_u8 shown;
            result = real_matte_next(&matte, &frame, &shown);
            for (int32_t i = 0; i < pixels && result == RLF_OK; i++) {
                double raw = real_clip_depth(clip, f)[i] / clip->units_per_metre;
                const uint8_t now[2] = {rlf_u8_row(&shown, i / width)[i % width],
                                        raw > 0.0 && raw < z ? 0 : 255};
                for (int k = 0; k < 2; k++) {
                    int change = now[k] - alpha[k][i];
                    bool is_judged = f >= clip->count - last && f > 0;
                    changes[k] += is_judged && (change > ALPHA_CHANGE || change < -ALPHA_CHANGE);
                    alpha[k][i] = now[k];
                }
            }
        }
        real_matte_close(&matte);
    }
    for (int k = 0; k < 2; k++) {
        out[k] = (double)changes[k] / last * PICTURE_PIXELS / pixels;
        rlf_free(alpha[k]);
    }
    rlf_free(scratch);
    return result;
}

/* ---- rows ------------------------------------------------------------------------------------ */

static void add_row(real_table *table, const char *part, const char *key, const char *title,
                    double goal, const double value[2], const char *baseline)
{
    const real_row row = {.key = key,
                          .title = title,
                          .relation = '<',
                          .goal = goal,
                          .relief = value[0],
                          .baseline = value[1],
                          .baseline_name = baseline};
    real_add(table, part, &row);
}

static rlf_result add_rows(real_table *table, const still_clip *c, const real_clip *clip,
                           still_run *r)
{
    const char *const fit = "5x5 plane on the mean of all frames";
    float *rays[2] = {NULL, NULL};
    double noise[2], angle[2], over[2], flicker[2];
    plane_figures planes = {0};
    find_interior(r);
    rlf_result result = RLF_OK;
    for (int k = 0; k < 2; k++) {
        rays[k] = rlf_alloc_array((size_t)r->pixels, sizeof(float));
        result = rays[k] != NULL ? result : RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < r->pixels && result == RLF_OK; i++) {
        rlf_vec3 ray;
        (void)rlf_camera_unproject(&clip->rig.depth, i % r->width, i / r->width, &ray);
        rays[0][i] = (float)ray.x;
        rays[1][i] = (float)ray.y;
    }
    if (result == RLF_OK) {
        const real_points mean = {r->width, r->height, rays[0], rays[1], r->mean};
        compare_planes(r, &mean, r->scratch, r->band, &planes);
        result = measure_flicker(clip, r->last, flicker);
    }
    for (int k = 0; k < 2; k++) {
        noise[k] = temporal_noise(r, k);
        angle[k] = planes.samples > 0 ? planes.angle_sum[k] / (double)planes.samples : NAN;
        over[k] = eval_percent(planes.over[k], planes.samples);
        rlf_free(rays[k]);
    }
    if (result == RLF_OK && !command_interrupted) {
        add_row(table, c->part, "normals_noise_deg", "normals, interior: noise over time, deg", NAN,
                noise, fit);
        add_row(table, c->part, "normals_plane_deg", "normals on large planes: off by, deg", NAN,
                angle, fit);
        add_row(table, c->part, "normals_plane_over_30_percent", "  more than 30 deg, %", NAN, over,
                fit);
        add_row(table, c->part, "alpha_flicker_px",
                "matte: pixels of 76,800 whose alpha changes by > .5 a frame", 5.0, flicker,
                "raw depth");
    }
    return result;
}

rlf_result real_still_run(real_table *table, const real_options *options)
{
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < sizeof(clips) / sizeof(clips[0]) && result == RLF_OK; i++) {
        char folder[REAL_PATH_SIZE];
        if (command_interrupted || !real_join(folder, options->folder, clips[i].name) ||
            !real_is_there(folder)) {
            continue;
        }
        real_clip clip;
        still_run run = {0};
        result = real_clip_load(folder, 0, clips[i].count, &clip);
        result = result == RLF_OK ? allocate(&run, &clip, clips[i].last) : result;
        result = result == RLF_OK ? real_clip_surfaces(&clip, 1, take_surface, &run) : result;
        if (result == RLF_OK && !command_interrupted) {
            result = add_rows(table, &clips[i], &clip, &run);
        }
        release(&run);
        real_clip_free(&clip);
    }
    return result;
}
