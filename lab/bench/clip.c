/* A clip of the synthetic room in memory, and as a raw file. */
#define _POSIX_C_SOURCE 200809L
#include "bench/peers.h"

#include <stdio.h>
#include <string.h>

#define EMPTY_FRAMES 10
#define MOVING_FROM 60 /* frame of the source at which the person is well in view */
#define MOVING_FRAMES 50
#define LABEL_OFFSET 10 /* room's labels, kept off the person's */

static rlf_result allocate(bench_clip *c)
{
    size_t samples = c->pixels * (size_t)c->frame_count;
    c->depth = rlf_alloc_array(samples, sizeof(*c->depth));
    c->z = rlf_alloc_array(samples, sizeof(*c->z));
    c->normal = rlf_alloc_array(3 * samples, sizeof(*c->normal));
    c->label = rlf_alloc(samples);
    bool is_complete = c->depth != NULL && c->z != NULL && c->normal != NULL && c->label != NULL;
    return is_complete ? RLF_OK : RLF_ERROR_MEMORY;
}

static void keep_frame(bench_clip *c, int32_t index, const rlf_frame *frame, const rlf_truth *truth)
{
    size_t first = c->pixels * (size_t)index;
    for (size_t i = 0; i < c->pixels; i++) {
        size_t x = i % (size_t)c->rig.depth.width, y = i / (size_t)c->rig.depth.width;
        const char *row = (const char *)frame->depth_u16 + (ptrdiff_t)y * frame->depth_stride;
        bool is_there = truth->depth[i] > 0.0f;
        int32_t label = truth->label[i] >= RLF_SYNTHETIC_LABEL_PERSON
                            ? CLIP_LABEL_PERSON
                            : truth->label[i] + LABEL_OFFSET;
        c->depth[first + i] = ((const uint16_t *)(const void *)row)[x];
        c->z[first + i] = truth->depth[i];
        c->normal[3 * (first + i)] = truth->normal_x[i];
        c->normal[3 * (first + i) + 1] = truth->normal_y[i];
        c->normal[3 * (first + i) + 2] = truth->normal_z[i];
        c->label[first + i] = (uint8_t)(is_there ? label : CLIP_LABEL_NOTHING);
    }
}

static rlf_result fill(bench_clip *c, rlf_source *source)
{
    int32_t kept = 0;
    for (int32_t k = 0; kept < c->frame_count; k++) {
        rlf_frame frame;
        rlf_result result = rlf_source_next(source, &frame);
        if (result != RLF_OK) {
            return result;
        }
        if (frame.depth_u16 == NULL || frame.depth_units_per_metre < 999.0 ||
            frame.depth_units_per_metre > 1001.0) {
            return rlf_fail(RLF_ERROR_UNSUPPORTED, "the clip needs millimetres");
        }
        if (k < EMPTY_FRAMES || k >= MOVING_FROM) {
            keep_frame(c, kept++, &frame, rlf_source_get_truth(source));
        }
    }
    return RLF_OK;
}

rlf_result bench_clip_create(bench_clip *out)
{
    memset(out, 0, sizeof(*out));
    rlf_source *source = NULL;
    rlf_result result = rlf_open_source("synthetic:room?frames=-1&color=0", NULL, &source);
    if (result != RLF_OK) {
        return result;
    }
    out->rig = rlf_source_get_info(source)->rig;
    out->frame_count = EMPTY_FRAMES + MOVING_FRAMES;
    out->pixels = (size_t)out->rig.depth.width * (size_t)out->rig.depth.height;
    result = allocate(out);
    result = result == RLF_OK ? fill(out, source) : result;
    rlf_source_destroy(&source);
    if (result != RLF_OK) {
        bench_clip_destroy(out);
    }
    return result;
}

void bench_clip_destroy(bench_clip *c)
{
    rlf_free(c->depth);
    rlf_free(c->z);
    rlf_free(c->normal);
    rlf_free(c->label);
    memset(c, 0, sizeof(*c));
}

static void write_truth(const bench_clip *c, FILE *file)
{
    for (int32_t k = 0; k < c->frame_count; k++) {
        size_t first = c->pixels * (size_t)k;
        fwrite(c->z + first, sizeof(float), c->pixels, file);
        fwrite(c->normal + 3 * first, sizeof(float), 3 * c->pixels, file);
        fwrite(c->label + first, 1, c->pixels, file);
    }
}

static rlf_result finish(FILE *file, const char *path)
{
    bool is_bad = ferror(file) != 0;
    is_bad = fclose(file) != 0 || is_bad;
    return is_bad ? rlf_fail(RLF_ERROR_IO, "%s: write failed; is the disk full?", path) : RLF_OK;
}

rlf_result bench_clip_write(const bench_clip *c, const char *path)
{
    char truth_path[1024];
    int length = snprintf(truth_path, sizeof(truth_path), "%s.gt", path);
    FILE *file = fopen(path, "wb");
    FILE *truth = length > 0 && length < (int)sizeof(truth_path) ? fopen(truth_path, "wb") : NULL;
    if (file == NULL || truth == NULL) {
        if (file != NULL) {
            fclose(file);
        }
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be written; choose another --peer-clip file",
                        path);
    }
    const rlf_camera *d = &c->rig.depth;
    fprintf(file, "%d %d %d %.17g %.17g %.17g %.17g\n", (int)d->width, (int)d->height,
            (int)c->frame_count, d->fx, d->fy, d->cx, d->cy);
    fwrite(c->depth, sizeof(*c->depth), c->pixels * (size_t)c->frame_count, file);
    write_truth(c, truth);
    rlf_result result = finish(file, path);
    rlf_result truth_result = finish(truth, truth_path);
    return result == RLF_OK ? truth_result : result;
}
