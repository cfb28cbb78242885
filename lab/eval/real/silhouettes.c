/* Foreground and matte against silhouettes of people, which script/silhouettes cuts. The matte is
 * that of a slab behind the person and before the room. */
#include "command.h"
#include "eval/measures/foreground.h"
#include "eval/measures/percent.h"
#include "eval/real/clip.h"
#include "eval/real/mask.h"
#include "eval/real/matte.h"
#include "eval/real/parts.h"
#include "eval/real/real.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define MEDIAN_FRAMES 10 /* the baseline's background */
#define NEARER 0.97      /* of the background's depth: the baseline's foreground */
#define BEHIND_M 0.1     /* the room is behind the slab by this much, or not judged */
#define RIM_RAGGED 6     /* pixels */
#define RIM_SHARE 0.25   /* rows and columns at the border with depth in less than this have none */

typedef struct silhouette_clip {
    const char *name, *part;
    int32_t first, count; /* the background is learnt from frame `first` on */
    double slab_m;
    bool has_foreground; /* false: the person is there, and still, from the first frame on */
} silhouette_clip;

static const silhouette_clip clips[] = {
    {"hands_toys", "hands_toys from frame 80", 80, 280, 1.6, true},
    {"table_hands", "table_hands from frame 0", 0, 100, 1.5, false},
};

/* What is judged: [0] Relief, [1] the baseline, [2] for the matte a baseline that is closed. */
typedef struct silhouette_run {
    real_mask_errors foreground[2], matte[3];
    real_mask_work work;
    int32_t pixels;
    uint8_t *found, *scratch, *truth, *first; /* first: the person in the first frames */
    int32_t x0, y0, x1, y1;                   /* within the rim without depth */
    int64_t rim, rim_hidden[2];               /* the person's pixels there */
    uint8_t *near; /* furniture before the slab, or its edge, in the first frames */
    float *raw, *median;
    const char *folder;
    double slab_m;
} silhouette_run;

static rlf_result allocate(silhouette_run *r, const real_clip *clip)
{
    size_t n = (size_t)real_clip_pixels(clip);
    r->pixels = (int32_t)n;
    uint8_t **const bytes[5] = {&r->found, &r->scratch, &r->truth, &r->first, &r->near};
    for (int k = 0; k < 5; k++) {
        *bytes[k] = rlf_alloc_array(n, 1);
        if (*bytes[k] == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    r->raw = rlf_alloc_array(n, sizeof(float));
    r->median = rlf_alloc_array(n, sizeof(float));
    return r->raw != NULL && r->median != NULL
               ? real_mask_work_init(&r->work, clip->rig.depth.width, clip->rig.depth.height)
               : RLF_ERROR_MEMORY;
}

static void release(silhouette_run *r)
{
    real_mask_work_finish(&r->work);
    rlf_free(r->found);
    rlf_free(r->scratch);
    rlf_free(r->truth);
    rlf_free(r->first);
    rlf_free(r->near);
    rlf_free(r->raw);
    rlf_free(r->median);
    rlf_free(r);
}

/* Per pixel the middle one of the first frames' depths. */
static void find_median(silhouette_run *r, const real_clip *clip)
{
    for (int32_t i = 0; i < r->pixels; i++) {
        uint16_t seen[MEDIAN_FRAMES];
        int32_t count = 0;
        for (int32_t f = 0; f < MEDIAN_FRAMES && f < clip->count; f++) {
            uint16_t z = real_clip_depth(clip, f)[i];
            int32_t k = count;
            for (; z > 0 && k > 0 && seen[k - 1] > z; k--) {
                seen[k] = seen[k - 1];
            }
            if (z > 0) {
                seen[k] = z;
                count++;
            }
        }
        r->median[i] = count > 0 ? (float)(seen[count / 2] / clip->units_per_metre) : 0.0f;
    }
}

/* The edge of furniture is no outline of a person: twice 4 pixels around it are not judged. */
static void find_near(silhouette_run *r)
{
    for (int32_t i = 0; i < r->pixels; i++) {
        r->near[i] = r->median[i] > 0.0f && r->median[i] < (float)(r->slab_m + BEHIND_M);
    }
    real_mask_grow(r->near, r->work.width, r->work.height, r->scratch);
    real_mask_grow(r->near, r->work.width, r->work.height, r->scratch);
}

static double line_share(const silhouette_run *r, int32_t start, int32_t count, int32_t stride)
{
    int32_t seen = 0;
    for (int32_t i = 0; i < count; i++) {
        seen += r->median[start + i * stride] > 0.0f;
    }
    return (double)seen / count;
}

/* Most cameras have no depth in some rows and columns at the border, and little beside them: a rim
 * is RIM_RAGGED wider than they are. */
static void find_rim(silhouette_run *r)
{
    int32_t w = r->work.width, h = r->work.height;
    r->x1 = w;
    r->y1 = h;
    for (; r->x0 < w / 4 && line_share(r, r->x0, h, w) < RIM_SHARE; r->x0++) {
    }
    for (; r->x1 > w - w / 4 && line_share(r, r->x1 - 1, h, w) < RIM_SHARE; r->x1--) {
    }
    for (; r->y0 < h / 4 && line_share(r, r->y0 * w, w, 1) < RIM_SHARE; r->y0++) {
    }
    for (; r->y1 > h - h / 4 && line_share(r, (r->y1 - 1) * w, w, 1) < RIM_SHARE; r->y1--) {
    }
    r->x0 += r->x0 > 0 ? RIM_RAGGED : 0;
    r->y0 += r->y0 > 0 ? RIM_RAGGED : 0;
    r->x1 -= r->x1 < w ? RIM_RAGGED : 0;
    r->y1 -= r->y1 < h ? RIM_RAGGED : 0;
}

static bool is_in_rim(const silhouette_run *r, int32_t i)
{
    int32_t x = i % r->work.width, y = i / r->work.width;
    return x < r->x0 || y < r->y0 || x >= r->x1 || y >= r->y1;
}

/* False when there is none for this frame. */
static bool read_mask(const silhouette_run *r, const char *name, uint8_t *out)
{
    char path[REAL_PATH_SIZE];
    rlf_image_rgba8 image = {0};
    FILE *file = real_join(path, r->folder, name) ? fopen(path, "rb") : NULL;
    bool is_there = file != NULL && fclose(file) == 0;
    is_there = is_there && rlf_picture_read(path, &image) == RLF_OK;
    is_there = is_there && image.width == r->work.width && image.height == r->work.height;
    for (int32_t i = 0; i < r->pixels && is_there; i++) {
        out[i] = rlf_rgba8_row(&image, i / image.width)[4 * (i % image.width)];
    }
    rlf_free(image.data);
    return is_there;
}

/* Where the person stood in the first frames, he is background to anyone. */
static void judge_foreground(silhouette_run *r, const rlf_surface *s, const uint8_t *mask)
{
    for (int32_t i = 0; i < r->pixels; i++) {
        r->truth[i] = r->first[i] || is_in_rim(r, i) ? REAL_UNJUDGED : mask[i];
        r->found[i] = s->foreground[i];
    }
    real_mask_add(&r->foreground[0], &r->work, r->found, r->truth);
    for (int32_t i = 0; i < r->pixels; i++) {
        r->found[i] = r->raw[i] > 0.0f && r->raw[i] < (float)NEARER * r->median[i];
    }
    real_mask_close(r->found, r->work.width, r->work.height, r->scratch);
    real_mask_add(&r->foreground[1], &r->work, r->found, r->truth);
}

/* Furniture nearer than the slab hides it as well: what is beside him is judged only where the room
 * is not known to be nearer. The rim is judged by itself. */
static void judge_matte(silhouette_run *r, const rlf_plane_u8 *matte, const uint8_t *mask)
{
    for (int32_t i = 0; i < r->pixels; i++) {
        bool is_rim = is_in_rim(r, i);
        r->truth[i] = is_rim || (mask[i] == 0 && r->near[i]) ? REAL_UNJUDGED : mask[i];
        r->found[i] = rlf_u8_row(matte, i / r->work.width)[i % r->work.width] < 128;
        r->rim += is_rim && mask[i] == REAL_INSIDE;
        r->rim_hidden[0] += is_rim && mask[i] == REAL_INSIDE && r->found[i];
    }
    real_mask_add(&r->matte[0], &r->work, r->found, r->truth);
    for (int32_t i = 0; i < r->pixels; i++) {
        r->found[i] = r->raw[i] > 0.0f && r->raw[i] < (float)r->slab_m;
        r->rim_hidden[1] += is_in_rim(r, i) && mask[i] == REAL_INSIDE && r->found[i];
    }
    real_mask_add(&r->matte[1], &r->work, r->found, r->truth);
    real_mask_close(r->found, r->work.width, r->work.height, r->scratch);
    real_mask_add(&r->matte[2], &r->work, r->found, r->truth);
}

static rlf_result run_frames(silhouette_run *r, const silhouette_clip *c, const real_clip *clip)
{
    real_matte matte;
    uint8_t *mask = rlf_alloc_array((size_t)r->pixels, 1);
    rlf_result result = mask != NULL ? real_matte_open(clip, c->slab_m, &matte) : RLF_ERROR_MEMORY;
    if (result != RLF_OK) {
        rlf_free(mask);
        return result;
    }
    for (int32_t i = 0; i < clip->count && result == RLF_OK && !command_interrupted; i++) {
        rlf_pipeline_output frame;
        rlf_plane_u8 alpha;
        char name[32];
        result = real_matte_next(&matte, &frame, &alpha);
        (void)snprintf(name, sizeof(name), "%06d.png", (int)(c->first + i));
        if (result != RLF_OK || !read_mask(r, name, mask)) {
            continue;
        }
        for (int32_t k = 0; k < r->pixels; k++) {
            r->raw[k] = (float)(real_clip_depth(clip, i)[k] / clip->units_per_metre);
        }
        if (c->has_foreground) {
            judge_foreground(r, frame.surface, mask);
        }
        judge_matte(r, &alpha, mask);
    }
    real_matte_close(&matte);
    rlf_free(mask);
    return result;
}

/* ---- rows ------------------------------------------------------------------------------------ */

static double f_measure(const real_mask_errors *e)
{
    return e->pictures > 0 ? eval_f_measure(&e->pixels) : NAN;
}
static double per_picture(const real_mask_errors *e, int64_t sum)
{
    return e->pictures > 0 ? (double)sum / (double)e->pictures : NAN;
}
static double inside_mean(const real_mask_errors *e)
{
    return per_picture(e, e->blot_inside_sum);
}
static double outside_mean(const real_mask_errors *e)
{
    return per_picture(e, e->blot_outside_sum);
}
static double inside_max(const real_mask_errors *e)
{
    return e->pictures > 0 ? (double)e->blot_inside_max : NAN;
}
static double outside_max(const real_mask_errors *e)
{
    return e->pictures > 0 ? (double)e->blot_outside_max : NAN;
}

#define MEDIAN "median of 10 frames, 3 %, closed 9x9"
#define RAW "raw depth"
#define CLOSED "raw depth, closed 9x9"

static const struct {
    const char *key, *title, *baseline_name;
    bool is_matte;
    int baseline; /* index into the errors */
    char relation;
    double goal;
    double (*value)(const real_mask_errors *e);
} figures[] = {
    {"foreground_f", "foreground: F", MEDIAN, false, 1, '>', 0.975, f_measure},
    {"foreground_iou", "foreground: IoU", MEDIAN, false, 1, '>', NAN, real_mask_iou},
    {"foreground_outline_mean_px", "foreground, outline: off by, px", MEDIAN, false, 1, '<', NAN,
     real_mask_distance_mean},
    {"foreground_outline_p95_px", "foreground, outline: p95, px", MEDIAN, false, 1, '<', NAN,
     real_mask_distance_p95},
    {"foreground_hole_px", "foreground, largest hole in a person: mean, px", MEDIAN, false, 1, '<',
     NAN, inside_mean},
    {"foreground_blot_px", "foreground, largest blot beside him: mean, px", MEDIAN, false, 1, '<',
     NAN, outside_mean},
    {"matte_iou", "matte, hidden by a person: IoU", RAW, true, 1, '>', NAN, real_mask_iou},
    {"matte_outline_mean_px", "matte, outline of a person: off by, px", RAW, true, 1, '<', 1.0,
     real_mask_distance_mean},
    {"matte_outline_p95_px", "matte, outline of a person: p95, px", RAW, true, 1, '<', 4.0,
     real_mask_distance_p95},
    {"matte_outline_mean_closed_px", "  the same beside another baseline: off by, px", CLOSED, true,
     2, '<', NAN, real_mask_distance_mean},
    {"matte_outline_p95_closed_px", "  p95, px", CLOSED, true, 2, '<', NAN, real_mask_distance_p95},
    {"matte_hole_px", "matte, largest blot on a person: mean, px", RAW, true, 1, '<', NAN,
     inside_mean},
    {"matte_hole_max_px", "  most of all frames, px", RAW, true, 1, '<', 30.0, inside_max},
    {"matte_blot_px", "matte, largest blot beside him: mean, px", RAW, true, 1, '<', NAN,
     outside_mean},
    {"matte_blot_max_px", "  most of all frames, px", RAW, true, 1, '<', 30.0, outside_max},
};

static void add_rows(real_table *table, const silhouette_clip *c, const silhouette_run *r)
{
    real_row count = {.key = "silhouettes",
                      .title = "silhouettes (script/silhouettes; \"-\" = none were found)",
                      .relation = '>',
                      .goal = NAN,
                      .relief = r->matte[0].pictures > 0 ? (double)r->matte[0].pictures : NAN,
                      .baseline = NAN,
                      .baseline_name = ""};
    real_add(table, c->part, &count);
    for (size_t i = 0; i < sizeof(figures) / sizeof(figures[0]); i++) {
        const real_mask_errors *e = figures[i].is_matte ? r->matte : r->foreground;
        real_row row = {.key = figures[i].key,
                        .title = figures[i].title,
                        .relation = figures[i].relation,
                        .goal = figures[i].goal,
                        .relief = figures[i].value(&e[0]),
                        .baseline = figures[i].value(&e[figures[i].baseline]),
                        .baseline_name = figures[i].baseline_name};
        if (figures[i].is_matte || c->has_foreground) {
            real_add(table, c->part, &row);
        }
    }
    const real_row rim = {.key = "matte_rim_percent",
                          .title = "matte, person in the rim without depth: hides, %",
                          .relation = '>',
                          .goal = NAN,
                          .relief = eval_percent(r->rim_hidden[0], r->rim),
                          .baseline = eval_percent(r->rim_hidden[1], r->rim),
                          .baseline_name = RAW};
    real_add(table, c->part, &rim);
}

static rlf_result run_clip(real_table *table, const silhouette_clip *c, const char *folder,
                           const char *silhouettes)
{
    silhouette_run *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    real_clip clip = {0};
    r->folder = silhouettes;
    r->slab_m = c->slab_m;
    bool has_masks = real_is_there(silhouettes);
    rlf_result result = has_masks ? real_clip_load(folder, c->first, c->count, &clip) : RLF_OK;
    result = has_masks && result == RLF_OK ? allocate(r, &clip) : result;
    if (has_masks && result == RLF_OK) {
        find_median(r, &clip);
        find_near(r);
        find_rim(r);
        (void)read_mask(r, "first.png", r->first);
        result = run_frames(r, c, &clip);
    }
    if (result == RLF_OK) {
        add_rows(table, c, r);
    }
    release(r);
    real_clip_free(&clip);
    return result;
}

rlf_result real_silhouettes_run(real_table *table, const real_options *options)
{
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < sizeof(clips) / sizeof(clips[0]) && result == RLF_OK; i++) {
        char folder[REAL_PATH_SIZE], masks[REAL_PATH_SIZE];
        if (real_join(folder, options->folder, clips[i].name) &&
            real_join(masks, options->silhouettes, clips[i].name) && real_is_there(folder)) {
            result = run_clip(table, &clips[i], folder, masks);
        }
    }
    return result;
}
