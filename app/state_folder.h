/* Where the command keeps what it remembers from run to run. */
#ifndef RELIEF_APP_STATE_FOLDER_H
#define RELIEF_APP_STATE_FOLDER_H

#include <stdbool.h>

#define STATE_PATH_SIZE 4096

/* Path of a file in $XDG_STATE_HOME/relief, else ~/.local/state/relief. The folder may not be there
 * yet. False without a home. */
bool state_path(const char *name, char out[STATE_PATH_SIZE]);
/* Makes the folder. False when that cannot be. */
bool state_make_folder(void);

#endif
