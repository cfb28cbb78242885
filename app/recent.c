/* Recordings that were shown lately. */
#define _XOPEN_SOURCE 700
#include "recent.h"

#include "state_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static FILE *open_list(const char *name, const char *mode)
{
    char path[STATE_PATH_SIZE];
    return state_path(name, path) ? fopen(path, mode) : NULL;
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
    FILE *file = state_make_folder() ? open_list("recent.part", "w") : NULL;
    if (file == NULL) {
        return;
    }
    bool is_good = fprintf(file, "%s\n", first) > 0;
    for (int32_t i = 0; i < others->count; i++) {
        if (strcmp(others->paths[i], first) != 0) {
            is_good = fprintf(file, "%s\n", others->paths[i]) > 0 && is_good;
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
