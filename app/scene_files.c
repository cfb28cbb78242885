/* Shipped scenes by name. */
#define _POSIX_C_SOURCE 200809L
#include "scene_files.h"

#include "command.h"

#include <dirent.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define ENDING ".json"

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static bool is_file(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISDIR(status.st_mode);
}

/* PREFIX/share/relief/scenes of a command that is PREFIX/bin/relief; a build tree is like that,
 * too. */
static bool find_folder(char out[SCENE_PATH])
{
    char exe[SCENE_PATH];
    const ssize_t length = readlink("/proc/self/exe", exe, sizeof(exe) - 1);
    exe[length > 0 ? length : 0] = '\0';
    for (int i = 0; i < 2; i++) {
        char *slash = strrchr(exe, '/');
        if (slash == NULL) {
            return false;
        }
        *slash = '\0';
    }
    const int wanted = snprintf(out, SCENE_PATH, "%s/" RELIEF_DATA_FOLDER "/scenes", exe);
    return wanted < SCENE_PATH && is_folder(out);
}

static void copy_text(const json_t *top, const char *key, char out[SCENE_TEXT])
{
    const char *text = json_string_value(json_object_get(top, key));
    (void)snprintf(out, SCENE_TEXT, "%.127s", text != NULL ? text : "");
}

/* Whether the file can be read; a scene that cannot is no scene to offer. */
static bool read_entry(const char *folder, const char *name, scene_entry *out)
{
    const int length = snprintf(out->path, SCENE_PATH, "%s/%s" ENDING, folder, name);
    json_t *top = length < SCENE_PATH ? json_load_file(out->path, 0, NULL) : NULL;
    (void)snprintf(out->name, SCENE_TEXT, "%.127s", name);
    copy_text(top, "source", out->source);
    copy_text(top, "about", out->about);
    const bool is_read = json_is_object(top);
    json_decref(top);
    return is_read;
}

typedef struct entry_list {
    scene_entry *entries;
    int32_t count, capacity;
} entry_list;

/* The scenes of folder/below, whose names begin with `below`. */
static void add_folder(entry_list *list, const char *folder, const char *below)
{
    char path[SCENE_PATH];
    DIR *directory =
        snprintf(path, sizeof(path), "%s/%s", folder, below) < SCENE_PATH ? opendir(path) : NULL;
    for (struct dirent *d = NULL; directory != NULL && (d = readdir(directory)) != NULL;) {
        const char *dot = strrchr(d->d_name, '.');
        char name[SCENE_TEXT];
        if (dot == NULL || strcmp(dot, ENDING) != 0 || list->count == list->capacity ||
            snprintf(name, sizeof(name), "%s%.*s", below, (int)(dot - d->d_name), d->d_name) >=
                SCENE_TEXT) {
            continue;
        }
        list->count += read_entry(folder, name, &list->entries[list->count]) ? 1 : 0;
    }
    if (directory != NULL) {
        closedir(directory);
    }
}

static int by_name(const void *a, const void *b)
{
    const scene_entry *first = a;
    const scene_entry *second = b;
    const bool is_below = strchr(first->name, '/') != NULL;
    const bool other_is_below = strchr(second->name, '/') != NULL;
    return is_below != other_is_below ? (int)is_below - (int)other_is_below
                                      : strcmp(first->name, second->name);
}

int32_t scene_files_list(scene_entry *out, int32_t capacity)
{
    char folder[SCENE_PATH];
    entry_list list = {out, 0, capacity};
    if (find_folder(folder)) {
        add_folder(&list, folder, "");
        add_folder(&list, folder, "thesis/");
    }
    qsort(out, (size_t)list.count, sizeof(*out), by_name);
    return list.count;
}

static bool ends_in_json(const char *text)
{
    const size_t length = strlen(text);
    const size_t ending = strlen(ENDING);
    return length >= ending && strcmp(text + length - ending, ENDING) == 0;
}

static void explain(const char *text, char *out_message, size_t message_size)
{
    static scene_entry entries[SCENES_MAX];
    const char *names[SCENES_MAX + 1] = {NULL};
    const int32_t count = scene_files_list(entries, SCENES_MAX);
    for (int32_t i = 0; i < count; i++) {
        names[i] = entries[i].name;
    }
    char nearest[SUGGEST_TEXT];
    (void)snprintf(out_message, message_size, "there is no file and no scene '%s'%s%s", text,
                   count > 0 ? ": " : "", suggest_text(text, names, true, nearest));
}

bool scene_files_find_shipped(const char *name, char out_path[SCENE_PATH])
{
    char folder[SCENE_PATH];
    return find_folder(folder) &&
           snprintf(out_path, SCENE_PATH, "%s/%s" ENDING, folder, name) < SCENE_PATH &&
           is_file(out_path);
}

bool scene_files_find(const char *text, char out_path[SCENE_PATH], char *out_message,
                      size_t message_size)
{
    const bool is_path = ends_in_json(text) || is_file(text);
    if (is_path ? snprintf(out_path, SCENE_PATH, "%s", text) < SCENE_PATH
                : scene_files_find_shipped(text, out_path)) {
        return true;
    }
    explain(text, out_message, message_size);
    return false;
}
