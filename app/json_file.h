/* JSON of what was measured, as a whole file or none, and the machine that it was measured on. */
#ifndef RELIEF_APP_JSON_FILE_H
#define RELIEF_APP_JSON_FILE_H

#include "relief/base.h"

#include <jansson.h>

/* null for NAN. */
json_t *json_file_number(double value);
/* Writes and gives back `root`, indented. */
rlf_result json_file_write(const char *path, json_t *root);

/* One line: processor, cores, instruction set, system, compiler, build type, version, commit. */
void machine_print(void);
/* The same as an object of strings: "cpu", "cores", "isa", "system", "compiler", "build",
 * "version", "commit" ("unknown" outside a git checkout), "date", "load" (mean number of busy
 * programs in the last minute: more than cores spoils times). */
json_t *machine_json(void);

#endif
