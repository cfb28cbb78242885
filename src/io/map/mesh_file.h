/* Kinds of mesh files. */
#ifndef RLF_IO_MAP_MESH_FILE_H
#define RLF_IO_MAP_MESH_FILE_H

#include "relief/map.h"
#include "io/file.h"

/* glTF 2.0 in one file: a JSON chunk and a binary one. */
rlf_result io_mesh_write_glb(io_out_file *file, const rlf_map_mesh *mesh);

/* Binary PLY; `frame` says in a comment how its axes lie. */
rlf_result io_mesh_write_ply(io_out_file *file, const rlf_map_mesh *mesh, const char *frame,
                             bool has_faces);

#endif
