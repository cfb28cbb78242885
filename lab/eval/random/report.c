/* Mean, interval and the worst room; and the three columns. */
#include "eval/random/random.h"
#include "eval/table.h"
#include "eval/statistics.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* More is better of these; less of all others. */
static bool is_more_better(const char *key)
{
    static const char *const good[] = {
        "foreground_f",           "foreground_f_valid",        "foreground_precision",
        "foreground_recall",      "exit_within_5_cm_percent",  "standing_within_5_cm_percent",
        "standing_known_percent", "still_zero_percent",        "bounces",
        "bounces_right_percent",  "bounces_within_10_percent", "behind_bounced_percent",
        "edge_bounced_percent"};
    for (size_t i = 0; i < sizeof(good) / sizeof(good[0]); i++) {
        if (strcmp(good[i], key) == 0) {
            return true;
        }
    }
    return strncmp(key, "lift", 4) == 0 || strncmp(key, "swipe", 5) == 0 ||
           strncmp(key, "carry", 5) == 0;
}

static int32_t worst_of(const eval_row *row)
{
    const double *v = row->values[RLF_PROFILE_LIVE];
    int32_t worst = -1;
    for (int32_t i = 0; i < row->count[RLF_PROFILE_LIVE]; i++) {
        const bool is_worse =
            worst >= 0 && (is_more_better(row->key) ? v[i] < v[worst] : v[i] > v[worst]);
        worst = !isnan(v[i]) && (worst < 0 || is_worse) ? i : worst;
    }
    return worst;
}

void eval_random_report(const eval_table *table, const char *section, bool is_tuning)
{
    bool has_title = false;
    for (int32_t i = 0; i < table->count; i++) {
        const eval_row *row = &table->rows[i];
        const int32_t worst = worst_of(row);
        if (strcmp(row->scene, section) != 0 || worst < 0) {
            continue;
        }
        if (!has_title) {
            printf("%s: %d rooms drawn at random, %s seeds, profile live\n", section,
                   (int)row->count[RLF_PROFILE_LIVE], is_tuning ? "even" : "odd");
            printf("  %-54s %10s %10s %12s  %s\n", "figure", "mean", "+- 95 %", "worst", "seed");
            has_title = true;
        }
        const statistics s =
            statistics_of(row->values[RLF_PROFILE_LIVE], row->count[RLF_PROFILE_LIVE]);
        printf("  %-54s %10.4g %10.2g %12.4g  %lld\n", row->title, s.mean, s.half_width,
               row->values[RLF_PROFILE_LIVE][worst], (long long)eval_random_seed(worst, is_tuning));
    }
}

/* A headline figure: where each column finds it. */
typedef struct headline {
    const char *title, *key;
    const char *old_scene, *old_key; /* NULL: the same key, scene room */
} headline;

static const headline headlines[] = {
    {"depth at rest: RMSE, mm", "depth_still_rmse_mm", "room", NULL},
    {"normals, interior: mean, deg", "normals_interior_mean_deg", "room", NULL},
    {"normals, interior: > 30 deg off, %", "normals_interior_over_30_percent", "room", NULL},
    {"normals, edge band: > 30 deg off, %", "normals_band_over_30_percent", "room", NULL},
    {"  of the surface that depth shows, %", "normals_band_shown_over_30_percent", "room", NULL},
    {"foreground: F", "foreground_f", "room", NULL},
    {"room behind what moves: > 4 cm off, %", "behind_off_percent", "room", NULL},
    {"thickness of people: exit error, cm", "exit_mean_cm", "room", NULL},
    {"bounces within 10 deg of a true direction, %", "bounces_right_percent", "room", NULL},
    {"bounces where nothing real is, %", "bounces_phantom_percent", "room", NULL},
    {"THROW: tunnelled, % (old room: of 334 throws)", "throw_tunnelled_percent", "sensed",
     "throw_tunnelled"},
    {"BEHIND: through a person's back, %", "behind_passed_percent", "sensed", NULL},
    {"EDGE: through, %", "edge_passed_percent", "sensed", NULL},
    {"LIFT from rest: right, % (old room: of 12)", "lift_percent", "sensed", "lift_count"},
    {"SWIPE from rest: right, % (old room: of 12)", "swipe_percent", "sensed", "swipe_count"},
    {"CARRY from rest: right, % (old room: of 3)", "carry_percent", "sensed", "carry_stayed"},
    {"outline of a person: off by, px", "person_mean_px", "picture", NULL},
    {"objects on tables: IoU of the best region", "object_iou", "room", NULL},
    {"up within 10 deg, any roll, %", "up_right_percent", "room", NULL},
};

static double mean_of(const eval_table *table, const char *scene, const char *key)
{
    const eval_row *row = eval_table_find(table, scene, key);
    return row != NULL
               ? statistics_of(row->values[RLF_PROFILE_LIVE], row->count[RLF_PROFILE_LIVE]).mean
               : NAN;
}

double eval_columns_real(const eval_table *table, const char *key)
{
    return mean_of(table, "real", key);
}

static void print_cell(double value)
{
    if (isnan(value)) {
        printf(" %12s", "-");
    } else {
        printf(" %12.4g", value);
    }
}

void eval_columns_report(const eval_table *table)
{
    printf("%-54s %12s %12s %12s\n", "in short, profile live", "old room", "random rooms", "real");
    for (size_t i = 0; i < sizeof(headlines) / sizeof(headlines[0]); i++) {
        const headline *h = &headlines[i];
        printf("  %-52s", h->title);
        print_cell(mean_of(table, h->old_scene, h->old_key != NULL ? h->old_key : h->key));
        print_cell(mean_of(table, EVAL_RANDOM, h->key));
        print_cell(eval_columns_real(table, h->key));
        printf("\n");
    }
}
