/* Real surfaces near a body keep light around from it: where the bodies are, and at nodes of their
 * faces. */
#include "render/soft/passes.h"

#include "kernel/kernel.h"
#include "render/soft/soft.h"
#include "render/soft/stream.h"

#define BODIES_AT_ONCE 8 /* per worker */
#define ENDLESS 1e9f
#define ALONG 0.9f /* the axis: a cylinder's cap */

/* ---- bodies --------------------------------------------------------------------------------- */

typedef struct obscure_job {
    soft *s;
    const rlf_surface *surface;
    const rlf_snapshot *snapshot;
    rlf_pose T_depth_picture;
} obscure_job;

/* 1 / z = a X + b Y + c on a face, with the ray (X, Y, 1): (a, b, c) is across it. */
static void flat_normal(const soft *s, const soft_face *f, float out[3])
{
    const float a = f->inverse_z.dx * (float)s->camera.fx;
    const float b = f->inverse_z.dy * (float)s->camera.fy;
    const float x = s->ray_x0 + s->ray_step_x * f->origin_x;
    const float y = s->ray_y0 + s->ray_step_y * f->origin_y;
    const float c = f->inverse_z.at0 - a * x - b * y;
    const float scale = -1.0f / sqrtf(a * a + b * b + c * c);
    out[0] = scale * a;
    out[1] = scale * b;
    out[2] = scale * c;
}

static float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A cylinder's faces are round, but for those across its axis. */
static void sort_faces(const soft *s, bool is_cylinder, const caster *c, const soft_body *body)
{
    const float center[3] = {c->center[0], c->center[1], c->center[2]};
    for (int32_t i = body->first; i < body->end; i++) {
        soft_face *f = &s->scene.faces[i];
        flat_normal(s, f, f->normal);
        const float along = dot3(c->axis[1], f->normal);
        f->nearness = FACE_ROUND;
        if (!is_cylinder || along * along > ALONG * ALONG) {
            bool is_near =
                obscurance_may_take(body->obscurance, center, (float)body->radius, f->normal, 0.0f);
            f->nearness = is_near ? FACE_FLAT : FACE_FAR;
        }
    }
}

static void find_surfaces(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const obscure_job *job = context;
    soft_scene *scene = &job->s->scene;
    (void)worker;
    for (int32_t i = begin; i < end; i++) {
        soft_body *body = &scene->bodies[i];
        const caster *c = &scene->casters[body->index];
        const rlf_body_state *state = &job->snapshot->bodies[body->index];
        obscurance *near_by = &scene->obscurances[i];
        obscurance_find(job->surface, &job->T_depth_picture, c, near_by);
        body->obscurance = near_by->count > 0 ? near_by : NULL;
        const rlf_shape_type type = state->look.model != NULL ? RLF_SHAPE_HULL : state->shape.type;
        const bool is_cylinder = type == RLF_SHAPE_CYLINDER;
        body->is_round = type == RLF_SHAPE_SPHERE || type == RLF_SHAPE_CAPSULE;
        body->core = is_cylinder ? ENDLESS : c->half[1];
        body->per_round = 1.0f / (c->half[0] + c->round);
        if (body->obscurance != NULL && !body->is_round) {
            sort_faces(job->s, is_cylinder, c, body);
        }
    }
}

void soft_place_obscurances(soft *s, const rlf_render_input *input)
{
    obscure_job job = {s, input->surface, input->snapshot, rlf_pose_invert(&s->T_picture_depth)};
    if (s->def.enable_real_ambient && s->scene.caster_count > 0) {
        rlf_parallel_for(s->def.pool, s->scene.body_count, BODIES_AT_ONCE, find_surfaces, &job);
    }
}

/* ---- faces ---------------------------------------------------------------------------------- */

/* Of a point (x, y, z) from the body's centre: away from the line that is its core. */
RLF_KERNEL_PART void round_normal(const float axis[3], float core, float x, float y, float z,
                                  float *out_x, float *out_y, float *out_z)
{
    const float along = stream_clamp(axis[0] * x + axis[1] * y + axis[2] * z, -core, core);
    x -= along * axis[0];
    y -= along * axis[1];
    z -= along * axis[2];
    const float scale = 1.0f / sqrtf(x * x + y * y + z * z + 1e-12f);
    *out_x = scale * x;
    *out_y = scale * y;
    *out_z = scale * z;
}

/* Faces of a body that is round all over are not even looked at: there are many. */
static soft_nearness nearness_of(const soft_body *body, const soft_face *f)
{
    return body->is_round ? FACE_ROUND : f->nearness;
}

bool soft_may_obscure(const soft *s, const soft_face *f, const float middle[3], float radius)
{
    const soft_body *body = &s->scene.bodies[f->body];
    const caster *c = &s->scene.casters[body->index];
    if (body->obscurance == NULL || nearness_of(body, f) == FACE_FAR) {
        return false;
    }
    if (nearness_of(body, f) == FACE_FLAT) {
        return obscurance_may_take(body->obscurance, middle, radius, f->normal, 0.0f);
    }
    float n[3];
    for (int k = 0; k < 3; k++) {
        n[k] = middle[k] - c->center[k];
    }
    const float along = stream_clamp(dot3(c->axis[1], n), -body->core, body->core);
    for (int k = 0; k < 3; k++) {
        n[k] = (n[k] - along * c->axis[1][k]) * body->per_round;
    }
    return obscurance_may_take(body->obscurance, middle, radius, n, radius * body->per_round);
}

RLF_KERNEL_PART void fill(float value, int32_t count, float *restrict out)
{
    for (int32_t first = 0; first < count; first += SOFT_LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < SOFT_LANES; k++) {
            out[first + k] = value;
        }
    }
}

RLF_KERNEL_PART void fill_round(const caster *c, float core, const caster_points *points,
                                float *restrict nx, float *restrict ny, float *restrict nz)
{
    const float axis[3] = {c->axis[1][0], c->axis[1][1], c->axis[1][2]};
    const float center[3] = {c->center[0], c->center[1], c->center[2]};
    for (int32_t first = 0; first < points->count; first += SOFT_LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < SOFT_LANES; k++) {
            const int32_t i = first + k;
            const float z = points->z[i];
            round_normal(axis, core, points->x[i] * z - center[0], points->y[i] * z - center[1],
                         z - center[2], &nx[i], &ny[i], &nz[i]);
        }
    }
}

RLF_KERNEL void soft_obscure_nodes(const soft *s, const soft_face *f, const caster_points *points,
                                   float *left)
{
    const soft_body *body = &s->scene.bodies[f->body];
    float n[3][2 * ROW_NODES];
    if (nearness_of(body, f) == FACE_ROUND) {
        fill_round(&s->scene.casters[body->index], body->core, points, n[0], n[1], n[2]);
    } else {
        for (int k = 0; k < 3; k++) {
            fill(f->normal[k], points->count, n[k]);
        }
    }
    const obscurance_normals normals = {n[0], n[1], n[2]};
    obscurance_take(body->obscurance, points, &normals, left);
}
