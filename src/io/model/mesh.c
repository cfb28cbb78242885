/* The meshes of an imported file as one list of triangles, by material. */
#include "io/model/import.h"

#define MESHES_MAX 65536

static io_affine multiply(const io_affine *a, const struct aiMatrix4x4 *b)
{
    const double m[4][4] = {{(double)b->a1, (double)b->a2, (double)b->a3, (double)b->a4},
                            {(double)b->b1, (double)b->b2, (double)b->b3, (double)b->b4},
                            {(double)b->c1, (double)b->c2, (double)b->c3, (double)b->c4},
                            {0, 0, 0, 1}};
    io_affine out = {{{0}}};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 4; k++) {
            for (int j = 0; j < 4; j++) {
                out.m[i][k] += a->m[i][j] * m[j][k];
            }
        }
    }
    return out;
}

/* Meshes of the node and its children, which are IO_MODEL_DEPTH_MAX deep at most. */
static int64_t count_meshes(const struct aiNode *node)
{
    int64_t count = node->mNumMeshes;
    for (unsigned i = 0; i < node->mNumChildren; i++) {
        count += count_meshes(node->mChildren[i]);
    }
    return count;
}

/* Adds the node's meshes and its children's. */
static rlf_result add_node(io_model_draft *d, const struct aiNode *node, const io_affine *parent)
{
    const io_affine here = multiply(parent, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        if (node->mMeshes[i] >= d->scene->mNumMeshes) {
            return rlf_fail(RLF_ERROR_FORMAT, "%s: names a mesh that it has not", d->name);
        }
        io_model_instance *instance = &d->instances[d->instance_count++];
        instance->mesh = d->scene->mMeshes[node->mMeshes[i]];
        instance->place = here;
    }
    for (unsigned i = 0; i < node->mNumChildren; i++) {
        rlf_result result = add_node(d, node->mChildren[i], &here);
        if (result != RLF_OK) {
            return result;
        }
    }
    return RLF_OK;
}

/* How much there will be; two-sided triangles are there twice. */
static rlf_result check_size(const io_model_draft *d, int64_t *out_vertices, int64_t *out_triangles)
{
    *out_vertices = *out_triangles = 0;
    for (int32_t i = 0; i < d->instance_count; i++) {
        const struct aiMesh *mesh = d->instances[i].mesh;
        int64_t sides = io_model_is_two_sided(d, mesh) ? 2 : 1;
        *out_vertices += sides * mesh->mNumVertices;
        *out_triangles += sides * mesh->mNumFaces;
    }
    if (*out_triangles > RLF_MODEL_TRIANGLES_MAX || *out_vertices > RLF_MODEL_VERTICES_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the model has %lld triangles and %lld vertices, at most %d and %d are "
                        "drawn: simplify it",
                        d->name, (long long)*out_triangles, (long long)*out_vertices,
                        RLF_MODEL_TRIANGLES_MAX, RLF_MODEL_VERTICES_MAX);
    }
    return RLF_OK;
}

static double determinant(const io_affine *place)
{
    rlf_vec3 row[3];
    for (int i = 0; i < 3; i++) {
        row[i] = rlf_vec3_make(place->m[i][0], place->m[i][1], place->m[i][2]);
    }
    return rlf_dot(row[0], rlf_cross(row[1], row[2]));
}

/* Normals go by the cofactors: the inverse transposed, but for its size and sign. */
static void turn_normal(const io_affine *place, double sign, const struct aiVector3D *n,
                        float out[3])
{
    rlf_vec3 column[3];
    for (int k = 0; k < 3; k++) {
        column[k] = rlf_vec3_make(place->m[0][k], place->m[1][k], place->m[2][k]);
    }
    rlf_vec3 sum = rlf_scale(rlf_cross(column[1], column[2]), sign * (double)n->x);
    sum = rlf_mad(sum, rlf_cross(column[2], column[0]), sign * (double)n->y);
    sum = rlf_mad(sum, rlf_cross(column[0], column[1]), sign * (double)n->z);
    sum = rlf_normalize(sum);
    out[0] = (float)sum.x;
    out[1] = (float)sum.y;
    out[2] = (float)sum.z;
}

static void add_vertices(io_model_draft *d, const io_model_instance *instance, bool has_texture,
                         double sign)
{
    const struct aiMesh *mesh = instance->mesh;
    const struct aiVector3D *uv = has_texture ? mesh->mTextureCoords[0] : NULL;
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        rlf_model_vertex *v = &d->vertices[d->vertex_count++];
        const struct aiVector3D *p = &mesh->mVertices[i];
        for (int k = 0; k < 3; k++) {
            const double *row = instance->place.m[k];
            v->position[k] = (float)(row[0] * (double)p->x + row[1] * (double)p->y +
                                     row[2] * (double)p->z + row[3]);
        }
        if (mesh->mNormals != NULL) {
            turn_normal(&instance->place, sign, &mesh->mNormals[i], v->normal);
        }
        if (uv != NULL) {
            v->uv[0] = uv[i].x;
            v->uv[1] = uv[i].y;
        }
    }
}

/* Points and lines are left out. */
static rlf_result add_triangles(io_model_draft *d, const struct aiMesh *mesh, int32_t first,
                                bool is_turned)
{
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices != 3) {
            continue;
        }
        int32_t *corner = &d->triangles[3 * (ptrdiff_t)d->triangle_count++];
        for (unsigned k = 0; k < 3; k++) {
            if (face->mIndices[k] >= mesh->mNumVertices) {
                return rlf_fail(RLF_ERROR_FORMAT, "%s: a triangle names a vertex that is not there",
                                d->name);
            }
            corner[is_turned ? 2 - k : k] = first + (int32_t)face->mIndices[k];
        }
    }
    return RLF_OK;
}

static rlf_result add_instance(io_model_draft *d, const io_model_instance *instance,
                               bool has_texture)
{
    bool is_mirrored = determinant(&instance->place) < 0.0;
    int sides = io_model_is_two_sided(d, instance->mesh) ? 2 : 1;
    for (int side = 0; side < sides; side++) {
        bool is_turned = is_mirrored != (side == 1);
        int32_t first = d->vertex_count;
        add_vertices(d, instance, has_texture, is_turned ? -1.0 : 1.0);
        rlf_result result = add_triangles(d, instance->mesh, first, is_turned);
        if (result != RLF_OK) {
            return result;
        }
    }
    return RLF_OK;
}

static rlf_result add_part(io_model_draft *d, unsigned material)
{
    rlf_model_part part = {d->triangle_count, 0, {1.0f, 1.0f, 1.0f}, -1};
    bool is_known = false;
    for (int32_t i = 0; i < d->instance_count; i++) {
        const io_model_instance *instance = &d->instances[i];
        if (instance->mesh->mMaterialIndex != material) {
            continue;
        }
        if (!is_known) {
            rlf_result result = io_model_material(d, d->scene->mMaterials[material], &part);
            if (result != RLF_OK) {
                return result;
            }
            is_known = true;
        }
        rlf_result result = add_instance(d, instance, part.texture >= 0);
        if (result != RLF_OK) {
            return result;
        }
    }
    part.triangle_count = d->triangle_count - part.first_triangle;
    if (part.triangle_count > 0) {
        d->parts[d->part_count++] = part;
    }
    return RLF_OK;
}

rlf_result io_model_collect(io_model_draft *d)
{
    /* glTF is y up and looks along +z; here y is down and the camera looks along +z: half a turn
     * about x lets a model stand upright and face the camera. */
    double flip = d->format == IO_MODEL_OBJ ? 1.0 : -1.0;
    const io_affine root = {{{1, 0, 0, 0}, {0, flip, 0, 0}, {0, 0, flip, 0}}};
    const int64_t count = count_meshes(d->scene->mRootNode);
    if (count > MESHES_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: has %lld meshes, at most %d: join some", d->name,
                        (long long)count, MESHES_MAX);
    }
    d->instances = rlf_alloc_array((size_t)count, sizeof(*d->instances));
    if (d->instances == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = add_node(d, d->scene->mRootNode, &root);
    int64_t vertices = 0;
    int64_t triangles = 0;
    if (result == RLF_OK) {
        result = check_size(d, &vertices, &triangles);
    }
    if (result == RLF_OK && d->scene->mNumMaterials > RLF_MODEL_PARTS_MAX) {
        result = rlf_fail(RLF_ERROR_FORMAT, "%s: has %u materials, at most %d: join some", d->name,
                          d->scene->mNumMaterials, RLF_MODEL_PARTS_MAX);
    }
    if (result != RLF_OK) {
        return result;
    }
    d->vertices = rlf_alloc_array((size_t)vertices, sizeof(*d->vertices));
    d->triangles = rlf_alloc_array(3 * (size_t)triangles, sizeof(*d->triangles));
    if (d->vertices == NULL || d->triangles == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (unsigned i = 0; i < d->scene->mNumMaterials && result == RLF_OK; i++) {
        result = add_part(d, i);
    }
    return result;
}
