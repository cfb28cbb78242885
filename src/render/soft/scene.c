/* Bodies of a snapshot as faces in the picture, nearest body first. */
#include "render/soft/passes.h"

#include "render/body_texture.h"
#include "render/soft/soft.h"

#include <string.h>

#define BODIES_AT_ONCE 8    /* per worker */
#define BODIES_FOR_GRID 16  /* of fewer each is looked at sooner than the whole surface */
#define FINE_FOCAL_PX 800.0 /* from here on shadows are as coarse as on half as many pixels */

/* What one body's vertices go through. */
typedef struct body_transform {
    rlf_mat3 R; /* T_picture_body */
    rlf_vec3 p;
    shape_mesh_scale scale;
} body_transform;

static rlf_result reserve_bodies(soft_scene *scene, int32_t count)
{
    if (count <= scene->body_capacity) {
        return RLF_OK;
    }
    soft_body *bodies = rlf_alloc_array((size_t)count * 2, sizeof(*bodies));
    if (bodies == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_free(scene->bodies);
    rlf_free(scene->casters);
    rlf_free(scene->reach);
    rlf_free(scene->real_shades);
    rlf_free(scene->obscurances);
    scene->bodies = bodies;
    scene->casters = rlf_alloc_array((size_t)count * 2, sizeof(*scene->casters));
    scene->reach = rlf_alloc_array((size_t)count * 2, sizeof(*scene->reach));
    scene->real_shades = rlf_alloc_array((size_t)count * 2, sizeof(*scene->real_shades));
    scene->obscurances = rlf_alloc_array((size_t)count * 2, sizeof(*scene->obscurances));
    bool has_all = scene->casters != NULL && scene->reach != NULL && scene->real_shades != NULL &&
                   scene->obscurances != NULL;
    scene->body_capacity = has_all ? count * 2 : 0;
    return has_all ? RLF_OK : RLF_ERROR_MEMORY;
}

static double magnitude(double x)
{
    return x < 0.0 ? -x : x;
}

/* False when the bounding sphere (centre c, radius r) is surely outside the picture. With
 * c_z >= 2 r, a point of it differs from the centre by at most 2 r (1 + |c_x / c_z|) / c_z in x /
 * z, and alike in y. */
static bool may_be_seen(const soft *s, rlf_vec3 center, double radius)
{
    if (!rlf_vec3_is_finite(center) || !rlf_is_finite(radius) || center.z + radius < SOFT_NEAR_Z) {
        return false;
    }
    const rlf_camera *k = &s->camera;
    if (k->distortion_model != RLF_DISTORTION_NONE || center.z < 2.0 * radius) {
        return true;
    }
    double x = center.x / center.z;
    double y = center.y / center.z;
    double u = k->fx * x + k->cx;
    double v = k->fy * y + k->cy;
    double reach = 2.0 * radius / center.z;
    double reach_u = k->fx * reach * (1.0 + magnitude(x)) + 1.0;
    double reach_v = k->fy * reach * (1.0 + magnitude(y)) + 1.0;
    return u > -reach_u && u < k->width + reach_u && v > -reach_v && v < k->height + reach_v;
}

static soft_corner transform_corner(const body_transform *T, const shape_vertex *v)
{
    rlf_vec3 p = {v->position[0] * T->scale.scale.x,
                  v->position[1] * T->scale.scale.y + v->shift * T->scale.half_height,
                  v->position[2] * T->scale.scale.z};
    const rlf_vec3 n = rlf_mat3_mul_vec(
        &T->R, rlf_vec3_make((double)v->normal[0], (double)v->normal[1], (double)v->normal[2]));
    soft_corner c;
    c.p = rlf_add(rlf_mat3_mul_vec(&T->R, p), T->p);
    c.attribute[SOFT_S] = v->uv[0];
    c.attribute[SOFT_T] = v->uv[1];
    caster_to_floats(n, c.attribute + SOFT_NORMAL);
    return c;
}

/* A box's mesh has four corners per face, in order. */
static void add_unit_mesh(soft *s, const body_transform *T, rlf_shape_type type, int32_t body)
{
    double focal = 0.5 * (s->camera.fx + s->camera.fy);
    bool is_small = focal * s->scene.bodies[body].radius < SOFT_COARSE_PX * T->p.z;
    const shape_mesh_set *meshes = is_small ? &s->coarse_meshes : &s->meshes;
    const shape_mesh_range *range = &meshes->range[type];
    for (int32_t i = 0; i < range->vertex_count; i++) {
        s->corners[i] = transform_corner(T, &meshes->vertices[range->first_vertex + i]);
    }
    for (int32_t i = 0; type == RLF_SHAPE_BOX && i < range->vertex_count; i += SOFT_CORNERS) {
        soft_scene_add_face(s, s->corners + i, SOFT_CORNERS, body);
    }
    for (int32_t i = 0; type != RLF_SHAPE_BOX && i < range->index_count; i += 3) {
        soft_corner corners[3];
        for (int k = 0; k < 3; k++) {
            int32_t index = meshes->indices[range->first_index + i + k];
            corners[k] = s->corners[index - range->first_vertex];
        }
        soft_scene_add_face(s, corners, 3, body);
    }
}

static void add_hull(soft *s, const body_transform *T, const rlf_shape *shape, int32_t body)
{
    double radius = rlf_shape_radius(shape);
    for (int32_t i = 0; i < shape->hull->triangle_count; i++) {
        shape_vertex v[3];
        if (shape_mesh_hull_triangle(shape->hull, i, radius, v)) {
            const soft_corner corners[3] = {transform_corner(T, &v[0]), transform_corner(T, &v[1]),
                                            transform_corner(T, &v[2])};
            soft_scene_add_face(s, corners, 3, body);
        }
    }
}

static void add_shape(soft *s, const rlf_shape *shape, const rlf_pose *T_picture_body, int32_t body)
{
    rlf_quat q = rlf_quat_normalize(T_picture_body->q);
    body_transform transform = {rlf_quat_to_mat3(q), T_picture_body->p, shape_mesh_scale_of(shape)};
    if (shape->type == RLF_SHAPE_HULL) {
        add_hull(s, &transform, shape, body);
    } else {
        add_unit_mesh(s, &transform, shape->type, body);
    }
}

static void choose_look(soft *s, const rlf_body_state *state, soft_body *body)
{
    for (int i = 0; i < 3; i++) {
        const float code = (float)rlf_clamp((double)state->color[i], 0.0, 1.0);
        body->color[i] = code * code;
    }
    body->material = body_material_of(state->shape.type);
    double focal = 0.5 * (s->camera.fx + s->camera.fy);
    int32_t level = body_texture_level_of(&state->shape, body->center.z, focal);
    body->texture =
        s->textures[body_texture_kind_of(state->shape.type)] + body_texture_level_offset(level) / 4;
    body->texture_size = BODY_TEXTURE_SIZE >> level;
}

/* Adds one body; it is left out again when none of its faces is in the picture. */
static rlf_result add_body(soft *s, const rlf_body_state *state, const rlf_pose *T_picture_world,
                           int32_t index)
{
    soft_scene *scene = &s->scene;
    const rlf_shape *shape = &state->shape;
    rlf_pose T = rlf_pose_mul(T_picture_world, &state->T_world_body);
    double radius = body_look_radius(state);
    if (!may_be_seen(s, T.p, radius)) {
        return RLF_OK;
    }
    bool is_hull = shape->type == RLF_SHAPE_HULL;
    if ((int)shape->type < 0 || shape->type > RLF_SHAPE_HULL || (is_hull && shape->hull == NULL)) {
        return RLF_OK;
    }
    int32_t count =
        is_hull ? shape->hull->triangle_count : s->meshes.range[shape->type].index_count / 3;
    /* The near plane may cut a triangle into two. */
    rlf_result result = soft_scene_reserve(s, scene->face_count + 2 * count);
    if (result != RLF_OK) {
        return result;
    }
    soft_body *body = &scene->bodies[scene->body_count];
    *body = (soft_body){.first = scene->face_count,
                        .y0 = s->camera.height,
                        .center = T.p,
                        .radius = radius,
                        .index = index};
    choose_look(s, state, body);
    if (state->look.model != NULL) {
        result = soft_scene_add_model(s, &state->look, &T, scene->body_count);
    } else {
        add_shape(s, shape, &T, scene->body_count);
    }
    body->end = scene->face_count;
    scene->body_count += body->end > body->first ? 1 : 0;
    return result;
}

static bool is_before(const soft_body *a, const soft_body *b)
{
    return a->center.z < b->center.z || (a->center.z == b->center.z && a->index < b->index);
}

/* Shell sort: in place, and a total order makes it the same everywhere. Faces name their body by
 * place, so they are renamed afterwards. */
static void sort_bodies(soft_scene *scene)
{
    soft_body *bodies = scene->bodies;
    int32_t count = scene->body_count;
    for (int32_t gap = count / 2; gap > 0; gap /= 2) {
        for (int32_t i = gap; i < count; i++) {
            soft_body moving = bodies[i];
            int32_t j = i;
            for (; j >= gap && is_before(&moving, &bodies[j - gap]); j -= gap) {
                bodies[j] = bodies[j - gap];
            }
            bodies[j] = moving;
        }
    }
    for (int32_t i = 0; i < count; i++) {
        for (int32_t t = bodies[i].first; t < bodies[i].end; t++) {
            scene->faces[t].body = i;
        }
    }
}

/* Who takes light from CASTER_LANES bodies, or as many as there are from the first on. */
static void choose_shaders(soft_scene *scene, int32_t first)
{
    const int32_t left = scene->body_count - first;
    const int32_t count = left < CASTER_LANES ? left : CASTER_LANES;
    int32_t index[CASTER_LANES];
    caster_choice choices[CASTER_LANES];
    for (int32_t i = 0; i < count; i++) {
        index[i] = scene->bodies[first + i].index;
    }
    caster_choose_many(scene->casters, scene->caster_count, index, count, choices);
    for (int32_t i = 0; i < count; i++) {
        soft_body *body = &scene->bodies[first + i];
        body->shader_count = choices[i].count;
        memcpy(body->shaders, choices[i].chosen, sizeof(body->shaders));
    }
}

/* Who takes light from whom. The thesis has no shadows, and plain augmented reality does not know
 * the real world. */
static void place_casters(soft *s, const rlf_snapshot *snapshot, const rlf_pose *T_picture_world)
{
    soft_scene *scene = &s->scene;
    bool has_shadows =
        s->def.occlusion == RLF_OCCLUSION_DEPTH || s->def.occlusion == RLF_OCCLUSION_SOFT;
    scene->caster_count = has_shadows ? snapshot->body_count : 0;
    for (int32_t i = 0; i < scene->caster_count; i++) {
        caster *c = &scene->casters[i];
        bool is_caster = caster_make(&snapshot->bodies[i], T_picture_world, s->to_light, c);
        if (is_caster && !caster_reach(c, &s->camera, s->to_light, &scene->reach[i])) {
            scene->reach[i] = (pixel_rect){0, 0, 0, 0};
        }
    }
    for (int32_t i = 0; has_shadows && i < scene->body_count; i += CASTER_LANES) {
        choose_shaders(scene, i);
    }
}

typedef struct shade_bodies_job {
    soft *s;
    real_shade_world world;
} shade_bodies_job;

static void shade_bodies(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const shade_bodies_job *job = context;
    soft_scene *scene = &job->s->scene;
    (void)worker;
    for (int32_t i = begin; i < end; i++) {
        real_shade *shade = &scene->real_shades[i];
        real_shade_make(&job->world, &scene->casters[scene->bodies[i].index], shade);
        scene->bodies[i].real_shade = shade->takes ? shade : NULL;
    }
}

/* What real things take from the bodies in the picture. */
static void place_real_shades(soft *s, const rlf_surface *surface)
{
    bool has_grid = s->scene.body_count >= BODIES_FOR_GRID && surface->depth != NULL;
    shade_bodies_job job = {s,
                            {.surface = surface,
                             .tiles = has_grid ? &s->real.seen : NULL,
                             .T_depth_picture = rlf_pose_invert(&s->T_picture_depth),
                             .to_light = s->to_light,
                             .focal_px = 0.5 * (s->camera.fx + s->camera.fy)}};
    if (s->def.enable_real_shade && s->scene.caster_count > 0) {
        rlf_parallel_for(s->def.pool, s->scene.body_count, BODIES_AT_ONCE, shade_bodies, &job);
    }
}

/* Light by place, for the bodies in the picture. */
static rlf_result place_probes(soft *s, const rlf_render_input *input)
{
    const rlf_pose T_camera_world = rlf_pose_invert(&input->T_world_camera);
    const probe_def def = {.rig = &s->def.rig,
                           .lamp = s->lamp.color,
                           .T_picture_depth = s->T_picture_depth,
                           .T_picture_world = rlf_pose_mul(&s->T_picture_depth, &T_camera_world),
                           .pool = s->def.pool,
                           .is_on = s->def.enable_real_ambient && s->scene.caster_count > 0};
    const rlf_result result =
        probe_set_update(s->probes, &def, input->frame, input->surface, input->snapshot);
    for (int32_t i = 0; i < s->scene.body_count && result == RLF_OK; i++) {
        soft_body *body = &s->scene.bodies[i];
        body->probe = &s->probes->probes[s->probes->of[body->index]];
    }
    return result;
}

rlf_result soft_scene_build(soft *s, const rlf_render_input *input)
{
    const rlf_snapshot *snapshot = input->snapshot;
    s->scene.face_count = 1;
    s->scene.body_count = 0;
    s->scene.skin_count = 1;
    s->scene.caster_count = 0;
    if (snapshot == NULL || snapshot->body_count <= 0) {
        return RLF_OK;
    }
    rlf_pose T_camera_world = rlf_pose_invert(&input->T_world_camera);
    rlf_pose T_picture_world = rlf_pose_mul(&s->T_picture_depth, &T_camera_world);
    rlf_result result = reserve_bodies(&s->scene, snapshot->body_count);
    for (int32_t i = 0; i < snapshot->body_count && result == RLF_OK; i++) {
        result = add_body(s, &snapshot->bodies[i], &T_picture_world, i);
    }
    if (result == RLF_OK) {
        sort_bodies(&s->scene);
        place_casters(s, snapshot, &T_picture_world);
    }
    return result == RLF_OK && s->scene.body_count > 0 ? place_probes(s, input) : result;
}

void soft_scene_light(soft *s, const rlf_render_input *input)
{
    if (s->scene.body_count > 0) {
        place_real_shades(s, input->surface);
        soft_place_obscurances(s, input);
    }
}

void soft_set_viewpoint(soft *s, const rlf_camera *camera, const rlf_pose *T_picture_depth)
{
    s->camera = *camera;
    s->T_picture_depth = *T_picture_depth;
    s->to_light = rlf_neg(rlf_rotate(T_picture_depth->q, s->direction.now));
    s->shade_px = camera->fx > FINE_FOCAL_PX ? 8 : 4;
    s->ray_x0 = (float)(-camera->cx / camera->fx);
    s->ray_y0 = (float)(-camera->cy / camera->fy);
    s->ray_step_x = (float)(1.0 / camera->fx);
    s->ray_step_y = (float)(1.0 / camera->fy);
}
