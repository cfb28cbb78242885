/* Relief: models, what a body looks like when that is not its collision shape.
 *
 * A model is a value: complete when made, never changed afterwards. Any number of bodies, worlds
 * and renderers on any threads may borrow one; it must outlive them. rlf_model_load (io.h) reads
 * one from a file. SPDX-License-Identifier: MIT */
#ifndef RELIEF_MODEL_H
#define RELIEF_MODEL_H

#include "relief/image.h"
#include "relief/math.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Limits of a model. What is beyond them is refused with a line that names the limit, before it
 * takes memory. */
#define RLF_MODEL_TRIANGLES_MAX 200000                       /* of all parts together */
#define RLF_MODEL_VERTICES_MAX (3 * RLF_MODEL_TRIANGLES_MAX) /* none shared by two triangles */
#define RLF_MODEL_PARTS_MAX 1024                             /* materials */
#define RLF_MODEL_TEXTURES_MAX 64                            /* pictures */
#define RLF_MODEL_IMAGE_MAX 8192   /* pixels on a side of a picture that may become a texture */
#define RLF_MODEL_TEXTURE_MAX 2048 /* pixels on a side that are kept of it */
#define RLF_MODEL_UV_MAX 1024      /* largest texture coordinate: a texture repeats so often */
#define RLF_MODEL_LEVELS_MAX 12    /* of a texture: 2048, 1024, ... 1 */

/* Eight floats without padding, as graphics APIs take them: stride 32, at 0, 12 and 24. */
typedef struct rlf_model_vertex {
    float position[3]; /* the model's own frame and unit: see rlf_look */
    float normal[3];   /* unit, outwards */
    float uv[2];       /* (0, 0) is the texture's upper left corner, (1, 1) its lower right one; it
                          repeats beyond them */
} rlf_model_vertex;

/* Triangles of one material, a run of the model's list. Parts do not overlap. */
typedef struct rlf_model_part {
    int32_t first_triangle, triangle_count; /* in the model's list; may be none */
    float color[3];                         /* base colour, sRGB 0..1: it multiplies the texture */
    int32_t texture;                        /* -1 = none */
    float metallic; /* 0..1: 0 = paint, rubber, wood; 1 = bare metal, whose colour is what it
                       mirrors */
    float gloss;    /* 0..1: 1 minus the roughness of glTF; 0 = matt */
    int32_t surface_texture; /* 1 + the index of the texture whose green multiplies the roughness
                                and whose blue the metal, as they are; 0 = none */
    int32_t normal_texture;  /* 1 + that of normals: red to larger u, green to smaller v, blue
                                outwards; 0 = none */
} rlf_model_part;

/* RGBA of a texture and of its smaller levels, one after the other without padding: a level has
 * half the width and height of the one before (but at least 1) and its means of 2x2. Alpha is kept
 * and not used. sRGB, averaged as it is, in 8 bits, so that the bits are the same everywhere. */
typedef struct rlf_model_texture {
    const uint8_t *texels; /* R, G, B, A per pixel; see rlf_model_texture_level */
    int32_t width, height; /* of level 0: powers of two, at most RLF_MODEL_TEXTURE_MAX */
    int32_t level_count;   /* down to 1 x 1 */
} rlf_model_texture;

/* Read only; from rlf_model_create, which puts all arrays into one block: nothing of it is freed by
 * itself. Indices and counts are within the limits above and were checked. */
typedef struct rlf_model {
    const rlf_model_vertex *vertices;  /* in the file's order */
    int32_t vertex_count;              /* at least 3 */
    const int32_t *triangles;          /* 3 indices each, counter-clockwise seen from outside */
    int32_t triangle_count;            /* at least 1 */
    const rlf_model_part *parts;       /* in order; together all triangles */
    int32_t part_count;                /* at least 1 */
    const rlf_model_texture *textures; /* NULL when there is none */
    int32_t texture_count;             /* of those that parts name */
    rlf_aabb box;                      /* of the vertices */
    double radius;                     /* of the vertices from the origin */
    uint64_t id;                       /* hash of all of the above: equal models have equal ids */
} rlf_model;

/* What a model is made of; all borrowed for the call and copied. From rlf_model_def_default; then
 * set at least vertices and triangles. */
typedef struct rlf_model_def {
    uint32_t cookie;  /* set by rlf_model_def_default */
    const char *name; /* begins error lines; default "model" */
    /* A normal of length 0 is worked out from the triangles around the vertex. */
    const rlf_model_vertex *vertices;
    int32_t vertex_count;          /* 3 to RLF_MODEL_VERTICES_MAX */
    const int32_t *triangles;      /* 3 indices each, counter-clockwise seen from outside */
    int32_t triangle_count;        /* 1 to RLF_MODEL_TRIANGLES_MAX */
    const rlf_model_part *parts;   /* NULL = one part, white, texture 0 if there is one */
    int32_t part_count;            /* 0 with NULL */
    const rlf_image_rgba8 *images; /* any size up to RLF_MODEL_IMAGE_MAX; kept as the next power of
                                      two, at most RLF_MODEL_TEXTURE_MAX */
    int32_t image_count;           /* 0 = no textures */
} rlf_model_def;

/* No geometry, no pictures, the name "model". */
RLF_API rlf_model_def rlf_model_def_default(void);

/* Copies the def's content into one block and works out box, radius and id. RLF_ERROR_INVALID names
 * what is wrong: no triangles, a limit above, a number that is not finite, an index that names
 * nothing; RLF_ERROR_MEMORY. *out is then NULL. Thread-safety: safe. */
RLF_API rlf_result rlf_model_create(const rlf_model_def *def, rlf_model **out);
/* Frees it and nulls the pointer; NULL is allowed. No body, world or renderer may borrow it any
 * more. */
RLF_API void rlf_model_destroy(rlf_model **model);

/* Byte offset of a level in a texture's texels, and its size in pixels. `level` is 0 ..
 * level_count; of level_count the offset is the size of all texels. Thread-safety: safe. */
RLF_API size_t rlf_model_texture_level(const rlf_model_texture *texture, int32_t level,
                                       int32_t *out_width, int32_t *out_height);

#ifdef __cplusplus
}
#endif
#endif
