/* Rooms drawn at random: the same figures as of the old room, over many rooms. */
#ifndef RELIEF_APP_EVAL_RANDOM_RANDOM_H
#define RELIEF_APP_EVAL_RANDOM_RANDOM_H

#include "eval/table.h"
#include "settings.h"

#define EVAL_RANDOM "random"
#define EVAL_RANDOM_PUSH "push"
#define EVAL_RANDOM_FRAMES 200

/* Seed of room i = 0, 1, ...: even ones are for tuning, odd ones are reported. */
static inline int64_t eval_random_seed(int32_t i, bool is_tuning)
{
    return 2 * (int64_t)i + (is_tuning ? 2 : 1);
}

/* One room in profile live: surface, throws, and one push of each kind at a speed that goes round
 * with the rooms. */
rlf_result eval_random_run(eval_table *table, int64_t seed, int64_t frames,
                           const setting_list *settings);
/* LIFT, SWIPE and CARRY from rest in that room, at every speed. */
rlf_result eval_random_push_run(eval_table *table, int64_t seed);
/* push.c: the same at every speed, or at one of them. */
rlf_result eval_random_add_pushes(eval_table *table, int64_t seed, bool has_all_speeds);

/* Mean, 95 % interval and worst room with its seed of every figure of a section. */
void eval_random_report(const eval_table *table, const char *section, bool is_tuning);
/* Headline figures of the old room, the random rooms and real clips side by side. */
void eval_columns_report(const eval_table *table);

/* What of the headline figures real clips tell; NAN = nothing. Keys are those of the columns. */
double eval_columns_real(const eval_table *table, const char *key);

#endif
