/* scene.json from memory. */
#ifndef RLF_IO_SCENE_SCENE_H
#define RLF_IO_SCENE_SCENE_H

#include "relief/pipeline.h"
#include "io/file.h"

#define IO_SCENE_BODIES_MAX 65536

/* `folder` is where relative names of models start. */
rlf_result io_scene_parse(const io_bytes *file, const char *folder, rlf_scene *out);

#endif
