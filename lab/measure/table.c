/* One row per scale and case, with the thesis's own count beside those of its grid. */
#define _POSIX_C_SOURCE 200809L
#include "measure/table.h"

#include "json_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void format_or_dash(double value, const char *format, char *out, size_t size)
{
    if (isnan(value)) {
        snprintf(out, size, "-");
    } else {
        snprintf(out, size, format, value);
    }
}

static void print_row(const measure_points *m, int32_t scale, measure_case index)
{
    const measure_counts *c = &m->cases[index];
    char grid[24], counted[16], published[16], off[16];
    snprintf(grid, sizeof(grid), "%dx%d", (int)m->width, (int)m->height);
    format_or_dash(measure_counted_percent(c), "%.2f", counted, sizeof(counted));
    format_or_dash(measure_published(m, index), "%.1f", published, sizeof(published));
    format_or_dash(measure_published_off_percent(m, index), "%+.1f", off, sizeof(off));
    printf("%5d %9s %4s %6lld %7lld %10.3f %7s %6s %7.2f %9.2f %8s  ", (int)scale, grid,
           measure_case_name(index), (long long)c->frames, (long long)c->points, measure_missing(c),
           published, off, measure_missing_percent(c), measure_estimated_percent(c), counted);
    for (int r = 1; r < RLF_REASON_COUNT; r++) {
        if (c->reasons[r] > 0) {
            printf(" %s %.1f", rlf_reason_name((rlf_reason)r),
                   (double)c->reasons[r] / (double)c->frames);
        }
    }
    printf("\n");
}

static const char *profile_name(rlf_profile profile)
{
    return profile == RLF_PROFILE_LIVE ? "live" : "thesis";
}

void measure_print(const measure_report *r)
{
    printf("%s, profile %s; missing points per frame, averaged\n", r->source,
           profile_name(r->profile));
    printf("%5s %9s %4s %6s %7s %10s %7s %6s %7s %9s %8s   %s\n", "scale", "grid", "case", "frames",
           "points", "missing", "thesis", "off %", "%", "est. bad", "bad %",
           "by reason, per frame");
    for (int32_t i = 0; i < r->count; i++) {
        for (int c = 0; c < MEASURE_CASE_COUNT; c++) {
            print_row(&r->points[i], r->scales[i], (measure_case)c);
        }
    }
    printf("thesis: its table 5.1, of a room of its own; its estimate of wrong normals in d is "
           "8.67 %%\n");
}

static void write_csv_row(FILE *file, const measure_points *m, int32_t scale, measure_case index)
{
    const measure_counts *c = &m->cases[index];
    char counted[24];
    format_or_dash(measure_counted_percent(c), "%.9g", counted, sizeof(counted));
    fprintf(file, "%d,%d,%d,%s,%lld,%lld,%.9g,%.9g,%.9g,%s", (int)scale, (int)m->width,
            (int)m->height, measure_case_name(index), (long long)c->frames, (long long)c->points,
            measure_missing(c), measure_missing_percent(c), measure_estimated_percent(c),
            counted[0] == '-' ? "" : counted);
    for (int k = 0; k < RLF_REASON_COUNT; k++) {
        double mean = c->frames > 0 ? (double)c->reasons[k] / (double)c->frames : 0.0;
        fprintf(file, ",%.9g", mean);
    }
    fprintf(file, "\n");
}

rlf_result measure_write_csv(const measure_report *r, const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file == NULL) {
        return rlf_fail(RLF_ERROR_MEMORY, "%s: not enough memory for it", path);
    }
    fprintf(file, "scale,width,height,case,frames,points,missing,missing_percent,"
                  "estimated_bad_percent,counted_bad_percent");
    for (int k = 0; k < RLF_REASON_COUNT; k++) {
        fprintf(file, ",reason_%d", k);
    }
    fprintf(file, "\n");
    for (int32_t i = 0; i < r->count; i++) {
        for (int k = 0; k < MEASURE_CASE_COUNT; k++) {
            write_csv_row(file, &r->points[i], r->scales[i], (measure_case)k);
        }
    }
    bool is_whole = fclose(file) == 0;
    rlf_result result = is_whole ? rlf_file_write(path, text, size) : RLF_ERROR_MEMORY;
    free(text);
    return result;
}

static json_t *case_json(const measure_points *m, int32_t scale, measure_case index)
{
    const measure_counts *c = &m->cases[index];
    json_t *reasons = json_object();
    for (int r = 0; r < RLF_REASON_COUNT; r++) {
        double mean = c->frames > 0 ? (double)c->reasons[r] / (double)c->frames : 0.0;
        json_object_set_new(reasons, rlf_reason_name((rlf_reason)r), json_real(mean));
    }
    return json_pack(
        "{s:i, s:i, s:i, s:s, s:I, s:I, s:f, s:o, s:o, s:f, s:f, s:o, s:o}", "scale", (int)scale,
        "width", (int)m->width, "height", (int)m->height, "case", measure_case_name(index),
        "frames", (json_int_t)c->frames, "points", (json_int_t)c->points, "missing",
        measure_missing(c), "published", json_file_number(measure_published(m, index)),
        "off_percent", json_file_number(measure_published_off_percent(m, index)), "missing_percent",
        measure_missing_percent(c), "estimated_bad_percent", measure_estimated_percent(c),
        "counted_bad_percent", json_file_number(measure_counted_percent(c)), "reasons", reasons);
}

rlf_result measure_write_json(const measure_report *r, const char *path)
{
    json_t *cases = json_array();
    for (int32_t i = 0; i < r->count; i++) {
        for (int c = 0; c < MEASURE_CASE_COUNT; c++) {
            json_array_append_new(cases, case_json(&r->points[i], r->scales[i], (measure_case)c));
        }
    }
    return json_file_write(path, json_pack("{s:o, s:s, s:s, s:o}", "machine", machine_json(),
                                           "source", r->source, "profile", profile_name(r->profile),
                                           "rows", cases));
}
