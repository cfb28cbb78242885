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
extern const rlf_backend io_backend_ros2;

/* Built-in ones first, in the order in which they are asked for a file, then those of plug-ins;
 * NULL past the last. The folders of plug-ins are searched once, by the first call past the
 * built-in ones. Thread-safety: safe. */
const rlf_backend *io_backend_at(int32_t index);
/* The built-in ones alone. */
const rlf_backend *io_backend_built_in_at(int32_t index);
/* The shared object that back end `index` came from; NULL = it is built in. */
const char *io_backend_plugin_path(int32_t index);

/* How a back end's open ends: what it made is destroyed when it failed. `self` NULL = nothing was
 * made. */
static inline rlf_result io_open_end(rlf_result result, void *self, void (*destroy)(void *))
{
    if (result != RLF_OK && self != NULL && destroy != NULL) {
        destroy(self);
    }
    return result;
}

/* Makes a source of its parts; they are destroyed when that fails. */
static inline rlf_result io_source_create(const rlf_opened *opened, rlf_source **out)
{
    rlf_result result =
        rlf_source_create_custom(&opened->methods, &opened->info, opened->self, out);
    return io_open_end(result, opened->self, opened->methods.destroy);
}

typedef rlf_result (*io_open_fn)(const char *source, rlf_pool *pool, rlf_source **out);

/* Lends it the function that opens what it plays. It cannot call it by name: that function knows
 * all back ends, this one among them. Thread-safe. */
void io_simulated_lend_open(io_open_fn opener);

/* ---- Which back end opens a SOURCE ---- */

/* By scheme, else by the file name's extension, else by what the back ends recognise. Fails with a
 * line that says what this build can open. */
rlf_result io_backend_find(const char *source, const io_address *address, const rlf_backend **out);

/* ---- Recordings of other programs that are not opened as they are ---- */

/* RLF_OK, or an error that says what the path is and how it is opened: a ROS 2 recording's folder
 * or database, a compressed file. */
rlf_result io_foreign_check(const char *source, const char *path);

/* A format or a driver that this build was made without. */
typedef struct io_backend_absent {
    const char *scheme, *extensions, *option, *summary;
    const char *cure; /* how to get it */
} io_backend_absent;

/* NULL past the last. */
const io_backend_absent *io_backend_absent_at(int32_t index);

/* Opens a shared object: a path, whose file is looked at first, since one that is cut short would
 * end the program with SIGBUS inside dlopen, which maps it unseen; or a name without a slash, which
 * the system looks for. NULL with what is wrong in *out_fault. */
void *io_object_open(const char *path, const char **out_fault);

/* ---- One plug-in: a shared object that exports rlf_backend_entry ---- */

/* Opens the shared object and checks its table. It stays in memory until the program ends: its
 * functions may be in use anywhere. Fails with a line that names the file and the cure. */
rlf_result io_plugin_open(const char *path, const rlf_backend **out);

#endif
