/* Things on tables as regions of their own, against hand-made labels. Each frame is shown
 * OBJECT_PASSES times, so that the background is there and what is averaged over time settles. */
#define _POSIX_C_SOURCE 200809L
#include "command.h"
#include "eval/measures/depth.h"
#include "eval/real/clip.h"
#include "eval/real/fit.h"
#include "eval/real/mask.h"
#include "eval/real/parts.h"
#include "eval/real/real.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <stdio.h>
#include <string.h>

#define OBJECT_PASSES 8
#define REGIONS_MAX 8192
#define ABOVE_M 0.01 /* over the plane a thing begins */
#define STEP 0.02    /* share of the depth: neighbours of one thing */

typedef struct object_sums {
    int32_t tables, objects, found; /* found: IoU >= 0.5 */
    double iou_sum[2];              /* Relief, baseline */
    int32_t found_sum[2];
} object_sums;

typedef struct object_frame {
    int32_t pixels;
    int32_t *truth;    /* 0 none or table, 2 = first object, 3 = second ... */
    int32_t *label[2]; /* Relief, baseline */
    int32_t *areas, *names, *counts, *stack;
    uint8_t *mark;
    int32_t last; /* index of the last frame */
} object_frame;

static rlf_result allocate(object_frame *f, int32_t pixels)
{
    size_t n = (size_t)pixels;
    *f = (object_frame){.pixels = pixels, .last = OBJECT_PASSES - 1};
    int32_t **const planes[7] = {&f->truth, &f->label[0], &f->label[1], &f->stack,
                                 &f->areas, &f->names,    &f->counts};
    for (int k = 0; k < 7; k++) {
        *planes[k] = rlf_alloc_array(k < 4 ? n : REGIONS_MAX, sizeof(int32_t));
        if (*planes[k] == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    f->mark = rlf_alloc_array(n, 1);
    return f->mark != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

static void release(object_frame *f)
{
    int32_t *const planes[7] = {f->truth, f->label[0], f->label[1], f->stack,
                                f->areas, f->names,    f->counts};
    for (int k = 0; k < 7; k++) {
        rlf_free(planes[k]);
    }
    rlf_free(f->mark);
}

/* Grey levels 1-9 are the table, 20-29 the first object's surfaces, 30-39 the second's ... */
static rlf_result read_truth(const char *path, object_frame *f)
{
    rlf_image_rgba8 image;
    rlf_result result = rlf_picture_read(path, &image);
    if (result == RLF_OK && image.width * image.height != f->pixels) {
        result = rlf_fail(RLF_ERROR_FORMAT, "%s: has another size than its depth", path);
    }
    for (int32_t i = 0; i < f->pixels && result == RLF_OK; i++) {
        int32_t object = rlf_rgba8_row(&image, i / image.width)[4 * (i % image.width)] / 10;
        f->truth[i] = object >= 2 ? object : 0;
    }
    rlf_free(image.data);
    return result;
}

/* The plane with most points, and what is connected above it. */
static void find_components(object_frame *f, const real_points *raw, const rlf_depth_noise *noise)
{
    real_plane table;
    bool has_table = real_plane_find(raw, NULL, noise, &table);
    for (int32_t i = 0; i < f->pixels; i++) {
        f->mark[i] = raw->depth[i] > 0.0f && has_table &&
                     rlf_dot(table.n, real_point(raw, i)) - table.d > ABOVE_M;
    }
    (void)real_components(raw, f->mark, STEP, f->label[1], f->stack);
}

static rlf_result take_surface(void *context, const rlf_frame *frame, const rlf_surface *s,
                               int32_t index)
{
    object_frame *f = context;
    if (index < f->last) {
        return RLF_OK;
    }
    for (int32_t i = 0; i < f->pixels; i++) {
        f->label[0][i] = s->label[i] != 0 ? s->label[i] : s->background_label[i];
    }
    float *depth = rlf_alloc_array((size_t)f->pixels, sizeof(float));
    if (depth == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < f->pixels; i++) {
        depth[i] = eval_raw_depth(frame, i % s->width, i / s->width);
    }
    const real_points raw = {s->width, s->height, s->ray_x, s->ray_y, depth};
    find_components(f, &raw, &frame->rig->noise);
    rlf_free(depth);
    return RLF_OK;
}

static void judge(object_frame *f, object_sums *sums)
{
    for (int k = 0; k < 2; k++) {
        int32_t count = real_dense_labels(f->label[k], f->pixels, f->areas, f->names, REGIONS_MAX);
        for (int32_t object = 2; object <= 25; object++) {
            double iou =
                real_best_iou(f->truth, object, f->label[k], f->pixels, f->areas, count, f->counts);
            if (!isnan(iou)) {
                sums->objects += k == 0;
                sums->iou_sum[k] += iou;
                sums->found_sum[k] += iou >= 0.5;
            }
        }
    }
    sums->tables++;
}

static rlf_result run_table(const char *folder, object_sums *sums)
{
    char path[REAL_PATH_SIZE];
    real_clip clip;
    object_frame frame = {0};
    rlf_result result = real_clip_load_single(folder, &clip);
    result = result == RLF_OK ? allocate(&frame, real_clip_pixels(&clip)) : result;
    if (result == RLF_OK && real_join(path, folder, "label.png")) {
        result = read_truth(path, &frame);
    }
    if (result == RLF_OK) {
        result = real_clip_surfaces(&clip, OBJECT_PASSES, take_surface, &frame);
    }
    if (result == RLF_OK && !command_interrupted) {
        judge(&frame, sums);
    }
    release(&frame);
    real_clip_free(&clip);
    return result;
}

static void add_rows(real_table *table, const object_sums *s)
{
    double n = s->objects > 0 ? s->objects : NAN;
    real_row row = {.key = "object_iou",
                    .title = "objects on labelled tables: mean IoU of the best region",
                    .relation = '>',
                    .goal = 0.72,
                    .relief = s->iou_sum[0] / n,
                    .baseline = s->iou_sum[1] / n,
                    .baseline_name = "table plane by RANSAC, components above"};
    real_add(table, "objects", &row);
    row.key = "object_found_percent";
    row.title = "  with an IoU of .5 or more, %";
    row.goal = NAN;
    row.relief = 100.0 * s->found_sum[0] / n;
    row.baseline = 100.0 * s->found_sum[1] / n;
    real_add(table, "objects", &row);
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

rlf_result real_objects_run(real_table *table, const real_options *options)
{
    char parent[REAL_PATH_SIZE], folder[REAL_PATH_SIZE], path[REAL_PATH_SIZE];
    if (!real_join(parent, options->folder, "labelled") || !real_is_there(parent)) {
        return RLF_OK;
    }
    struct dirent **entries = NULL;
    int count = scandir(parent, &entries, is_visible, alphasort);
    object_sums sums = {0};
    rlf_result result = RLF_OK;
    for (int i = 0; i < count; i++) {
        bool is_table =
            real_join(folder, parent, entries[i]->d_name) && real_join(path, folder, "label.png");
        FILE *file = is_table ? fopen(path, "rb") : NULL;
        if (file != NULL) {
            (void)fclose(file);
            bool goes_on = result == RLF_OK && !command_interrupted;
            result = goes_on ? run_table(folder, &sums) : result;
        }
        free(entries[i]);
    }
    free(entries);
    if (result == RLF_OK && sums.objects > 0) {
        add_rows(table, &sums);
    }
    return result;
}
