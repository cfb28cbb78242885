/* Whether the name of an output tells what will be in it. */
#ifndef RELIEF_APP_OUTPUT_NAME_H
#define RELIEF_APP_OUTPUT_NAME_H

#include <stdbool.h>

/* A file of one of the `endings`, words with blanks between. A name that ends as files of another
 * kind do is wrong; one that ends as none does is right, and so are a device and a pipe. */
bool output_name_is_right(const char *path, const char *endings);
/* A file that only its ending tells from others: it has one of the `endings`, or is a device or a
 * pipe. */
bool output_name_has(const char *path, const char *endings);
/* A folder: one that is there, or whose name does not end as a file's. */
bool output_name_is_folder(const char *path);

#endif
