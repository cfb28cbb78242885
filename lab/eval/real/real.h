/* Figures on real recordings, each beside a baseline of a few lines: the rows of the table. */
#ifndef RELIEF_APP_EVAL_REAL_REAL_H
#define RELIEF_APP_EVAL_REAL_REAL_H

#include "relief/base.h"

#define REAL_ROWS_MAX 256

/* One figure. Part and key together are its name, and stay the same from version to version. */
typedef struct real_row {
    char part[32]; /* of the run, e.g. "objects", or a clip */
    const char *key, *title;
    char relation;           /* of the goal: '<' at most, '>' at least */
    double goal;             /* NAN = none */
    double relief, baseline; /* NAN = not measured */
    const char *baseline_name;
} real_row;

typedef struct real_table {
    real_row rows[REAL_ROWS_MAX];
    int32_t count;
    bool is_full; /* a figure had no room: the table is not whole */
} real_table;

typedef struct real_options {
    const char *folder;      /* with the clips, e.g. ../shared/data */
    const char *silhouettes; /* what script/silhouettes made */
} real_options;

/* Takes the row over unless the table is full. */
void real_add(real_table *table, const char *part, const real_row *row);

/* False when the folder is not there, after saying SKIPPED. */
bool real_is_there(const char *path);
/* Joins two names; false when the path is too long. */
#define REAL_PATH_SIZE 1024
bool real_join(char path[REAL_PATH_SIZE], const char *folder, const char *name);

#endif
