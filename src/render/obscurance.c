/* Light around that planes keep from points: see obscurance.h. */
#include "render/real_shade.h"

static float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The body in the depth camera's frame. */
static near_planes_body body_of(const caster *from, const rlf_pose *T_depth_picture)
{
    near_planes_body body = {.round = from->round, .reach = from->reach};
    caster_to_floats(rlf_transform(T_depth_picture, caster_from_floats(from->center)), body.center);
    for (int i = 0; i < 3; i++) {
        caster_to_floats(rlf_rotate(T_depth_picture->q, caster_from_floats(from->axis[i])),
                         body.axis[i]);
        body.half[i] = from->half[i];
    }
    return body;
}

void obscurance_find(const rlf_surface *surface, const rlf_pose *T_depth_picture,
                     const caster *body, obscurance *out)
{
    out->count = 0;
    if (!(body->near_m > 0.0f)) {
        return;
    }
    const rlf_pose *T = T_depth_picture;
    const near_planes_body in_depth = body_of(body, T);
    near_planes near_by;
    near_planes_find(surface, &in_depth, &near_by);
    for (int32_t i = 0; i < near_by.count; i++) {
        const near_plane *from = &near_by.plane[i];
        if (from->presence > 0.0f) {
            const rlf_vec3 p = rlf_transform_inverse(T, caster_from_floats(from->p));
            const rlf_vec3 turned =
                rlf_rotate(rlf_quat_conjugate(T->q), caster_from_floats(from->normal));
            caster_to_floats(turned, out->normal[out->count]);
            out->offset[out->count] = (float)-rlf_dot(turned, p);
            out->presence[out->count++] = from->presence;
        }
    }
    out->per_reach = near_by.count > 0 ? 1.0f / near_by.reach : 0.0f;
}

/* What is lost is at most (1 - height)^2 (1 - facing) / 2. */
bool obscurance_may_take(const obscurance *o, const float p[3], float radius, const float normal[3],
                         float turn)
{
    for (int32_t k = 0; k < o->count; k++) {
        const float height = dot3(o->normal[k], p) + o->offset[k] - radius;
        const float near_share = 1.0f - (height > 0.0f ? height * o->per_reach : 0.0f);
        const float facing = dot3(normal, o->normal[k]) - turn;
        const float most = (float)OBSCURANCE_SHARE * o->presence[k] * near_share * near_share;
        if (near_share > 0.0f && 0.5f * most * (1.0f - facing) > OBSCURANCE_HARDLY) {
            return true;
        }
    }
    return false;
}

RLF_KERNEL_PART void take(const float normal[3], float offset, float per_reach, float share,
                          const caster_points *points, const obscurance_normals *normals,
                          int32_t first, float *restrict left)
{
    const float *restrict ray_x = points->x + first;
    const float *restrict ray_y = points->y + first;
    const float *restrict z = points->z + first;
    const float *restrict nx = normals->x + first;
    const float *restrict ny = normals->y + first;
    const float *restrict nz = normals->z + first;
    const float a = normal[0];
    const float b = normal[1];
    const float c = normal[2];
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < CASTER_LANES; i++) {
        float height = ((a * ray_x[i] + b * ray_y[i] + c) * z[i] + offset) * per_reach;
        float facing = a * nx[i] + b * ny[i] + c * nz[i];
        left[first + i] *= 1.0f - share * obscurance_lost(facing, height > 0.0f ? height : 0.0f);
    }
}

RLF_KERNEL void obscurance_take(const obscurance *o, const caster_points *points,
                                const obscurance_normals *normals, float *left)
{
    for (int32_t k = 0; k < o->count; k++) {
        const float share = (float)OBSCURANCE_SHARE * o->presence[k];
        for (int32_t i = 0; i < points->count; i += CASTER_LANES) {
            take(o->normal[k], o->offset[k], o->per_reach, share, points, normals, i, left);
        }
    }
}
