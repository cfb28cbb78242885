/* Section moving: the camera moves, its pose is found. Synthetic paths, where the truth is known,
 * and real clips with poses. */
#include "eval/moving/moving.h"
#include "eval/moving/thrown.h"
#include "eval/sections.h"

#include "relief/io.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#define REAL_FOLDER "../shared/data"

typedef struct moving_clip {
    const char *name;   /* of the table's rows */
    const char *source; /* synthetic: without its seed; real: a folder's name */
    bool is_covered;
} moving_clip;

static const moving_clip synthetic[] = {
    {"moving empty", "synthetic:empty?path=handheld&color=320x180&frames=300", false},
    {"moving person", "synthetic:room?path=handheld&color=320x180&frames=300", false},
    {"moving walk", "synthetic:room?path=walk&color=320x180&frames=240", false},
    {"moving orbit", "synthetic:room?path=orbit&color=320x180&frames=240", false},
    {"moving look_away", "synthetic:room?path=look_away&color=320x180&frames=240", false},
    {"moving fast", "synthetic:room?path=fast&color=320x180&frames=120", false},
    {"moving covered", "synthetic:room?path=handheld&color=320x180&frames=430", true},
};

static const moving_clip real[] = {{"moving fr1_rpy", "tum_fr1_rpy", false},
                                   {"moving redkitchen", "redkitchen", false}};

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
        {"track_ms", "tracker a frame, median, ms", f->track_ms},
        {"predict_ms", "prediction a frame, median, ms", f->predict_ms},
        {"integrate_ms", "fusion a frame, median, ms", f->integrate_ms},
    };
    for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++) {
        eval_table_add(table, name, rows[i].key, rows[i].title, RLF_PROFILE_LIVE, rows[i].value);
    }
    if (f->covers > 0) {
        eval_table_add(table, name, "found_again_percent",
                       "found again within 10 frames of a covered lens, %", RLF_PROFILE_LIVE,
                       100.0 * (double)f->found_again / (double)f->covers);
    }
}

static rlf_result run_clip(eval_table *table, const moving_clip *clip, const char *text)
{
    const moving_options options = {.is_covered = clip->is_covered};
    moving_figures figures = {.ate_mm = NAN};
    rlf_pool *pool = NULL;
    rlf_source *source = NULL;
    rlf_result result = rlf_pool_create(1, &pool);
    if (result == RLF_OK) {
        result = rlf_open_source(text, pool, &source);
    }
    if (result == RLF_OK) {
        result = moving_measure(source, &options, &figures);
    }
    rlf_source_destroy(&source);
    rlf_pool_destroy(&pool);
    if (result == RLF_OK) {
        add_rows(table, clip->name, &figures);
        fprintf(stderr, "%s: %.1f mm, %.1f %% lost\n", clip->name, figures.ate_mm,
                figures.lost_share);
    }
    return result;
}

static rlf_result run_real(eval_table *table)
{
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < sizeof(real) / sizeof(real[0]) && result == RLF_OK; i++) {
        char path[256];
        struct stat about;
        (void)snprintf(path, sizeof(path), "%s/%s", REAL_FOLDER, real[i].source);
        if (stat(path, &about) != 0) {
            printf("%s: SKIPPED, there is no %s\n", real[i].name, path);
            continue;
        }
        result = run_clip(table, &real[i], path);
    }
    return result;
}

static rlf_result run_thrown(eval_table *table, int64_t seed)
{
    thrown_figures f;
    rlf_result result = thrown_measure(seed, &f);
    if (result == RLF_OK) {
        eval_table_add(table, "moving thrown", "lost", "bodies lost of 1000 thrown",
                       RLF_PROFILE_LIVE, f.gone + f.sunk + f.hanging);
        eval_table_add(table, "moving thrown", "sunk", "  more than 1 cm inside of the room",
                       RLF_PROFILE_LIVE, f.sunk);
        eval_table_add(table, "moving thrown", "hanging", "  more than 1 cm over it",
                       RLF_PROFILE_LIVE, f.hanging);
        eval_table_add(table, "moving thrown", "restless", "not asleep after all",
                       RLF_PROFILE_LIVE, f.restless);
        eval_table_add(table, "moving thrown", "surface_ms", "contacts with grid and map, mean, ms",
                       RLF_PROFILE_LIVE, f.surface_ms);
    }
    return result;
}

rlf_result eval_moving_run(eval_table *table, int64_t seed, int profile_mask)
{
    rlf_result result = run_thrown(table, seed);
    (void)profile_mask; /* poses do not depend on it */
    for (size_t i = 0; i < sizeof(synthetic) / sizeof(synthetic[0]) && result == RLF_OK; i++) {
        char text[256];
        (void)snprintf(text, sizeof(text), "%s&seed=%lld", synthetic[i].source, (long long)seed);
        result = run_clip(table, &synthetic[i], text);
    }
    return result == RLF_OK && seed == 1 ? run_real(table) : result;
}
