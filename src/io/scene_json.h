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

/* A scene while it is read; models are kept in it. */
typedef struct io_scene_reader {
    const char *folder;   /* where names of files start */
    const json_t *bodies; /* those in scene->bodies have been read; NULL = none */
    rlf_scene *scene;
} io_scene_reader;

/* scene_shape.c: the look comes with the key "model". */
rlf_result io_scene_read_shape(const io_json_object *object, const io_scene_reader *reader,
                               rlf_shape *out, rlf_look *out_look);
/* scene_model.c: keys "model" and "vertices" of a hull whose extents shall be `size` (0 = as
 * given), and "model" of another shape. */
rlf_result io_scene_read_hull(const io_json_object *object, const io_scene_reader *reader,
                              rlf_vec3 size, rlf_shape *out, rlf_look *out_look);
rlf_result io_scene_read_look(const io_json_object *object, const io_scene_reader *reader,
                              const rlf_shape *shape, rlf_look *out);

/* known_json.c: the list "known_objects". What is read is the scene's also on failure. */
rlf_result io_known_read(const io_json_object *top, const char *folder, rlf_scene *scene);

#endif
