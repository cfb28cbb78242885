/* The back ends of this build, and those of plug-ins. */
#ifndef RLF_IO_SOURCE_BACKENDS_H
#define RLF_IO_SOURCE_BACKENDS_H

#include "relief/backend.h"

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

#endif
