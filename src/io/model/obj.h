/* Wavefront OBJ. */
#ifndef RLF_IO_MODEL_OBJ_H
#define RLF_IO_MODEL_OBJ_H

#include "io/file.h"
#include "relief/math.h"

#define IO_OBJ_LIBRARIES_MAX 8
#define IO_OBJ_FILE_MAX ((size_t)64 << 20)

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
