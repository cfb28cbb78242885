/* Is the simulated sensor the thesis's? Its missing points in the four cases of table 5.1. They
 * belong to the frames, not to a profile: both columns have them. */
#include "eval/sections.h"
#include "eval/sensed/room.h"
#include "eval/table.h"
#include "measure/points.h"

#include <math.h>
#include <stdio.h>

typedef struct case_name {
    const char *off_key, *off_title, *key, *title;
} case_name;

static const case_name names[MEASURE_CASE_COUNT] = {
    {"table_a_off_percent", "table 5.1 a, whole scene, nobody: off by, %", "table_a_missing",
     "  missing points, of 3392"},
    {"table_b_off_percent", "table 5.1 b, centre, nobody: off by, %", "table_b_missing",
     "  missing points, of 2632"},
    {"table_c_off_percent", "table 5.1 c, whole scene, visitor: off by, %", "table_c_missing",
     "  missing points, of 3392"},
    {"table_d_off_percent", "table 5.1 d, centre, visitor: off by, %", "table_d_missing",
     "  missing points, of 2632"},
};

static void add_rows(eval_table *table, const measure_points *points, rlf_profile profile)
{
    for (int c = 0; c < MEASURE_CASE_COUNT; c++) {
        double off = fabs(measure_published_off_percent(points, (measure_case)c));
        eval_table_add(table, "simulator", names[c].off_key, names[c].off_title, profile, off);
        eval_table_add(table, "simulator", names[c].key, names[c].title, profile,
                       measure_missing(&points->cases[c]));
    }
}

rlf_result eval_simulator_run(eval_table *table, int64_t seed, int profile_mask)
{
    char source[64];
    snprintf(source, sizeof(source), "synthetic:thesis?color=0&seed=%lld", (long long)seed);
    eval_room room;
    measure_points points = {0};
    rlf_result result = eval_room_open(source, 0, RLF_PROFILE_THESIS, 0, &room);
    if (result != RLF_OK) {
        return result;
    }
    while ((result = eval_room_step(&room)) == RLF_OK) {
        measure_points_add(&points, room.frame.surface, NULL, room.frame.frame.rig);
    }
    eval_room_close(&room);
    for (int profile = 0; profile < EVAL_PROFILES && result == RLF_END; profile++) {
        if (profile_mask & (1 << profile)) {
            add_rows(table, &points, (rlf_profile)profile);
        }
    }
    return result == RLF_END ? RLF_OK : result;
}
