/* associations.txt: depth and colour pictures in pairs. Each line is cut into its two halves, and
 * these are read as the two lists that they are. */
#include "io/folder/lists.h"
#include "io/folder/layout.h"

#include <stdio.h>
#include <string.h>

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
    for (int32_t number = 1; at < end; number++) {
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
                            file->name, (int)number);
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
        const int64_t number = list->entries[i].time_ns / 1000000000;
        list->entries[i].time_ns = number / IO_NUMBERED_RATE * 1000000000 +
                                   number % IO_NUMBERED_RATE * 1000000000 / IO_NUMBERED_RATE;
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
