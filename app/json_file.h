/* JSON of what was measured, as a whole file or none. */
#ifndef RELIEF_APP_JSON_FILE_H
#define RELIEF_APP_JSON_FILE_H

#include "relief/base.h"

#include <jansson.h>

/* null for NAN. */
json_t *json_file_number(double value);
/* Writes and gives back `root`, indented. */
rlf_result json_file_write(const char *path, json_t *root);

#endif
