/* Reads a source and counts. */
#include "info/info.h"

#include "command.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void info_depth_plane(const rlf_frame *frame, float *out)
{
    const int32_t width = frame->rig->depth.width;
    const int32_t height = frame->rig->depth.height;
    for (ptrdiff_t y = 0; y < height; y++) {
        const unsigned char *base = frame->depth_u16 != NULL
                                        ? (const unsigned char *)frame->depth_u16
                                        : (const unsigned char *)frame->depth_f32;
        const void *row = base + y * frame->depth_stride;
        for (int32_t x = 0; x < width; x++) {
            const double z = frame->depth_u16 != NULL
                                 ? ((const uint16_t *)row)[x] / frame->depth_units_per_metre
                                 : (double)((const float *)row)[x];
            *out++ = z > 0.0 && z < 1000.0 ? (float)z : 0.0f;
        }
    }
}

#define INTERVALS_MAX 4096 /* for the median; later ones only count for the longest */
#define FIT_FRAMES_MAX 40  /* spread over the clip */
#define FAILED_MAX 100     /* a source that fails this often in a row has no more to give */

typedef struct reader {
    survey *out;
    rlf_source *source;
    float *depth;
    stillness *still;
    color_fit *fit;
    int64_t fit_every;
    int64_t first_ns, last_ns;
    double color_gap_sum_s;
    double intervals[INTERVALS_MAX];
    int32_t interval_count;
} reader;

static int compare(const void *a, const void *b)
{
    const double *x = a;
    const double *y = b;
    return (*x > *y) - (*x < *y);
}

static void add_time(reader *r, const rlf_frame *frame)
{
    survey *out = r->out;
    const double interval_s = (double)(frame->time_ns - r->last_ns) * 1e-9;
    const bool is_jump = (frame->flags & RLF_FRAME_DISCONTINUITY) != 0;
    out->jumps += is_jump ? 1 : 0;
    if (out->frames == 0) {
        r->first_ns = frame->time_ns;
    } else if (!is_jump) {
        out->interval_longest_s = fmax(out->interval_longest_s, interval_s);
        if (r->interval_count < INTERVALS_MAX) {
            r->intervals[r->interval_count++] = interval_s;
        }
    }
    r->last_ns = frame->time_ns;
}

static void add_frame(reader *r, const rlf_frame *frame)
{
    survey *out = r->out;
    add_time(r, frame);
    out->flags |= frame->flags;
    out->with_pose += frame->has_pose ? 1 : 0;
    out->with_confidence += frame->confidence != NULL ? 1 : 0;
    info_depth_plane(frame, r->depth);
    missing_add(&out->missing, frame->rig, r->depth);
    stillness_add(r->still, r->depth);
    if (frame->color.data != NULL) {
        out->with_color++;
        const int64_t color_ns = frame->color_time_ns != 0 ? frame->color_time_ns : frame->time_ns;
        r->color_gap_sum_s += fabs((double)(color_ns - frame->time_ns)) * 1e-9;
        if (r->fit != NULL && out->frames % r->fit_every == 0 &&
            out->frames / r->fit_every < FIT_FRAMES_MAX) {
            color_fit_add(r->fit, r->depth, &frame->color);
        }
    }
    out->frames++;
}

/* A frame that cannot be read is counted, and the next one asked for. */
static rlf_result count_failed(survey *out, rlf_result result, int32_t *in_a_row)
{
    if (out->failed++ == 0) {
        snprintf(out->first_error, sizeof(out->first_error), "%s", rlf_error_text());
    }
    return ++*in_a_row < FAILED_MAX ? RLF_OK : result;
}

static rlf_result read_all(reader *r, const survey_options *options)
{
    const bool is_live = rlf_source_get_info(r->source)->is_live;
    const int64_t end_ns = rlf_clock_ns() + (int64_t)(options->seconds * 1e9);
    int32_t failed_in_a_row = 0;
    while (!command_interrupted && (!is_live || rlf_clock_ns() < end_ns) &&
           (options->frame_limit <= 0 || r->out->frames < options->frame_limit)) {
        rlf_frame frame;
        rlf_result result = rlf_source_next(r->source, &frame);
        if (result == RLF_END) {
            return r->out->frames > 0 || r->out->failed == 0
                       ? RLF_OK
                       : rlf_fail(RLF_ERROR_FORMAT, "%s (no frame could be read)",
                                  r->out->first_error);
        }
        if (result == RLF_OK) {
            add_frame(r, &frame);
            failed_in_a_row = 0;
        } else if (result < 0) {
            result = count_failed(r->out, result, &failed_in_a_row);
            if (result != RLF_OK) {
                return r->out->frames > 0 ? RLF_OK : result;
            }
        }
    }
    return RLF_OK;
}

static void sum_up(reader *r)
{
    survey *out = r->out;
    out->status = rlf_source_get_status(r->source);
    out->duration_s = (double)(r->last_ns - r->first_ns) * 1e-9;
    qsort(r->intervals, (size_t)r->interval_count, sizeof(r->intervals[0]), compare);
    out->interval_s = r->interval_count > 0 ? r->intervals[r->interval_count / 2] : 0.0;
    out->color_gap_s = out->with_color > 0 ? r->color_gap_sum_s / (double)out->with_color : 0.0;
    stillness_get(r->still, &out->stillness);
    out->has_fit = r->fit != NULL && out->with_color > 0;
    if (out->has_fit) {
        color_fit_get(r->fit, &out->fit);
    }
}

rlf_result survey_run(rlf_source *source, const survey_options *options, survey *out)
{
    memset(out, 0, sizeof(*out));
    const rlf_source_info *info = rlf_source_get_info(source);
    const rlf_rig *rig = &info->rig;
    static reader r;
    memset(&r, 0, sizeof(r));
    r.out = out;
    r.source = source;
    const int64_t expected = info->frame_count > 0 ? info->frame_count : STILLNESS_FRAMES_MAX;
    r.fit_every = expected > FIT_FRAMES_MAX ? expected / FIT_FRAMES_MAX : 1;
    r.depth = rlf_alloc_array((size_t)rig->depth.width * (size_t)rig->depth.height, sizeof(float));
    r.still = stillness_create(rig);
    r.fit = rig->has_color ? color_fit_create(rig) : NULL;
    rlf_result result = RLF_ERROR_MEMORY;
    if (r.depth != NULL && r.still != NULL && (r.fit != NULL || !rig->has_color)) {
        result = read_all(&r, options);
    }
    if (result == RLF_OK) {
        sum_up(&r);
    }
    rlf_free(r.depth);
    if (r.still != NULL) {
        stillness_destroy(&r.still);
    }
    if (r.fit != NULL) {
        color_fit_destroy(&r.fit);
    }
    return result;
}
