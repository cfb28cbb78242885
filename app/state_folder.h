/* Where the command keeps what it remembers from run to run. */
#ifndef RELIEF_APP_STATE_FOLDER_H
#define RELIEF_APP_STATE_FOLDER_H

#include "relief/image.h"

#define STATE_PATH_SIZE 4096

/* Path of a file in $XDG_STATE_HOME/relief, else ~/.local/state/relief. The folder may not be there
 * yet. False without a home. */
bool state_path(const char *name, char out[STATE_PATH_SIZE]);
/* Makes the folder. False when that cannot be. */
bool state_make_folder(void);

/* ---- recent.c: recordings that were shown lately, for the window's start page */

#define RECENT_MAX 8
#define RECENT_SIZE 1024

typedef struct recent_list {
    int32_t count;
    char paths[RECENT_MAX][RECENT_SIZE]; /* the newest first */
} recent_list;

/* From $XDG_STATE_HOME/relief/recent, else ~/.local/state/relief/recent; those that are gone are
 * left out. No such file: none. */
void recent_load(recent_list *out);
/* Puts a recording first, if it is a file or folder. A list that cannot be written stays as it was:
 * it is of use, not of need. */
void recent_note(const char *source);

/* Path of the small picture of a recording; "" = it has none. */
void recent_find_picture(const char *source, char *out, size_t size);
/* Keeps one, of any size, for a recording that has none yet. What fails, fails quietly. */
void recent_keep_picture(const char *source, const rlf_image_rgba8 *image);

#endif
