/* What a standing camera remembers of the room behind people: the background per pixel, and in its
 * place a map with and without a residual per pixel. The old room, a random room that was empty at
 * first, and the same from where people were in it when the background was learnt, ten frames a
 * second. */
#include "eval/measures/foreground.h"
#include "eval/measures/normals.h"
#include "eval/measures/percent.h"
#include "eval/memory/map_memory.h"
#include "eval/sections.h"
#include "relief/io.h"
#include "relief/synthetic.h"

#include <math.h>
#include <stdio.h>

#define OFF_M 0.04       /* of a background's depth: it is of something else */
#define PICTURE 300000.0 /* pixels: counts are of a picture of so many */

enum { ROOMS = 3, MEMORIES = 3 };
typedef enum memory_kind { PER_PIXEL, MAP, MAP_RESIDUAL } memory_kind;

typedef struct memory_room {
    const char *format;     /* of the source; the seed is put in */
    int32_t skipped, count; /* frames */
} memory_room;

static const memory_room rooms[ROOMS] = {
    {"synthetic:room?color=0&frames=-1&seed=%lld", 0, 130},
    {"synthetic:random?color=0&fps=10&frames=-1&seed=%lld", 0, 60},
    {"synthetic:random?color=0&fps=10&frames=-1&seed=%lld", 28, 110},
};

typedef struct memory_lane {
    map_memory memory;
    rlf_reconstruct *stage;
    eval_foreground foreground;
    int64_t empty, false_front; /* pixels where nobody is in view any more; of them foreground */
    int64_t known, off;         /* of the edge band, whose background is known; of something else */
    int64_t rest;               /* pixels outside the band, not off: */
    double square_sum;          /* m^2, of their background */
    int64_t time_ns;
    int32_t frames;
} memory_lane;

typedef struct memory_run {
    rlf_source *source;
    rlf_frame frame;
    memory_lane lanes[MEMORIES];
    uint8_t *band, *scratch;
    bool has_been; /* somebody was in view */
} memory_run;

static rlf_result open_lane(const memory_run *r, memory_kind kind, memory_lane *l)
{
    const rlf_rig *rig = &rlf_source_get_info(r->source)->rig;
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, rig);
    rlf_result result = RLF_OK;
    if (kind != PER_PIXEL) {
        result = map_memory_open(rig, kind == MAP_RESIDUAL, &l->memory);
        map_memory_use(&l->memory, &def);
    }
    return result == RLF_OK ? rlf_reconstruct_create(&def, &l->stage) : result;
}

static rlf_result open_run(memory_run *r, const char *name)
{
    rlf_result result = rlf_open_source(name, NULL, &r->source);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_camera *depth = &rlf_source_get_info(r->source)->rig.depth;
    r->band = rlf_alloc_array((size_t)depth->width, (size_t)depth->height);
    r->scratch = rlf_alloc_array((size_t)depth->width, (size_t)depth->height);
    result = r->band != NULL && r->scratch != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (int k = 0; k < MEMORIES && result == RLF_OK; k++) {
        result = open_lane(r, (memory_kind)k, &r->lanes[k]);
    }
    return result;
}

static void close_run(memory_run *r)
{
    for (int k = 0; k < MEMORIES; k++) {
        rlf_reconstruct_destroy(&r->lanes[k].stage);
        map_memory_close(&r->lanes[k].memory);
    }
    rlf_free(r->band);
    rlf_free(r->scratch);
    rlf_source_destroy(&r->source);
}

/* The background's depth against the room without people. */
static void add_background(memory_lane *l, const rlf_surface *s, const rlf_truth *truth,
                           const uint8_t *band)
{
    for (int32_t i = 0; i < s->width * s->height; i++) {
        const double error = (double)(s->background_depth[i] - truth->background_depth[i]);
        const bool is_known = s->background_depth[i] > 0.0f && truth->background_depth[i] > 0.0f;
        if (is_known && band[i] != 0) {
            l->known++;
            l->off += fabs(error) > OFF_M;
        } else if (is_known && fabs(error) < OFF_M) {
            l->rest++;
            l->square_sum += error * error;
        }
    }
}

static void measure(const memory_run *r, memory_lane *l, const rlf_surface *s, bool is_empty)
{
    const rlf_truth *truth = rlf_source_get_truth(r->source);
    const rlf_rig *rig = &rlf_source_get_info(r->source)->rig;
    if (s->background_state != RLF_BACKGROUND_READY) {
        return;
    }
    eval_foreground_add(&l->foreground, s, truth, rig);
    add_background(l, s, truth, r->band);
    if (is_empty && r->has_been) {
        l->empty += (int64_t)s->width * s->height;
        l->false_front += s->foreground_count;
    }
}

static rlf_result see(const memory_run *r, memory_lane *l, bool is_empty)
{
    const rlf_surface *s = NULL;
    const int64_t begin_ns = rlf_clock_ns();
    rlf_result result = rlf_reconstruct_process(l->stage, &r->frame, &s);
    if (result == RLF_OK && l->memory.map != NULL) {
        result = map_memory_fuse(&l->memory, s);
    }
    l->time_ns += rlf_clock_ns() - begin_ns;
    l->frames++;
    if (result == RLF_OK) {
        measure(r, l, s, is_empty);
    }
    return result;
}

static rlf_result step(memory_run *r, bool is_skipped)
{
    rlf_result result = rlf_source_next(r->source, &r->frame);
    if (result != RLF_OK || is_skipped) {
        return result;
    }
    const rlf_camera *depth = &rlf_source_get_info(r->source)->rig.depth;
    const rlf_truth *truth = rlf_source_get_truth(r->source);
    bool is_empty = true;
    for (int32_t i = 0; i < depth->width * depth->height && is_empty; i++) {
        is_empty = truth->foreground[i] == 0;
    }
    eval_mark_band(truth->background_depth, depth->width, depth->height, r->band, r->scratch);
    for (int k = 0; k < MEMORIES && result == RLF_OK; k++) {
        result = see(r, &r->lanes[k], is_empty);
    }
    r->has_been = r->has_been || !is_empty;
    return result;
}

#define FIGURES(key, title)                                                                        \
    {                                                                                              \
        {key "_f", title ": foreground, F"},                                                       \
            {key "_left_false", title ": foreground when all have gone, of 300,000 pixels"},       \
            {key "_rest_mm", title ": room away from edges, RMSE, mm"},                            \
            {key "_band_percent", title ": edge band, > 4 cm off, %"},                             \
        {                                                                                          \
            key "_ms", title ": surface and memory, ms a frame"                                    \
        }                                                                                          \
    }
#define MEMORY_FIGURES(key, title)                                                                 \
    {                                                                                              \
        FIGURES(key "_pixels", title ", per pixel"), FIGURES(key "_map", title ", map"),           \
            FIGURES(key "_residual", title ", map and residual")                                   \
    }
static const char *const names[ROOMS][MEMORIES][5][2] = {
    MEMORY_FIGURES("room", "old room"), MEMORY_FIGURES("random", "random room"),
    MEMORY_FIGURES("passed", "people at first")};

static void report(eval_table *table, const memory_run *r, int room)
{
    for (int k = 0; k < MEMORIES; k++) {
        const memory_lane *l = &r->lanes[k];
        const double nothing = NAN;
        const double values[5] = {
            eval_f_measure(&l->foreground.all),
            l->empty > 0 ? PICTURE * (double)l->false_front / (double)l->empty : nothing,
            l->rest > 0 ? 1e3 * sqrt(l->square_sum / (double)l->rest) : nothing,
            eval_percent(l->off, l->known),
            l->frames > 0 ? 1e-6 * (double)l->time_ns / l->frames : nothing,
        };
        for (int i = 0; i < 5; i++) {
            eval_table_add(table, "memory", names[room][k][i][0], names[room][k][i][1],
                           RLF_PROFILE_LIVE, values[i]);
        }
    }
}

static rlf_result run_room(eval_table *table, int64_t seed, int room)
{
    char name[128];
    snprintf(name, sizeof(name), rooms[room].format, (long long)seed);
    memory_run r = {.source = NULL};
    rlf_result result = open_run(&r, name);
    const int32_t end = rooms[room].skipped + rooms[room].count;
    for (int32_t i = 0; i < end && result == RLF_OK; i++) {
        result = step(&r, i < rooms[room].skipped);
    }
    if (result == RLF_OK) {
        report(table, &r, room);
    }
    close_run(&r);
    return result;
}

rlf_result eval_memory_run(eval_table *table, int64_t seed, int profile_mask)
{
    rlf_result result = RLF_OK;
    for (int room = 0; room < ROOMS && result == RLF_OK; room++) {
        result = profile_mask & (1 << RLF_PROFILE_LIVE) ? run_room(table, seed, room) : RLF_OK;
    }
    return result;
}
