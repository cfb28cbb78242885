/* What of the foreground touches a body, pixel by pixel. */
#include "physics/grab/grab.h"
#include "physics/grid/contact/search.h"

#define SAMPLES_PER_SIDE 48
/* A finger, or a hand laid flat, is no thicker, whatever the guess, metres. */
#define FINGER_M 0.03
/* The camera loses so much of an outline, pixels. */
#define RIM_PX 3.0
/* What is seen so deep in a body, a share of its inner radius, goes through it. */
#define DEEP_SHARE 0.6
/* Places on a body that are one patch: cosine between normals, and share of the radius. */
#define PATCH_COS 0.9
#define PATCH_SHARE 0.5

typedef struct look_job {
    const grid_query *query;
    const phys_shape *shape;
    rlf_pose T_grid_body;
    double tau, tolerance;
    grab_touches *out;
} look_job;

double grab_tolerance(const grid_query *query, rlf_vec3 x)
{
    rlf_vec3 p = rlf_transform(&query->T_grid_world, x);
    return GRID_MARGIN + RIM_PX * rlf_max(p.z, 0.0) * query->grid->pixel_angle;
}

static void add_touch(look_job *job, rlf_vec3 point, rlf_vec3 normal, double distance,
                      rlf_vec3 velocity)
{
    grab_touches *out = job->out;
    double near = PATCH_SHARE * job->shape->radius;
    grab_patch *patch = NULL;
    out->weight += 1.0;
    for (int32_t i = 0; i < out->count && patch == NULL; i++) {
        grab_patch *other = &out->patches[i];
        rlf_vec3 off = rlf_sub(rlf_scale(other->point, 1.0 / other->weight), point);
        bool is_same = rlf_dot(other->normal, normal) > PATCH_COS * rlf_length(other->normal) &&
                       rlf_dot(off, off) < near * near;
        patch = is_same ? other : NULL;
    }
    if (patch == NULL && out->count == GRAB_PATCHES_MAX) {
        return;
    }
    if (patch == NULL) {
        patch = &out->patches[out->count++];
        *patch = (grab_patch){.off = distance};
    }
    patch->point = rlf_add(patch->point, point);
    patch->normal = rlf_add(patch->normal, normal);
    patch->velocity = rlf_add(patch->velocity, velocity);
    patch->off = rlf_min(patch->off, distance);
    patch->weight += 1.0;
}

/* Whether all of the body is before the face that is seen there: what it lies on presses on it
 * squarely, even beside its edge. */
static bool bears(const look_job *job, const field_cell *cell, rlf_vec3 p)
{
    rlf_vec3 normal = rlf_rotate(rlf_quat_conjugate(job->T_grid_body.q), cell->normal);
    return -rlf_dot(normal, p) >= job->shape->inner_radius - job->tolerance;
}

/* The seen point itself touches, or the solid behind it does: its place nearest to the body, or
 * where the ray enters it. */
static void look_at(look_job *job, const field_cell *cell)
{
    const phys_shape *shape = job->shape;
    rlf_vec3 gradient;
    rlf_vec3 p = rlf_mad(cell->point, cell->velocity, job->tau);
    p = rlf_transform_inverse(&job->T_grid_body, p);
    rlf_quat to_body = rlf_quat_conjugate(job->T_grid_body.q);
    rlf_vec3 velocity = rlf_rotate(to_body, cell->velocity);
    double distance = phys_shape_distance(shape, p, &gradient);
    if (distance < -DEEP_SHARE * shape->inner_radius) {
        job->out->deep += 1.0;
        return;
    }
    if (distance > job->tolerance) {
        rlf_vec3 way = rlf_rotate(to_body, grid_cell_inward(cell));
        double thickness = rlf_min(cell->thickness, FINGER_M);
        double level = rlf_clamp(-rlf_dot(p, way) / rlf_dot(way, way), 0.0, thickness);
        double enter, leave;
        if (rlf_shape_cast(&shape->shape, p, way, &enter, &leave) && enter >= 0.0) {
            level = rlf_min(level, enter);
        }
        p = rlf_mad(p, way, level);
        distance = phys_shape_distance(shape, p, &gradient);
    }
    if (distance <= job->tolerance && bears(job, cell, p)) {
        gradient = rlf_neg(rlf_rotate(to_body, cell->normal));
    }
    if (distance <= job->tolerance) {
        add_touch(job, rlf_mad(p, gradient, -distance), gradient, distance, velocity);
    }
}

void grab_look(const grid_query *query, const phys_body *body, const rlf_pose *T_world_body,
               double tau, double tolerance, grab_touches *out)
{
    const rlf_grid *grid = query->grid;
    const rlf_grid_sheet *sheet = &grid->foreground;
    look_job job = {query, &body->shape, rlf_pose_mul(&query->T_grid_world, T_world_body),
                    tau,   tolerance,    out};
    double z = job.T_grid_body.p.z, reach = body->shape.radius + tolerance + FINGER_M;
    int32_t rect[4], stride;
    out->count = 0;
    out->weight = out->deep = 0.0;
    if (!grid_footprint(grid, job.T_grid_body.p, body->shape.radius + tolerance, rect, &stride)) {
        return;
    }
    int32_t wide = rect[2] - rect[0] > rect[3] - rect[1] ? rect[2] - rect[0] : rect[3] - rect[1];
    stride = 1 + wide / SAMPLES_PER_SIDE;
    for (int32_t y = rect[1]; y < rect[3]; y += stride) {
        for (int32_t x = rect[0]; x < rect[2]; x += stride) {
            int32_t i = y * grid->width + x;
            double depth = sheet->depth[i];
            field_cell cell;
            if ((sheet->mask == NULL || sheet->mask[i] != 0) && depth > z - reach &&
                depth < z + reach && grid_cell_read(grid, sheet, x, y, &cell)) {
                look_at(&job, &cell);
            }
        }
    }
}
