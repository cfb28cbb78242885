/* Rows of real recordings. */
#define _POSIX_C_SOURCE 200809L
#include "eval/real/real.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

bool real_join(char path[REAL_PATH_SIZE], const char *folder, const char *name)
{
    int length = snprintf(path, REAL_PATH_SIZE, "%s/%s", folder, name);
    return length > 0 && length < REAL_PATH_SIZE;
}

bool real_is_there(const char *path)
{
    struct stat status;
    bool is_there = stat(path, &status) == 0 && S_ISDIR(status.st_mode);
    if (!is_there) {
        fprintf(stderr, "SKIPPED: there is no folder %s\n", path);
    }
    return is_there;
}

void real_add(real_table *table, const char *part, const real_row *row)
{
    table->is_full = table->is_full || table->count == REAL_ROWS_MAX;
    if (table->count < REAL_ROWS_MAX) {
        real_row *out = &table->rows[table->count++];
        *out = *row;
        (void)snprintf(out->part, sizeof(out->part), "%s", part);
    }
}
