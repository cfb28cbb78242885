/* What the window offers to open. */
#define _XOPEN_SOURCE 700
#include "run_window.h"

#include "command.h"
#include "state_folder.h"
#include "relief/io.h"
#include "scene_files.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- scenes ---------------------------------------------------------------------------------- */

static int is_scene(const struct dirent *entry)
{
    const size_t length = strlen(entry->d_name);
    return length > 5 && strcmp(entry->d_name + length - 5, ".json") == 0;
}

static int32_t list_folder(const char *folder, rlf_window_choice *out)
{
    struct dirent **entries = NULL;
    const int found = scandir(folder, &entries, is_scene, alphasort);
    int32_t count = 0;
    for (int i = 0; i < found; i++) {
        if (count < RLF_WINDOW_CHOICES_MAX) {
            rlf_window_choice *c = &out[count++];
            const char *name = entries[i]->d_name;
            (void)snprintf(c->source, sizeof(c->source), "%.700s/%.255s", folder, name);
            (void)snprintf(c->text, sizeof(c->text), "%.*s", (int)strlen(name) - 5, name);
            c->scene[0] = c->picture[0] = '\0';
        }
        free(entries[i]);
    }
    free(entries);
    return count;
}

static bool is_shipped(const scene_entry *entries, int32_t count, const char *path)
{
    for (int32_t i = 0; i < count; i++) {
        if (strcmp(entries[i].path, path) == 0) {
            return true;
        }
    }
    return false;
}

int32_t scene_list(const char *scene_path, rlf_window_choice *out)
{
    static scene_entry entries[SCENES_MAX];
    char folder[RLF_WINDOW_SOURCE_SIZE];
    int32_t count = 0;
    const int32_t shipped = scene_files_list(entries, SCENES_MAX);
    if (scene_path != NULL && !is_shipped(entries, shipped, scene_path)) {
        const char *slash = strrchr(scene_path, '/');
        (void)snprintf(folder, sizeof(folder), "%.*s",
                       slash != NULL ? (int)(slash - scene_path) : 1,
                       slash != NULL ? scene_path : ".");
        count = list_folder(folder, out);
    }
    for (int32_t i = 0; i < shipped && count < RLF_WINDOW_CHOICES_MAX; i++) {
        rlf_window_choice *c = &out[count++];
        (void)snprintf(c->source, sizeof(c->source), "%s", entries[i].path);
        (void)snprintf(c->text, sizeof(c->text), "%.95s", entries[i].name);
        c->scene[0] = c->picture[0] = '\0';
    }
    return count;
}

/* Beside the scenes lie their pictures: scenes/rain.json has scenes/pictures/rain.png. */
static void find_scene_picture(const char *path, char *out, size_t size)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    const int length = (int)strlen(name) - (int)strlen(".json");
    const int written = snprintf(out, size, "%.*spictures/%.*s.png", (int)(name - path), path,
                                 length > 0 ? length : 0, name);
    if (written < 0 || (size_t)written >= size || access(out, R_OK) != 0) {
        out[0] = '\0';
    }
}

/* The simulated rooms are always there; recordings are where they were built. */
static bool is_source_there(const char *source)
{
    return strncmp(source, "synthetic:", 10) == 0 || access(source, R_OK) == 0;
}

int32_t scene_list_played(rlf_window_choice *out, int32_t capacity)
{
    static scene_entry entries[SCENES_MAX];
    const int32_t found = scene_files_list(entries, SCENES_MAX);
    int32_t count = 0;
    for (int32_t i = 0; i < found && count < capacity; i++) {
        const scene_entry *e = &entries[i];
        if (e->source[0] == '\0' || !is_source_there(e->source)) {
            continue;
        }
        rlf_window_choice *c = &out[count++];
        (void)snprintf(c->source, sizeof(c->source), "%s", e->source);
        (void)snprintf(c->scene, sizeof(c->scene), "%s", e->path);
        (void)snprintf(c->text, sizeof(c->text), "scene %.30s: %.120s", e->name, e->about);
        find_scene_picture(e->path, c->picture, sizeof(c->picture));
    }
    return count;
}

/* ---- sources, and the page without a SOURCE -------------------------------------------------- */

#define CAMERAS_MAX 16

/* The end of a path tells more than its beginning. */
static const char *end_of(const char *path)
{
    const size_t length = strlen(path);
    const size_t most = 60;
    return length > most ? path + (length - most) : path;
}

int32_t start_page_list(rlf_window_choice *out)
{
    int32_t count = 0;
    rlf_source_entry cameras[CAMERAS_MAX];
    const int32_t found = rlf_source_list(cameras, CAMERAS_MAX);
    for (int32_t i = 0; i < found && i < CAMERAS_MAX; i++) {
        rlf_window_choice *c = &out[count++];
        (void)snprintf(c->source, sizeof(c->source), "%.255s", cameras[i].source);
        c->scene[0] = c->picture[0] = '\0';
        (void)snprintf(c->text, sizeof(c->text), "camera: %.80s", cameras[i].description);
    }
    rlf_window_choice *room = &out[count++];
    (void)snprintf(room->source, sizeof(room->source), "synthetic:room");
    room->scene[0] = room->picture[0] = '\0';
    (void)snprintf(room->text, sizeof(room->text), "simulated room%s",
                   found <= 0 ? " (no camera is plugged in)" : "");
    char demo[SCENE_PATH];
    if (scene_files_find_shipped("demo", demo)) {
        find_scene_picture(demo, room->picture, sizeof(room->picture));
    }
    recent_list recent;
    recent_load(&recent);
    for (int32_t i = 0; i < recent.count; i++) {
        rlf_window_choice *c = &out[count++];
        (void)snprintf(c->source, sizeof(c->source), "%.1023s", recent.paths[i]);
        c->scene[0] = c->picture[0] = '\0';
        (void)snprintf(c->text, sizeof(c->text), "recent: %s", end_of(recent.paths[i]));
        recent_find_picture(recent.paths[i], c->picture, sizeof(c->picture));
    }
    return count;
}

static int32_t list_choices(void *context, rlf_window_choice *out)
{
    (void)context;
    const int32_t count = start_page_list(out);
    return count + scene_list_played(out + count, RLF_WINDOW_CHOICES_MAX - count);
}

rlf_result start_page_choose(rlf_window_choice *out)
{
    return rlf_window_choose(list_choices, NULL, &command_interrupted, out);
}
