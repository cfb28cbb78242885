/* What a measurement was made on and with. */
#ifndef RELIEF_APP_MACHINE_H
#define RELIEF_APP_MACHINE_H

#include <jansson.h>

/* One line: processor, cores, instruction set, system, compiler, build type, version, commit. */
void machine_print(void);
/* The same as an object of strings: "cpu", "cores", "isa", "system", "compiler", "build",
 * "version", "commit" ("unknown" outside a git checkout), "date", "load" (mean number of busy
 * programs in the last minute: more than cores spoils times). */
json_t *machine_json(void);

#endif
