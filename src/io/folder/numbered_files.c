/* Lists of pictures made from the names in a folder. */
#define _POSIX_C_SOURCE 200809L
#include "io/folder/layout.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define NUMBER_DIGITS_MAX 15
#define FILES_MAX 10000000

/* Reads digits; -1 = there are none or too many. */
static int64_t read_number(const char **text)
{
    int64_t value = 0;
    int digits = 0;
    for (; **text >= '0' && **text <= '9'; ++*text) {
        if (++digits > NUMBER_DIGITS_MAX) {
            return -1;
        }
        value = value * 10 + (**text - '0');
    }
    return digits > 0 ? value : -1;
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

/* Whether the name is one of those wanted, and its time. */
static bool parse_name(const char *name, const char *prefix, const char *const *endings,
                       int64_t *out_ns)
{
    const size_t length = strlen(prefix);
    if (strncmp(name, prefix, length) != 0) {
        return false;
    }
    const char *rest = name + length;
    const int64_t number = read_number(&rest);
    if (number < 0 || number > INT64_MAX / 1000000000 * IO_NUMBERED_RATE) {
        return false;
    }
    *out_ns = number / IO_NUMBERED_RATE * 1000000000 +
              number % IO_NUMBERED_RATE * 1000000000 / IO_NUMBERED_RATE;
    if (*rest == '-') {
        rest++;
        const int64_t micros = read_number(&rest);
        if (micros < 0 || micros > INT64_MAX / 1000) {
            return false;
        }
        *out_ns = micros * 1000;
    }
    return ends_with_one(rest, endings);
}

static int compare(const void *a, const void *b)
{
    const io_list_entry *x = a;
    const io_list_entry *y = b;
    return x->time_ns != y->time_ns ? (x->time_ns > y->time_ns) - (x->time_ns < y->time_ns)
                                    : strcmp(x->name, y->name);
}

/* Counts, and where `out` has room takes, the names that are wanted. */
static size_t walk(DIR *directory, const char *sub, const char *prefix, const char *const *endings,
                   io_frame_list *out, size_t room)
{
    size_t used = 0;
    int32_t count = 0;
    const size_t sub_length = strlen(sub);
    for (struct dirent *e = readdir(directory); e != NULL && count < FILES_MAX;
         e = readdir(directory)) {
        int64_t time_ns;
        if (!parse_name(e->d_name, prefix, endings, &time_ns)) {
            continue;
        }
        const size_t length = strlen(e->d_name);
        const size_t size = sub_length + 1 + length + 1;
        if (out->text != NULL && used + size <= room && out->entries != NULL) {
            char *name = out->text + used;
            memcpy(name, sub, sub_length);
            name[sub_length] = '/';
            memcpy(name + sub_length + 1, e->d_name, length + 1);
            const char *shown = sub_length > 0 ? name : name + 1;
            out->entries[out->count++] = (io_list_entry){time_ns, count + 1, shown};
        }
        used += size;
        count++;
    }
    return used;
}

rlf_result io_numbered_list(const char *folder, const char *sub, const char *prefix,
                            const char *const *endings, io_frame_list *out)
{
    memset(out, 0, sizeof(*out));
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(folder, sub[0] != '\0' ? sub : ".", path);
    DIR *directory = result == RLF_OK ? opendir(path) : NULL;
    if (directory == NULL) {
        return result;
    }
    const size_t size = walk(directory, sub, prefix, endings, out, 0);
    if (size > 0) {
        /* A name is at least seven characters with its slash and its end: so many suffice. */
        out->text = rlf_alloc(size);
        out->entries = rlf_alloc_array(size / 7 + 1, sizeof(out->entries[0]));
        rewinddir(directory);
        if (out->text != NULL && out->entries != NULL) {
            walk(directory, sub, prefix, endings, out, size);
            qsort(out->entries, (size_t)out->count, sizeof(out->entries[0]), compare);
        } else {
            io_frame_list_free(out);
            result = RLF_ERROR_MEMORY;
        }
    }
    closedir(directory);
    return result;
}
