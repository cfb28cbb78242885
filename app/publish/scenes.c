/* Scenes that a command may name. */
#include "publish/inside.h"

#include "scene_files.h"
#include "relief/io.h"

#include <stdio.h>
#include <string.h>

#define SCENES_KEPT 32 /* of one run: bodies borrow from them until its end */

typedef struct kept_scene {
    char name[RLF_NAME_MAX];
    rlf_scene scene;
} kept_scene;

struct publish_scenes {
    pthread_mutex_t lock;
    char folder[SCENE_PATH]; /* of the run's scene; "" = none */
    kept_scene kept[SCENES_KEPT];
    int32_t count;
};

rlf_result publish_scenes_create(const char *scene_path, publish_scenes **out)
{
    publish_scenes *s = rlf_alloc(sizeof *s);
    *out = s;
    if (s == NULL) {
        return RLF_ERROR_MEMORY;
    }
    pthread_mutex_init(&s->lock, NULL);
    const char *slash = scene_path != NULL ? strrchr(scene_path, '/') : NULL;
    if (scene_path != NULL) {
        (void)snprintf(s->folder, sizeof s->folder, "%.*s",
                       slash != NULL ? (int)(slash - scene_path) : 1,
                       slash != NULL ? scene_path : ".");
    }
    return RLF_OK;
}

/* "rain", "thesis/arm" or "mine.json": no way leads out of the folders. */
static bool is_plain(const char *name)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                  "_-./ ";
    return name[0] != '/' && name[0] != '.' && strstr(name, "..") == NULL &&
           strspn(name, letters) == strlen(name);
}

/* False with one line. */
static bool find_path(const publish_scenes *s, const char *name, char out[SCENE_PATH],
                      char error[PUBLISH_ERROR_SIZE])
{
    const size_t length = strlen(name), ending = strlen(".json");
    const bool is_file = length > ending && strcmp(name + length - ending, ".json") == 0;
    if (!is_plain(name) || (is_file && strchr(name, '/') != NULL)) {
        (void)snprintf(error, PUBLISH_ERROR_SIZE,
                       "scene '%s': a name of `relief list scenes`, or of a file beside the run's "
                       "scene",
                       name);
        return false;
    }
    if (is_file) {
        (void)snprintf(out, SCENE_PATH, "%.900s/%s", s->folder, name);
        (void)snprintf(error, PUBLISH_ERROR_SIZE, "scene '%s': the run has no scene file", name);
        return s->folder[0] != '\0';
    }
    (void)snprintf(error, PUBLISH_ERROR_SIZE, "there is no scene '%s': see `relief list scenes`",
                   name);
    return scene_files_find_shipped(name, out);
}

/* What only a new run can bring. */
static const char *missing_of(const rlf_scene *scene)
{
    for (int i = 0; i < RLF_HAND_EVENT_COUNT; i++) {
        if (scene->on[i] != RLF_HAND_ACTION_NONE) {
            return "has actions of hands";
        }
    }
    return scene->known_count > 0 ? "has known objects" : NULL;
}

static bool load(publish_scenes *s, const char *name, char error[PUBLISH_ERROR_SIZE])
{
    char path[SCENE_PATH];
    kept_scene *kept = &s->kept[s->count];
    if (s->count == SCENES_KEPT) {
        (void)snprintf(error, PUBLISH_ERROR_SIZE, "scene: %d were opened already", SCENES_KEPT);
        return false;
    }
    if (!find_path(s, name, path, error)) {
        return false;
    }
    if (rlf_scene_load(path, &kept->scene) != RLF_OK) {
        (void)snprintf(error, PUBLISH_ERROR_SIZE, "scene: %.200s", rlf_error_text());
        return false;
    }
    const char *missing = missing_of(&kept->scene);
    if (missing != NULL) {
        (void)snprintf(error, PUBLISH_ERROR_SIZE, "scene '%s' %s: start the run with it", name,
                       missing);
        rlf_scene_destroy(&kept->scene);
        return false;
    }
    (void)snprintf(kept->name, sizeof kept->name, "%s", name);
    s->count++;
    return true;
}

const rlf_scene *publish_scenes_find(publish_scenes *s, const char *name,
                                     char error[PUBLISH_ERROR_SIZE])
{
    const rlf_scene *found = NULL;
    pthread_mutex_lock(&s->lock);
    for (int32_t i = 0; i < s->count && found == NULL; i++) {
        found = strcmp(s->kept[i].name, name) == 0 ? &s->kept[i].scene : NULL;
    }
    if (found == NULL && load(s, name, error)) {
        found = &s->kept[s->count - 1].scene;
    }
    pthread_mutex_unlock(&s->lock);
    return found;
}

void publish_scenes_destroy(publish_scenes **scenes)
{
    publish_scenes *s = *scenes;
    *scenes = NULL;
    if (s == NULL) {
        return;
    }
    for (int32_t i = 0; i < s->count; i++) {
        rlf_scene_destroy(&s->kept[i].scene);
    }
    pthread_mutex_destroy(&s->lock);
    rlf_free(s);
}
