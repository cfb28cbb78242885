/* glTF 2.0: the meshes that its scene shows, as one list of triangles. Each node is visited once,
 * and all that is drawn is counted before it takes memory. */
#include "io/model/gltf.h"
#include "io/model/obj.h"

#include <stdlib.h>
#include <string.h>

#define MESHES_MAX 65536

typedef struct affine {
    double m[3][4];
} affine;

/* One primitive at one place. */
typedef struct instance {
    const json_t *primitive;
    affine place;
} instance;

typedef struct scene {
    gltf *g;
    uint8_t *is_visited; /* of each node */
    instance *instances;
    int32_t count, room;
} scene;

/* ---- nodes ---------------------------------------------------------------------------------- */

static affine multiply(const affine *a, const affine *b)
{
    affine out = {{{0}}};
    for (int i = 0; i < 3; i++) {
        out.m[i][3] = a->m[i][3];
        for (int k = 0; k < 4; k++) {
            for (int j = 0; j < 3; j++) {
                out.m[i][k] += a->m[i][j] * b->m[j][k];
            }
        }
    }
    return out;
}

/* Keeps *out unless it is an array of so many numbers. */
static bool get_numbers(const json_t *object, const char *key, double *out, size_t count)
{
    const json_t *list = json_object_get(object, key);
    if (json_array_size(list) != count) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        out[i] = json_number_value(json_array_get(list, i));
    }
    return true;
}

/* Its matrix, or its translation, rotation and scale. */
static affine place_of(const json_t *node)
{
    double m[16], t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    affine out;
    if (get_numbers(node, "matrix", m, 16)) {
        for (int i = 0; i < 12; i++) {
            out.m[i / 4][i % 4] = m[i % 4 * 4 + i / 4];
        }
        return out;
    }
    get_numbers(node, "translation", t, 3);
    get_numbers(node, "rotation", q, 4);
    get_numbers(node, "scale", s, 3);
    const rlf_mat3 turn = rlf_quat_to_mat3(rlf_quat_normalize((rlf_quat){q[0], q[1], q[2], q[3]}));
    for (int i = 0; i < 12; i++) {
        out.m[i / 4][i % 4] = i % 4 == 3 ? t[i / 4] : turn.m[i / 4][i % 4] * s[i % 4];
    }
    return out;
}

static rlf_result add_primitives(scene *s, const json_t *mesh, const affine *place)
{
    const json_t *primitives = json_object_get(mesh, "primitives");
    for (size_t i = 0; i < json_array_size(primitives); i++) {
        if (s->count == MESHES_MAX) {
            return rlf_fail(RLF_ERROR_FORMAT, "%s: has more than %d meshes: join some",
                            s->g->draft->name, MESHES_MAX);
        }
        rlf_result result = io_list_grow((void **)(void *)&s->instances, s->count, 1, &s->room,
                                         sizeof(s->instances[0]));
        if (result != RLF_OK) {
            return result;
        }
        s->instances[s->count++] = (instance){json_array_get(primitives, i), *place};
    }
    return RLF_OK;
}

/* Each node has one parent: what is there twice would be read twice, its children four times. */
static rlf_result add_nodes(scene *s, const json_t *list, const affine *parent, int depth)
{
    const json_t *nodes = json_object_get(s->g->top, "nodes");
    rlf_result result = RLF_OK;
    if (depth > IO_MODEL_DEPTH_MAX) {
        return gltf_fail(s->g, "its parts are nested more than 256 deep");
    }
    for (size_t i = 0; i < json_array_size(list) && result == RLF_OK; i++) {
        const json_t *number = json_array_get(list, i);
        const json_int_t index = json_is_integer(number) ? json_integer_value(number) : -1;
        if (index < 0 || index >= (json_int_t)json_array_size(nodes)) {
            return gltf_fail(s->g, "a node names a child that is not there");
        }
        if (s->is_visited[index] != 0) {
            return gltf_fail(s->g, depth == 1 ? "a node is in a scene more than once"
                                              : "a node has more than one parent");
        }
        s->is_visited[index] = 1;
        const json_t *node = json_array_get(nodes, (size_t)index);
        const affine own = place_of(node);
        const affine place = multiply(parent, &own);
        result = add_primitives(s, gltf_named(s->g, node, "mesh", "meshes"), &place);
        if (result == RLF_OK) {
            result = add_nodes(s, json_object_get(node, "children"), &place, depth + 1);
        }
    }
    return result;
}

/* ---- materials ------------------------------------------------------------------------------ */

/* IEC 61966-2-1. */
static float srgb_of_linear(double linear)
{
    const double x = linear >= 0.0 && linear <= 1.0 ? linear : 1.0;
    return (float)(x <= 0.0031308 ? 12.92 * x : 1.055 * rlf_exp(rlf_log_e(x) / 2.4) - 0.055);
}

/* The texture's name: where its bytes are in the file, or the file beside it. */
static rlf_result find_texture(gltf *g, const json_t *image, int32_t *out)
{
    char name[256];
    const char *uri = json_string_value(json_object_get(image, "uri"));
    const bool is_data = uri != NULL && strncmp(uri, "data:", 5) == 0;
    if (uri != NULL && !is_data) {
        return io_model_texture(g->draft, uri, NULL, out);
    }
    io_buffer buffer = {0};
    io_bytes bytes = {"", NULL, 0};
    rlf_result result =
        is_data ? gltf_data(g, uri, &buffer, &bytes)
                : gltf_view(g, gltf_named(g, image, "bufferView", "bufferViews"), &bytes);
    if (result == RLF_ERROR_FORMAT) {
        bytes = (io_bytes){"", NULL, 0}; /* the decoder says that it is no picture */
        result = RLF_OK;
    }
    (void)snprintf(name, sizeof(name), "picture at %p", (const void *)image);
    bytes.name = "a picture in the file";
    result = result == RLF_OK ? io_model_texture(g->draft, name, &bytes, out) : result;
    io_buffer_free(&buffer);
    return result;
}

/* KHR_texture_transform: offset, rotation, scale. */
static void read_transform(const json_t *texture, double out[2][3])
{
    const json_t *t =
        json_object_get(json_object_get(texture, "extensions"), "KHR_texture_transform");
    double offset[2] = {0, 0}, scale[2] = {1, 1};
    const double turn = json_number_value(json_object_get(t, "rotation"));
    get_numbers(t, "offset", offset, 2);
    get_numbers(t, "scale", scale, 2);
    const double c = rlf_cos(turn), s = rlf_sin(turn);
    const double m[2][3] = {{c * scale[0], s * scale[1], offset[0]},
                            {-s * scale[0], c * scale[1], offset[1]}};
    memcpy(out, m, sizeof(m));
}

/* 0..1; 1 when it is not there. */
static float json_factor(const json_t *pbr, const char *key)
{
    const json_t *number = json_object_get(pbr, key);
    const double value = json_is_number(number) ? json_number_value(number) : 1.0;
    return (float)rlf_clamp(value, 0.0, 1.0);
}

/* The picture that a material's texture names; -1 = none, or one that cannot be had. */
static rlf_result read_texture(gltf *g, const json_t *texture, int32_t *out)
{
    const json_t *image =
        gltf_named(g, gltf_named(g, texture, "index", "textures"), "source", "images");
    *out = -1;
    return image != NULL ? find_texture(g, image, out) : RLF_OK;
}

/* Metal, roughness and normals. */
static rlf_result read_surface(gltf *g, const json_t *material, rlf_model_part *out)
{
    const json_t *pbr = json_object_get(material, "pbrMetallicRoughness");
    const json_t *texture = json_object_get(pbr, "metallicRoughnessTexture");
    int32_t normals = -1, surface = -1;
    rlf_result result = read_texture(g, json_object_get(material, "normalTexture"), &normals);
    result = result == RLF_OK ? read_texture(g, texture, &surface) : result;
    out->normal_texture = normals + 1;
    out->surface_texture = surface + 1;
    out->metallic = json_factor(pbr, "metallicFactor");
    out->gloss = 1.0f - json_factor(pbr, "roughnessFactor");
    if (pbr == NULL || (texture != NULL && surface < 0)) {
        out->metallic = 0.0f; /* painted, as most things are */
        out->gloss = 0.5f * (1.0f + out->gloss);
    }
    return result;
}

/* What is read of a material; `out_transform` is of texture coordinates. */
static rlf_result read_material(gltf *g, const json_t *material, rlf_model_part *out,
                                double out_transform[2][3])
{
    const json_t *pbr = json_object_get(material, "pbrMetallicRoughness");
    const json_t *gloss = json_object_get(json_object_get(material, "extensions"),
                                          "KHR_materials_pbrSpecularGlossiness");
    const json_t *texture = json_object_get(pbr, "baseColorTexture");
    texture = texture != NULL ? texture : json_object_get(gloss, "diffuseTexture");
    double color[4] = {1, 1, 1, 1};
    get_numbers(pbr, "baseColorFactor", color, 4);
    for (int i = 0; i < 3; i++) {
        out->color[i] = srgb_of_linear(color[i]);
    }
    rlf_result result = read_texture(g, texture, &out->texture);
    result = result == RLF_OK ? read_surface(g, material, out) : result;
    texture = texture != NULL ? texture : json_object_get(pbr, "metallicRoughnessTexture");
    texture = texture != NULL ? texture : json_object_get(material, "normalTexture");
    read_transform(texture, out_transform);
    return result;
}

/* ---- primitives ----------------------------------------------------------------------------- */

/* What a primitive's vertices go through. */
typedef struct primitive {
    io_model_draft *draft;
    const affine *place;
    const double (*transform)[3]; /* of texture coordinates */
    gltf_accessor position, normal, uv, corner;
    bool has_normals, has_uvs, has_corners;
    bool is_turned; /* mirrored, or the other side */
    int32_t mode, corner_count, first;
} primitive;

static void set_position(void *self, int32_t index, const double *value)
{
    const primitive *p = self;
    for (int k = 0; k < 3; k++) {
        const double *row = p->place->m[k];
        p->draft->vertices[p->first + index].position[k] =
            (float)(row[0] * value[0] + row[1] * value[1] + row[2] * value[2] + row[3]);
    }
}

/* Normals go by the cofactors: the inverse transposed, but for its size and sign. */
static void set_normal(void *self, int32_t index, const double *value)
{
    const primitive *p = self;
    const double sign = p->is_turned ? -1.0 : 1.0;
    rlf_vec3 column[3];
    for (int k = 0; k < 3; k++) {
        column[k] = rlf_vec3_make(p->place->m[0][k], p->place->m[1][k], p->place->m[2][k]);
    }
    rlf_vec3 sum = rlf_scale(rlf_cross(column[1], column[2]), sign * value[0]);
    sum = rlf_mad(sum, rlf_cross(column[2], column[0]), sign * value[1]);
    sum = rlf_normalize(rlf_mad(sum, rlf_cross(column[0], column[1]), sign * value[2]));
    float *normal = p->draft->vertices[p->first + index].normal;
    normal[0] = (float)sum.x;
    normal[1] = (float)sum.y;
    normal[2] = (float)sum.z;
}

static void set_uv(void *self, int32_t index, const double *value)
{
    const primitive *p = self;
    for (int k = 0; k < 2; k++) {
        const double *row = p->transform[k];
        p->draft->vertices[p->first + index].uv[k] =
            (float)(row[0] * value[0] + row[1] * value[1] + row[2]);
    }
}

static rlf_result fill(const gltf *g, primitive *p, const gltf_accessor *a,
                       void (*set)(void *self, int32_t index, const double *value))
{
    double value[4];
    for (int32_t i = 0; i < p->position.count && i < a->count; i++) {
        gltf_get(a, i, value);
        set(p, i, value);
    }
    return a->count == p->position.count ? RLF_OK
                                         : gltf_fail(g, "a mesh has lists of different lengths");
}

/* Corner `k` of triangle `t` among the vertices, or -1. */
static int32_t corner_of(const primitive *p, int32_t t, int32_t k)
{
    double number;
    int32_t at = 3 * t + k;
    if (p->mode == 5) { /* a strip: every other one is wound the other way round */
        at = t + (k > 0 && t % 2 == 1 ? 3 - k : k);
    } else if (p->mode == 6) { /* a fan */
        at = k == 0 ? 0 : t + k;
    }
    if (!p->has_corners) {
        return at;
    }
    gltf_get(&p->corner, at, &number);
    return number < (double)p->position.count ? (int32_t)number : -1;
}

static rlf_result fill_triangles(const gltf *g, primitive *p, int32_t count)
{
    io_model_draft *d = p->draft;
    for (int32_t t = 0; t < count; t++) {
        int32_t *out = &d->triangles[3 * (ptrdiff_t)d->triangle_count++];
        for (int32_t k = 0; k < 3; k++) {
            const int32_t corner = corner_of(p, t, k);
            if (corner < 0) {
                return gltf_fail(g, "a triangle names a vertex that is not there");
            }
            out[p->is_turned ? 2 - k : k] = p->first + corner;
        }
    }
    return RLF_OK;
}

/* Gives each corner from there on a vertex of its own, whose normal is yet to be made. */
static rlf_result part_corners(io_model_draft *d, int32_t first, int32_t first_triangle)
{
    const int32_t count = d->vertex_count - first;
    const int32_t corners = 3 * (d->triangle_count - first_triangle);
    rlf_model_vertex *copy = rlf_alloc_array((size_t)count, sizeof(*copy));
    rlf_result result = copy != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    if (result == RLF_OK) {
        memcpy(copy, d->vertices + first, (size_t)count * sizeof(*copy));
        d->vertex_count = first;
        result = io_model_reserve(d, corners, 0);
    }
    for (int32_t i = 0; i < corners && result == RLF_OK; i++) {
        int32_t *corner = &d->triangles[3 * (ptrdiff_t)first_triangle + i];
        d->vertices[d->vertex_count] = copy[*corner - first];
        *corner = d->vertex_count++;
    }
    rlf_free(copy);
    return result;
}

static rlf_result add_side(const gltf *g, primitive *p, int32_t triangles)
{
    io_model_draft *d = p->draft;
    const int32_t first_triangle = d->triangle_count;
    p->first = d->vertex_count;
    rlf_result result = io_model_reserve(d, p->position.count, triangles);
    if (result != RLF_OK) {
        return result;
    }
    memset(d->vertices + p->first, 0, (size_t)p->position.count * sizeof(d->vertices[0]));
    d->vertex_count += p->position.count;
    result = fill(g, p, &p->position, set_position);
    if (result == RLF_OK && p->has_normals) {
        result = fill(g, p, &p->normal, set_normal);
    }
    if (result == RLF_OK && p->has_uvs) {
        result = fill(g, p, &p->uv, set_uv);
    }
    result = result == RLF_OK ? io_model_check_vertices(d, p->first) : result;
    result = result == RLF_OK ? fill_triangles(g, p, triangles) : result;
    if (result == RLF_OK && !p->has_normals) {
        result = part_corners(d, p->first, first_triangle);
        result = result == RLF_OK ? io_model_smooth(d, p->first, first_triangle) : result;
    }
    return result;
}

static rlf_result access_named(const gltf *g, const json_t *object, const char *key,
                               const char *type, gltf_accessor *out, bool *out_is_there)
{
    *out_is_there = json_object_get(object, key) != NULL;
    return *out_is_there ? gltf_access(g, gltf_named(g, object, key, "accessors"), type, out)
                         : RLF_OK;
}

static rlf_result read_lists(const gltf *g, const json_t *object, primitive *p)
{
    const json_t *attributes = json_object_get(object, "attributes");
    bool has_positions = false;
    if (json_object_get(json_object_get(object, "extensions"), "KHR_draco_mesh_compression") !=
        NULL) {
        return gltf_fail(g, "its meshes are packed with Draco: choose no compression");
    }
    rlf_result result =
        access_named(g, attributes, "POSITION", "VEC3", &p->position, &has_positions);
    if (result == RLF_OK) {
        result = access_named(g, attributes, "NORMAL", "VEC3", &p->normal, &p->has_normals);
    }
    if (result == RLF_OK) {
        result = access_named(g, attributes, "TEXCOORD_0", "VEC2", &p->uv, &p->has_uvs);
    }
    if (result == RLF_OK) {
        result = access_named(g, object, "indices", "SCALAR", &p->corner, &p->has_corners);
    }
    const bool is_empty = p->position.count == 0;
    p->corner_count = is_empty ? 0 : p->has_corners ? p->corner.count : p->position.count;
    return result;
}

static double determinant(const affine *place)
{
    rlf_vec3 row[3];
    for (int i = 0; i < 3; i++) {
        row[i] = rlf_vec3_make(place->m[i][0], place->m[i][1], place->m[i][2]);
    }
    return rlf_dot(row[0], rlf_cross(row[1], row[2]));
}

/* Points and lines are left out. */
static rlf_result add_instance(gltf *g, const instance *in, bool is_two_sided, bool has_texture,
                               const double transform[2][3])
{
    primitive p = {.draft = g->draft, .place = &in->place, .transform = transform};
    p.mode = (int32_t)gltf_whole(in->primitive, "mode", 4);
    if (p.mode < 4 || p.mode > 6) {
        return RLF_OK;
    }
    rlf_result result = read_lists(g, in->primitive, &p);
    p.has_uvs = p.has_uvs && has_texture;
    const int32_t triangles = p.mode == 4           ? p.corner_count / 3
                              : p.corner_count >= 3 ? p.corner_count - 2
                                                    : 0;
    const bool is_mirrored = determinant(&in->place) < 0.0;
    for (int side = 0; side < (is_two_sided ? 2 : 1) && triangles > 0 && result == RLF_OK; side++) {
        p.is_turned = is_mirrored != (side == 1);
        result = add_side(g, &p, triangles);
    }
    return result;
}

/* The triangles of one material; -1 = of none. */
static rlf_result add_part(const scene *s, int64_t index)
{
    gltf *g = s->g;
    io_model_draft *d = g->draft;
    const json_t *materials = json_object_get(g->top, "materials");
    const json_t *material = index >= 0 ? json_array_get(materials, (size_t)index) : NULL;
    const bool is_two_sided = json_is_true(json_object_get(material, "doubleSided"));
    rlf_model_part part = {
        .first_triangle = d->triangle_count, .color = {1.0f, 1.0f, 1.0f}, .texture = -1};
    double transform[2][3] = {{1, 0, 0}, {0, 1, 0}};
    bool is_read = false;
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < s->count && result == RLF_OK; i++) {
        if (gltf_whole(s->instances[i].primitive, "material", -1) != index) {
            continue;
        }
        result = is_read ? RLF_OK : read_material(g, material, &part, transform);
        is_read = true;
        if (result == RLF_OK) {
            const bool has_textures =
                part.texture >= 0 || part.surface_texture > 0 || part.normal_texture > 0;
            result = add_instance(g, &s->instances[i], is_two_sided, has_textures,
                                  (const double(*)[3])transform);
        }
    }
    part.triangle_count = d->triangle_count - part.first_triangle;
    if (result == RLF_OK && part.triangle_count > 0) {
        d->parts[d->part_count++] = part;
    }
    return result;
}

/* ---- all of it ------------------------------------------------------------------------------ */

static rlf_result read_scene(scene *s)
{
    /* glTF is y up and looks along +z; here y is down and the camera looks along +z: half a turn
     * about x lets a model stand upright and face the camera. */
    static const affine root = {{{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}}};
    const json_t *top = s->g->top;
    const json_t *scenes = json_object_get(top, "scenes");
    const int64_t index = gltf_whole(top, "scene", 0);
    const json_t *shown = index >= 0 ? json_array_get(scenes, (size_t)index) : NULL;
    const size_t materials = json_array_size(json_object_get(top, "materials"));
    if (materials >= RLF_MODEL_PARTS_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: has %zu materials, fewer than %d are drawn: join some",
                        s->g->draft->name, materials, RLF_MODEL_PARTS_MAX);
    }
    if (shown == NULL) {
        return gltf_fail(s->g, "it has no scene");
    }
    rlf_result result = add_nodes(s, json_object_get(shown, "nodes"), &root, 1);
    for (int64_t i = -1; i < (int64_t)materials && result == RLF_OK; i++) {
        result = add_part(s, i);
    }
    return result;
}

rlf_result io_model_read_gltf(io_model_draft *d, const io_bytes *file)
{
    gltf g = {.draft = d};
    scene s = {.g = &g};
    rlf_result result = gltf_open(&g, file);
    if (result == RLF_OK) {
        s.is_visited = rlf_alloc(json_array_size(json_object_get(g.top, "nodes")) + 1);
        result = s.is_visited != NULL ? read_scene(&s) : RLF_ERROR_MEMORY;
    }
    rlf_free(s.is_visited);
    rlf_free(s.instances);
    gltf_close(&g);
    return result;
}
