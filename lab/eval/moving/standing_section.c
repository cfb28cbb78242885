/* Section standing: cameras that stand, in rooms drawn at random, and cameras that are moved. */
#include "eval/moving/standing.h"
#include "eval/sections.h"

#include <stdio.h>

#define ROOMS 4 /* a seed's */

typedef struct standing_clip {
    const char *name, *source; /* the source without its seed; */
    int32_t rooms;             /* of `synthetic:random`: so many of a seed's, at most ROOMS */
    standing_case kind;
    int64_t frames;
    bool is_moved;
} standing_clip;

#define RANDOM "synthetic:random?color=160x90"

static const standing_clip clips[] = {
    {"standing room", "synthetic:room?color=160x90", 1, STANDING_AS_IT_IS, 90, false},
    {"standing room", "synthetic:hands?color=160x90", 1, STANDING_AS_IT_IS, 90, false},
    {"standing room", "synthetic:swipe?speed=1&color=160x90", 1, STANDING_AS_IT_IS, 60, false},
    {"standing room", "synthetic:lift?speed=1&color=160x90", 1, STANDING_AS_IT_IS, 60, false},
    {"standing rooms", RANDOM, 4, STANDING_AS_IT_IS, 60, false},
    {"standing person", RANDOM, 4, STANDING_PERSON, 60, false},
    {"standing dark", RANDOM, 4, STANDING_DARK, 50, false},
    {"standing bump", RANDOM "&path=bump", 4, STANDING_AS_IT_IS, 155, true},
    {"standing carried", RANDOM "&path=carried", 2, STANDING_AS_IT_IS, 195, true},
    {"standing handheld", RANDOM "&path=handheld", 2, STANDING_AS_IT_IS, 20, true},
    {"standing walk", RANDOM "&path=walk", 2, STANDING_AS_IT_IS, 20, true},
};

static void add(eval_table *table, const standing_clip *clip, const standing_figures *f)
{
    const double never = EVAL_NEVER;
    const bool is_put_down = clip->is_moved && clip->frames > 100;
    eval_table_add(table, clip->name, "alarms", "camera taken to move, times", RLF_PROFILE_LIVE,
                   f->alarms);
    eval_table_add(table, clip->name, "wait_s", "bodies wait at longest, s", RLF_PROFILE_LIVE,
                   f->wait_s);
    if (clip->is_moved) {
        eval_table_add(table, clip->name, "told_frames", "frames until motion is told",
                       RLF_PROFILE_LIVE, f->told >= 0 ? f->told : never);
        eval_table_add(table, clip->name, "snap_mm", "  pose off the truth until then, mm",
                       RLF_PROFILE_LIVE, f->snap_mm);
    }
    if (is_put_down) {
        eval_table_add(table, clip->name, "stands_s", "until it stands again, s", RLF_PROFILE_LIVE,
                       f->stands_s >= 0.0 ? f->stands_s : never);
        eval_table_add(table, clip->name, "jump_mm", "  jump of the pose then, mm",
                       RLF_PROFILE_LIVE, f->jump_mm);
    }
}

void standing_tell(const char *name, const standing_figures *f)
{
    fprintf(stderr,
            "%-22s %4d frames, %d alarms, told after %d frames (%.1f mm off), stands after %.2f s "
            "(jump %.2f mm), bodies wait %.2f s\n",
            name, (int)f->frames, (int)f->alarms, (int)f->told, f->snap_mm, f->stands_s, f->jump_mm,
            f->wait_s);
}

rlf_result eval_standing_run(eval_table *table, int64_t seed, int profile_mask)
{
    (void)profile_mask; /* only live has a camera that moves */
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < sizeof(clips) / sizeof(clips[0]); i++) {
        const standing_clip *clip = &clips[i];
        for (int64_t k = 0; k < clip->rooms && result == RLF_OK; k++) {
            const int64_t room = 2 * (ROOMS * (seed - 1) + k) + 1;
            char text[256];
            standing_figures f;
            (void)snprintf(text, sizeof(text), "%s&seed=%lld", clip->source, (long long)room);
            result = standing_measure(text, clip->kind, clip->frames, &f);
            if (result == RLF_OK) {
                standing_tell(clip->name, &f);
                add(table, clip, &f);
            }
        }
    }
    return result;
}
