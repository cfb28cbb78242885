/* Pictures of a folder that nothing lists. */
#define _POSIX_C_SOURCE 200809L
#include "io/folder/layout.h"

#include <dirent.h>
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

static bool is_wanted(const char *name, const char *word, const char *const *endings)
{
    const char *dot = strrchr(name, '.');
    if (name[0] == '.' || dot == NULL || !holds_word(name, word)) {
        return false;
    }
    for (; *endings != NULL; endings++) {
        if (strcasecmp(dot, *endings) == 0) {
            return true;
        }
    }
    return false;
}

/* Names into `out`, one after the other; with no memory there yet, only what they need. */
static size_t walk(DIR *directory, const char *sub, const char *word, const char *const *endings,
                   io_frame_list *out, size_t room, int32_t *inout_count)
{
    size_t used = 0;
    int32_t count = 0;
    const int32_t most = out->entries != NULL ? *inout_count : FILES_MAX;
    for (struct dirent *e = readdir(directory); e != NULL && count < most; e = readdir(directory)) {
        const size_t size = strlen(sub) + 1 + strlen(e->d_name) + 1;
        if (!is_wanted(e->d_name, word, endings) || (out->entries != NULL && used + size > room)) {
            continue;
        }
        if (out->entries != NULL) {
            char *name = out->text + used;
            name[0] = '\0';
            if (sub[0] != '\0') {
                memcpy(name, sub, strlen(sub));
                memcpy(name + strlen(sub), "/", 2);
            }
            strcat(name, e->d_name);
            out->entries[count] = (io_list_entry){0, count + 1, name};
        }
        used += size;
        count++;
    }
    *inout_count = count;
    return used;
}

static int64_t time_of(int64_t number)
{
    return number / IO_NUMBERED_RATE * 1000000000 +
           number % IO_NUMBERED_RATE * 1000000000 / IO_NUMBERED_RATE;
}

static void sort(io_frame_list *list)
{
    qsort(list->entries, (size_t)list->count, sizeof(list->entries[0]), compare);
    for (int32_t i = 0; i < list->count; i++) {
        list->entries[i].time_ns = time_of(i);
        list->entries[i].line = i + 1;
    }
}

rlf_result io_named_list(const char *folder, const char *sub, const char *word,
                         const char *const *endings, io_frame_list *out)
{
    memset(out, 0, sizeof(*out));
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(folder, sub[0] != '\0' ? sub : ".", path);
    DIR *directory = result == RLF_OK ? opendir(path) : NULL;
    if (directory == NULL) {
        return result;
    }
    int32_t count = 0;
    const size_t size = walk(directory, sub, word, endings, out, 0, &count);
    if (count > 0) {
        out->text = rlf_alloc(size);
        out->entries = rlf_alloc_array((size_t)count, sizeof(out->entries[0]));
        if (out->text != NULL && out->entries != NULL) {
            rewinddir(directory);
            walk(directory, sub, word, endings, out, size, &count);
            out->count = count;
            sort(out);
        } else {
            io_frame_list_free(out);
            result = RLF_ERROR_MEMORY;
        }
    }
    closedir(directory);
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
            e->time_ns = time_of(number_of(e->name) - first);
        }
    }
    return true;
}
