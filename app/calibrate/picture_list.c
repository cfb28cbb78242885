/* Folders of pictures, paired by the numbers in their names. */
#define _POSIX_C_SOURCE 200809L /* scandir */
#include "calibrate/views.h"

#include <ctype.h>
#include <dirent.h>
#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

int64_t calibrate_picture_number(const char *name)
{
    const char *end = strrchr(name, '.');
    end = end != NULL ? end : name + strlen(name);
    while (end > name && !isdigit((unsigned char)end[-1])) {
        end--;
    }
    const char *begin = end;
    while (begin > name && isdigit((unsigned char)begin[-1]) && end - begin < 18) {
        begin--;
    }
    return begin < end ? strtoll(begin, NULL, 10) : -1;
}

static bool is_picture(const char *name, const char *pattern)
{
    const char *end = strrchr(name, '.');
    return name[0] != '.' && end != NULL && strlen(name) < CALIBRATE_NAME_SIZE &&
           (strcasecmp(end, ".png") == 0 || strcasecmp(end, ".jpg") == 0 ||
            strcasecmp(end, ".jpeg") == 0) &&
           fnmatch(pattern, name, 0) == 0;
}

static int by_number(const void *a, const void *b)
{
    const int64_t x = calibrate_picture_number(a), y = calibrate_picture_number(b);
    return x != y ? (x > y) - (x < y) : strcmp(a, b);
}

/* "FOLDER/PATTERN" or "FOLDER" into folder; returns the pattern. */
static const char *split(const char *place, char folder[CALIBRATE_PATH_SIZE])
{
    const char *slash = strrchr(place, '/');
    const char *last = slash != NULL ? slash + 1 : place;
    if (strpbrk(last, "*?[") == NULL) {
        snprintf(folder, CALIBRATE_PATH_SIZE, "%s", place);
        return "*";
    }
    snprintf(folder, CALIBRATE_PATH_SIZE, "%.*s", slash != NULL ? (int)(slash - place) : 1,
             slash != NULL ? place : ".");
    return last;
}

rlf_result calibrate_pictures_list(const char *place, calibrate_pictures *out)
{
    struct dirent **entries = NULL;
    *out = (calibrate_pictures){.names = NULL};
    const char *pattern = split(place, out->folder);
    const int count = scandir(out->folder, &entries, NULL, NULL);
    if (count < 0) {
        return rlf_fail(RLF_ERROR_IO, "%s: is not a folder that can be read", out->folder);
    }
    out->names = rlf_alloc_array((size_t)count + 1, sizeof(*out->names));
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name;
        if (out->names != NULL && is_picture(name, pattern)) {
            memcpy(out->names[out->count++], name, strlen(name) + 1);
        }
        free(entries[i]);
    }
    free(entries);
    if (out->names == NULL) {
        return RLF_ERROR_MEMORY;
    }
    qsort(out->names, (size_t)out->count, sizeof(*out->names), by_number);
    return out->count > 0 ? RLF_OK
                          : rlf_fail(RLF_ERROR_IO, "%s: no .png, .jpg or .jpeg pictures", place);
}

void calibrate_pictures_path(const calibrate_pictures *p, const char *name,
                             char out[CALIBRATE_PATH_SIZE])
{
    snprintf(out, CALIBRATE_PATH_SIZE, "%.3900s/%.120s", p->folder, name);
}

void calibrate_pictures_free(calibrate_pictures *p)
{
    rlf_free(p->names);
    *p = (calibrate_pictures){.names = NULL};
}

static bool is_numbered(const calibrate_pictures *p)
{
    bool is = true;
    for (int32_t i = 0; i < p->count; i++) {
        const int64_t number = calibrate_picture_number(p->names[i]);
        is = is && number >= 0 && (i == 0 || number > calibrate_picture_number(p->names[i - 1]));
    }
    return is;
}

int32_t calibrate_pictures_pair(const calibrate_pictures *a, const calibrate_pictures *b,
                                calibrate_pair *pairs)
{
    int32_t count = 0, i = 0, k = 0;
    const bool by_order = !is_numbered(a) || !is_numbered(b);
    if (b->count > 0 && by_order && a->count != b->count) {
        return -1;
    }
    while (i < a->count || k < b->count) {
        const int64_t x = i < a->count ? calibrate_picture_number(a->names[i]) : INT64_MAX;
        const int64_t y = k < b->count ? calibrate_picture_number(b->names[k]) : INT64_MAX;
        const bool has_a = i < a->count && (x <= y || by_order);
        const bool has_b = k < b->count && (y <= x || by_order);
        pairs[count++] = (calibrate_pair){{has_a ? i++ : -1, has_b ? k++ : -1}};
    }
    return count;
}
