/* Pictures of a folder that nothing lists. */
#define _POSIX_C_SOURCE 200809L
#include "io/folder/folder.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define FILES_MAX 10000000
#define DIGITS_MAX 15
#define SPARSE 4 /* numbers that leave out more than three of four are no frame numbers */

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static size_t digits_of(const char *text)
{
    size_t count = 0;
    while (is_digit(text[count])) {
        count++;
    }
    return count;
}

/* Runs of digits compare as numbers of any length. */
static int compare_natural(const char *a, const char *b)
{
    while (*a != '\0' && *b != '\0') {
        if (!is_digit(*a) || !is_digit(*b)) {
            if (*a != *b) {
                return (unsigned char)*a < (unsigned char)*b ? -1 : 1;
            }
            a++;
            b++;
            continue;
        }
        while (*a == '0' && is_digit(a[1])) {
            a++;
        }
        while (*b == '0' && is_digit(b[1])) {
            b++;
        }
        const size_t na = digits_of(a), nb = digits_of(b);
        const int order = na != nb ? (na < nb ? -1 : 1) : strncmp(a, b, na);
        if (order != 0) {
            return order;
        }
        a += na;
        b += nb;
    }
    return (*a != '\0') - (*b != '\0');
}

static int compare(const void *a, const void *b)
{
    const io_list_entry *x = a, *y = b;
    const int order = compare_natural(x->name, y->name);
    return order != 0 ? order : strcmp(x->name, y->name);
}

static bool holds_word(const char *name, const char *word)
{
    const size_t length = strlen(word);
    for (; strlen(name) >= length; name++) {
        if (strncasecmp(name, word, length) == 0) {
            return true;
        }
        if (*name == '\0') {
            break;
        }
    }
    return false;
}

static bool ends_with_one(const char *text, const char *const *endings)
{
    for (; *endings != NULL; endings++) {
        if (strcasecmp(text, *endings) == 0) {
            return true;
        }
    }
    return false;
}

/* Which names are taken, and when. */
typedef struct wish {
    const char *part; /* that the name holds, or begins with */
    const char *const *endings;
    bool (*is_wanted)(const char *name, const struct wish *wish, int64_t *out_ns);
} wish;

static bool is_picture_name(const char *name, const wish *w, int64_t *out_ns)
{
    const char *dot = strrchr(name, '.');
    *out_ns = 0;
    return name[0] != '.' && dot != NULL && holds_word(name, w->part) &&
           ends_with_one(dot, w->endings);
}

/* Reads digits; -1 = there are none or too many. */
static int64_t read_number(const char **text)
{
    int64_t value = 0;
    int digits = 0;
    for (; **text >= '0' && **text <= '9'; ++*text) {
        if (++digits > DIGITS_MAX) {
            return -1;
        }
        value = value * 10 + (**text - '0');
    }
    return digits > 0 ? value : -1;
}

/* Whether the name is one of those wanted, and its time. */
static bool is_numbered_name(const char *name, const wish *w, int64_t *out_ns)
{
    const size_t length = strlen(w->part);
    if (strncmp(name, w->part, length) != 0) {
        return false;
    }
    const char *rest = name + length;
    const int64_t number = read_number(&rest);
    if (number < 0 || number > INT64_MAX / 1000000000 * IO_NUMBERED_RATE) {
        return false;
    }
    *out_ns = io_numbered_time(number);
    if (*rest == '-') {
        rest++;
        const int64_t micros = read_number(&rest);
        if (micros < 0 || micros > INT64_MAX / 1000) {
            return false;
        }
        *out_ns = micros * 1000;
    }
    return ends_with_one(rest, w->endings);
}

/* Names into `out`, one after the other; with no memory there yet, only what they need. */
static size_t walk(DIR *directory, const char *sub, const wish *w, io_frame_list *out, size_t room,
                   int32_t *inout_count)
{
    size_t used = 0;
    int32_t count = 0;
    const bool takes = out->entries != NULL;
    const int32_t most = takes ? *inout_count : FILES_MAX;
    for (struct dirent *e = readdir(directory); e != NULL && count < most; e = readdir(directory)) {
        int64_t time_ns;
        const size_t size = strlen(sub) + 1 + strlen(e->d_name) + 1;
        if (!w->is_wanted(e->d_name, w, &time_ns) || (takes && used + size > room)) {
            continue;
        }
        if (takes) {
            char *name = out->text + used;
            snprintf(name, size, "%s%s%s", sub, sub[0] != '\0' ? "/" : "", e->d_name);
            out->entries[count] = (io_list_entry){time_ns, count + 1, name};
        }
        used += size;
        count++;
    }
    *inout_count = count;
    return used;
}

static rlf_result list_files(const char *folder, const char *sub, const wish *w, io_frame_list *out)
{
    memset(out, 0, sizeof(*out));
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(folder, sub[0] != '\0' ? sub : ".", path);
    DIR *directory = result == RLF_OK ? opendir(path) : NULL;
    if (directory == NULL) {
        return result;
    }
    int32_t count = 0;
    const size_t size = walk(directory, sub, w, out, 0, &count);
    if (count > 0) {
        out->text = rlf_alloc(size);
        out->entries = rlf_alloc_array((size_t)count, sizeof(out->entries[0]));
        if (out->text != NULL && out->entries != NULL) {
            rewinddir(directory);
            walk(directory, sub, w, out, size, &count);
            out->count = count;
        } else {
            io_frame_list_free(out);
            result = RLF_ERROR_MEMORY;
        }
    }
    closedir(directory);
    return result;
}

static int compare_times(const void *a, const void *b)
{
    const io_list_entry *x = a, *y = b;
    return x->time_ns != y->time_ns ? (x->time_ns > y->time_ns) - (x->time_ns < y->time_ns)
                                    : strcmp(x->name, y->name);
}

rlf_result io_numbered_list(const char *folder, const char *sub, const char *prefix,
                            const char *const *endings, io_frame_list *out)
{
    const wish w = {prefix, endings, is_numbered_name};
    rlf_result result = list_files(folder, sub, &w, out);
    if (out->count > 0) {
        qsort(out->entries, (size_t)out->count, sizeof(out->entries[0]), compare_times);
    }
    return result;
}

rlf_result io_named_list(const char *folder, const char *sub, const char *word,
                         const char *const *endings, io_frame_list *out)
{
    const wish w = {word, endings, is_picture_name};
    rlf_result result = list_files(folder, sub, &w, out);
    if (out->count > 0) {
        qsort(out->entries, (size_t)out->count, sizeof(out->entries[0]), compare);
    }
    for (int32_t i = 0; i < out->count; i++) {
        out->entries[i].time_ns = io_numbered_time(i);
        out->entries[i].line = i + 1;
    }
    return result;
}

/* The last number of a name; -1 = none. */
static int64_t number_of(const char *name)
{
    const char *end = name + strlen(name);
    while (end > name && !is_digit(end[-1])) {
        end--;
    }
    const char *begin = end;
    while (begin > name && is_digit(begin[-1])) {
        begin--;
    }
    return begin < end && end - begin <= DIGITS_MAX ? strtoll(begin, NULL, 10) : -1;
}

/* Every name has a number, larger than the one before, and few are left out. */
static bool is_numbered(const io_frame_list *list)
{
    int64_t last = -1;
    for (int32_t i = 0; i < list->count; i++) {
        const int64_t number = number_of(list->entries[i].name);
        if (number <= last) {
            return false;
        }
        last = number;
    }
    return list->count > 0 &&
           last - number_of(list->entries[0].name) < (int64_t)SPARSE * list->count;
}

bool io_named_pair(io_frame_list *depth, io_frame_list *color)
{
    if (!is_numbered(depth) || (color->count > 0 && !is_numbered(color))) {
        return color->count == 0 || color->count == depth->count; /* else one by one */
    }
    int64_t first = number_of(depth->entries[0].name);
    if (color->count > 0 && number_of(color->entries[0].name) < first) {
        first = number_of(color->entries[0].name);
    }
    io_frame_list *const lists[2] = {depth, color};
    for (int k = 0; k < 2; k++) {
        for (int32_t i = 0; i < lists[k]->count; i++) {
            io_list_entry *e = &lists[k]->entries[i];
            e->time_ns = io_numbered_time(number_of(e->name) - first);
        }
    }
    return true;
}
