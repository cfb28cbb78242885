/* associations.txt: depth and colour pictures in pairs. Each line is cut into its two halves, and
 * these are read as the two lists that they are. */
#include "io/folder/lists.h"
#include "io/folder/layout.h"

#include <string.h>

#define WORDS 4

typedef struct word {
    const char *text;
    size_t length;
} word;

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Words of a line, WORDS + 1 when there are more. */
static int cut(const char *line, const char *end, word out[WORDS])
{
    int count = 0;
    while (line < end) {
        while (line < end && is_blank(*line)) {
            line++;
        }
        if (line == end || (count == 0 && *line == '#')) {
            break;
        }
        if (count == WORDS) {
            return WORDS + 1;
        }
        out[count].text = line;
        while (line < end && !is_blank(*line)) {
            line++;
        }
        out[count].length = (size_t)(line - out[count].text);
        count++;
    }
    return count;
}

static bool holds(const word *w, const char *part)
{
    const size_t length = strlen(part);
    for (size_t i = 0; i + length <= w->length; i++) {
        if (memcmp(w->text + i, part, length) == 0) {
            return true;
        }
    }
    return false;
}

typedef struct halves {
    char *text[2]; /* depth, colour */
    size_t size[2];
} halves;

static void append(halves *h, int which, const word *time, const word *name)
{
    char *to = h->text[which] + h->size[which];
    memcpy(to, time->text, time->length);
    to[time->length] = ' ';
    memcpy(to + time->length + 1, name->text, name->length);
    to[time->length + 1 + name->length] = '\n';
    h->size[which] += time->length + name->length + 2;
}

static rlf_result split(const io_bytes *file, halves *h)
{
    const io_bytes text = io_bytes_unmarked(file);
    const char *at = (const char *)text.data;
    const char *end = at + text.size;
    for (int32_t number = 1; at < end; number++) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        stop = stop != NULL ? stop : end;
        word words[WORDS];
        const int count = cut(at, stop, words);
        if ((count != 0 && count != WORDS) || (count == WORDS && words[2].text[0] == '#')) {
            return rlf_fail(RLF_ERROR_FORMAT,
                            "%s:%d: is not \"TIME FILE TIME FILE\": write one depth and one colour "
                            "picture per line",
                            file->name, (int)number);
        }
        if (count == WORDS) {
            const bool is_depth_first = holds(&words[1], "depth") || !holds(&words[3], "depth");
            append(h, is_depth_first ? 0 : 1, &words[0], &words[1]);
            append(h, is_depth_first ? 1 : 0, &words[2], &words[3]);
        }
        at = stop < end ? stop + 1 : end;
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
