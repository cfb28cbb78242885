/* Where no hand is known: pixels of the foreground that touch a body, and whether two sides of them
 * hold it by friction (Nguyen 1988, "Constructing force-closure grasps"). The normals are the
 * body's own: a depth camera sees those of a finger's contact least of all. */
#include "physics/grab/grab.h"

#define SAMPLES_PER_SIDE 48
/* A finger, or a hand laid flat, is no thicker, whatever the guess, metres. */
#define FINGER_M 0.03
/* The camera loses so much of an outline, pixels. */
#define RIM_PX 3.0
/* What is seen so deep in a body, a share of its inner radius, goes through it; more of it than
 * this share of what touches: the body is passed through. */
#define DEEP_RADIUS 0.6
#define DEEP_SHARE 0.5
#define BIN_COS 0.38 /* a coordinate of a normal that counts as none */
/* Cosine of the friction cone of skin, whose coefficient is 0.8. */
#define CONE_COS 0.78
/* Cosine between the normals of two sides: with what is hidden behind the body they leave it no
 * way out. */
#define OPPOSED_COS (-0.35)
/* A side is touched by so many pixels, or it is noise. */
#define PIXELS_MIN 6.0

typedef struct look_job {
    const grid_query *query;
    const phys_shape *shape;
    rlf_pose T_grid_body;
    double tau, tolerance;
    grab_front *out;
} look_job;

double grab_tolerance(const grid_query *query, rlf_vec3 x)
{
    rlf_vec3 p = rlf_transform(&query->T_grid_world, x);
    return GRID_MARGIN + RIM_PX * rlf_max(p.z, 0.0) * query->grid->pixel_angle;
}

static int32_t third(double x)
{
    return x > BIN_COS ? 2 : (x < -BIN_COS ? 0 : 1);
}

static void add_touch(grab_front *out, rlf_vec3 point, rlf_vec3 normal, double off,
                      rlf_vec3 velocity)
{
    grab_bin *bin = &out->bins[9 * third(normal.x) + 3 * third(normal.y) + third(normal.z)];
    out->weight += 1.0;
    bin->point = rlf_add(bin->point, point);
    bin->normal = rlf_add(bin->normal, normal);
    bin->velocity = rlf_add(bin->velocity, velocity);
    bin->off = bin->weight > 0.0 ? rlf_min(bin->off, off) : off;
    bin->weight += 1.0;
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
    double distance = phys_shape_distance(shape, p, &gradient);
    if (distance < -DEEP_RADIUS * shape->inner_radius) {
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
    if (distance <= job->tolerance) {
        rlf_vec3 seen = rlf_neg(rlf_rotate(to_body, cell->normal));
        gradient = bears(job, cell, p) ? seen : gradient;
        add_touch(job->out, rlf_mad(p, gradient, -distance), gradient, distance,
                  rlf_rotate(to_body, cell->velocity));
    }
}

void grab_look(const grid_query *query, const phys_body *body, const rlf_pose *T_world_body,
               double tau, double tolerance, grab_front *out)
{
    const rlf_grid *grid = query->grid;
    const rlf_grid_sheet *sheet = &grid->foreground;
    look_job job = {query, &body->shape, rlf_pose_mul(&query->T_grid_world, T_world_body),
                    tau,   tolerance,    out};
    double z = job.T_grid_body.p.z, reach = body->shape.radius + tolerance + FINGER_M;
    int32_t rect[4], stride;
    *out = (grab_front){.weight = 0.0};
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

static bool is_in_cone(rlf_vec3 normal, rlf_vec3 along)
{
    return rlf_dot(normal, along) >= CONE_COS * rlf_length(normal) * rlf_length(along);
}

static grab_bin side_of(const grab_front *front, rlf_vec3 axis, double sign)
{
    grab_bin sum = {.off = 1.0};
    for (int32_t i = 0; i < GRAB_BINS; i++) {
        const grab_bin *bin = &front->bins[i];
        if (bin->weight > 0.0 && is_in_cone(bin->normal, rlf_scale(axis, sign))) {
            sum.point = rlf_add(sum.point, bin->point);
            sum.normal = rlf_add(sum.normal, bin->normal);
            sum.velocity = rlf_add(sum.velocity, bin->velocity);
            sum.off = rlf_min(sum.off, bin->off);
            sum.weight += bin->weight;
        }
    }
    const double scale = 1.0 / rlf_max(sum.weight, 1.0);
    return (grab_bin){rlf_scale(sum.point, scale), rlf_scale(sum.normal, scale),
                      rlf_scale(sum.velocity, scale), sum.off, sum.weight};
}

/* The grip of two bins that face each other. */
static bool try_pair(const grab_front *front, int32_t i, int32_t k, grab_grip *out)
{
    if (front->bins[i].weight <= 0.0 || front->bins[k].weight <= 0.0) {
        return false;
    }
    rlf_vec3 a = rlf_normalize(front->bins[i].normal);
    rlf_vec3 b = rlf_normalize(front->bins[k].normal);
    if (rlf_dot(a, b) > OPPOSED_COS) {
        return false;
    }
    out->axis = rlf_normalize(rlf_sub(b, a));
    out->sides[0] = side_of(front, out->axis, -1.0);
    out->sides[1] = side_of(front, out->axis, 1.0);
    return is_in_cone(out->axis, rlf_sub(out->sides[1].point, out->sides[0].point));
}

bool grab_find_grip(const grab_front *front, grab_grip *out)
{
    double best = PIXELS_MIN - 0.5;
    bool is_found = false;
    for (int32_t i = 0; i < GRAB_BINS && front->deep <= DEEP_SHARE * front->weight; i++) {
        for (int32_t k = i + 1; k < GRAB_BINS; k++) {
            grab_grip grip;
            if (!try_pair(front, i, k, &grip)) {
                continue;
            }
            double weight = rlf_min(grip.sides[0].weight, grip.sides[1].weight);
            if (weight > best) {
                best = weight;
                *out = grip;
                is_found = true;
            }
        }
    }
    return is_found;
}
