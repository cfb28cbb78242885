/* The rows as JSON, and the comparison with an earlier file. */
#include "bench/bench.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static json_t *number_json(double value)
{
    return isnan(value) ? json_null() : json_real(value);
}

rlf_result bench_write_json(const bench_options *o, const bench_table *table)
{
    json_t *rows = json_array();
    for (int32_t i = 0; i < table->count; i++) {
        const bench_row *r = &table->rows[i];
        json_array_append_new(rows, json_pack("{s:s, s:s, s:s, s:o, s:o, s:o}", "group", r->group,
                                              "name", r->name, "unit", r->unit, "median",
                                              number_json(r->median), "p95", number_json(r->p95),
                                              "ratio", number_json(r->ratio)));
    }
    json_t *root = json_pack("{s:s, s:I, s:i, s:o}", "source", o->source, "frames",
                             (json_int_t)o->frames, "threads", (int)o->threads, "rows", rows);
    int failed = json_dump_file(root, o->json_path, JSON_INDENT(2));
    json_decref(root);
    return failed ? rlf_fail(RLF_ERROR_IO, "%s: cannot be written; choose another --json file",
                             o->json_path)
                  : RLF_OK;
}

static const json_t *find_row(const json_t *rows, const bench_row *wanted)
{
    for (size_t i = 0; i < json_array_size(rows); i++) {
        const json_t *row = json_array_get(rows, i);
        const char *group = json_string_value(json_object_get(row, "group"));
        const char *name = json_string_value(json_object_get(row, "name"));
        if (group != NULL && name != NULL && strcmp(group, wanted->group) == 0 &&
            strcmp(name, wanted->name) == 0) {
            return row;
        }
    }
    return NULL;
}

rlf_result bench_compare(const bench_options *o, const bench_table *table)
{
    json_error_t error;
    json_t *root = json_load_file(o->compare_path, 0, &error);
    const json_t *rows = json_object_get(root, "rows");
    if (!json_is_array(rows)) {
        json_decref(root);
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is not a file of `relief bench --json`",
                        o->compare_path);
    }
    printf("\nbeside %s: medians\n%-14s %-22s %10s %10s %9s\n", o->compare_path, "group", "name",
           "old", "new", "old/new");
    for (int32_t i = 0; i < table->count; i++) {
        const bench_row *r = &table->rows[i];
        const json_t *row = find_row(rows, r);
        double old = row != NULL ? json_number_value(json_object_get(row, "median")) : NAN;
        bool is_compared = strcmp(r->unit, "ms") == 0 || strcmp(r->unit, "MiB") == 0;
        if (is_compared && old > 0.0 && r->median > 0.0) {
            printf("%-14s %-22s %10.3f %10.3f %9.2f\n", r->group, r->name, old, r->median,
                   old / r->median);
        }
    }
    json_decref(root);
    return RLF_OK;
}
