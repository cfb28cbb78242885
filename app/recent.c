/* Recordings that were shown lately. */
#define _XOPEN_SOURCE 700
#include "state_folder.h"

#include "picture_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PICTURE_WIDTH 128 /* pixels, about */

static FILE *open_list(const char *name, const char *mode)
{
    char path[STATE_PATH_SIZE];
    return state_path(name, path) ? fopen(path, mode) : NULL;
}

/* Named by the recording's path: FNV-1a of 64 bits. */
static bool picture_path(const char *path, char out[STATE_PATH_SIZE])
{
    char name[48];
    uint64_t hash = UINT64_C(14695981039346656037);
    for (const char *c = path; *c != '\0'; c++) {
        hash = (hash ^ (uint8_t)*c) * UINT64_C(1099511628211);
    }
    (void)snprintf(name, sizeof(name), "recent-%016llx.png", (unsigned long long)hash);
    return state_path(name, out);
}

void recent_find_picture(const char *source, char *out, size_t size)
{
    char path[STATE_PATH_SIZE];
    const bool is_there = picture_path(source, path) && access(path, R_OK) == 0;
    const int length = snprintf(out, size, "%s", is_there ? path : "");
    if (length < 0 || (size_t)length >= size) {
        out[0] = '\0';
    }
}

void recent_keep_picture(const char *source, const rlf_image_rgba8 *image)
{
    char path[STATE_PATH_SIZE];
    char *whole = realpath(source, NULL);
    if (whole != NULL && picture_path(whole, path) && access(path, R_OK) != 0 &&
        state_make_folder()) {
        const int32_t factor = image->width / PICTURE_WIDTH;
        (void)picture_file_write(path, image, factor > 1 ? factor : 1);
    }
    free(whole);
}

void recent_load(recent_list *out)
{
    out->count = 0;
    FILE *file = open_list("recent", "r");
    while (file != NULL && out->count < RECENT_MAX) {
        char *line = out->paths[out->count];
        if (fgets(line, RECENT_SIZE, file) == NULL) {
            break;
        }
        line[strcspn(line, "\n")] = '\0';
        out->count += line[0] == '/' && access(line, R_OK) == 0 ? 1 : 0;
    }
    if (file != NULL) {
        (void)fclose(file);
    }
}

static void write_list(const char *first, const recent_list *others)
{
    char old[STATE_PATH_SIZE];
    FILE *file = state_make_folder() ? open_list("recent.part", "w") : NULL;
    if (file == NULL) {
        return;
    }
    bool is_good = fprintf(file, "%s\n", first) > 0;
    int32_t count = 1;
    for (int32_t i = 0; i < others->count; i++) {
        if (strcmp(others->paths[i], first) == 0) {
            continue;
        }
        if (count < RECENT_MAX) {
            is_good = fprintf(file, "%s\n", others->paths[i]) > 0 && is_good;
            count++;
        } else if (picture_path(others->paths[i], old)) {
            (void)remove(old);
        }
    }
    is_good = fclose(file) == 0 && is_good;
    char part[STATE_PATH_SIZE];
    char whole[STATE_PATH_SIZE];
    (void)state_path("recent.part", part);
    (void)state_path("recent", whole);
    if (!is_good || rename(part, whole) != 0) {
        (void)remove(part);
    }
}

void recent_note(const char *source)
{
    char *path = realpath(source, NULL);
    if (path != NULL && strlen(path) + 2 <= RECENT_SIZE && strchr(path, '\n') == NULL) {
        recent_list list;
        recent_load(&list);
        write_list(path, &list);
    }
    free(path);
}
