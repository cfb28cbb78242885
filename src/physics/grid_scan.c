/* Walks the pixels under a body's footprint, thinned to a bounded number.
 *
 * Interior pixels give the surface's directions and bumps; outline pixels stand for the side wall
 * of the solid behind them, from its front to its back along the ray. */
#include "physics/grid_scan.h"
#include "physics/grid_edge.h"

#define SAMPLES_PER_SIDE 20
#define RING_PX 32 /* this near the image's border pixels may be missing */

static rlf_vec3 to_body(const grid_job *job, rlf_vec3 p)
{
    return rlf_mat3_mul_vec(&job->R_body_grid, rlf_sub(p, job->centre));
}

/* Speed at which surface and body approach at p along the normal. */
static double approach_at(const grid_job *job, rlf_vec3 p, rlf_vec3 normal, rlf_vec3 velocity)
{
    rlf_vec3 v = rlf_add(job->v, rlf_cross(job->w, rlf_sub(p, job->centre)));
    return rlf_dot(normal, rlf_sub(velocity, v));
}

static void note_normal(grid_job *job, rlf_vec3 normal)
{
    for (int32_t i = 0; i < job->normal_count; i++) {
        if (rlf_dot(job->normals[i], normal) > 0.97) {
            return;
        }
    }
    if (job->normal_count < GRID_NORMALS_MAX) {
        job->normals[job->normal_count++] = normal;
    }
}

static void note_bump(grid_job *job, const grid_hit *hit)
{
    int32_t slot = job->bump_count;
    if (slot == GRID_BUMPS_MAX) {
        slot = 0;
        for (int32_t i = 1; i < GRID_BUMPS_MAX; i++) {
            slot = job->bumps[i].separation > job->bumps[slot].separation ? i : slot;
        }
        if (hit->separation >= job->bumps[slot].separation) {
            return;
        }
    } else {
        job->bump_count++;
    }
    job->bumps[slot] = *hit;
}

static void look_at_interior(grid_job *job, const field_cell *cell, rlf_vec3 p)
{
    rlf_vec3 gradient;
    rlf_vec3 local = to_body(job, p);
    double distance = phys_shape_distance(&job->body->shape, local, &gradient);
    rlf_vec3 outward = rlf_neg(rlf_mat3_mul_vec(&job->R_grid_body, gradient));
    double approach = approach_at(job, p, outward, cell->velocity);
    double near = rlf_max(0.0, approach) * job->horizon;
    if (distance < near + 0.5 * job->body->shape.radius) {
        note_normal(job, cell->normal);
    }
    if (distance > near) {
        return;
    }
    grid_hit hit = {.point = p, .velocity = cell->velocity, .label = cell->label};
    /* A feature that pokes into a side of the body pushes that side, but never into the solid. */
    double agreement = rlf_dot(outward, cell->normal);
    hit.normal = agreement > 0.0 && agreement < 0.3 ? outward : cell->normal;
    hit.facing = cell->normal;
    hit.anchor = rlf_mad(local, gradient, -distance);
    rlf_vec3 anchor = rlf_mat3_mul_vec(&job->R_grid_body, hit.anchor);
    hit.separation = rlf_dot(hit.normal, rlf_sub(rlf_add(job->centre, anchor), p));
    note_bump(job, &hit);
}

/* z at which the side wall at this pixel ends, or 0 when it is no outline. */
static double outline_end(const grid_job *job, const field_cell *cell, int32_t stride)
{
    const int32_t OFFSETS[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    const rlf_grid_sheet *sheet = job->sheet;
    double end = 0.0;
    for (int32_t k = 0; k < 4; k++) {
        int32_t x = cell->x + OFFSETS[k][0] * stride;
        int32_t y = cell->y + OFFSETS[k][1] * stride;
        end = rlf_max(end, grid_edge_end(job->query->grid, sheet, cell, x, y));
    }
    if (end > 0.0 && sheet->thickness == NULL) { /* never seen: no deeper than wide */
        double width = grid_edge_width(job->query->grid, sheet, cell, cell->thickness);
        end = rlf_min(end, cell->point.z + width);
    }
    return end;
}

/* The wall's directions at an outline's point: its face, and at its front and back edge all between
 * that face and the ray. The body's own normal there, brought into them. */
static rlf_vec3 wall_normal(const field_cell *cell, rlf_vec3 side, rlf_vec3 normal, int32_t edge)
{
    rlf_vec3 ray = rlf_normalize(cell->point);
    double out = rlf_dot(normal, side);
    double along = rlf_dot(normal, ray);
    along = edge < 0 ? rlf_min(along, 0.0) : edge > 0 ? rlf_max(along, 0.0) : 0.0;
    return rlf_normalize(rlf_mad(rlf_scale(ray, along), side, rlf_max(out, 0.0)));
}

static void look_at_outline(grid_job *job, const field_cell *cell, rlf_vec3 shift, double end)
{
    double z = cell->point.z;
    double middle = rlf_clamp(job->centre.z, z, end);
    double inner = 0.5 * job->body->shape.inner_radius;
    double depths[3] = {middle, rlf_clamp(middle - inner, z, end),
                        rlf_clamp(middle + inner, z, end)};
    rlf_vec3 side;
    bool has_side = grid_edge_normal(job->query->grid, job->sheet, cell, &side);
    for (int32_t k = 0; k < 3 && job->hit_count < GRID_HITS_MAX / 2; k++) {
        rlf_vec3 p = rlf_add(rlf_scale(cell->point, depths[k] / z), shift);
        rlf_vec3 gradient;
        rlf_vec3 local = to_body(job, p);
        double distance = phys_shape_distance(&job->body->shape, local, &gradient);
        rlf_vec3 normal = rlf_neg(rlf_mat3_mul_vec(&job->R_grid_body, gradient));
        double approach = approach_at(job, p, normal, cell->velocity);
        if (distance > GRID_MARGIN + rlf_max(0.0, approach) * job->horizon) {
            continue;
        }
        grid_hit hit = {.point = p, .velocity = cell->velocity, .label = cell->label};
        hit.anchor = rlf_mad(local, gradient, -distance);
        hit.normal = normal;
        hit.separation = distance;
        if (has_side) {
            int32_t edge = depths[k] <= z ? -1 : depths[k] >= end ? 1 : 0;
            hit.normal = wall_normal(cell, side, normal, edge);
            rlf_vec3 anchor = rlf_mat3_mul_vec(&job->R_grid_body, hit.anchor);
            hit.separation = rlf_dot(hit.normal, rlf_sub(rlf_add(job->centre, anchor), p));
        }
        if (rlf_dot(hit.normal, normal) > 0.3) {
            job->hits[job->hit_count++] = hit;
        }
    }
}

/* Rectangle of pixels under the sphere of `reach` about the centre. */
static bool footprint(const grid_job *job, int32_t rect[4], int32_t *stride)
{
    const rlf_grid *grid = job->query->grid;
    double u, v;
    rlf_vec3 c = job->centre;
    if (!(c.z > 0.0) || !grid->project(grid->project_context, c, &u, &v)) {
        return false;
    }
    double near = rlf_max(c.z - job->reach, 0.1);
    double half = rlf_min(job->reach / (near * grid->pixel_angle) + 1.0, 4096.0);
    rect[0] = (int32_t)rlf_clamp(u - half, 0, grid->width);
    rect[1] = (int32_t)rlf_clamp(v - half, 0, grid->height);
    rect[2] = (int32_t)rlf_clamp(u + half + 1, 0, grid->width);
    rect[3] = (int32_t)rlf_clamp(v + half + 1, 0, grid->height);
    *stride = 1 + (int32_t)(2.0 * half / SAMPLES_PER_SIDE);
    return rect[0] < rect[2] && rect[1] < rect[3];
}

/* Directions of the room beyond the border, where the body is near it or past it. */
static void look_beyond_border(grid_job *job)
{
    const int32_t OFFSETS[5][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (int32_t k = 0; k < 5; k++) {
        rlf_vec3 to = rlf_vec3_make(OFFSETS[k][0], OFFSETS[k][1], 0.0);
        field_cell cell;
        field_state state = grid_field_at(job->query->grid, job->sheet,
                                          rlf_mad(job->centre, to, job->reach), &cell);
        if (state != FIELD_NONE && cell.is_extended) {
            note_normal(job, cell.normal);
        }
    }
}

/* A cheap look first: most pixels under a body in flight are far behind it. */
static bool is_near_in_depth(const grid_job *job, int32_t i)
{
    const rlf_grid_sheet *sheet = job->sheet;
    double z = sheet->depth[i];
    if (!(z > 0.0) || z > job->centre.z + job->reach ||
        (sheet->mask != NULL && sheet->mask[i] == 0)) {
        return false;
    }
    return true;
}

void grid_scan_footprint(grid_job *job)
{
    const rlf_grid *grid = job->query->grid;
    double tau = job->query->tau;
    int32_t rect[4], stride, moving = 0;
    rlf_vec3 velocity = {0, 0, 0};
    bool is_in_view = footprint(job, rect, &stride);
    if (job->sheet->border == RLF_BORDER_EXTEND &&
        (!is_in_view || rect[0] < RING_PX || rect[1] < RING_PX || rect[2] > grid->width - RING_PX ||
         rect[3] > grid->height - RING_PX)) {
        look_beyond_border(job);
    }
    if (!is_in_view) {
        return;
    }
    for (int32_t y = rect[1]; y < rect[3]; y += stride) {
        for (int32_t x = rect[0]; x < rect[2]; x += stride) {
            field_cell cell;
            if (!is_near_in_depth(job, y * grid->width + x) ||
                !grid_cell_read(grid, job->sheet, x, y, &cell)) {
                continue;
            }
            rlf_vec3 shift = rlf_scale(cell.velocity, tau);
            rlf_vec3 p = rlf_add(cell.point, shift);
            rlf_vec3 d = rlf_sub(p, job->centre);
            if (rlf_dot(d, d) < job->reach * job->reach) {
                velocity = rlf_add(velocity, cell.velocity);
                moving++;
                look_at_interior(job, &cell, p);
            }
            double level = rlf_clamp(job->centre.z, cell.point.z, cell.point.z + cell.thickness);
            rlf_vec3 beside = rlf_mad(shift, cell.point, level / cell.point.z);
            if (rlf_length(rlf_sub(beside, job->centre)) < job->reach) {
                double end = outline_end(job, &cell, stride);
                if (end > 0.0) {
                    look_at_outline(job, &cell, shift, end);
                }
            }
        }
    }
    if (moving > 0) {
        job->surface_velocity = rlf_scale(velocity, 1.0 / moving);
    }
}
