/* Whether the camera of real clips is taken to stand or to move, by default. */
#include "command.h"
#include "eval/moving/standing.h"
#include "eval/real/parts.h"

#include <math.h>

typedef struct standing_clip {
    const char *name, *part;
    bool moves; /* from the first frame on */
} standing_clip;

static const standing_clip clips[] = {
    {"room_still", "standing: room_still", false},
    {"hands_toys", "standing: hands_toys", false},
    {"table_hands", "standing: table_hands", false},
    {"classroom_walk", "standing: classroom_walk", false},
    {"apples", "standing: apples", false},
    {"tum_fr1_rpy", "standing: tum_fr1_rpy moves", true},
    {"redkitchen", "standing: redkitchen moves", true},
};

static void add_rows(real_table *table, const standing_clip *clip, const standing_figures *f)
{
    const real_row told = {.key = "told_frames",
                           .title = "frames until motion is told, without poses",
                           .relation = '<',
                           .goal = 10.0,
                           .relief = f->told >= 0 ? f->told : NAN,
                           .baseline = NAN,
                           .baseline_name = ""};
    const real_row alarms = {.key = "alarms",
                             .title = "camera taken to move, times",
                             .relation = '<',
                             .goal = 0.0,
                             .relief = f->alarms,
                             .baseline = NAN,
                             .baseline_name = ""};
    real_add(table, clip->part, clip->moves ? &told : &alarms);
}

rlf_result real_standing_run(real_table *table, const real_options *options)
{
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < sizeof(clips) / sizeof(clips[0]) && result == RLF_OK; i++) {
        const standing_clip *clip = &clips[i];
        char folder[REAL_PATH_SIZE];
        standing_figures figures;
        if (command_interrupted || !real_join(folder, options->folder, clip->name) ||
            !real_is_there(folder)) {
            continue;
        }
        const int64_t frames = clip->moves ? 30 : 0;
        result = standing_measure(folder, STANDING_AS_IT_IS, frames, &figures);
        if (result == RLF_OK) {
            standing_tell(clip->name, &figures);
            add_rows(table, clip, &figures);
        }
    }
    return result;
}
