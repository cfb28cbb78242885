/* The back ends of this build, and those of plug-ins. */
#ifndef RLF_IO_SOURCE_BACKENDS_H
#define RLF_IO_SOURCE_BACKENDS_H

#include "io/source/address.h"
#include "relief/backend.h"
#include "relief/base.h"

#include <stdint.h>

extern const rlf_backend io_backend_folder;
extern const rlf_backend io_backend_simulated;
extern const rlf_backend io_backend_freenect;
extern const rlf_backend io_backend_oni;
extern const rlf_backend io_backend_openni2;
extern const rlf_backend io_backend_pcd;
extern const rlf_backend io_backend_freenect2;
extern const rlf_backend io_backend_k4a;
extern const rlf_backend io_backend_realsense;
extern const rlf_backend io_backend_klg;
extern const rlf_backend io_backend_matroska;
extern const rlf_backend io_backend_rosbag;
extern const rlf_backend io_backend_sens;
extern const rlf_backend io_backend_mcap;

/* Built-in ones first, in the order in which they are asked for a file, then those of plug-ins;
 * NULL past the last. The folders of plug-ins are searched once, by the first call past the
 * built-in ones. Thread-safety: safe. */
const rlf_backend *io_backend_at(int32_t index);
/* The built-in ones alone. */
const rlf_backend *io_backend_built_in_at(int32_t index);
/* The shared object that back end `index` came from; NULL = it is built in. */
const char *io_backend_plugin_path(int32_t index);

/* Makes a source of its parts; they are destroyed when that fails. */
rlf_result io_source_create(const rlf_opened *opened, rlf_source **out);

/* How a back end's open ends: what it made is destroyed when it failed. `self` NULL = nothing was
 * made. */
static inline rlf_result io_open_end(rlf_result result, void *self, void (*destroy)(void *))
{
    if (result != RLF_OK && self != NULL) {
        destroy(self);
    }
    return result;
}

/* ---- Which back end opens a SOURCE ---- */

/* By scheme, else by the file name's extension, else by what the back ends recognise. Fails with a
 * line that says what this build can open. */
rlf_result io_backend_find(const char *source, const io_address *address, const rlf_backend **out);

/* ---- Recordings of other programs that are not opened as they are ---- */

/* RLF_OK, or an error that says what the path is and how it is opened: a ROS 2 recording's folder
 * or database, a compressed file. */
rlf_result io_foreign_check(const char *source, const char *path);

/* ---- One plug-in: a shared object that exports rlf_backend_entry ---- */

/* Opens the shared object and checks its table. It stays in memory until the program ends: its
 * functions may be in use anywhere. Fails with a line that names the file and the cure. */
rlf_result io_plugin_open(const char *path, const rlf_backend **out);

#endif
