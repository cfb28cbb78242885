/* scene.json from memory. */
#ifndef RLF_IO_SCENE_JSON_H
#define RLF_IO_SCENE_JSON_H

#include "relief/pipeline.h"
#include "io/file.h"

/* `folder` is where relative names of models start. */
rlf_result io_scene_parse(const io_bytes *file, const char *folder, rlf_scene *out);

#endif
