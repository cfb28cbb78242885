/* Points of a body's surface against the map. */
#include "physics/grid/mapped/mapped.h"

#include "relief/map.h"

/* The directions of the map's surface about a body, grid frame, and a place of each. */
typedef struct mapped_normals {
    rlf_vec3 of[GRID_NORMALS_MAX];
    mapped_touch touches[GRID_NORMALS_MAX];
    bool has_touch[GRID_NORMALS_MAX];
    int32_t count;
} mapped_normals;

/* `touch`: NULL = none is known. */
static void note_normal(mapped_normals *normals, rlf_vec3 normal, const mapped_touch *touch)
{
    int32_t i = 0;
    while (i < normals->count && rlf_dot(normals->of[i], normal) <= ONE_PLANE_COS) {
        i++;
    }
    if (i == GRID_NORMALS_MAX) {
        return;
    }
    if (i == normals->count) {
        normals->of[i] = normal;
        normals->has_touch[i] = false;
        normals->count++;
    }
    if (touch != NULL && !normals->has_touch[i]) {
        normals->touches[i] = *touch;
        normals->has_touch[i] = true;
    }
}

/* The body's point that a core point and a direction name, from its centre, grid frame. */
static rlf_vec3 arm_of(const grid_job *job, rlf_vec3 anchor, double rounding, rlf_vec3 normal)
{
    return rlf_mad(rlf_mat3_mul_vec(&job->motion.R_grid_body, anchor), normal, -rounding);
}

/* Whether one of the hits from `first` on is with a face that looks that way. */
static bool has_face(const grid_job *job, int32_t first, rlf_vec3 normal)
{
    for (int32_t i = first; i < job->hit_count; i++) {
        if (rlf_dot(job->hits[i].normal, normal) > APART_COS) {
            return true;
        }
    }
    return false;
}

/* Whether the map tells of the hit's place better: it meets that face itself, or has no face so
 * near there. */
static bool is_known_better(const grid_job *job, const grid_hit *hit, int32_t first)
{
    const grid_query *query = job->query;
    rlf_vec3 q = rlf_add(job->motion.centre, arm_of(job, hit->anchor, hit->rounding, hit->normal));
    double at_body, at_face;
    if (mapped_distance(query, q, &at_body) &&
        (has_face(job, first, hit->normal) || hit->separation < at_body - GRID_NOISE_M)) {
        return true;
    }
    bool is_off = mapped_distance(query, hit->point, &at_face) &&
                  (at_face > GRID_NOISE_M || at_face < -GRID_NOISE_M);
    return is_off || mapped_is_open(query, q) || mapped_is_open(query, hit->point);
}

/* Of the hits before `first` keeps those of which the map does not know better. */
static void keep_unknown(grid_job *job, int32_t first)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < job->hit_count; i++) {
        if (i >= first || !is_known_better(job, &job->hits[i], first)) {
            job->hits[kept] = job->hits[i];
            kept++;
        }
    }
    job->hit_count = kept;
}

/* Casts a point at `arm` from the centre along its way; *touch is in the world. */
static bool cast_arm(const grid_job *job, rlf_vec3 arm, double margin, mapped_touch *touch)
{
    const rlf_grid *grid = job->query->grid;
    rlf_vec3 q = rlf_add(job->motion.centre, arm);
    rlf_vec3 v = rlf_add(job->motion.v, rlf_cross(job->motion.w, arm));
    rlf_vec3 path = rlf_scale(v, job->window.horizon);
    return mapped_cast(job->query, rlf_transform(&grid->T_world_grid, q),
                       rlf_rotate(grid->T_world_grid.q, path), margin, touch);
}

static void add_touch(grid_job *job, const mapped_touch *touch, rlf_vec3 anchor, double rounding,
                      rlf_vec3 towards)
{
    grid_hit hit = {.point = rlf_transform(&job->query->T_grid_world, touch->point)};
    hit.normal = rlf_rotate(job->query->T_grid_world.q, touch->normal);
    hit.anchor = anchor;
    hit.rounding = rounding;
    hit.separation = touch->separation;
    grid_follow_plane(job, &hit, arm_of(job, anchor, rounding, towards), towards);
    grid_add_hit(job, &hit);
}

/* The sample points of the body's surface. Of what is round they only tell directions. */
static void meet_samples(grid_job *job, bool is_round, mapped_normals *normals)
{
    const double ROUND_SHARE = 0.2; /* of the radius: as much lower is a ball between its samples */
    const phys_shape *shape = &job->body->shape;
    double margin = GRID_MARGIN + (is_round ? ROUND_SHARE * shape->radius : 0.0);
    for (int32_t i = 0; i < shape->point_count; i++) {
        mapped_touch touch;
        rlf_vec3 none = {0, 0, 0};
        if (cast_arm(job, arm_of(job, shape->points[i], 0.0, none), margin, &touch)) {
            note_normal(normals, rlf_rotate(job->query->T_grid_world.q, touch.normal), &touch);
            if (!is_round) {
                add_touch(job, &touch, shape->points[i], 0.0, none);
            }
        }
    }
}

/* The face that the map knows about a place of the body, against the body's points: those may be
 * deeper in the solid than the map knows. */
static void meet_face_at(grid_job *job, rlf_vec3 anchor, double rounding)
{
    const phys_shape *shape = &job->body->shape;
    rlf_vec3 arm = rlf_mat3_mul_vec(&job->motion.R_grid_body, anchor);
    rlf_vec3 q = rlf_add(job->motion.centre, arm);
    rlf_vec3 p = rlf_transform(&job->query->grid->T_world_grid, q);
    rlf_map_point there = rlf_map_sample(job->query->map, p);
    if (there.state == RLF_MAP_UNKNOWN || rlf_dot(there.gradient, there.gradient) < 0.5 ||
        there.distance > rounding) {
        return;
    }
    mapped_touch touch = {.normal = there.gradient};
    touch.point = rlf_mad(p, there.gradient, -there.distance);
    rlf_vec3 normal = rlf_rotate(job->query->T_grid_world.q, there.gradient);
    if (rounding > 0.0) {
        add_touch(job, &touch, anchor, rounding, normal);
        return;
    }
    for (int32_t i = 0; i < shape->vertex_count; i++) {
        rlf_vec3 to = rlf_sub(shape->points[i], anchor);
        to = rlf_mat3_mul_vec(&job->motion.R_grid_body, to);
        touch.separation = there.distance + rlf_dot(normal, to);
        if (touch.separation < 0.0) {
            add_touch(job, &touch, shape->points[i], 0.0, normal);
        }
    }
}

/* A point that the shape names for one of those directions, where that comes to the surface. In a
 * small gap of what the map knows the face goes on as it is beside it. */
static void meet_support(grid_job *job, rlf_vec3 core, double rounding,
                         const mapped_normals *normals, int32_t i)
{
    rlf_vec3 normal = normals->of[i], arm = arm_of(job, core, rounding, normal);
    double distance;
    mapped_touch touch;
    if (cast_arm(job, arm, GRID_MARGIN, &touch)) {
        add_touch(job, &touch, core, rounding, normal);
    } else if (normals->has_touch[i] && rounding > 0.0 &&
               !mapped_distance(job->query, rlf_add(job->motion.centre, arm), &distance)) {
        add_touch(job, &normals->touches[i], core, rounding, normal);
    }
}

/* The points that a shape names for each of those directions. */
static void meet_supports(grid_job *job, const mapped_normals *normals)
{
    for (int32_t i = 0; i < normals->count; i++) {
        rlf_vec3 core[2], normal = normals->of[i];
        double rounding;
        rlf_vec3 down = rlf_mat3_mul_vec(&job->motion.R_body_grid, rlf_neg(normal));
        int32_t count = phys_shape_support(&job->body->shape, down, core, &rounding);
        for (int32_t k = 0; k < count; k++) {
            if (phys_shape_is_round(&job->body->shape)) {
                meet_face_at(job, core[k], rounding);
            }
            meet_support(job, core[k], rounding, normals, i);
        }
    }
}

/* Whether all that the body can come to is in the picture, and before what that shows. */
static bool is_all_seen(const grid_job *job)
{
    const double AROUND = 1.5; /* of the reach: what is aside looks wider the nearer it is */
    rlf_vec3 centre = job->motion.centre;
    double r = AROUND * job->window.reach;
    if (job->scan.is_near || centre.z < 2.0 * r || !mapped_is_seen(job->query->grid, centre)) {
        return false;
    }
    for (int32_t k = 0; k < 4; k++) {
        int32_t x, y;
        rlf_vec3 corner = rlf_vec3_make(k & 1 ? r : -r, k & 2 ? r : -r, 0);
        if (!grid_pixel_of(job->query->grid, rlf_add(centre, corner), &x, &y)) {
            return false;
        }
    }
    return true;
}

void mapped_collide(grid_job *job)
{
    if (job->query->map == NULL || is_all_seen(job)) {
        return;
    }
    rlf_vec3 centre = rlf_transform(&job->query->grid->T_world_grid, job->motion.centre);
    rlf_map_point there = rlf_map_sample(job->query->map, centre);
    double gap = there.state == RLF_MAP_FREE ? there.distance : 0.0;
    job->scan.nearest2 = rlf_min(job->scan.nearest2, gap * gap);
    int32_t first = job->hit_count;
    if (gap > job->window.reach) {
        keep_unknown(job, first);
        return;
    }
    bool is_round = phys_shape_is_round(&job->body->shape);
    mapped_normals normals = {.count = 0};
    if (rlf_dot(job->query->up, job->query->up) > 0.0) {
        note_normal(&normals, job->query->up, NULL);
    }
    meet_samples(job, is_round, &normals);
    meet_supports(job, &normals);
    const rlf_vec3 middle = {0, 0, 0};
    meet_face_at(job, middle, 0.0);
    keep_unknown(job, first);
}
