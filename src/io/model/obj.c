/* Wavefront OBJ: vertices and faces. */
#include "io/model/obj.h"
#include "relief/model.h"
#include "io/file.h"

#include <stdlib.h>
#include <string.h>

#define CORNERS_MAX 1024 /* of a face: cutting it into triangles takes their square */
#define USES_MAX 65536   /* lines that begin a material */
#define POSITION_MAX_M 1e6
#define ROUNDING 1e-9
#define BLANKS " \t\r"

typedef struct parser {
    const char *name;
    int32_t line, uses, material;
    int32_t position_room, normal_room, uv_room, triangle_room;
    int32_t face[CORNERS_MAX][3];
    int32_t corner_count;
    io_obj *obj;
} parser;

/* ---- words ---------------------------------------------------------------------------------- */

char *io_obj_next_line(char **text, int32_t *line)
{
    char *begin = *text;
    if (*begin == '\0') {
        return NULL;
    }
    char *end = begin;
    *line += 1;
    while (*end != '\0' && *end != '\n') {
        size_t skip = *end != '\\'                       ? 0
                      : end[1] == '\n'                   ? 2
                      : end[1] == '\r' && end[2] == '\n' ? 3
                                                         : 0;
        memset(end, ' ', skip);
        end += skip > 0 ? skip : 1;
    }
    *text = *end == '\n' ? end + 1 : end;
    *end = '\0';
    return begin;
}

char *io_obj_next_word(char **line)
{
    char *word = *line + strspn(*line, BLANKS);
    char *end = word + strcspn(word, BLANKS);
    *line = *end != '\0' ? end + 1 : end;
    *end = '\0';
    return *word != '\0' ? word : NULL;
}

char *io_obj_rest(char *line)
{
    line += strspn(line, BLANKS);
    size_t length = strlen(line);
    while (length > 0 && strchr(BLANKS, line[length - 1]) != NULL) {
        length--;
    }
    line[length] = '\0';
    return line;
}

static rlf_result fail_line(const parser *p, const char *problem)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s:%d: %s", p->name, (int)p->line, problem);
}

/* ---- vertices ------------------------------------------------------------------------------- */

/* `needed` numbers of a line into a list; the others are 0 where they are missing. */
static rlf_result add_numbers(parser *p, char *line, int needed, rlf_vec3 **list, int32_t *count,
                              int32_t *room)
{
    double c[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        const char *word = io_obj_next_word(&line);
        const bool is_there = word != NULL && io_number_parse(word, &c[i]) &&
                              c[i] <= POSITION_MAX_M && c[i] >= -POSITION_MAX_M;
        if (!is_there && i < needed) {
            return fail_line(p, "a vertex must be \"v X Y Z\", \"vn X Y Z\" or \"vt U V\", in "
                                "numbers within a million: export it again");
        }
        c[i] = is_there ? c[i] : 0.0;
    }
    if (*count == RLF_MODEL_VERTICES_MAX) {
        return fail_line(p, "the model has more than 600000 vertices: simplify it");
    }
    rlf_result result = io_list_grow((void **)(void *)list, *count, 1, room, sizeof(**list));
    if (result == RLF_OK) {
        (*list)[(*count)++] = rlf_vec3_make(c[0], c[1], c[2]);
    }
    return result;
}

/* ---- faces ---------------------------------------------------------------------------------- */

/* Numbers count from 1, negative ones back from the last. -1 = there is none such. */
static int32_t index_of(long number, int32_t count)
{
    const long index = number > 0 ? number - 1 : count + number;
    return number != 0 && index >= 0 && index < count ? (int32_t)index : -1;
}

/* "7", "7/1", "7//3" or "7/1/3". */
static bool read_corner(const io_obj *obj, char *word, int32_t out[3])
{
    const int32_t counts[3] = {obj->position_count, obj->uv_count, obj->normal_count};
    out[0] = out[1] = out[2] = -1;
    for (int i = 0; i < 3; i++) {
        char *end = word;
        const long number = strtol(word, &end, 10);
        out[i] = end != word ? index_of(number, counts[i]) : -1;
        if (*end != '/') {
            return *end == '\0' && out[0] >= 0;
        }
        word = end + 1;
    }
    return false;
}

static rlf_result add_triangle(parser *p, int32_t a, int32_t b, int32_t c)
{
    io_obj *obj = p->obj;
    const int32_t corners[3] = {a, b, c};
    if (obj->triangle_count == RLF_MODEL_TRIANGLES_MAX) {
        return fail_line(p, "the model has more than 200000 triangles: simplify it");
    }
    int32_t room = p->triangle_room;
    rlf_result result = io_list_grow((void **)(void *)&obj->corners, obj->triangle_count, 1, &room,
                                     3 * sizeof(obj->corners[0]));
    if (result == RLF_OK) {
        result = io_list_grow((void **)(void *)&obj->materials, obj->triangle_count, 1,
                              &p->triangle_room, sizeof(obj->materials[0]));
    }
    if (result != RLF_OK) {
        return result;
    }
    for (int i = 0; i < 3; i++) {
        memcpy(obj->corners[3 * (ptrdiff_t)obj->triangle_count + i], p->face[corners[i]],
               sizeof(p->face[0]));
    }
    obj->materials[obj->triangle_count++] = p->material;
    return RLF_OK;
}

static rlf_vec3 place_of(const parser *p, int32_t corner)
{
    return p->obj->positions[p->face[corner][0]];
}

/* Twice the face's area along its normal (Newell). */
static rlf_vec3 face_normal(const parser *p)
{
    rlf_vec3 sum = rlf_vec3_make(0, 0, 0);
    for (int32_t i = 1; i + 1 < p->corner_count; i++) {
        sum = rlf_add(sum, rlf_cross(rlf_sub(place_of(p, i), place_of(p, 0)),
                                     rlf_sub(place_of(p, i + 1), place_of(p, 0))));
    }
    return sum;
}

/* How far c is to the left of the line from a to b. */
static double turn(rlf_vec3 normal, rlf_vec3 a, rlf_vec3 b, rlf_vec3 c)
{
    return rlf_dot(normal, rlf_cross(rlf_sub(b, a), rlf_sub(c, a)));
}

/* Whether the corner at `at` of those that are left can be cut off. */
static bool is_ear(const parser *p, rlf_vec3 normal, const int32_t *left, int32_t count, int32_t at)
{
    const int32_t before = (at + count - 1) % count, after = (at + 1) % count;
    const rlf_vec3 a = place_of(p, left[before]), b = place_of(p, left[at]),
                   c = place_of(p, left[after]);
    if (!(turn(normal, a, b, c) > 0.0)) {
        return false;
    }
    for (int32_t i = 0; i < count; i++) {
        const rlf_vec3 q = place_of(p, left[i]);
        if (i != before && i != at && i != after && turn(normal, a, b, q) > 0.0 &&
            turn(normal, b, c, q) > 0.0 && turn(normal, c, a, q) > 0.0) {
            return false;
        }
    }
    return true;
}

static bool is_convex(const parser *p, rlf_vec3 normal)
{
    for (int32_t i = 0; i < p->corner_count; i++) {
        const int32_t b = (i + 1) % p->corner_count, c = (i + 2) % p->corner_count;
        /* Corners on a line are rounded to either side. */
        if (turn(normal, place_of(p, i), place_of(p, b), place_of(p, c)) <
            -ROUNDING * rlf_dot(normal, normal)) {
            return false;
        }
    }
    return true;
}

/* A convex face as a fan; of another one ears are cut off. */
static rlf_result cut_face(parser *p)
{
    int32_t left[CORNERS_MAX];
    int32_t count = p->corner_count;
    const rlf_vec3 normal = face_normal(p);
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < count; i++) {
        left[i] = i;
    }
    int32_t misses = count <= 3 || is_convex(p, normal) ? count : 0;
    for (int32_t at = 0; count > 3 && misses < count && result == RLF_OK;) {
        at = at < count ? at : 0;
        if (!is_ear(p, normal, left, count, at)) {
            misses++;
            at++;
            continue;
        }
        result = add_triangle(p, left[(at + count - 1) % count], left[at], left[(at + 1) % count]);
        memmove(left + at, left + at + 1, (size_t)(count - at - 1) * sizeof(left[0]));
        count--;
        misses = 0;
    }
    for (int32_t i = 2; i < count && result == RLF_OK; i++) {
        result = add_triangle(p, left[0], left[i - 1], left[i]);
    }
    return result;
}

static rlf_result add_face(parser *p, char *line)
{
    p->corner_count = 0;
    for (char *word = io_obj_next_word(&line); word != NULL; word = io_obj_next_word(&line)) {
        if (p->corner_count == CORNERS_MAX) {
            return fail_line(p, "a face has more than 1024 corners: export it as triangles");
        }
        if (!read_corner(p->obj, word, p->face[p->corner_count++])) {
            return fail_line(p, "a face must be \"f A B C ...\" with numbers of earlier vertices");
        }
    }
    return p->corner_count >= 3 ? cut_face(p) : fail_line(p, "a face needs at least three corners");
}

/* ---- materials ------------------------------------------------------------------------------ */

static rlf_result use_material(parser *p, const char *name)
{
    io_obj *obj = p->obj;
    if (++p->uses > USES_MAX) {
        return fail_line(p, "more than 65536 uses of materials: join some");
    }
    for (p->material = 0; p->material < obj->material_count; p->material++) {
        if (strncmp(obj->names[p->material], name, sizeof(obj->names[0]) - 1) == 0) {
            return RLF_OK;
        }
    }
    if (obj->material_count == RLF_MODEL_PARTS_MAX) {
        return fail_line(p, "more than 1024 materials: join some");
    }
    if (obj->names == NULL) {
        obj->names = rlf_alloc_array(RLF_MODEL_PARTS_MAX, sizeof(obj->names[0]));
    }
    if (obj->names == NULL) {
        return RLF_ERROR_MEMORY;
    }
    (void)snprintf(obj->names[obj->material_count++], sizeof(obj->names[0]), "%s", name);
    return RLF_OK;
}

static rlf_result use_library(parser *p, const char *name)
{
    io_obj *obj = p->obj;
    if (obj->library_count == IO_OBJ_LIBRARIES_MAX) {
        return fail_line(p, "more than 8 libraries of materials: join some");
    }
    (void)snprintf(obj->libraries[obj->library_count++], sizeof(obj->libraries[0]), "%s", name);
    return RLF_OK;
}

/* ---- all of it ------------------------------------------------------------------------------ */

static rlf_result parse_line(parser *p, char *line)
{
    io_obj *obj = p->obj;
    const char *word = io_obj_next_word(&line);
    if (word == NULL) {
        return RLF_OK;
    }
    if (strcmp(word, "v") == 0) {
        return add_numbers(p, line, 3, &obj->positions, &obj->position_count, &p->position_room);
    }
    if (strcmp(word, "vn") == 0) {
        return add_numbers(p, line, 3, &obj->normals, &obj->normal_count, &p->normal_room);
    }
    if (strcmp(word, "vt") == 0) {
        return add_numbers(p, line, 1, &obj->uvs, &obj->uv_count, &p->uv_room);
    }
    if (strcmp(word, "f") == 0) {
        return add_face(p, line);
    }
    if (strcmp(word, "usemtl") == 0) {
        return use_material(p, io_obj_rest(line));
    }
    return strcmp(word, "mtllib") == 0 ? use_library(p, io_obj_rest(line)) : RLF_OK;
}

static rlf_result parse_lines(const io_bytes *file, char *text, io_obj *out)
{
    parser *p = rlf_alloc(sizeof(*p));
    if (p == NULL) {
        return RLF_ERROR_MEMORY;
    }
    p->name = file->name;
    p->material = -1;
    p->obj = out;
    rlf_result result = RLF_OK;
    for (char *line; result == RLF_OK && (line = io_obj_next_line(&text, &p->line)) != NULL;) {
        result = parse_line(p, line);
    }
    rlf_free(p);
    return result;
}

rlf_result io_obj_parse(const io_bytes *file, io_obj *out)
{
    memset(out, 0, sizeof(*out));
    if (file->size == 0 || memchr(file->data, '\0', file->size) != NULL) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is not an OBJ text file: export the model as Wavefront OBJ",
                        file->name);
    }
    char *text = rlf_alloc(file->size + 1);
    if (text == NULL) {
        return RLF_ERROR_MEMORY;
    }
    memcpy(text, file->data, file->size);
    rlf_result result = parse_lines(file, text, out);
    rlf_free(text);
    if (result != RLF_OK) {
        io_obj_free(out);
    }
    return result;
}

void io_obj_free(io_obj *obj)
{
    rlf_free(obj->positions);
    rlf_free(obj->normals);
    rlf_free(obj->uvs);
    rlf_free(obj->corners);
    rlf_free(obj->materials);
    rlf_free(obj->names);
    memset(obj, 0, sizeof(*obj));
}
