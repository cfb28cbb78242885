/* Parts of scene.json while it is read. */
#ifndef RLF_IO_SCENE_READER_H
#define RLF_IO_SCENE_READER_H

#include "io/file.h"
#include "io/json.h"
#include "relief/math.h"
#include "relief/pipeline.h"

/* ---- scene.json from memory ---- */

#define IO_SCENE_BODIES_MAX 65536

/* `folder` is where relative names of models start. */
rlf_result io_scene_parse(const io_bytes *file, const char *folder, rlf_scene *out);

/* Parts of a scene that bodies and known objects share. Absent keys that are not required leave
 * *out as it is; the shape must be a def's default. */
rlf_result io_scene_read_name(const io_json_object *object, char out[RLF_NAME_MAX]);

/* A scene while it is read; models are kept in it. */
typedef struct io_scene_reader {
    const char *folder; /* where names of files start */
    json_t *bodies;     /* what each of scene->bodies was read from; NULL = none */
    json_t *names;      /* each with the path of the body or known object that has it */
    rlf_scene *scene;
    int32_t capacity; /* of scene->bodies */
} io_scene_reader;

/* body.c: room for `count` more bodies. */
rlf_result io_scene_reserve(io_scene_reader *reader, int32_t count);
/* Reads one more body of the scene, for which there is room; the scene has it also on failure. */
rlf_result io_scene_read_body(const io_json_object *body, const io_scene_reader *reader);
/* The scene's last body comes from `body`: an error when its name is taken. */
rlf_result io_scene_note_body(const io_json_object *body, const io_scene_reader *reader);
/* Logs tell bodies and models apart by their names: an error when it is taken. "" is no name. */
rlf_result io_scene_note_name(const io_json_object *body, const io_scene_reader *reader,
                              const char *name);
/* The list "bodies". */
rlf_result io_scene_read_bodies(const io_json_object *top, io_scene_reader *reader);
/* spawn.c: the list "spawn". */
rlf_result io_spawn_read(const io_json_object *top, io_scene_reader *reader);

/* shape.c: the look comes with the key "model". */
rlf_result io_scene_read_shape(const io_json_object *object, const io_scene_reader *reader,
                               rlf_shape *out, rlf_look *out_look);
/* model.c: keys "model" and "vertices" of a hull whose extents shall be `size` (0 = as
 * given), and "model" of another shape. */
rlf_result io_scene_read_hull(const io_json_object *object, const io_scene_reader *reader,
                              rlf_vec3 size, rlf_shape *out, rlf_look *out_look);
rlf_result io_scene_read_look(const io_json_object *object, const io_scene_reader *reader,
                              const rlf_shape *shape, rlf_look *out);

/* known.c: the list "known_objects". What is read is the scene's also on failure. */
rlf_result io_known_read(const io_json_object *top, const io_scene_reader *reader);

#endif
