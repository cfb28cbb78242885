/* What a body is made of: models from files (rlf_model_load), and convex hulls from OBJ or around
 * points. */
#ifndef RLF_IO_MODEL_MODEL_H
#define RLF_IO_MODEL_MODEL_H

#include "relief/model.h"
#include "relief/snapshot.h"
#include "io/file.h"

/* Of a model's file, and of all that it names together. */
#define IO_MODEL_FILE_MAX ((size_t)64 << 20)
/* Vertices of a hull around a model: as many sample points as physics keeps of a shape. */
#define IO_MODEL_HULL_VERTICES 64
/* Nodes one in the other. */
#define IO_MODEL_DEPTH_MAX 256

#ifdef RLF_HAVE_QHULL
#define IO_WRAPS_MODELS true
#else
#define IO_WRAPS_MODELS false
#endif

typedef enum io_model_format {
    IO_MODEL_UNKNOWN = 0,
    IO_MODEL_OBJ = 1,
    IO_MODEL_GLTF = 2,
    IO_MODEL_GLB = 3
} io_model_format;

/* By the ending of the name. */
io_model_format io_model_format_of(const char *name);

/* file->name is the path that other files are found beside; they are not read when `is_alone`. */
rlf_result io_model_import(const io_bytes *file, io_model_format format, bool is_alone,
                           rlf_model **out);

/* Scale that makes the box fit into one of `size`, proportions kept; a side of 0 counts for
 * nothing. 0 when the box has no size. */
double io_model_fit(const rlf_aabb *box, rlf_vec3 size);

/* The convex hull of the model's vertices times `scale`, with its origin at the centre of mass; the
 * look places the model in it. rlf_free the hull. */
rlf_result io_model_hull(const char *name, const rlf_model *model, double scale, rlf_hull **out,
                         rlf_look *out_look);

/* ---- readers: what load.c puts together ---------------------------------------------------- */

/* A model in the making. Its arrays grow. */
typedef struct io_model_draft {
    const char *name;
    bool is_alone;
    size_t left; /* bytes that may still be read of other files */
    rlf_model_vertex *vertices;
    int32_t *triangles;
    int32_t vertex_count, triangle_count, vertex_room, triangle_room;
    rlf_model_part parts[RLF_MODEL_PARTS_MAX];
    int32_t part_count;
    rlf_image_rgba8 images[RLF_MODEL_TEXTURES_MAX];
    int32_t image_count;
    struct {
        char name[256];
        int32_t image; /* -1 = it cannot be had, which was warned of */
    } textures[RLF_MODEL_TEXTURES_MAX];
    int32_t texture_count;
    int64_t pixels; /* of all images */
} io_model_draft;

/* gltf.c, obj_model.c */
rlf_result io_model_read_gltf(io_model_draft *draft, const io_bytes *file);
rlf_result io_model_read_obj(io_model_draft *draft, const io_bytes *file);

/* Room for more vertices and triangles, or the line that says that there are too many. */
rlf_result io_model_reserve(io_model_draft *draft, int64_t vertices, int64_t triangles);
/* Vertices and triangles from these on, three corners of their own each: gives normals of length 0
 * those of the faces around, but keeps sharp edges; then joins vertices that are alike. */
rlf_result io_model_smooth(io_model_draft *draft, int32_t first_vertex, int32_t first_triangle);
/* RLF_ERROR_FORMAT names the first vertex from there on that has no usable number. */
rlf_result io_model_check_vertices(const io_model_draft *draft, int32_t first_vertex);

/* Reads a file that the model names. RLF_ERROR_UNSUPPORTED when it is neither in the model's folder
 * nor below, links followed: whoever made the model may not have files read for him. */
rlf_result io_model_read_beside(io_model_draft *draft, const char *name, io_buffer *buffer,
                                io_bytes *out);
/* *out is the index of the picture of that name, decoded when it is new: from `embedded`, or from
 * the file when that is NULL. -1 = it cannot be had, which is warned of once. */
rlf_result io_model_texture(io_model_draft *draft, const char *name, const io_bytes *embedded,
                            int32_t *out);

#endif
