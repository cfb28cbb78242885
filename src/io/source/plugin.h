/* One plug-in: a shared object that exports rlf_backend_entry. */
#ifndef RLF_IO_SOURCE_PLUGIN_H
#define RLF_IO_SOURCE_PLUGIN_H

#include "relief/backend.h"

/* Opens the shared object and checks its table. It stays in memory until the program ends: its
 * functions may be in use anywhere. Fails with a line that names the file and the cure. */
rlf_result io_plugin_open(const char *path, const rlf_backend **out);

#endif
