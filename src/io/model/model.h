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

/* Limits of a hull that bodies collide with. */
#define IO_HULL_VERTICES_MAX 4096
#define IO_HULL_TRIANGLES_MAX 8192

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

/* ---- hulls ---------------------------------------------------------------------------------- */

/* A mesh while it is being made; both arrays are rlf_alloc'ed. */
typedef struct io_mesh {
    rlf_vec3 *vertices;
    int32_t vertex_count;
    int32_t *triangles;
    int32_t triangle_count;
} io_mesh;

void io_mesh_free(io_mesh *mesh);

/* Turns a closed convex mesh into a hull with its origin at the centre of mass, which goes to
 * *out_centre (NULL is allowed), and triangles counter-clockwise seen from outside. The hull and
 * its arrays are one rlf_alloc block. Vertices that no triangle uses are left out. RLF_ERROR_FORMAT
 * when it is open or not convex. */
rlf_result io_hull_from_mesh(const char *name, const io_mesh *mesh, rlf_hull **out,
                             rlf_vec3 *out_centre);

/* What a file says beside its mesh. */
typedef struct io_obj_facts {
    rlf_vec3 centre;    /* of mass, in the file's frame */
    bool has_materials; /* names a library of materials */
} io_obj_facts;

/* A closed convex OBJ; out_facts may be NULL. */
rlf_result io_hull_load(const char *path, rlf_hull **out, io_obj_facts *out_facts);
/* Grows a hull that io_hull_from_mesh made, about its centre. */
void io_hull_scale(rlf_hull *hull, double scale);
/* A copy in one rlf_alloc block; NULL when memory is short. */
rlf_hull *io_hull_copy(const rlf_hull *hull);

/* Triangles around all points, outward, between those points that are its corners; io_mesh_free it.
 * hull_qhull.c, or hull_absent.c where RELIEF_WITH_QHULL is off. */
rlf_result io_hull_wrap(const char *name, const rlf_vec3 *points, int32_t count, io_mesh *out);

/* rlf_hull_create with a name for error lines. */
rlf_result io_hull_of_points(const char *name, const rlf_vec3 *points, int32_t count,
                             int32_t vertex_limit, rlf_hull **out, rlf_vec3 *out_centre);

/* ---- readers: what import.c puts together ---------------------------------------------------- */

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

/* Room for `more` items in a list that has `count`; the limit is the caller's. */
rlf_result io_model_grow(void **items, int32_t count, int64_t more, int32_t *room, size_t size);
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

/* ---- OBJ ------------------------------------------------------------------------------------- */

#define IO_OBJ_LIBRARIES_MAX 8

/* The triangles of a Wavefront OBJ file. rlf_free'd by io_obj_free. */
typedef struct io_obj {
    rlf_vec3 *positions, *normals, *uvs;
    int32_t position_count, normal_count, uv_count;
    int32_t (*corners)[3]; /* position, uv, normal; -1 = none; three a triangle */
    int32_t *materials;    /* of each triangle; -1 = none */
    int32_t triangle_count;
    char (*names)[256]; /* of materials */
    int32_t material_count;
    char libraries[IO_OBJ_LIBRARIES_MAX][256];
    int32_t library_count;
} io_obj;

rlf_result io_obj_parse(const io_bytes *file, io_obj *out);
void io_obj_free(io_obj *obj);

/* The next line of a text that ends with a zero, cut off there; a backslash at its end joins it to
 * the one after. NULL at the end. *line counts. */
char *io_obj_next_line(char **text, int32_t *line);
/* The next word of a line, cut off there; NULL when there is none. */
char *io_obj_next_word(char **line);
/* What is left of a line, without blanks around. */
char *io_obj_rest(char *line);

#endif
