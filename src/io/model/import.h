/* Steps of an import by assimp. */
#ifndef RLF_IO_MODEL_IMPORT_H
#define RLF_IO_MODEL_IMPORT_H

#include "io/model/model.h"

#include <assimp/material.h>
#include <assimp/scene.h>

/* Of nodes. */
#define IO_MODEL_DEPTH_MAX 256

/* check_gltf.c, check_obj.c: refuses what would cost assimp more memory, time or stack than a model
 * that can be drawn needs. glTF is the text or the binary kind; *out, in the buffer, is what of it
 * is drawn. OBJ or its MTL. */
rlf_result io_model_reduce_gltf(const io_bytes *file, io_buffer *buffer, io_bytes *out);
rlf_result io_model_check_obj(const io_bytes *file);

typedef struct io_affine {
    double m[3][4];
} io_affine;

/* A mesh at a place in the model. */
typedef struct io_model_instance {
    const struct aiMesh *mesh;
    io_affine place; /* to the model's frame */
} io_model_instance;

typedef struct io_model_draft {
    const char *name;
    const struct aiScene *scene;
    io_model_format format;
    bool is_alone;
    io_model_instance *instances;
    int32_t instance_count;
    rlf_model_vertex *vertices;
    int32_t *triangles;
    int32_t vertex_count, triangle_count;
    rlf_model_part parts[RLF_MODEL_PARTS_MAX];
    int32_t part_count;
    rlf_image_rgba8 images[RLF_MODEL_TEXTURES_MAX];
    char image_names[RLF_MODEL_TEXTURES_MAX][256]; /* as in the file; a NULL image was warned of */
    int32_t image_count;
    int32_t image_slot[RLF_MODEL_TEXTURES_MAX]; /* of the images that there are; -1 = warned of */
    int32_t slot_count;
    int64_t pixels; /* of all images */
} io_model_draft;

/* material.c: colour and texture of a material. What is missing is warned of, once; what memory
 * does not suffice for is an error. */
rlf_result io_model_material(io_model_draft *draft, const struct aiMaterial *material,
                             rlf_model_part *out);
bool io_model_is_two_sided(const io_model_draft *draft, const struct aiMesh *mesh);

/* mesh.c: fills vertices, triangles and parts. */
rlf_result io_model_collect(io_model_draft *draft);

#endif
