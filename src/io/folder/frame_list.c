/* Lists of timestamped files. */
#include "io/folder/frame_list.h"

#include <stdlib.h>
#include <string.h>

#define NS_PER_S 1000000000
#define SECONDS_MAX INT64_C(9000000000) /* the year 2255; keeps nanoseconds within 64 bits */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Exact decimal reading: a double cannot hold nanoseconds of Unix time. Digits after the ninth are
 * dropped. Returns what follows the number, or NULL. */
static const char *parse_seconds(const char *text, int64_t *out_ns)
{
    int64_t seconds = 0;
    int digits = 0;
    for (; *text >= '0' && *text <= '9'; text++, digits++) {
        seconds = seconds * 10 + (*text - '0');
        if (seconds > SECONDS_MAX) {
            *out_ns = INT64_MAX;
            return NULL;
        }
    }
    int64_t fraction = 0;
    if (*text == '.') {
        int64_t unit = NS_PER_S / 10;
        for (text++; *text >= '0' && *text <= '9'; text++, digits++) {
            fraction += (*text - '0') * unit;
            unit /= 10;
        }
    }
    *out_ns = seconds * NS_PER_S + fraction;
    return digits > 0 ? text : NULL;
}

/* Reads one line, which is zero-terminated and is cut at its last non-blank character. RLF_NO_FRAME
 * means that it holds no entry. */
static rlf_result parse_line(const char *file, int32_t number, char *line, io_list_entry *out)
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
    const char *rest = parse_seconds(line, &out->time_ns);
    if (rest == NULL && out->time_ns == INT64_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s:%d: its time is more than %lld seconds: write seconds, not "
                        "milliseconds or less",
                        file, (int)number, (long long)SECONDS_MAX);
    }
    if (rest == NULL || (!is_blank(*rest) && *rest != '\0')) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s:%d: does not start with a time in seconds, like 12.345678: write one "
                        "\"SECONDS FILE\" per line",
                        file, (int)number);
    }
    while (is_blank(*rest)) {
        rest++;
    }
    if (*rest == '\0') {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s:%d: has no file name after the time: write one \"SECONDS FILE\" per "
                        "line",
                        file, (int)number);
    }
    out->name = rest;
    out->line = number;
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

static rlf_result parse_lines(const char *file, io_frame_list *list)
{
    int32_t number = 0;
    for (char *line = list->text; line != NULL;) {
        char *end = strchr(line, '\n');
        if (end != NULL) {
            *end = '\0';
        }
        rlf_result result = parse_line(file, ++number, line, &list->entries[list->count]);
        if (result < 0) {
            return result;
        }
        list->count += result == RLF_OK ? 1 : 0;
        line = end != NULL ? end + 1 : NULL;
    }
    return RLF_OK;
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
    size_t lines = 1;
    for (size_t i = 0; i < file->size; i++) {
        lines += file->data[i] == '\n' ? 1 : 0;
    }
    out->text = rlf_alloc(file->size + 1);
    out->entries = rlf_alloc_array(lines, sizeof(out->entries[0]));
    if (out->text == NULL || out->entries == NULL) {
        io_frame_list_free(out);
        return RLF_ERROR_MEMORY;
    }
    if (file->size > 0) {
        memcpy(out->text, file->data, file->size);
    }
    rlf_result result = parse_lines(file->name, out);
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
