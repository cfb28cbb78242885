/* The part of Wavefront OBJ that a hull needs: vertices and faces. */
#include "io/hull/hull.h"
#include "io/number.h"

#include <stdlib.h>
#include <string.h>

#define TOKENS_MAX 64 /* words of a line that are looked at: a face of 63 corners */

typedef struct parser {
    const char *name;
    int line;
    char *words[TOKENS_MAX];
    int word_count;
    io_mesh *mesh;
} parser;

static rlf_result fail_line(const parser *p, const char *problem)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s:%d: %s", p->name, p->line, problem);
}

/* Splits at blanks. False when there are too many words. */
static bool split(parser *p, char *line)
{
    p->word_count = 0;
    while (true) {
        line += strspn(line, " \t\r");
        if (*line == '\0') {
            return true;
        }
        if (p->word_count == TOKENS_MAX) {
            return false;
        }
        p->words[p->word_count++] = line;
        line += strcspn(line, " \t\r");
        if (*line != '\0') {
            *line++ = '\0';
        }
    }
}

static rlf_result add_vertex(parser *p)
{
    io_mesh *mesh = p->mesh;
    double c[3];
    for (int i = 0; i < 3; i++) {
        if (p->word_count < 4 || !io_number_parse(p->words[i + 1], &c[i]) || c[i] > 100.0 ||
            c[i] < -100.0) {
            return fail_line(p, "a vertex must be \"v X Y Z\" in metres, each within 100");
        }
    }
    if (mesh->vertex_count == IO_HULL_VERTICES_MAX) {
        return fail_line(p, "the hull has more than 4096 vertices: simplify it");
    }
    mesh->vertices[mesh->vertex_count++] = rlf_vec3_make(c[0], c[1], c[2]);
    return RLF_OK;
}

/* "7", "7/1", "7//3" or "7/1/3"; negative numbers count back from the last vertex. -1 = wrong. */
static int32_t corner_index(const parser *p, const char *word)
{
    char *end = NULL;
    long index = strtol(word, &end, 10);
    if (end == word || (*end != '\0' && *end != '/')) {
        return -1;
    }
    long zero_based = index > 0 ? index - 1 : p->mesh->vertex_count + index;
    bool is_valid = index != 0 && zero_based >= 0 && zero_based < p->mesh->vertex_count;
    return is_valid ? (int32_t)zero_based : -1;
}

static rlf_result add_face(parser *p)
{
    io_mesh *mesh = p->mesh;
    int corners = p->word_count - 1;
    int32_t index[TOKENS_MAX];
    for (int i = 0; i < corners; i++) {
        index[i] = corner_index(p, p->words[i + 1]);
        if (index[i] < 0) {
            return fail_line(p, "a face must be \"f A B C ...\" with numbers of earlier vertices");
        }
    }
    if (corners < 3) {
        return fail_line(p, "a face needs at least three corners");
    }
    for (int i = 2; i < corners; i++) {
        if (mesh->triangle_count == IO_HULL_TRIANGLES_MAX) {
            return fail_line(p, "the hull has more than 8192 triangles: simplify it");
        }
        int32_t *triangle = &mesh->triangles[(ptrdiff_t)mesh->triangle_count++ * 3];
        triangle[0] = index[0];
        triangle[1] = index[i - 1];
        triangle[2] = index[i];
    }
    return RLF_OK;
}

static rlf_result parse_line(parser *p, char *line)
{
    bool is_vertex = line[0] == 'v' && (line[1] == ' ' || line[1] == '\t');
    bool is_face = line[0] == 'f' && (line[1] == ' ' || line[1] == '\t');
    if (!is_vertex && !is_face) {
        return RLF_OK;
    }
    if (!split(p, line)) {
        return fail_line(p, "a line has more than 63 numbers: split the face");
    }
    return is_vertex ? add_vertex(p) : add_face(p);
}

static rlf_result parse_lines(parser *p, char *text)
{
    for (char *line = text; line != NULL;) {
        char *end = strchr(line, '\n');
        if (end != NULL) {
            *end = '\0';
        }
        p->line++;
        rlf_result result = parse_line(p, line);
        if (result != RLF_OK) {
            return result;
        }
        line = end != NULL ? end + 1 : NULL;
    }
    return RLF_OK;
}

rlf_result io_obj_parse(const io_bytes *file, io_mesh *out)
{
    memset(out, 0, sizeof(*out));
    if (file->size == 0 || memchr(file->data, '\0', file->size) != NULL) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is not an OBJ text file: export the hull as "
                        "Wavefront OBJ",
                        file->name);
    }
    char *text = rlf_alloc(file->size + 1);
    out->vertices = rlf_alloc_array(IO_HULL_VERTICES_MAX, sizeof(out->vertices[0]));
    out->triangles = rlf_alloc_array(IO_HULL_TRIANGLES_MAX, 3 * sizeof(out->triangles[0]));
    rlf_result result = RLF_ERROR_MEMORY;
    if (text != NULL && out->vertices != NULL && out->triangles != NULL) {
        memcpy(text, file->data, file->size);
        parser p = {.name = file->name, .mesh = out};
        result = parse_lines(&p, text);
    }
    rlf_free(text);
    if (result != RLF_OK) {
        io_mesh_free(out);
    }
    return result;
}

void io_mesh_free(io_mesh *mesh)
{
    rlf_free(mesh->vertices);
    rlf_free(mesh->triangles);
    memset(mesh, 0, sizeof(*mesh));
}

/* A line that begins with the word mtllib. */
static bool has_materials(const io_bytes *file)
{
    static const char word[] = "mtllib";
    const size_t length = sizeof(word) - 1;
    for (size_t i = 0; i + length < file->size; i++) {
        if ((i == 0 || file->data[i - 1] == '\n') && memcmp(file->data + i, word, length) == 0) {
            return true;
        }
    }
    return false;
}

rlf_result io_hull_load(const char *path, rlf_hull **out, io_obj_facts *out_facts)
{
    *out = NULL;
    io_obj_facts facts = {{0, 0, 0}, false};
    io_buffer buffer = {0};
    io_bytes file;
    io_mesh mesh;
    rlf_result result =
        io_file_read(path, IO_OBJ_FILE_MAX, "check the name of the model", &buffer, &file);
    if (result == RLF_OK) {
        facts.has_materials = has_materials(&file);
        result = io_obj_parse(&file, &mesh);
        if (result == RLF_OK) {
            result = io_hull_from_mesh(path, &mesh, out, &facts.centre);
            io_mesh_free(&mesh);
        }
    }
    io_buffer_free(&buffer);
    if (out_facts != NULL) {
        *out_facts = facts;
    }
    return result;
}
