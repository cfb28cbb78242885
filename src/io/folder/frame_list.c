/* Lists of timestamped files. */
#include "io/folder/folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BILLION 1000000000
#define WHOLE_MAX (INT64_MAX / 10 - 1)

/* A time as it stands in the file: before its unit is known. */
typedef struct number {
    int64_t whole, billionths;
} number;

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Exact decimal reading: a double cannot hold nanoseconds of Unix time. Digits after the ninth are
 * dropped; a number of too many digits stays at more than any time. Returns what follows it, or
 * NULL. */
static const char *parse_number(const char *text, number *out)
{
    int digits = 0;
    *out = (number){0, 0};
    for (; *text >= '0' && *text <= '9'; text++, digits++) {
        const bool is_full = out->whole > WHOLE_MAX;
        out->whole = is_full ? INT64_MAX : out->whole * 10 + (*text - '0');
    }
    if (*text == '.') {
        int64_t unit = BILLION / 10;
        for (text++; *text >= '0' && *text <= '9'; text++, digits++) {
            out->billionths += (*text - '0') * unit;
            unit /= 10;
        }
    }
    return digits > 0 ? text : NULL;
}

/* Reads one line, which is zero-terminated and is cut at its last non-blank character. RLF_NO_FRAME
 * means that it holds no entry. */
static rlf_result parse_line(const char *file, int32_t row, char *line, number *out_time,
                             io_list_entry *out)
{
    size_t length = strlen(line);
    while (length > 0 && is_blank(line[length - 1])) {
        line[--length] = '\0';
    }
    while (is_blank(*line)) {
        line++;
    }
    if (*line == '\0' || *line == '#') {
        return RLF_NO_FRAME;
    }
    const char *rest = parse_number(line, out_time);
    if (rest == NULL || (!is_blank(*rest) && *rest != '\0')) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s:%d: does not start with a time in seconds, like 12.345678: write one "
                        "\"SECONDS FILE\" per line",
                        file, (int)row);
    }
    while (is_blank(*rest)) {
        rest++;
    }
    if (*rest == '\0') {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s:%d: has no file name after the time: write one \"SECONDS FILE\" per "
                        "line",
                        file, (int)row);
    }
    out->name = rest;
    out->line = row;
    return RLF_OK;
}

static int compare_entries(const void *a, const void *b)
{
    const io_list_entry *x = a;
    const io_list_entry *y = b;
    if (x->time_ns != y->time_ns) {
        return x->time_ns < y->time_ns ? -1 : 1;
    }
    return (x->line > y->line) - (x->line < y->line);
}

static void sort_by_time(const char *file, io_frame_list *list)
{
    for (int32_t i = 1; i < list->count; i++) {
        if (list->entries[i].time_ns < list->entries[i - 1].time_ns) {
            rlf_log(RLF_LOG_WARNING, "%s:%d: the time goes back: the frames are sorted by time",
                    file, (int)list->entries[i].line);
            qsort(list->entries, (size_t)list->count, sizeof(list->entries[0]), compare_entries);
            return;
        }
    }
}

static rlf_result parse_lines(const char *file, number *times, io_frame_list *list)
{
    int32_t row = 0;
    for (char *line = list->text; line != NULL;) {
        char *end = strchr(line, '\n');
        if (end != NULL) {
            *end = '\0';
        }
        rlf_result result =
            parse_line(file, ++row, line, &times[list->count], &list->entries[list->count]);
        if (result < 0) {
            return result;
        }
        list->count += result == RLF_OK ? 1 : 0;
        line = end != NULL ? end + 1 : NULL;
    }
    return RLF_OK;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* What the numbers mean. In doubt they are seconds, if they can be. */
static rlf_result set_times(const char *file, const number *times, double *values, double *scratch,
                            io_frame_list *list)
{
    for (int32_t i = 0; i < list->count; i++) {
        values[i] = (double)times[i].whole + 1e-9 * (double)times[i].billionths;
    }
    qsort(values, (size_t)list->count, sizeof(values[0]), compare_doubles);
    const int64_t found = io_time_unit(values, list->count, scratch);
    const int64_t unit = found > 0 ? found : 1;
    for (int32_t i = 0; i < list->count; i++) {
        if (!((double)times[i].whole <= IO_SECONDS_MAX * (double)unit)) {
            return rlf_fail(RLF_ERROR_FORMAT,
                            "%s:%d: its time is more than %.0f seconds: write seconds, not "
                            "milliseconds or less",
                            file, (int)list->entries[i].line, IO_SECONDS_MAX);
        }
        list->entries[i].time_ns = io_time_in_ns(times[i].whole, times[i].billionths, unit);
    }
    io_time_unit_tell(file, unit);
    return RLF_OK;
}

/* The lines and then, when all are known, their times. */
static rlf_result parse_all(const char *file, size_t lines, io_frame_list *out)
{
    number *times = rlf_alloc_array(lines, sizeof(times[0]));
    double *values = rlf_alloc_array(lines, sizeof(values[0]));
    double *scratch = rlf_alloc_array(lines, sizeof(scratch[0]));
    rlf_result result = RLF_ERROR_MEMORY;
    if (times != NULL && values != NULL && scratch != NULL) {
        result = parse_lines(file, times, out);
        result = result == RLF_OK ? set_times(file, times, values, scratch, out) : result;
    }
    rlf_free(times);
    rlf_free(values);
    rlf_free(scratch);
    return result;
}

rlf_result io_frame_list_parse(const io_bytes *marked, io_frame_list *out)
{
    const io_bytes text = io_bytes_unmarked(marked);
    const io_bytes *file = &text;
    memset(out, 0, sizeof(*out));
    if (file->size > 0 && memchr(file->data, '\0', file->size) != NULL) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is not a text file: write one \"SECONDS FILE\" per line", file->name);
    }
    const size_t lines = io_bytes_lines(file);
    out->text = rlf_alloc(file->size + 1);
    out->entries = rlf_alloc_array(lines, sizeof(out->entries[0]));
    if (out->text == NULL || out->entries == NULL) {
        io_frame_list_free(out);
        return RLF_ERROR_MEMORY;
    }
    if (file->size > 0) {
        memcpy(out->text, file->data, file->size);
    }
    rlf_result result = parse_all(file->name, lines, out);
    if (result != RLF_OK) {
        io_frame_list_free(out);
        return result;
    }
    sort_by_time(file->name, out);
    return RLF_OK;
}

void io_frame_list_free(io_frame_list *list)
{
    rlf_free(list->entries);
    rlf_free(list->text);
    memset(list, 0, sizeof(*list));
}

/* ---- associations.txt: each line is cut into its two halves, and these are read as the two lists
 * that they are ---- */

#define LINE_SIZE 8192

typedef struct halves {
    char *text[2]; /* depth, colour */
    size_t size[2];
} halves;

static void append(halves *h, int which, const char *time, const char *name)
{
    h->size[which] += (size_t)sprintf(h->text[which] + h->size[which], "%s %s\n", time, name);
}

static rlf_result split(const io_bytes *file, halves *h)
{
    const io_bytes text = io_bytes_unmarked(file);
    const char *at = (const char *)text.data;
    const char *end = at + text.size;
    for (int32_t row = 1; at < end; row++) {
        char line[LINE_SIZE], time[2][128] = {{0}}, name[2][IO_PATH_MAX], more;
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        const size_t length = (size_t)((stop != NULL ? stop : end) - at);
        const size_t size = length < sizeof(line) ? length : 0;
        memcpy(line, at, size);
        line[size] = '\0';
        const int count =
            sscanf(line, "%127s %4095s %127s %4095s %c", time[0], name[0], time[1], name[1], &more);
        const bool is_empty = length == 0 || (size > 0 && count <= 0) || time[0][0] == '#';
        if (!is_empty && (count != 4 || time[1][0] == '#')) {
            return rlf_fail(RLF_ERROR_FORMAT,
                            "%s:%d: is not \"TIME FILE TIME FILE\": write one depth and one colour "
                            "picture per line",
                            file->name, (int)row);
        }
        if (!is_empty) {
            const int depth = strstr(name[0], "depth") != NULL || strstr(name[1], "depth") == NULL;
            append(h, 0, time[1 - depth], name[1 - depth]);
            append(h, 1, time[depth], name[depth]);
        }
        at += length + 1;
    }
    return RLF_OK;
}

static bool are_numbers(const io_frame_list *list)
{
    for (int32_t i = 1; i < list->count; i++) {
        if (list->entries[i].time_ns - list->entries[i - 1].time_ns != 1000000000) {
            return false;
        }
    }
    return list->count > 1 && list->entries[0].time_ns % 1000000000 == 0;
}

static void scale(io_frame_list *list)
{
    for (int32_t i = 0; i < list->count; i++) {
        list->entries[i].time_ns = io_numbered_time(list->entries[i].time_ns / 1000000000);
    }
}

rlf_result io_associations_parse(const io_bytes *file, io_frame_list *out_depth,
                                 io_frame_list *out_color, bool *out_has_numbers)
{
    memset(out_depth, 0, sizeof(*out_depth));
    memset(out_color, 0, sizeof(*out_color));
    *out_has_numbers = false;
    /* Each half is shorter than the whole, but for the last line's end. */
    halves h = {{rlf_alloc(file->size + 2), rlf_alloc(file->size + 2)}, {0, 0}};
    rlf_result result = h.text[0] != NULL && h.text[1] != NULL ? split(file, &h) : RLF_ERROR_MEMORY;
    io_frame_list *const lists[2] = {out_depth, out_color};
    for (int k = 0; k < 2 && result == RLF_OK; k++) {
        const io_bytes half = {file->name, (const uint8_t *)h.text[k], h.size[k]};
        result = io_frame_list_parse(&half, lists[k]);
    }
    rlf_free(h.text[0]);
    rlf_free(h.text[1]);
    if (result != RLF_OK) {
        io_frame_list_free(out_depth);
        io_frame_list_free(out_color);
        return result;
    }
    if (are_numbers(out_depth) && are_numbers(out_color)) {
        *out_has_numbers = true;
        scale(out_depth);
        scale(out_color);
    }
    return RLF_OK;
}
