/* The rows as JSON, and the comparison with an earlier file. */
#include "bench/bench.h"
#include "json_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

rlf_result bench_write_json(const bench_options *o, const bench_table *table, json_t *peers)
{
    json_t *rows = json_array();
    for (int32_t i = 0; i < table->count; i++) {
        const bench_row *r = &table->rows[i];
        json_array_append_new(
            rows, json_pack("{s:s, s:s, s:s, s:o, s:o, s:o}", "group", r->group, "name", r->name,
                            "unit", r->unit, "median", json_file_number(r->median), "p95",
                            json_file_number(r->p95), "ratio", json_file_number(r->ratio)));
    }
    json_t *root = json_pack("{s:o, s:s, s:I, s:i, s:o, s:o}", "machine", machine_json(), "source",
                             o->source, "frames", (json_int_t)o->frames, "threads", (int)o->threads,
                             "rows", rows, "peers", peers != NULL ? peers : json_null());
    return json_file_write(o->json_path, root);
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

/* The root of a file of `relief-lab bench --json`; NULL and the error line when it is none. */
static json_t *load(const char *path)
{
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error);
    if (root == NULL) {
        bool is_there = error.line > 0;
        rlf_fail(is_there ? RLF_ERROR_FORMAT : RLF_ERROR_IO,
                 is_there ? "%s: is damaged or no JSON: %s; make it with `relief-lab bench --json`"
                          : "%s: cannot be read: %s; make it with `relief-lab bench --json`",
                 path, error.text);
        return NULL;
    }
    if (json_array_size(json_object_get(root, "rows")) == 0) {
        json_decref(root);
        rlf_fail(RLF_ERROR_FORMAT, "%s: is not a file of `relief-lab bench --json`", path);
        return NULL;
    }
    return root;
}

rlf_result bench_compare_check(const char *path)
{
    json_t *root = load(path);
    json_decref(root);
    return root != NULL ? RLF_OK : RLF_ERROR_FORMAT;
}

static void print_difference(const json_t *old, const bench_row *r)
{
    double before = old != NULL ? json_number_value(json_object_get(old, "median")) : NAN;
    bool is_compared = strcmp(r->unit, "ms") == 0 || strcmp(r->unit, "MiB") == 0;
    if (is_compared && before > 0.0 && r->median > 0.0) {
        printf("%-14s %-22s %10.3f %10.3f %9.2f\n", r->group, r->name, before, r->median,
               before / r->median);
    }
}

rlf_result bench_compare(const bench_options *o, const bench_table *table)
{
    json_t *root = load(o->compare_path);
    if (root == NULL) {
        return RLF_ERROR_FORMAT;
    }
    const json_t *rows = json_object_get(root, "rows");
    printf("\nbeside %s: medians\n%-14s %-22s %10s %10s %9s\n", o->compare_path, "group", "name",
           "old", "new", "old/new");
    for (int32_t i = 0; i < table->count; i++) {
        print_difference(find_row(rows, &table->rows[i]), &table->rows[i]);
    }
    json_decref(root);
    return RLF_OK;
}
