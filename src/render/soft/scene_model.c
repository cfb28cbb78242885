/* Bodies that are drawn as models: their triangles as faces, each with a skin. */
#include "render/soft/passes.h"

#include "render/body_texture.h"
#include "render/soft/soft.h"

#include <string.h>

#define AT_ONCE 256 /* triangles between two looks at the room that is left */

static rlf_result reserve_corners(soft *s, int32_t count)
{
    if (count <= s->corner_capacity) {
        return RLF_OK;
    }
    rlf_free(s->corners);
    s->corners = rlf_alloc_array((size_t)count, sizeof(*s->corners));
    s->corner_capacity = s->corners != NULL ? count : 0;
    return s->corners != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

static rlf_result reserve_skins(soft_scene *scene, int32_t count)
{
    if (count <= scene->skin_capacity) {
        return RLF_OK;
    }
    int32_t capacity = count + count / 2;
    soft_skin *skins = rlf_alloc_array((size_t)capacity, sizeof(*skins));
    if (skins == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (scene->skins != NULL) {
        memcpy(skins, scene->skins, (size_t)scene->skin_count * sizeof(*skins));
        rlf_free(scene->skins);
    }
    scene->skins = skins;
    scene->skin_capacity = capacity;
    return RLF_OK;
}

/* All vertices of the model into s->corners. */
static void transform(soft *s, const rlf_look *look, const rlf_pose *T_picture_body)
{
    const rlf_quat q = rlf_quat_normalize(T_picture_body->q);
    const rlf_mat3 R = rlf_quat_to_mat3(q);
    for (int32_t i = 0; i < look->model->vertex_count; i++) {
        const rlf_model_vertex *v = &look->model->vertices[i];
        rlf_vec3 n = {(double)v->normal[0], (double)v->normal[1], (double)v->normal[2]};
        soft_corner *c = &s->corners[i];
        c->p = rlf_add(rlf_mat3_mul_vec(&R, body_look_point(look, v)), T_picture_body->p);
        c->attribute[SOFT_S] = v->uv[0];
        c->attribute[SOFT_T] = v->uv[1];
        caster_to_floats(rlf_mat3_mul_vec(&R, n), c->attribute + SOFT_NORMAL);
    }
}

/* True when the camera surely sees the triangle's back. */
static bool is_turned_away(const soft *s, const soft_corner corners[3])
{
    rlf_vec3 n =
        rlf_cross(rlf_sub(corners[1].p, corners[0].p), rlf_sub(corners[2].p, corners[0].p));
    return s->camera.distortion_model == RLF_DISTORTION_NONE && rlf_dot(n, corners[0].p) >= 0.0;
}

/* Where texture coordinates grow on the face, the longer one unit: Schueler 2006. */
static void set_tangents(const soft_corner corners[3], soft_skin *out)
{
    const rlf_vec3 a = rlf_sub(corners[1].p, corners[0].p);
    const rlf_vec3 b = rlf_sub(corners[2].p, corners[0].p);
    const rlf_vec3 n = rlf_cross(a, b);
    const rlf_vec3 by_a = rlf_cross(b, n);
    const rlf_vec3 by_b = rlf_cross(n, a);
    rlf_vec3 grow[2];
    for (int k = 0; k < 2; k++) {
        const double from = (double)corners[0].attribute[k];
        grow[k] = rlf_mad(rlf_scale(by_a, (double)corners[1].attribute[k] - from), by_b,
                          (double)corners[2].attribute[k] - from);
    }
    const double most = rlf_max(rlf_dot(grow[0], grow[0]), rlf_dot(grow[1], grow[1]));
    const double scale = most > 0.0 ? 1.0 / sqrt(most) : 0.0;
    caster_to_floats(rlf_scale(grow[0], scale), out->across);
    caster_to_floats(rlf_scale(grow[1], -scale), out->up);
}

static void put_skin(soft_scene *scene, const soft_skin *part, const soft_corner corners[3])
{
    soft_skin *skin = &scene->skins[scene->skin_count++];
    *skin = *part;
    if (part->normals != NULL) {
        set_tangents(corners, skin);
    }
    for (int k = 0; k < 2; k++) {
        skin->low[k] = skin->high[k] = corners[0].attribute[k];
        for (int i = 1; i < 3; i++) {
            float at = corners[i].attribute[k];
            skin->low[k] = at < skin->low[k] ? at : skin->low[k];
            skin->high[k] = at > skin->high[k] ? at : skin->high[k];
        }
    }
}

static rlf_result add_triangles(soft *s, const int32_t *indices, int32_t count,
                                const soft_skin *part, int32_t body)
{
    soft_scene *scene = &s->scene;
    rlf_result result = soft_scene_reserve(s, scene->face_count + 2 * count);
    if (result == RLF_OK) {
        result = reserve_skins(scene, scene->skin_count + count);
    }
    for (int32_t i = 0; i < 3 * count && result == RLF_OK; i += 3) {
        const soft_corner corners[3] = {s->corners[indices[i]], s->corners[indices[i + 1]],
                                        s->corners[indices[i + 2]]};
        int32_t first = scene->face_count;
        if (!is_turned_away(s, corners)) {
            soft_scene_add_face(s, corners, 3, body);
        }
        for (int32_t f = first; f < scene->face_count; f++) {
            scene->faces[f].skin = scene->skin_count;
        }
        if (scene->face_count > first) {
            put_skin(scene, part, corners);
        }
    }
    return result;
}

/* One more than its index; 0 = none. */
static const rlf_model_texture *texture_of(const rlf_model *model, int32_t number)
{
    return number > 0 ? &model->textures[number - 1] : NULL;
}

rlf_result soft_scene_add_model(soft *s, const rlf_look *look, const rlf_pose *T_picture_body,
                                int32_t body)
{
    const rlf_model *model = look->model;
    rlf_result result = reserve_corners(s, model->vertex_count);
    if (result == RLF_OK) {
        transform(s, look, T_picture_body);
    }
    for (int32_t i = 0; i < model->part_count && result == RLF_OK; i++) {
        const rlf_model_part *part = &model->parts[i];
        soft_skin skin = {.texture = texture_of(model, part->texture + 1),
                          .surface = texture_of(model, part->surface_texture),
                          .normals = texture_of(model, part->normal_texture)};
        skin.material = (probe_material){part->metallic, 1.0f - part->gloss};
        for (int k = 0; k < 3; k++) {
            skin.color[k] = s->scene.bodies[body].color[k] * part->color[k] * part->color[k];
        }
        const int32_t end = part->first_triangle + part->triangle_count;
        for (int32_t t = part->first_triangle; t < end && result == RLF_OK; t += AT_ONCE) {
            const int32_t count = end - t < AT_ONCE ? end - t : AT_ONCE;
            result = add_triangles(s, model->triangles + 3 * (ptrdiff_t)t, count, &skin, body);
        }
    }
    return result;
}
