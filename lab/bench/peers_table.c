/* The table of each stage, printed and as JSON. */
#include "bench/peers_table.h"

#include "json_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int by_time(const void *a, const void *b)
{
    double x = ((const peer_stage *)a)->least_ms, y = ((const peer_stage *)b)->least_ms;
    return (x > y) - (x < y);
}

static void print_group(const peer_group *g, const peer_results *r, double ours_least,
                        bench_table *table)
{
    printf("\n%s\n%-46s %8s %8s %8s", g->title, "", "median", "least", "/ ours");
    for (int k = 0; k < PEER_VALUES_MAX && g->columns[k].key != NULL; k++) {
        printf(" %10s", g->columns[k].head);
    }
    printf("\n");
    for (int32_t i = 0; i < r->count; i++) {
        const peer_stage *s = &r->stages[i];
        if (peer_group_of(s->stage) != g || isnan(s->ms)) {
            continue;
        }
        char name[96];
        snprintf(name, sizeof(name), "%s %s", s->peer, s->stage + 2);
        double ratio = s->least_ms / ours_least;
        printf("%-46s %8.3f %8.3f %8.2f", name, s->ms, s->least_ms, ratio);
        for (int k = 0; k < PEER_VALUES_MAX && g->columns[k].key != NULL; k++) {
            char text[24];
            snprintf(text, sizeof(text), isnan(s->values[k]) ? "-" : "%.4g", s->values[k]);
            printf(" %10s", text);
        }
        printf("\n");
        bench_add(table, "peers", name, "ms", s->ms, NAN, ratio);
    }
}

void peer_table_print(peer_results *r, bench_table *table)
{
    double ours[PEER_GROUPS];
    for (int g = 0; g < PEER_GROUPS; g++) {
        ours[g] = r->stages[g].least_ms;
    }
    qsort(r->stages, (size_t)r->count, sizeof(r->stages[0]), by_time);
    for (int g = 0; g < PEER_GROUPS; g++) {
        print_group(&peer_groups[g], r, ours[g], table);
    }
}

static json_t *stage_json(const peer_group *g, const peer_stage *s)
{
    json_t *values = json_array();
    for (int k = 0; k < PEER_VALUES_MAX && g->columns[k].key != NULL; k++) {
        json_array_append_new(values, json_file_number(s->values[k]));
    }
    return json_pack("{s:s, s:s, s:o, s:o, s:o}", "peer", s->peer, "stage", s->stage + 2, "median",
                     json_file_number(s->ms), "least", json_file_number(s->least_ms), "values",
                     values);
}

json_t *peer_table_json(const peer_results *r)
{
    json_t *groups = json_array();
    for (int k = 0; k < PEER_GROUPS; k++) {
        const peer_group *g = &peer_groups[k];
        json_t *heads = json_array(), *rows = json_array();
        for (int c = 0; c < PEER_VALUES_MAX && g->columns[c].key != NULL; c++) {
            json_array_append_new(heads, json_string(g->columns[c].head));
        }
        for (int32_t i = 0; i < r->count; i++) {
            const peer_stage *s = &r->stages[i];
            if (peer_group_of(s->stage) == g && !isnan(s->ms)) {
                json_array_append_new(rows, stage_json(g, s));
            }
        }
        json_array_append_new(
            groups, json_pack("{s:s, s:o, s:o}", "title", g->title, "heads", heads, "rows", rows));
    }
    return groups;
}
