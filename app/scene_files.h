/* The scenes that come with Relief, in the folder share/relief/scenes beside the command's own. */
#ifndef RELIEF_APP_SCENE_FILES_H
#define RELIEF_APP_SCENE_FILES_H

#include "relief/base.h"

#define SCENE_PATH 1024
#define SCENE_TEXT 128
#define SCENES_MAX 128

typedef struct scene_entry {
    char name[SCENE_TEXT];   /* as --scene takes it: "rain", "thesis/arm" */
    char path[SCENE_PATH];   /* of the file */
    char source[SCENE_TEXT]; /* that it was made for; "" = any */
    char about[SCENE_TEXT];  /* what it shows; "" = not told */
} scene_entry;

/* The scenes in the order of their names; their count, at most `capacity`. 0 where there are none.
 * Takes a few milliseconds: it reads every file. */
int32_t scene_files_list(scene_entry *out, int32_t capacity);

/* Path of a scene that the user named: `text` itself where that is a file or means to be one (it
 * ends in .json), else a shipped scene's. False, with a message that lists what there is, where no
 * scene has that name. */
bool scene_files_find(const char *text, char out_path[SCENE_PATH], char *out_message,
                      size_t message_size);
/* Path of a scene that comes with Relief; false where none has that name. */
bool scene_files_find_shipped(const char *name, char out_path[SCENE_PATH]);

#endif
