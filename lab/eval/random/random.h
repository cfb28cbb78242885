/* Rooms drawn at random: the same figures as of the old room, over many rooms. */
#ifndef RELIEF_APP_EVAL_RANDOM_RANDOM_H
#define RELIEF_APP_EVAL_RANDOM_RANDOM_H

#include "eval/table.h"
#include "settings.h"

#define EVAL_RANDOM "random"
#define EVAL_RANDOM_PUSH "push"
#define EVAL_RANDOM_FRAMES 200

/* One room in profile live: surface, throws, and one push of each kind at a speed that goes round
 * with the rooms. */
rlf_result eval_random_run(eval_table *table, int64_t seed, int64_t frames,
                           const setting_list *settings);
/* LIFT, SWIPE and CARRY from rest in that room, at every speed. */
rlf_result eval_random_push_run(eval_table *table, int64_t seed);
/* push.c: the same at every speed, or at one of them. */
rlf_result eval_random_add_pushes(eval_table *table, int64_t seed, bool has_all_speeds);

#endif
