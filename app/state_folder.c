/* The folder of what is remembered, as the XDG Base Directory Specification has it. */
#include "state_folder.h"

#include "relief/io.h"

#include <stdio.h>
#include <stdlib.h>

static bool find_folder(char out[STATE_PATH_SIZE])
{
    const char *state = getenv("XDG_STATE_HOME");
    const char *home = getenv("HOME");
    int length = -1;
    if (state != NULL && state[0] == '/') {
        length = snprintf(out, STATE_PATH_SIZE, "%s/relief", state);
    } else if (home != NULL && home[0] == '/') {
        length = snprintf(out, STATE_PATH_SIZE, "%s/.local/state/relief", home);
    }
    return length > 0 && length < STATE_PATH_SIZE;
}

bool state_path(const char *name, char out[STATE_PATH_SIZE])
{
    char folder[STATE_PATH_SIZE];
    if (!find_folder(folder)) {
        return false;
    }
    const int length = snprintf(out, STATE_PATH_SIZE, "%s/%s", folder, name);
    return length > 0 && length < STATE_PATH_SIZE;
}

bool state_make_folder(void)
{
    char folder[STATE_PATH_SIZE];
    return find_folder(folder) && rlf_make_folder(folder) == RLF_OK;
}
