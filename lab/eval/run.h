/* One synthetic scene with one seed through the profiles: every figure of it. */
#ifndef RELIEF_APP_EVAL_RUN_H
#define RELIEF_APP_EVAL_RUN_H

#include "eval/table.h"
#include "settings.h"

/* The synthetic scenes that are measured, and for how long. */
typedef struct eval_scene {
    const char *name;
    const char *title;
    int32_t frames;      /* default number, 30 a second */
    const char *source;  /* synthetic scene */
    const char *options; /* of it, each with a leading & */
    bool has_others;     /* another person with every seed; else always the same */
} eval_scene;

extern const eval_scene eval_scenes[];
extern const int32_t eval_scene_count;
/* NULL when there is no scene of that name. */
const eval_scene *eval_scene_find(const char *name);

/* Runs a scene on the calling thread and adds every figure; profile_mask has a bit of each
 * rlf_profile; the settings take the place of the profiles'. */
rlf_result eval_scene_run(eval_table *table, const eval_scene *scene, int64_t seed, int64_t frames,
                          int profile_mask, const setting_list *settings);

#endif
