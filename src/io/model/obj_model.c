/* OBJ as a model: its materials, and one part for each that faces use. */
#include "io/model/model.h"
#include "io/model/obj.h"
#include "io/file.h"

#include <string.h>

/* What a library says of a material. */
typedef struct material {
    float color[3];
    char texture[256]; /* "" = none */
    float metallic, gloss;
} material;

static float share_of(double x)
{
    return x >= 0.0 && x <= 1.0 ? (float)x : 1.0f;
}

static void read_color(char *line, float out[3])
{
    for (int i = 0; i < 3; i++) {
        const char *word = io_obj_next_word(&line);
        double x = 1.0;
        out[i] = word != NULL && io_number_parse(word, &x) ? share_of(x) : 1.0f;
    }
}

/* The line's number, 0..most. */
static double number_within(char *line, double most)
{
    const char *word = io_obj_next_word(&line);
    double x = 0.0;
    return word != NULL && io_number_parse(word, &x) ? rlf_clamp(x, 0.0, most) : 0.0;
}

/* The roughness whose highlight is as wide as Phong's with an exponent, after Walter et al. 2007.
 */
static float gloss_of(double exponent)
{
    return (float)(1.0 - sqrt(sqrt(2.0 / (exponent + 2.0))));
}

/* A name may have blanks, unless options are before it. */
static void read_texture(char *line, char out[256])
{
    char *name = io_obj_rest(line);
    char *last = strrchr(name, ' ');
    (void)snprintf(out, 256, "%s", name[0] == '-' && last != NULL ? last + 1 : name);
}

static material *find(const io_obj *obj, material *materials, const char *name)
{
    for (int32_t i = 0; i < obj->material_count; i++) {
        if (strncmp(obj->names[i], name, sizeof(obj->names[0]) - 1) == 0) {
            return &materials[i];
        }
    }
    return NULL;
}

/* What the faces do not use is passed over. */
static void read_library(const io_obj *obj, char *text, material *materials)
{
    int32_t number = 0;
    material *m = NULL;
    for (char *line; (line = io_obj_next_line(&text, &number)) != NULL;) {
        const char *word = io_obj_next_word(&line);
        if (word == NULL) {
            continue;
        }
        if (strcmp(word, "newmtl") == 0) {
            m = find(obj, materials, io_obj_rest(line));
        } else if (m != NULL && strcmp(word, "Kd") == 0) {
            read_color(line, m->color);
        } else if (m != NULL && strcmp(word, "Ns") == 0) {
            m->gloss = gloss_of(number_within(line, 1000.0));
        } else if (m != NULL && strcmp(word, "Pr") == 0) {
            m->gloss = (float)(1.0 - number_within(line, 1.0));
        } else if (m != NULL && strcmp(word, "Pm") == 0) {
            m->metallic = (float)number_within(line, 1.0);
        } else if (m != NULL && strcmp(word, "map_Kd") == 0) {
            read_texture(line, m->texture);
        }
    }
}

/* A library that is not there is warned of, as is one that is no text. */
static rlf_result load_library(io_model_draft *d, const io_obj *obj, const char *name,
                               material *materials)
{
    io_buffer buffer = {0};
    io_bytes file;
    rlf_result result = io_model_read_beside(d, name, &buffer, &file);
    char *text = result == RLF_OK ? rlf_alloc(file.size + 1) : NULL;
    if (text != NULL) {
        memcpy(text, file.data, file.size);
        read_library(obj, text, materials);
    } else if (result == RLF_OK) {
        result = RLF_ERROR_MEMORY;
    }
    if (result == RLF_ERROR_IO) {
        rlf_log(RLF_LOG_WARNING, "%s: names %s, which cannot be read: drawn without it", d->name,
                name);
        result = RLF_OK;
    }
    rlf_free(text);
    io_buffer_free(&buffer);
    return result;
}

static rlf_model_vertex vertex_of(const io_obj *obj, const int32_t corner[3])
{
    const rlf_vec3 none = {0, 0, 0};
    const rlf_vec3 p = obj->positions[corner[0]];
    const rlf_vec3 uv = corner[1] >= 0 ? obj->uvs[corner[1]] : (rlf_vec3){0, 1, 0};
    const rlf_vec3 n = corner[2] >= 0 ? rlf_normalize(obj->normals[corner[2]]) : none;
    return (rlf_model_vertex){{(float)p.x, (float)p.y, (float)p.z},
                              {(float)n.x, (float)n.y, (float)n.z},
                              {(float)uv.x, (float)(1.0 - uv.y)}}; /* rows go down */
}

/* The triangles of one material; -1 = of none. */
static rlf_result add_part(io_model_draft *d, const io_obj *obj, int32_t index, const material *m)
{
    rlf_model_part part = {.first_triangle = d->triangle_count,
                           .color = {m->color[0], m->color[1], m->color[2]},
                           .texture = -1,
                           .metallic = m->metallic,
                           .gloss = m->gloss};
    for (int32_t t = 0; t < obj->triangle_count; t++) {
        if (obj->materials[t] != index) {
            continue;
        }
        for (int k = 0; k < 3; k++) {
            d->triangles[3 * (ptrdiff_t)d->triangle_count + k] = d->vertex_count;
            d->vertices[d->vertex_count++] = vertex_of(obj, obj->corners[3 * (ptrdiff_t)t + k]);
        }
        d->triangle_count++;
    }
    part.triangle_count = d->triangle_count - part.first_triangle;
    if (part.triangle_count == 0) {
        return RLF_OK;
    }
    if (d->part_count == RLF_MODEL_PARTS_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: has more than %d materials: join some", d->name,
                        RLF_MODEL_PARTS_MAX);
    }
    rlf_result result =
        m->texture[0] != '\0' ? io_model_texture(d, m->texture, NULL, &part.texture) : RLF_OK;
    d->parts[d->part_count++] = part;
    return result;
}

static rlf_result add_parts(io_model_draft *d, const io_obj *obj, const material *materials)
{
    static const material plain = {.color = {1.0f, 1.0f, 1.0f}};
    if (obj->triangle_count == 0) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the model has no triangles: export its faces, not points or lines",
                        d->name);
    }
    rlf_result result = io_model_reserve(d, 3 * (int64_t)obj->triangle_count, obj->triangle_count);
    for (int32_t i = -1; i < obj->material_count && result == RLF_OK; i++) {
        result = add_part(d, obj, i, i >= 0 ? &materials[i] : &plain);
    }
    result = result == RLF_OK ? io_model_check_vertices(d, 0) : result;
    return result == RLF_OK ? io_model_smooth(d, 0, 0) : result;
}

rlf_result io_model_read_obj(io_model_draft *d, const io_bytes *file)
{
    io_obj obj;
    rlf_result result = io_obj_parse(file, &obj);
    if (result != RLF_OK) {
        return result;
    }
    material *materials = rlf_alloc_array((size_t)obj.material_count + 1, sizeof(*materials));
    result = materials != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (int32_t i = 0; i < obj.material_count && result == RLF_OK; i++) {
        materials[i] = (material){.color = {1.0f, 1.0f, 1.0f}};
    }
    for (int32_t i = 0; i < obj.library_count && result == RLF_OK; i++) {
        result = load_library(d, &obj, obj.libraries[i], materials);
    }
    result = result == RLF_OK ? add_parts(d, &obj, materials) : result;
    rlf_free(materials);
    io_obj_free(&obj);
    return result;
}
