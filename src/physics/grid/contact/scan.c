/* Walks the pixels under a body's footprint, thinned to a bounded number: they give the surface's
 * directions and bumps, and its outlines the walls. */
#include "physics/grid/ball/ball.h"
#include "physics/grid/contact/search.h"

#define SAMPLES_PER_SIDE 20
#define ROUNDING 1e-6 /* m, far more than distances are rounded by */

static void note_normal(grid_job *job, rlf_vec3 normal)
{
    for (int32_t i = 0; i < job->scan.normal_count; i++) {
        if (rlf_dot(job->scan.normals[i], normal) > ONE_PLANE_COS) {
            return;
        }
    }
    if (job->scan.normal_count < GRID_NORMALS_MAX) {
        job->scan.normals[job->scan.normal_count++] = normal;
    }
}

static void note_bump(grid_job *job, const grid_hit *hit)
{
    int32_t slot = job->scan.bump_count;
    if (slot == GRID_BUMPS_MAX) {
        slot = 0;
        for (int32_t i = 1; i < GRID_BUMPS_MAX; i++) {
            slot = job->scan.bumps[i].separation > job->scan.bumps[slot].separation ? i : slot;
        }
        if (hit->separation >= job->scan.bumps[slot].separation) {
            return;
        }
    } else {
        job->scan.bump_count++;
    }
    job->scan.bumps[slot] = *hit;
}

/* What the pixel at p shows of its face goes on for `half` metres. */
static void look_at_interior(grid_job *job, const field_cell *cell, rlf_vec3 p, double half)
{
    if (job->is_ball) {
        grid_ball_look(job, cell, p);
        return;
    }
    rlf_vec3 gradient;
    rlf_vec3 local = grid_to_body(job, p);
    double distance = phys_shape_distance(&job->body->shape, local, &gradient);
    rlf_vec3 outward = rlf_neg(rlf_mat3_mul_vec(&job->motion.R_grid_body, gradient));
    double approach = grid_approach_at(job, p, outward, cell->velocity);
    double near = rlf_max(0.0, approach) * job->window.horizon;
    if (distance < near + 0.5 * job->body->shape.radius + half) {
        note_normal(job, cell->normal);
    }
    if (distance > near) {
        return;
    }
    double agreement = rlf_dot(outward, cell->normal);
    if (distance > 0.0 && agreement < -ASIDE_COS) {
        return; /* it is beside the face, below its plane */
    }
    grid_hit hit = {.point = p, .velocity = cell->velocity, .label = cell->label};
    hit.normal = cell->normal;
    if (agreement > -ASIDE_COS && agreement < ASIDE_COS) {
        /* A feature that pokes into a side of the body pushes that side, never into the solid. */
        rlf_vec3 aside = rlf_mad(outward, cell->normal, rlf_max(0.0, -agreement));
        hit.normal = rlf_normalize(aside);
    }
    hit.facing = cell->normal;
    hit.anchor = rlf_mad(local, gradient, -distance);
    rlf_vec3 anchor = rlf_mat3_mul_vec(&job->motion.R_grid_body, hit.anchor);
    hit.separation = rlf_dot(hit.normal, rlf_sub(rlf_add(job->motion.centre, anchor), p));
    note_bump(job, &hit);
}

/* Where the camera would see p, in pixels: beyond the border as though its lens went on there like
 * a pinhole. False where nothing within `reach` of p is in view. */
static bool project_beyond(const rlf_grid *grid, rlf_vec3 p, double reach, double *u, double *v)
{
    const double SLANT = 2.0; /* the border may be so much nearer than it is on the way inwards */
    const int32_t HALVINGS = 10;
    if (grid->project(grid->project_context, p, u, v)) {
        return true;
    }
    double aside = sqrt(p.x * p.x + p.y * p.y), unseen = 0.0, seen = rlf_min(aside, SLANT * reach);
    rlf_vec3 inwards = rlf_vec3_make(-p.x / aside, -p.y / aside, 0.0);
    if (!(aside > 0.0) || !grid->project(grid->project_context, rlf_mad(p, inwards, seen), u, v)) {
        return false;
    }
    for (int32_t i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (unseen + seen), at[2];
        if (grid->project(grid->project_context, rlf_mad(p, inwards, middle), &at[0], &at[1])) {
            seen = middle;
            *u = at[0];
            *v = at[1];
        } else {
            unseen = middle;
        }
    }
    *u -= seen * inwards.x / (p.z * grid->pixel_angle);
    *v -= seen * inwards.y / (p.z * grid->pixel_angle);
    return true;
}

bool grid_footprint(const rlf_grid *grid, rlf_vec3 centre, double reach, int32_t rect[4],
                    int32_t *stride)
{
    double u, v;
    if (!(centre.z > 0.0) || !project_beyond(grid, centre, reach, &u, &v)) {
        return false;
    }
    double near = rlf_max(centre.z - reach, 0.1);
    double half = rlf_min(reach / (near * grid->pixel_angle) + 1.0, 4096.0);
    rect[0] = (int32_t)rlf_clamp(u - half, 0, grid->width);
    rect[1] = (int32_t)rlf_clamp(v - half, 0, grid->height);
    rect[2] = (int32_t)rlf_clamp(u + half + 1, 0, grid->width);
    rect[3] = (int32_t)rlf_clamp(v + half + 1, 0, grid->height);
    *stride = 1 + (int32_t)(2.0 * half / SAMPLES_PER_SIDE);
    return rect[0] < rect[2] && rect[1] < rect[3];
}

/* Sum of the velocities of what is within reach. */
typedef struct flow_sum {
    rlf_vec3 velocity;
    double count;
} flow_sum;

/* Whether the body touches nothing that is this far from its centre, or farther, before the next
 * query, nor comes nearer to it than `margin`. (A hull's distance is that to a plane.) */
static bool is_too_far(const grid_job *job, const field_cell *cell, double distance, double margin)
{
    double turning = job->motion.spin * job->window.horizon;
    double coming = (job->motion.speed + rlf_length(cell->velocity)) * job->window.horizon;
    return turning < 1.0 && job->body->shape.shape.type != RLF_SHAPE_HULL && !job->is_ball &&
           distance * (1.0 - turning) > job->body->shape.radius + coming + margin;
}

static void look_at_pixel(grid_job *job, int32_t x, int32_t y, int32_t stride, flow_sum *flow)
{
    const rlf_grid *grid = job->query->grid;
    const rlf_grid_sheet *sheet = job->sheet;
    int32_t i = y * grid->width + x;
    field_cell cell;
    double z = sheet->depth[i]; /* a cheap look first */
    double nearest_z = z * (1.0 - GRID_LONGEST * stride * grid->pixel_angle);
    if (!(z > 0.0) || nearest_z > job->motion.centre.z + job->window.reach ||
        (sheet->mask != NULL && sheet->mask[i] == 0) || !grid_cell_read(grid, sheet, x, y, &cell)) {
        return;
    }
    rlf_vec3 shift = rlf_scale(cell.velocity, job->query->tau);
    rlf_vec3 inward = grid_cell_inward(&cell), beside = rlf_add(cell.point, shift);
    double level = rlf_dot(rlf_sub(job->motion.centre, beside), inward) / rlf_dot(inward, inward);
    beside = rlf_mad(beside, inward, rlf_clamp(level, 0.0, cell.thickness));
    beside = rlf_sub(beside, job->motion.centre);
    double distance2 = rlf_dot(beside, beside), half = grid_cell_half(grid, &cell, stride);
    double reach = job->window.reach + half;
    if (distance2 < reach * reach) {
        double nearest = rlf_max(0.0, sqrt(distance2) - half);
        job->scan.nearest2 = rlf_min(job->scan.nearest2, nearest * nearest);
        flow->velocity = rlf_add(flow->velocity, cell.velocity);
        flow->count += 1.0;
        job->scan.is_near = true;
        job->scan.is_flat = false;
        rlf_vec3 front = rlf_add(cell.point, shift);
        double margin = 0.5 * job->body->shape.radius + half + ROUNDING;
        if (!is_too_far(job, &cell, rlf_length(rlf_sub(front, job->motion.centre)), margin)) {
            look_at_interior(job, &cell, front, half);
        }
        double gap = (stride - 1) * cell.point.z * grid->pixel_angle; /* to the outline */
        if (!is_too_far(job, &cell, sqrt(distance2), 2.0 * gap + GRID_MARGIN + ROUNDING)) {
            grid_wall_look(job, &cell, stride);
        }
    }
}

/* A plane with nothing on it needs no look at its pixels. */
static void look_at_flat(grid_job *job, const grid_tile *tile, flow_sum *flow)
{
    rlf_vec3 centre = rlf_mad(job->motion.centre, tile->velocity, -job->query->tau);
    double height = rlf_dot(tile->normal, centre) - tile->offset;
    if (height > job->window.reach || height < -tile->deepest - job->window.reach) {
        return;
    }
    job->scan.is_near = true;
    job->scan.nearest2 = height > 0.0 ? rlf_min(job->scan.nearest2, height * height) : 0.0;
    if (job->is_ball) {
        grid_ball_look_tile(job, tile);
    }
    if (height < -job->body->shape.radius || job->scan.flat_count == GRID_FLATS_MAX) {
        job->scan.is_flat = job->scan.is_listed = false; /* it comes from behind */
    } else {
        job->scan.flats[job->scan.flat_count++] = tile;
    }
    if (height > -job->window.reach) {
        note_normal(job, tile->normal);
        flow->velocity = rlf_mad(flow->velocity, tile->velocity, tile->count);
        flow->count += tile->count;
    }
}

/* The reach in which the tile's pixels, as they were seen, can be by now. */
static double wide_reach(const grid_job *job, const grid_tile *tile, double reach)
{
    double tau = job->query->tau < 0.0 ? -job->query->tau : job->query->tau;
    return reach + tile->speed * tau;
}

/* Whether the solid of a tile is farther than `reach` from the body's centre. */
static bool is_out_of_reach(const grid_job *job, const grid_tile *tile, double reach)
{
    if (tile->is_endless) {
        return tile->near_z > job->motion.centre.z + reach;
    }
    double wide = wide_reach(job, tile, reach);
    return rlf_aabb_distance2(&tile->solid, job->motion.centre) > wide * wide;
}

/* Lists the boxes of those blocks of a tile. */
static void list_solids(grid_job *job, const grid_tile *tile, uint32_t blocks)
{
    if (tile->is_endless) {
        job->scan.is_listed = false;
    }
    for (int32_t block = 0; blocks >> block != 0 && job->scan.is_listed; block++) {
        if ((blocks >> block & 1u) == 0) {
            continue;
        }
        if (job->scan.solid_count == GRID_SOLIDS_MAX) {
            job->scan.is_listed = false;
            return;
        }
        float *box = job->scan.solids[job->scan.solid_count++];
        for (int32_t k = 0; k < 3; k++) {
            box[k] = tile->blocks.low[k][block];
            box[k + 3] = tile->blocks.high[k][block];
        }
    }
}

/* The tile's pixels within `rect` that lie on the rectangle's pattern of every stride-th, or a
 * finer one, so that nothing narrow is between them, in blocks that are within reach. */
static void look_at_rough(grid_job *job, const grid_tile *tile, const int32_t rect[4],
                          const int32_t corner[2], flow_sum *flow)
{
    int32_t size = job->tiles->size, shift = job->tiles->block_shift;
    int32_t stride = tile->narrow < job->scan.stride ? tile->narrow : job->scan.stride;
    int32_t begin[2], end[2];
    uint32_t near = ~(uint32_t)0;
    if (!tile->is_endless) {
        near = grid_tile_blocks_near(tile, job->motion.centre,
                                     wide_reach(job, tile, job->window.reach));
    }
    list_solids(job, tile, near);
    for (int32_t k = 0; k < 2; k++) {
        int32_t skipped = corner[k] > rect[k] ? (corner[k] - rect[k] + stride - 1) / stride : 0;
        begin[k] = rect[k] + skipped * stride;
        end[k] = corner[k] + size < rect[k + 2] ? corner[k] + size : rect[k + 2];
    }
    for (int32_t y = begin[1]; y < end[1]; y += stride) {
        uint32_t row = near >> (((y - corner[1]) >> shift) * TILE_BLOCKS);
        for (int32_t x = begin[0]; x < end[0]; x += stride) {
            if ((row >> ((x - corner[0]) >> shift) & 1u) != 0) {
                look_at_pixel(job, x, y, stride, flow);
            }
        }
    }
}

/* Whether no block of the tile is within `reach` at this time. */
static bool is_tile_free(const grid_job *job, const grid_tile *tile, double reach)
{
    return is_out_of_reach(job, tile, reach) ||
           (!tile->is_endless &&
            grid_tile_blocks_near(tile, job->motion.centre, wide_reach(job, tile, reach)) == 0);
}

bool grid_is_free(const grid_job *job, const grid_tiles *tiles, double reach)
{
    int32_t rect[4], stride;
    if (tiles->sheet->depth == NULL || tiles->sheet->normal_x == NULL ||
        !grid_footprint(job->query->grid, job->motion.centre, reach, rect, &stride)) {
        return true;
    }
    for (int32_t y = rect[1] / tiles->size; y * tiles->size < rect[3]; y++) {
        for (int32_t x = rect[0] / tiles->size; x * tiles->size < rect[2]; x++) {
            int32_t i = y * tiles->columns + x;
            if (grid_tiles_kind(tiles, i) != TILE_EMPTY &&
                !is_tile_free(job, &tiles->tiles[i], reach)) {
                return false;
            }
        }
    }
    return true;
}

void grid_scan_footprint(grid_job *job)
{
    const grid_tiles *tiles = job->tiles;
    int32_t rect[4], stride;
    flow_sum flow = {{0, 0, 0}, 0.0};
    if (!grid_footprint(job->query->grid, job->motion.centre, job->window.reach, rect, &stride)) {
        return;
    }
    job->scan.is_flat = true;
    job->scan.stride = stride;
    for (int32_t y = rect[1] / tiles->size; y * tiles->size < rect[3]; y++) {
        for (int32_t x = rect[0] / tiles->size; x * tiles->size < rect[2]; x++) {
            int32_t i = y * tiles->columns + x;
            tile_kind kind = grid_tiles_kind(tiles, i);
            const grid_tile *tile = &tiles->tiles[i];
            const int32_t corner[2] = {x * tiles->size, y * tiles->size};
            if (kind == TILE_EMPTY || tile->near_z > job->motion.centre.z + job->window.reach) {
                continue;
            }
            if (kind == TILE_FLAT) {
                look_at_flat(job, tile, &flow);
            } else if (!is_out_of_reach(job, tile, job->window.reach)) {
                look_at_rough(job, tile, rect, corner, &flow);
            }
        }
    }
    if (flow.count > 0.0) {
        job->scan.surface_velocity = rlf_scale(flow.velocity, 1.0 / flow.count);
    }
}
