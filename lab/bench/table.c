/* Rows by group and name. */
#include "bench/bench.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void bench_add(bench_table *table, const char *group, const char *name, const char *unit,
               double median, double p95, double ratio)
{
    if (!RLF_ASSERT(table->count < BENCH_ROWS_MAX)) {
        return;
    }
    bench_row *row = &table->rows[table->count++];
    *row = (bench_row){.median = median, .p95 = p95, .ratio = ratio};
    snprintf(row->group, sizeof(row->group), "%s", group);
    snprintf(row->name, sizeof(row->name), "%s", name);
    snprintf(row->unit, sizeof(row->unit), "%s", unit);
}

void bench_add_series(bench_table *table, const char *group, const char *name,
                      const timing_series *series, double ratio)
{
    bench_add(table, group, name, "ms", timing_percentile(series, 50),
              timing_percentile(series, 95), ratio);
}

const bench_row *bench_find(const bench_table *table, const char *group, const char *name)
{
    for (int32_t i = 0; i < table->count; i++) {
        const bench_row *row = &table->rows[i];
        if (strcmp(row->group, group) == 0 && strcmp(row->name, name) == 0) {
            return row;
        }
    }
    return NULL;
}
