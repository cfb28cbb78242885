/* Recordings that were shown lately. */
#define _XOPEN_SOURCE 700
#include "recent.h"

#include "relief/io.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PATH_SIZE 4096

/* False without a home. */
static bool find_folder(char out[PATH_SIZE])
{
    const char *state = getenv("XDG_STATE_HOME");
    const char *home = getenv("HOME");
    int length = -1;
    if (state != NULL && state[0] == '/') {
        length = snprintf(out, PATH_SIZE, "%s/relief", state);
    } else if (home != NULL && home[0] == '/') {
        length = snprintf(out, PATH_SIZE, "%s/.local/state/relief", home);
    }
    return length > 0 && length + (int)sizeof("/recent.part") <= PATH_SIZE;
}

static FILE *open_list(const char *folder, const char *name, const char *mode)
{
    char path[PATH_SIZE];
    const int length = snprintf(path, sizeof(path), "%s/%s", folder, name);
    return length > 0 && length < PATH_SIZE ? fopen(path, mode) : NULL;
}

void recent_load(recent_list *out)
{
    char folder[PATH_SIZE];
    out->count = 0;
    FILE *file = find_folder(folder) ? open_list(folder, "recent", "r") : NULL;
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

static void write_list(const char *folder, const char *first, const recent_list *others)
{
    FILE *file = rlf_make_folder(folder) == RLF_OK ? open_list(folder, "recent.part", "w") : NULL;
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
    char part[PATH_SIZE + 16];
    char whole[PATH_SIZE + 16];
    (void)snprintf(part, sizeof(part), "%s/recent.part", folder);
    (void)snprintf(whole, sizeof(whole), "%s/recent", folder);
    if (!is_good || rename(part, whole) != 0) {
        (void)remove(part);
    }
}

void recent_note(const char *source)
{
    char folder[PATH_SIZE];
    char *path = realpath(source, NULL);
    if (path != NULL && strlen(path) + 2 <= RECENT_SIZE && strchr(path, '\n') == NULL &&
        find_folder(folder)) {
        recent_list list;
        recent_load(&list);
        write_list(folder, path, &list);
    }
    free(path);
}
