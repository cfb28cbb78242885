/* Rows by scene and key, in the order in which they came. */
#include "eval/table.h"

#include <stdio.h>
#include <string.h>

const eval_row *eval_table_find(const eval_table *table, const char *scene, const char *key)
{
    for (int32_t i = 0; i < table->count; i++) {
        const eval_row *row = &table->rows[i];
        if (strcmp(row->scene, scene) == 0 && strcmp(row->key, key) == 0) {
            return row;
        }
    }
    return NULL;
}

void eval_table_add(eval_table *table, const char *scene, const char *key, const char *title,
                    rlf_profile profile, double value)
{
    const eval_row *found = eval_table_find(table, scene, key);
    int32_t index = found != NULL ? (int32_t)(found - table->rows) : table->count;
    if (!RLF_ASSERT(index < EVAL_ROWS_MAX)) {
        table->is_full = true;
        return;
    }
    eval_row *row = &table->rows[index];
    if (found == NULL) {
        *row = (eval_row){.key = key, .title = title};
        snprintf(row->scene, sizeof(row->scene), "%s", scene);
        table->count++;
    }
    int32_t *count = &row->count[profile];
    if (RLF_ASSERT(*count < EVAL_SEEDS_MAX)) {
        row->values[profile][(*count)++] = value;
    }
}

void eval_table_merge(eval_table *table, const eval_table *other)
{
    table->is_full = table->is_full || other->is_full;
    for (int32_t i = 0; i < other->count; i++) {
        const eval_row *row = &other->rows[i];
        for (int profile = 0; profile < EVAL_PROFILES; profile++) {
            for (int32_t k = 0; k < row->count[profile]; k++) {
                eval_table_add(table, row->scene, row->key, row->title, (rlf_profile)profile,
                               row->values[profile][k]);
            }
        }
    }
}
