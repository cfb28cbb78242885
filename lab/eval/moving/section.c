/* Section moving: the camera moves through the synthetic room, its pose is found. */
#include "eval/moving/loop.h"
#include "eval/moving/moving.h"
#include "eval/moving/rested.h"
#include "eval/moving/thrown.h"
#include "eval/sections.h"

#include "relief/io.h"

#include <math.h>
#include <stdio.h>

#define COVERS 20

typedef struct moving_clip {
    const char *name;   /* of the table's rows */
    const char *source; /* without its seed */
} moving_clip;

static const moving_clip clips[] = {
    {"moving empty", "synthetic:empty?path=handheld&color=320x180&frames=90"},
    {"moving person", "synthetic:room?path=handheld&color=320x180&frames=90"},
    {"moving walk", "synthetic:room?path=walk&color=320x180&frames=45"},
    {"moving orbit", "synthetic:room?path=orbit&color=320x180&frames=45"},
    {"moving look_away", "synthetic:room?path=look_away&color=320x180&frames=105"},
    {"moving fast", "synthetic:room?path=fast&color=320x180&frames=45"},
};

static void add_rows(eval_table *table, const char *name, const moving_figures *f)
{
    const struct {
        const char *key, *title;
        double value;
    } rows[] = {
        {"ate_mm", "trajectory error, RMSE, mm", f->ate_mm},
        {"drift_mm", "a frame's motion off, median, mm", f->drift_mm},
        {"drift_deg", "a frame's turn off, median, degrees", f->drift_deg},
        {"lost_percent", "frames lost, %", f->lost_share},
        {"wrong_good_percent", "frames said to be good and over 5 cm off, %", f->wrong_good},
        {"found_again_percent", "found again within 10 frames of a covered lens, %",
         f->found_again},
        {"found_known_percent", "found within 10 frames in a known room, %", f->found_known},
        {"track_ms", "tracker a frame, median, ms", f->track_ms},
        {"predict_ms", "prediction a frame, median, ms", f->predict_ms},
        {"integrate_ms", "fusion a frame, median, ms", f->integrate_ms},
    };
    for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++) {
        eval_table_add(table, name, rows[i].key, rows[i].title, RLF_PROFILE_LIVE, rows[i].value);
    }
}

rlf_result moving_measure_clip(const char *name, const char *text, moving_figures *out)
{
    const moving_options options = {.covers = COVERS};
    rlf_pool *pool = NULL;
    rlf_source *source = NULL;
    rlf_result result = rlf_pool_create(1, &pool);
    if (result == RLF_OK) {
        result = rlf_open_source(text, pool, &source);
    }
    if (result == RLF_OK) {
        result = moving_measure(source, &options, out);
    }
    rlf_source_destroy(&source);
    rlf_pool_destroy(&pool);
    if (result == RLF_OK) {
        fprintf(stderr,
                "%s: %.1f mm, %.1f %% lost, %.0f %% found again, %.0f %% found in the known room\n",
                name, out->ate_mm, out->lost_share, out->found_again, out->found_known);
    }
    return result;
}

static rlf_result run_thrown(eval_table *table, int64_t seed)
{
    thrown_figures f;
    rlf_result result = thrown_measure(seed, &f);
    if (result == RLF_OK) {
        fprintf(stderr, "moving thrown: gone %d, sunk %d, hanging %d, restless %d, %.2f ms\n",
                (int)f.gone, (int)f.sunk, (int)f.hanging, (int)f.restless, f.surface_ms);
        eval_table_add(table, "moving thrown", "lost", "bodies lost of 1000 thrown",
                       RLF_PROFILE_LIVE, f.gone + f.sunk + f.hanging);
        eval_table_add(table, "moving thrown", "sunk", "  more than 1 cm inside of the room",
                       RLF_PROFILE_LIVE, f.sunk);
        eval_table_add(table, "moving thrown", "hanging", "  more than 1 cm over it",
                       RLF_PROFILE_LIVE, f.hanging);
        eval_table_add(table, "moving thrown", "restless", "not asleep after all", RLF_PROFILE_LIVE,
                       f.restless);
        eval_table_add(table, "moving thrown", "surface_ms", "contacts with grid and map, mean, ms",
                       RLF_PROFILE_LIVE, f.surface_ms);
    }
    return result;
}

static rlf_result run_rested(eval_table *table, int64_t seed)
{
    const char *const paths[2] = {"look_away", "orbit"};
    rested_figures f = {0};
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < 2 && result == RLF_OK; i++) {
        char text[256];
        (void)snprintf(text, sizeof(text), "synthetic:empty?path=%s&color=0&frames=125&seed=%lld",
                       paths[i], (long long)seed);
        result = rested_measure(text, seed, &f);
    }
    if (result == RLF_OK) {
        fprintf(stderr, "moving rested: %d put, lost %d, flung %d, sunk %d, woken %d\n", (int)f.put,
                (int)f.lost, (int)f.flung, (int)f.sunk, (int)f.woken);
        eval_table_add(table, "moving rested", "lost", "bodies at rest that leave, of 1000",
                       RLF_PROFILE_LIVE, f.lost);
        eval_table_add(table, "moving rested", "flung", "  that move by more than 5 cm",
                       RLF_PROFILE_LIVE, f.flung);
        eval_table_add(table, "moving rested", "sunk", "  that sink by more than 2 cm",
                       RLF_PROFILE_LIVE, f.sunk);
        eval_table_add(table, "moving rested", "woken", "  that wake up", RLF_PROFILE_LIVE,
                       f.woken);
    }
    return result;
}

/* From 1 s on: by then the room is known. */
static rlf_result run_loop(eval_table *table, int64_t seed)
{
    loop_figures f;
    char text[256];
    (void)snprintf(text, sizeof(text),
                   "synthetic:room?path=handheld&color=960x540&frames=120&seed=%lld",
                   (long long)seed);
    const rlf_result result = loop_measure(text, 30, &f);
    if (result == RLF_OK) {
        fprintf(stderr, "moving loop: F %.4f, %.4f with depth (%.4f, %.4f), %.1f ms\n", f.f,
                f.f_valid, f.precision, f.recall, f.loop_ms);
        eval_table_add(table, "moving loop", "foreground_f", "foreground: F", RLF_PROFILE_LIVE,
                       f.f);
        eval_table_add(table, "moving loop", "foreground_f_valid", "  of pixels with depth",
                       RLF_PROFILE_LIVE, f.f_valid);
        eval_table_add(table, "moving loop", "precision", "  their precision", RLF_PROFILE_LIVE,
                       f.precision);
        eval_table_add(table, "moving loop", "recall", "  their recall", RLF_PROFILE_LIVE,
                       f.recall);
        eval_table_add(table, "moving loop", "loop_ms",
                       "surface, physics and 960 x 540 picture, 2 threads, median, ms",
                       RLF_PROFILE_LIVE, f.loop_ms);
    }
    return result;
}

rlf_result eval_moving_run(eval_table *table, int64_t seed, int profile_mask)
{
    rlf_result result = run_thrown(table, seed);
    result = result == RLF_OK ? run_rested(table, seed) : result;
    result = result == RLF_OK ? run_loop(table, seed) : result;
    (void)profile_mask; /* poses do not depend on it */
    for (size_t i = 0; i < sizeof(clips) / sizeof(clips[0]) && result == RLF_OK; i++) {
        char text[256];
        moving_figures figures;
        (void)snprintf(text, sizeof(text), "%s&seed=%lld", clips[i].source, (long long)seed);
        result = moving_measure_clip(clips[i].name, text, &figures);
        if (result == RLF_OK) {
            add_rows(table, clips[i].name, &figures);
        }
    }
    return result;
}
