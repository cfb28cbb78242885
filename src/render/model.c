/* Models: checks, normals, and everything in one block of memory. */
#include "render/body_texture.h"

#include "base/checks.h"

#include <string.h>

#define POSITION_MAX 1e6f
#define ALIGN 64

/* The one block: the model first, then its arrays. */
typedef struct layout {
    size_t vertices, triangles, parts, textures, texels, size;
} layout;

rlf_model_def rlf_model_def_default(void)
{
    rlf_model_def def = {.cookie = RLF_DEF_COOKIE, .name = "model"};
    return def;
}

/* ---- checks --------------------------------------------------------------------------------- */

static rlf_result check_counts(const rlf_model_def *def)
{
    if (def->triangle_count < 1 || def->vertex_count < 1) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the model has no triangles: export its faces, not points or lines",
                        def->name);
    }
    if (def->triangle_count > RLF_MODEL_TRIANGLES_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the model has %d triangles, at most %d are drawn: simplify it",
                        def->name, (int)def->triangle_count, RLF_MODEL_TRIANGLES_MAX);
    }
    if (def->vertex_count > RLF_MODEL_VERTICES_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the model has %d vertices, at most %d are drawn: simplify it",
                        def->name, (int)def->vertex_count, RLF_MODEL_VERTICES_MAX);
    }
    if (def->part_count < 0 || def->part_count > RLF_MODEL_PARTS_MAX || def->image_count < 0 ||
        def->image_count > RLF_MODEL_TEXTURES_MAX) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the model has %d materials and %d textures, at most %d and %d are "
                        "drawn: join some",
                        def->name, (int)def->part_count, (int)def->image_count, RLF_MODEL_PARTS_MAX,
                        RLF_MODEL_TEXTURES_MAX);
    }
    return RLF_OK;
}

/* False for NaN too. */
static bool is_within(const float *values, int count, float limit)
{
    for (int i = 0; i < count; i++) {
        if (!(values[i] >= -limit && values[i] <= limit)) {
            return false;
        }
    }
    return true;
}

static rlf_result check_mesh(const rlf_model_def *def)
{
    for (int32_t i = 0; i < def->vertex_count; i++) {
        const rlf_model_vertex *v = &def->vertices[i];
        const char *field = NULL;
        if (!is_within(v->position, 3, POSITION_MAX)) {
            field = "position";
        } else if (!is_within(v->normal, 3, 1e6f)) {
            field = "normal";
        } else if (!is_within(v->uv, 2, RLF_MODEL_UV_MAX)) {
            field = "texture coordinate";
        }
        if (field != NULL) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: the %s of vertex %d is not a number that can be used: export the "
                            "model again",
                            def->name, field, (int)i);
        }
    }
    for (int32_t i = 0; i < 3 * def->triangle_count; i++) {
        if (def->triangles[i] < 0 || def->triangles[i] >= def->vertex_count) {
            return rlf_fail(RLF_ERROR_INVALID, "%s: triangle %d names vertex %d of %d", def->name,
                            (int)(i / 3), (int)def->triangles[i], (int)def->vertex_count);
        }
    }
    return RLF_OK;
}

static rlf_result check_parts(const rlf_model_def *def)
{
    int32_t next = 0;
    for (int32_t i = 0; i < def->part_count; i++) {
        const rlf_model_part *part = &def->parts[i];
        if (part->first_triangle != next || part->triangle_count < 0 ||
            part->triangle_count > def->triangle_count - next || part->texture < -1 ||
            part->texture >= def->image_count || part->surface_texture < 0 ||
            part->surface_texture > def->image_count || part->normal_texture < 0 ||
            part->normal_texture > def->image_count || !is_within(part->color, 3, 1.0f) ||
            part->color[0] < 0.0f || part->color[1] < 0.0f || part->color[2] < 0.0f ||
            !(part->metallic >= 0.0f && part->metallic <= 1.0f) ||
            !(part->gloss >= 0.0f && part->gloss <= 1.0f)) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: part %d: triangles must follow those of the part before, colours, "
                            "metallic and gloss be 0 to 1, and the textures be there",
                            def->name, (int)i);
        }
        next += part->triangle_count;
    }
    if (def->part_count > 0 && next != def->triangle_count) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: the parts have %d of %d triangles", def->name,
                        (int)next, (int)def->triangle_count);
    }
    return RLF_OK;
}

static rlf_result check_images(const rlf_model_def *def)
{
    for (int32_t i = 0; i < def->image_count; i++) {
        const rlf_image_rgba8 *image = &def->images[i];
        if (image->data == NULL || image->width < 1 || image->height < 1 ||
            image->width > RLF_MODEL_IMAGE_MAX || image->height > RLF_MODEL_IMAGE_MAX) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: texture %d is %d x %d: use 1 to %d pixels on a side", def->name,
                            (int)i, (int)image->width, (int)image->height, RLF_MODEL_IMAGE_MAX);
        }
    }
    return RLF_OK;
}

static rlf_result check_def(const rlf_model_def *def)
{
    rlf_result result = check_counts(def);
    if (result == RLF_OK) {
        result = check_mesh(def);
    }
    if (result == RLF_OK) {
        result = check_parts(def);
    }
    return result == RLF_OK ? check_images(def) : result;
}

/* ---- content -------------------------------------------------------------------------------- */

static size_t room(size_t *size, size_t bytes)
{
    size_t at = *size;
    *size += (bytes + ALIGN - 1) / ALIGN * ALIGN;
    return at;
}

static layout lay_out(const rlf_model_def *def)
{
    layout l = {.size = 0};
    (void)room(&l.size, sizeof(rlf_model));
    size_t parts = def->part_count > 0 ? (size_t)def->part_count : 1;
    l.vertices = room(&l.size, (size_t)def->vertex_count * sizeof(rlf_model_vertex));
    l.triangles = room(&l.size, 3 * (size_t)def->triangle_count * sizeof(int32_t));
    l.parts = room(&l.size, parts * sizeof(rlf_model_part));
    l.textures = room(&l.size, (size_t)def->image_count * sizeof(rlf_model_texture));
    l.texels = l.size;
    for (int32_t i = 0; i < def->image_count; i++) {
        rlf_model_texture texture = model_texture_fit(&def->images[i]);
        (void)room(&l.size, model_texture_bytes(&texture));
    }
    return l;
}

static rlf_vec3 vec3_of(const float v[3])
{
    return rlf_vec3_make((double)v[0], (double)v[1], (double)v[2]);
}

static void put_vec3(rlf_vec3 v, float out[3])
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

static bool has_normal(const rlf_model_vertex *v)
{
    return rlf_dot(vec3_of(v->normal), vec3_of(v->normal)) > 1e-12;
}

/* A vertex without a normal gets the sum of its triangles' normals, larger ones counting more. */
static void fill_normals(const rlf_model_def *def, rlf_model_vertex *vertices)
{
    for (int32_t i = 0; i < 3 * def->triangle_count; i += 3) {
        const int32_t *corner = def->triangles + i;
        rlf_vec3 a = vec3_of(vertices[corner[0]].position);
        rlf_vec3 n = rlf_cross(rlf_sub(vec3_of(vertices[corner[1]].position), a),
                               rlf_sub(vec3_of(vertices[corner[2]].position), a));
        for (int k = 0; k < 3; k++) {
            if (!has_normal(&def->vertices[corner[k]])) {
                float *sum = vertices[corner[k]].normal;
                put_vec3(rlf_add(vec3_of(sum), n), sum);
            }
        }
    }
    for (int32_t i = 0; i < def->vertex_count; i++) {
        put_vec3(rlf_normalize(vec3_of(vertices[i].normal)), vertices[i].normal);
    }
}

/* FNV-1a, 64 bits. */
static uint64_t hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * 0x100000001b3u;
    }
    return hash;
}

static void measure(rlf_model *model)
{
    model->box = rlf_aabb_empty();
    for (int32_t i = 0; i < model->vertex_count; i++) {
        rlf_vec3 p = vec3_of(model->vertices[i].position);
        rlf_aabb_extend(&model->box, p);
        model->radius = rlf_max(model->radius, rlf_length(p));
    }
    uint64_t hash = 0xcbf29ce484222325u;
    hash =
        hash_bytes(hash, model->vertices, (size_t)model->vertex_count * sizeof(*model->vertices));
    hash = hash_bytes(hash, model->triangles, 3 * (size_t)model->triangle_count * sizeof(int32_t));
    hash = hash_bytes(hash, model->parts, (size_t)model->part_count * sizeof(*model->parts));
    for (int32_t i = 0; i < model->texture_count; i++) {
        const rlf_model_texture *t = &model->textures[i];
        hash = hash_bytes(hash, t->texels, 4 * (size_t)t->width * (size_t)t->height);
    }
    model->id = hash;
}

static void fill_textures(const rlf_model_def *def, uint8_t *texels, rlf_model_texture *out)
{
    for (int32_t i = 0; i < def->image_count; i++) {
        out[i] = model_texture_fit(&def->images[i]);
        out[i].texels = texels;
        model_texture_fill(&def->images[i], &out[i], texels);
        size_t used = 0;
        (void)room(&used, model_texture_bytes(&out[i]));
        texels += used;
    }
}

/* Arrays of the block, which the model shows as read only. */
static rlf_model *build(const rlf_model_def *def)
{
    layout l = lay_out(def);
    char *block = rlf_alloc(l.size);
    if (block == NULL) {
        return NULL;
    }
    rlf_model_vertex *vertices = (rlf_model_vertex *)(void *)(block + l.vertices);
    int32_t *triangles = (int32_t *)(void *)(block + l.triangles);
    rlf_model_part *parts = (rlf_model_part *)(void *)(block + l.parts);
    rlf_model_texture *textures = (rlf_model_texture *)(void *)(block + l.textures);
    memcpy(vertices, def->vertices, (size_t)def->vertex_count * sizeof(*vertices));
    fill_normals(def, vertices);
    memcpy(triangles, def->triangles, 3 * (size_t)def->triangle_count * sizeof(*triangles));
    if (def->part_count > 0) {
        memcpy(parts, def->parts, (size_t)def->part_count * sizeof(*parts));
    } else {
        int32_t texture = def->image_count > 0 ? 0 : -1;
        parts[0] = (rlf_model_part){
            .triangle_count = def->triangle_count, .color = {1.0f, 1.0f, 1.0f}, .texture = texture};
    }
    fill_textures(def, (uint8_t *)block + l.texels, textures);
    rlf_model *model = (rlf_model *)(void *)block;
    *model = (rlf_model){.vertices = vertices,
                         .vertex_count = def->vertex_count,
                         .triangles = triangles,
                         .triangle_count = def->triangle_count,
                         .parts = parts,
                         .part_count = def->part_count > 0 ? def->part_count : 1,
                         .textures = textures,
                         .texture_count = def->image_count};
    measure(model);
    return model;
}

rlf_result rlf_model_create(const rlf_model_def *def, rlf_model **out)
{
    if (!RLF_ASSERT(def != NULL && out != NULL) || !RLF_ASSERT(def->cookie == RLF_DEF_COOKIE)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = check_def(def);
    if (result == RLF_OK) {
        *out = build(def);
        result = *out != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    return result;
}

void rlf_model_destroy(rlf_model **model)
{
    if (model != NULL) {
        rlf_free(*model);
        *model = NULL;
    }
}
