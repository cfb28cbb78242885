/* Goal, bound, mean with its confidence interval, and the thesis beside it. */
#include "eval/report.h"

#include "eval/bounds.h"
#include "eval/real/real.h"
#include "eval/table.h"
#include "json_file.h"
#include "eval/statistics.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static statistics row_statistics(const eval_row *row, rlf_profile profile)
{
    return statistics_of(row->values[profile], row->count[profile]);
}

static eval_verdict judge(const eval_row *row, const eval_bound *bound)
{
    return eval_bound_judge(bound, row_statistics(row, RLF_PROFILE_LIVE).mean);
}

static bool is_outside(eval_verdict verdict, bool is_whole)
{
    return verdict == EVAL_OUTSIDE || (verdict == EVAL_NOT_MEASURED && is_whole);
}

static void format_mean(const statistics *s, char *out, size_t size)
{
    if (s->count == 0) {
        snprintf(out, size, "-");
    } else if (s->mean >= EVAL_NEVER / EVAL_SEEDS_MAX) {
        snprintf(out, size, "never");
    } else if (isnan(s->half_width)) {
        snprintf(out, size, "%.4g", s->mean);
    } else {
        snprintf(out, size, "%.4g +-%-7.2g", s->mean, s->half_width);
    }
}

static void format_limit(const eval_bound *bound, double value, char *out, size_t size)
{
    if (bound == NULL || isnan(value)) {
        out[0] = '\0';
    } else {
        snprintf(out, size, "%s %.4g", bound->relation == '<' ? "<=" : ">=", value);
    }
}

static void print_row(const eval_row *row, const eval_bound *bound, bool is_whole)
{
    char live[40], thesis[40], goal[24], limit[24];
    statistics s = row_statistics(row, RLF_PROFILE_LIVE);
    format_mean(&s, live, sizeof(live));
    s = row_statistics(row, RLF_PROFILE_THESIS);
    format_mean(&s, thesis, sizeof(thesis));
    format_limit(bound, bound != NULL ? bound->goal : NAN, goal, sizeof(goal));
    format_limit(bound, bound != NULL ? bound->bound : NAN, limit, sizeof(limit));
    const char *mark = "";
    if (bound != NULL && row->count[RLF_PROFILE_LIVE] > 0) {
        eval_verdict verdict = judge(row, bound);
        bool is_short = verdict == EVAL_WITHIN_BOUND && !isnan(bound->goal);
        mark = is_outside(verdict, is_whole && !isnan(bound->bound))
                   ? eval_verdict_name(EVAL_OUTSIDE)
               : is_short ? "SHORT of the goal"
                          : eval_verdict_name(verdict);
    }
    printf("  %-54s %10s  %-18s %-18s %10s %s\n", row->title, goal, live, thesis, limit, mark);
}

static void print_table(const eval_table *table, const eval_report_options *o)
{
    printf("%-56s %10s  %-18s %-18s %10s\n", "figure: mean over seeds +- 95 % confidence", "goal",
           "live", "thesis", "bound");
    const char *scene = "";
    for (int32_t i = 0; i < table->count; i++) {
        const eval_row *row = &table->rows[i];
        const eval_bound *bound = eval_bound_find(row->scene, row->key);
        if (!o->print_all && bound == NULL) {
            continue;
        }
        if (strcmp(scene, row->scene) != 0) {
            printf("%s\n", row->scene);
            scene = row->scene;
        }
        print_row(row, bound, o->is_whole);
    }
}

static json_t *profile_json(const eval_row *row, rlf_profile profile)
{
    statistics s = row_statistics(row, profile);
    json_t *values = json_array();
    for (int32_t i = 0; i < row->count[profile]; i++) {
        json_array_append_new(values, json_file_number(row->values[profile][i]));
    }
    return json_pack("{s:o, s:o, s:o}", "mean", json_file_number(s.mean), "ci95",
                     json_file_number(s.half_width), "values", values);
}

static json_t *row_json(const eval_row *row, bool is_whole)
{
    json_t *json = json_pack("{s:s, s:s, s:s}", "scene", row->scene, "key", row->key, "title",
                             row->title + strspn(row->title, " "));
    for (int profile = 0; profile < EVAL_PROFILES; profile++) {
        if (row->count[profile] > 0) {
            json_object_set_new(json, profile == RLF_PROFILE_LIVE ? "live" : "thesis",
                                profile_json(row, (rlf_profile)profile));
        }
    }
    const eval_bound *bound = eval_bound_find(row->scene, row->key);
    if (bound != NULL) {
        eval_verdict verdict = judge(row, bound);
        json_object_set_new(json, "relation", json_string(bound->relation == '<' ? "<=" : ">="));
        json_object_set_new(json, "goal", json_file_number(bound->goal));
        json_object_set_new(json, "bound", json_file_number(bound->bound));
        json_object_set_new(json, "published", json_string(bound->thesis));
        json_object_set_new(json, "others", json_string(bound->others));
        json_object_set_new(json, "verdict", json_string(eval_verdict_name(verdict)));
        json_object_set_new(json, "ok", json_boolean(!is_outside(verdict, is_whole)));
    }
    return json;
}

static rlf_result write_json(const eval_table *table, const eval_report_options *o, int32_t outside)
{
    json_t *rows = json_array();
    for (int32_t i = 0; i < table->count; i++) {
        json_array_append_new(rows, row_json(&table->rows[i], o->is_whole));
    }
    json_t *seeds = json_array();
    for (int64_t seed = 1; seed <= o->seeds; seed++) {
        json_array_append_new(seeds, json_integer(seed));
    }
    json_t *root = json_pack("{s:o, s:o, s:i, s:o}", "machine", machine_json(), "seeds", seeds,
                             "outside", (int)outside, "figures", rows);
    if (o->real != NULL) {
        json_object_set_new(root, "real", real_json(o->real));
    }
    return json_file_write(o->json_path, root);
}

rlf_result eval_report(const eval_table *table, const eval_report_options *options,
                       int32_t *out_outside)
{
    int32_t outside = 0, judged = 0;
    for (int32_t i = 0; i < table->count; i++) {
        const eval_row *row = &table->rows[i];
        const eval_bound *bound = eval_bound_find(row->scene, row->key);
        if (bound != NULL && !isnan(bound->bound) && row->count[RLF_PROFILE_LIVE] > 0) {
            outside += is_outside(judge(row, bound), options->is_whole);
            judged++;
        }
    }
    if (judged > 0 || options->real == NULL) {
        print_table(table, options);
    }
    if (options->real != NULL) {
        real_print(options->real);
    }
    printf("%d figures with a bound, %d outside it\n", (int)judged, (int)outside);
    *out_outside = outside;
    return options->json_path != NULL ? write_json(table, options, outside) : RLF_OK;
}
