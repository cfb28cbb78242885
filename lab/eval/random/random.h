/* Rooms drawn at random: the throws and pushes of many. */
#ifndef RELIEF_APP_EVAL_RANDOM_RANDOM_H
#define RELIEF_APP_EVAL_RANDOM_RANDOM_H

#include "eval/table.h"

#define EVAL_RANDOM "random"
#define EVAL_RANDOM_PUSH "push"

/* Throws into one room in profile live, and one push of each kind at a speed that goes round with
 * the rooms. What its surface is worth is Python's: lab/relief_lab/rooms.py. */
rlf_result eval_random_run(eval_table *table, int64_t seed);
/* LIFT, SWIPE and CARRY from rest in that room, at every speed. */
rlf_result eval_random_push_run(eval_table *table, int64_t seed);
/* push.c: the same at every speed, or at one of them. */
rlf_result eval_random_add_pushes(eval_table *table, int64_t seed, bool has_all_speeds);

#endif
