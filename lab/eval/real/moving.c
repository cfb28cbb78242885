/* The camera's way through real rooms, against the poses that the clips bring. */
#include "command.h"
#include "eval/moving/moving.h"
#include "eval/real/parts.h"

#include <math.h>

typedef struct moving_clip {
    const char *name, *part;
    double goal_mm;
} moving_clip;

static const moving_clip clips[] = {
    {"tum_fr1_rpy", "moving: tum_fr1_rpy", 20.0},
    {"redkitchen", "moving: redkitchen", 15.0}, /* its poses are KinectFusion's own */
};

static void add_rows(real_table *table, const moving_clip *clip, const moving_figures *f)
{
    const real_row rows[] = {
        {.key = "ate_mm",
         .title = "trajectory error, RMSE, mm",
         .relation = '<',
         .goal = clip->goal_mm,
         .relief = f->ate_mm,
         .baseline = f->still_mm,
         .baseline_name = "the camera stands still"},
        {.key = "lost_percent",
         .title = "frames lost, %",
         .relation = '<',
         .goal = 0.0,
         .relief = f->lost_share,
         .baseline = NAN,
         .baseline_name = ""},
        {.key = "found_again_percent",
         .title = "found again within 10 frames of a covered lens, %",
         .relation = '>',
         .goal = 100.0,
         .relief = f->found_again,
         .baseline = NAN,
         .baseline_name = ""},
        {.key = "found_known_percent",
         .title = "found within 10 frames in a known room, %",
         .relation = '>',
         .goal = 100.0,
         .relief = f->found_known,
         .baseline = NAN,
         .baseline_name = ""},
        {.key = "track_ms",
         .title = "tracker a frame, median, ms",
         .relation = '<',
         .goal = NAN,
         .relief = f->track_ms,
         .baseline = NAN,
         .baseline_name = ""},
    };
    for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++) {
        real_add(table, clip->part, &rows[i]);
    }
}

rlf_result real_moving_run(real_table *table, const real_options *options)
{
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < sizeof(clips) / sizeof(clips[0]) && result == RLF_OK; i++) {
        char folder[REAL_PATH_SIZE];
        moving_figures figures;
        if (command_interrupted || !real_join(folder, options->folder, clips[i].name) ||
            !real_is_there(folder)) {
            continue;
        }
        result = moving_measure_clip(clips[i].part, folder, &figures);
        if (result == RLF_OK) {
            add_rows(table, &clips[i], &figures);
        }
    }
    return result;
}
