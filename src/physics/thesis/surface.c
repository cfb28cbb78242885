/* Collision with the real surface: regions' boxes first, then their points (Algorithms 2 and 3).
 *
 * Errata 9: the boxes are tested with the body's radius, and the distance of a point is to the
 * body's own surface, not to its centre. */
#include "physics/thesis/thesis.h"

typedef struct narrow_job {
    rlf_world *world;
    phys_body *body;
    int32_t body_index;
    const rlf_grid *grid;
    const rlf_grid_region *region;
    const rlf_grid_sheet *sheet;
    rlf_vec3 centre; /* of the body, grid frame */
} narrow_job;

bool thesis_broad_phase(const rlf_aabb *box, rlf_vec3 centre, double reach)
{
    return rlf_aabb_distance2(box, centre) <= reach * reach;
}

/* tau when the def leaves it open: half the diagonal between neighbouring points, so that a body
 * cannot lie between them without touching one. */
static double contact_distance(const narrow_job *job, double z)
{
    double tau = job->world->def.contact_distance_m;
    return tau > 0.0 ? tau : 0.7071067811865476 * z * job->grid->pixel_angle;
}

static void touch_point(const narrow_job *job, int32_t i)
{
    const rlf_grid_sheet *sheet = job->sheet;
    double z = sheet->depth[i];
    rlf_vec3 normal = rlf_vec3_make(sheet->normal_x[i], sheet->normal_y[i], sheet->normal_z[i]);
    if (!(z > 0.0) || rlf_dot(normal, normal) < 0.25) {
        return;
    }
    phys_body *body = job->body;
    double tau = contact_distance(job, z);
    rlf_vec3 p = rlf_vec3_make(z * job->grid->ray_x[i], z * job->grid->ray_y[i], z);
    rlf_vec3 d = rlf_sub(p, job->centre);
    double reach = body->shape.radius + tau;
    if (rlf_dot(d, d) > reach * reach) {
        return;
    }
    p = rlf_transform(&job->grid->T_world_grid, p);
    rlf_pose T_world_body = phys_body_pose(body);
    rlf_vec3 gradient;
    double distance =
        phys_shape_distance(&body->shape, rlf_transform_inverse(&T_world_body, p), &gradient);
    if (!(distance < tau)) {
        return;
    }
    rlf_vec3 n = rlf_rotate(job->grid->T_world_grid.q, normal);
    double approach = -rlf_dot(n, phys_body_velocity_at(body, rlf_sub(p, body->x)));
    double j = thesis_impulse(body, NULL, p, n, body->restitution);
    if (j > 0.0) {
        phys_contact contact = {.a = job->body_index, .b = -1, .log = -1, .met = phys_narrow(p)};
        contact.other =
            job->region->is_foreground ? RLF_CONTACT_FOREGROUND : RLF_CONTACT_BACKGROUND;
        contact.label = job->region->label;
        contact.met_normal = phys_narrow(n);
        contact.separation = distance;
        contact.impulse_sum = j;
        contact.approach = approach;
        phys_log_impulse(job->world, &contact);
    }
}

static void narrow_phase(const narrow_job *job)
{
    const rlf_grid_region *region = job->region;
    if (region->points != NULL) {
        for (int32_t i = 0; i < region->point_count; i++) {
            touch_point(job, region->points[i]);
        }
        return;
    }
    int32_t count = job->grid->width * job->grid->height;
    for (int32_t i = 0; job->sheet->label != NULL && i < count; i++) {
        if (job->sheet->label[i] == region->label) {
            touch_point(job, i);
        }
    }
}

void thesis_collide_surface(rlf_world *world, int32_t body_index, const rlf_grid *grid)
{
    narrow_job job = {.world = world, .body_index = body_index, .grid = grid};
    job.body = &world->bodies[body_index];
    job.centre = rlf_transform_inverse(&grid->T_world_grid, job.body->x);
    for (int32_t i = 0; i < grid->region_count; i++) {
        job.region = &grid->regions[i];
        job.sheet = job.region->is_foreground ? &grid->foreground : &grid->background;
        if (job.sheet->depth == NULL || job.sheet->normal_x == NULL) {
            continue;
        }
        double tau = contact_distance(&job, job.region->box.max.z);
        if (thesis_broad_phase(&job.region->box, job.centre, job.body->shape.radius + tau)) {
            narrow_phase(&job);
        }
    }
}
