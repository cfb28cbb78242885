/* Scene files to choose from in the window. */
#define _XOPEN_SOURCE 700
#include "scene_list.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int is_scene(const struct dirent *entry)
{
    const size_t length = strlen(entry->d_name);
    return length > 5 && strcmp(entry->d_name + length - 5, ".json") == 0;
}

static int32_t list_folder(const char *folder, viewer_choice *out)
{
    struct dirent **entries = NULL;
    const int found = scandir(folder, &entries, is_scene, alphasort);
    int32_t count = 0;
    for (int i = 0; i < found; i++) {
        if (count < VIEWER_CHOICES_MAX) {
            viewer_choice *c = &out[count++];
            const char *name = entries[i]->d_name;
            (void)snprintf(c->source, sizeof(c->source), "%.700s/%.255s", folder, name);
            (void)snprintf(c->text, sizeof(c->text), "%.*s", (int)strlen(name) - 5, name);
        }
        free(entries[i]);
    }
    free(entries);
    return count;
}

int32_t scene_list(const char *scene_path, viewer_choice *out)
{
    char folder[VIEWER_CHOICE_SOURCE];
    const char *slash = scene_path != NULL ? strrchr(scene_path, '/') : NULL;
    if (scene_path != NULL) {
        (void)snprintf(folder, sizeof(folder), "%.*s",
                       slash != NULL ? (int)(slash - scene_path) : 1,
                       slash != NULL ? scene_path : ".");
        return list_folder(folder, out);
    }
    const int32_t count = list_folder("scenes", out);
    return count > 0 ? count : list_folder(RELIEF_SCENES_FOLDER, out);
}
