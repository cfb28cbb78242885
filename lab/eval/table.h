/* What `relief-lab eval` has measured: one row per scene and figure, a value per profile and seed.
 */
#ifndef RELIEF_APP_EVAL_TABLE_H
#define RELIEF_APP_EVAL_TABLE_H

#include "relief/reconstruct.h"

#define EVAL_SEEDS_MAX 64
#define EVAL_ROWS_MAX 1024
#define EVAL_PROFILES 2
#define EVAL_NEVER 1e9 /* frames or seconds of what did not happen */

typedef struct eval_row {
    char scene[32];
    const char *key, *title;                      /* static text */
    double values[EVAL_PROFILES][EVAL_SEEDS_MAX]; /* by rlf_profile; NAN = not measured */
    int32_t count[EVAL_PROFILES];                 /* seeds that were tried */
} eval_row;

typedef struct eval_table {
    eval_row rows[EVAL_ROWS_MAX];
    int32_t count;
    bool is_full; /* a figure had no room: the table is not whole */
} eval_table;

/* Adds the next seed's value of a profile. A row appears where its first value was added. */
void eval_table_add(eval_table *table, const char *scene, const char *key, const char *title,
                    rlf_profile profile, double value);
/* Adds all values of another table behind those of the same rows. */
void eval_table_merge(eval_table *table, const eval_table *other);
/* NULL when nothing was added under these names. */
const eval_row *eval_table_find(const eval_table *table, const char *scene, const char *key);

#endif
