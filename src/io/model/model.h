/* Models from files: what stands behind rlf_model_load. */
#ifndef RLF_IO_MODEL_MODEL_H
#define RLF_IO_MODEL_MODEL_H

#include "relief/model.h"
#include "relief/snapshot.h"
#include "io/file.h"

/* Of a model's file, and of each file that it names. */
#define IO_MODEL_FILE_MAX ((size_t)64 << 20)
/* Vertices of a hull around a model: as many sample points as physics keeps of a shape. */
#define IO_MODEL_HULL_VERTICES 64

/* What this build can do. */
#ifdef RLF_HAVE_ASSIMP
#define IO_HAS_MODELS true
#else
#define IO_HAS_MODELS false
#endif
#if defined(RLF_HAVE_ASSIMP) && defined(RLF_HAVE_QHULL)
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

/* import.c, or absent.c where RELIEF_WITH_MODELS is off. file->name is the path that
 * other files are found beside; they are not read when `is_alone`. */
rlf_result io_model_import(const io_bytes *file, io_model_format format, bool is_alone,
                           rlf_model **out);

/* Scale that makes the box fit into one of `size`, proportions kept; a side of 0 counts for
 * nothing. 0 when the box has no size. */
double io_model_fit(const rlf_aabb *box, rlf_vec3 size);

/* The convex hull of the model's vertices times `scale`, with its origin at the centre of mass; the
 * look places the model in it. rlf_free the hull. */
rlf_result io_model_hull(const char *name, const rlf_model *model, double scale, rlf_hull **out,
                         rlf_look *out_look);

#endif
