/* scene.json from memory. */
#ifndef RLF_IO_SCENE_JSON_H
#define RLF_IO_SCENE_JSON_H

#include "relief/pipeline.h"
#include "io/json.h"

/* `folder` is where relative names of models start. */
rlf_result io_scene_parse(const io_bytes *file, const char *folder, rlf_scene *out);

/* Parts of a scene that bodies and known objects share. Absent keys that are not required leave
 * *out as it is; the shape must be a def's default. */
rlf_result io_scene_read_name(const io_json_object *object, char out[RLF_NAME_MAX]);
rlf_result io_scene_read_vec3(const io_json_object *object, const io_json_field *field,
                              rlf_vec3 *out);
rlf_result io_scene_read_orientation(const io_json_object *object, rlf_quat *out);
rlf_result io_scene_read_shape(const io_json_object *object, const char *folder, rlf_shape *out);

/* known_json.c: the list "known_objects". What is read is the scene's also on failure. */
rlf_result io_known_read(const io_json_object *top, const char *folder, rlf_scene *scene);

#endif
