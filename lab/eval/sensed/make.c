/* Random throws, drawn in a fixed order: the same on every machine. */
#include "eval/sensed/make.h"

#include "eval/analytic.h"
#include "eval/ball.h"
#include "eval/sensed/room.h"
#include "eval/sensed/throw.h"

#include <string.h>

#define RADIUS_MIN 0.02
#define RADIUS_MAX 0.20
#define EDGE_ON 0.2 /* sine of the angle between a book's cover and the view ray */

/* Octahedra of 4, 8 and 16 cm. */
#define OCTAHEDRON(r)                                                                              \
    {                                                                                              \
        {(r), 0, 0}, {-(r), 0, 0}, {0, (r), 0}, {0, -(r), 0}, {0, 0, (r)},                         \
        {                                                                                          \
            0, 0, -(r)                                                                             \
        }                                                                                          \
    }
static const rlf_vec3 octahedra[3][6] = {OCTAHEDRON(0.04), OCTAHEDRON(0.08), OCTAHEDRON(0.16)};
static const int32_t octahedron_faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                             2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
static const rlf_hull hulls[3] = {{octahedra[0], 6, octahedron_faces, 8},
                                  {octahedra[1], 6, octahedron_faces, 8},
                                  {octahedra[2], 6, octahedron_faces, 8}};

static rlf_shape random_shape(eval_random *r, bool is_ball)
{
    rlf_shape shape = {.type = RLF_SHAPE_SPHERE};
    double radius = eval_random_range(r, RADIUS_MIN, RADIUS_MAX);
    double kind = eval_random_range(r, 0.0, 5.0);
    double slant = eval_random_range(r, 0.4, 1.2);
    rlf_vec3 half = eval_random_in_box(r, rlf_vec3_make(0.4, 0.4, 0.4), rlf_vec3_make(1, 1, 1));
    shape.type = is_ball ? RLF_SHAPE_SPHERE : (rlf_shape_type)(int)kind;
    shape.radius = radius;
    if (shape.type == RLF_SHAPE_BOX) {
        shape.size = rlf_scale(half, 2.0 * radius / rlf_length(half));
    } else if (shape.type == RLF_SHAPE_CAPSULE) {
        shape.radius = 0.5 * slant * radius;
        shape.height = 2.0 * (radius - shape.radius);
    } else if (shape.type == RLF_SHAPE_CYLINDER) {
        shape.radius = radius * rlf_sin(slant);
        shape.height = 2.0 * radius * rlf_cos(slant);
    } else if (shape.type == RLF_SHAPE_HULL) {
        shape.hull = &hulls[radius < 0.06 ? 0 : radius < 0.12 ? 1 : 2];
    }
    return shape;
}

double eval_inner_radius(const rlf_shape *shape)
{
    double half = 0.5 * rlf_min(shape->size.x, rlf_min(shape->size.y, shape->size.z));
    switch (shape->type) {
    case RLF_SHAPE_BOX: return half;
    case RLF_SHAPE_CYLINDER: return rlf_min(shape->radius, 0.5 * shape->height);
    case RLF_SHAPE_HULL: return 0.577 * rlf_shape_radius(shape); /* an octahedron's, 1/sqrt(3) */
    default: return shape->radius;
    }
}

/* A random seen point of the true scene; on what moves if asked. */
static bool pick_point(const eval_room *stage, eval_random *r, bool on_foreground, rlf_vec3 *out)
{
    const int32_t MARGIN = 20;
    const rlf_truth *truth = rlf_source_get_truth(stage->truth);
    const rlf_rig *rig = &rlf_source_get_info(stage->truth)->rig;
    const rlf_camera *camera = &rig->depth;
    for (int32_t i = 0; i < 2000; i++) {
        int32_t x = (int32_t)eval_random_range(r, MARGIN, camera->width - MARGIN);
        int32_t y = (int32_t)eval_random_range(r, MARGIN, camera->height - MARGIN);
        int32_t pixel = y * camera->width + x;
        rlf_vec3 ray;
        if (truth->depth[pixel] > rig->depth_min_m && truth->depth[pixel] < rig->depth_max_m &&
            (!on_foreground || truth->foreground[pixel] != 0) &&
            rlf_camera_unproject(camera, x, y, &ray)) {
            *out = rlf_scale(ray, truth->depth[pixel] / ray.z);
            return true;
        }
    }
    return false;
}

/* False unless the book is seen edge-on. */
static bool book_pose(const eval_room *stage, rlf_pose *out)
{
    const rlf_truth *truth = rlf_source_get_truth(stage->truth);
    for (int32_t i = 0; i < truth->pose_count; i++) {
        if (strcmp(truth->poses[i].name, "book") == 0) {
            *out = truth->poses[i].T_camera_object;
            rlf_vec3 cover = rlf_rotate(out->q, rlf_vec3_make(0, 0, 1));
            double turned = rlf_dot(cover, rlf_normalize(out->p));
            return turned < EDGE_ON && turned > -EDGE_ON;
        }
    }
    return false;
}

/* From farther along the view, or from the left or right of it. */
static bool pick_way_at_anybody(eval_aim aim, const eval_room *stage, eval_random *r,
                                rlf_vec3 *from, rlf_vec3 *to)
{
    rlf_vec3 down = {0, 1, 0};
    if (!pick_point(stage, r, true, to) || rlf_synthetic_get_down(stage->truth, &down) != RLF_OK) {
        return false;
    }
    const rlf_vec3 view = rlf_normalize(*to);
    const rlf_vec3 aside = rlf_normalize(rlf_cross(down, view));
    const double side = eval_random_range(r, -1.0, 1.0) < 0.0 ? -1.0 : 1.0;
    const double away = eval_random_range(r, 0.5, 0.9);
    const rlf_vec3 way = aim == EVAL_AIM_BACK ? view : rlf_scale(aside, side);
    *from = rlf_mad(*to, way, away);
    *from = rlf_add(*from, eval_random_in_box(r, rlf_vec3_make(-0.15, -0.15, -0.15),
                                              rlf_vec3_make(0.15, 0.15, 0.15)));
    return true;
}

/* Where from, and the point to fly to. */
static bool pick_way(const eval_throw_def *def, const eval_room *stage, eval_random *r,
                     rlf_vec3 *from, rlf_vec3 *to)
{
    double side = eval_random_range(r, -1.0, 1.0);
    rlf_pose book;
    switch (def->aim) {
    case EVAL_AIM_ROOM:
    case EVAL_AIM_ANY:
        *from = eval_random_in_box(r, rlf_vec3_make(-0.9, -0.6, 0.7), rlf_vec3_make(0.9, 0.5, 2.4));
        return pick_point(stage, r, def->aim == EVAL_AIM_ANY && side > 0.0, to) ||
               pick_point(stage, r, false, to);
    case EVAL_AIM_BEHIND:
        if (!pick_point(stage, r, true, to)) {
            return false;
        }
        *from = eval_random_in_box(r, rlf_vec3_make(to->x - 0.3, to->y - 0.2, 3.45),
                                   rlf_vec3_make(to->x + 0.3, to->y + 0.2, 3.65));
        return to->x > -1.2 && to->x < 1.2;
    case EVAL_AIM_EDGE:
        if (!book_pose(stage, &book)) {
            return false;
        }
        *to = rlf_transform(&book, eval_random_in_box(r, rlf_vec3_make(-0.06, -0.09, 0),
                                                      rlf_vec3_make(0.06, 0.09, 0)));
        *from = rlf_add(*to, eval_random_in_box(r, rlf_vec3_make(-0.9, -0.15, -0.15),
                                                rlf_vec3_make(-0.6, 0.15, 0.15)));
        return true;
    case EVAL_AIM_BACK:
    case EVAL_AIM_SIDE: return pick_way_at_anybody(def->aim, stage, r, from, to);
    }
    return false;
}

bool eval_sensed_make(const eval_throw_def *def, const eval_room *stage, eval_random *r,
                      rlf_body_def *out)
{
    bool is_aimed = eval_is_aimed(def->aim);
    *out = rlf_body_def_default();
    rlf_vec3 to;
    if (!pick_way(def, stage, r, &out->position, &to)) {
        return false;
    }
    out->shape = random_shape(r, def->balls_only);
    out->mass = eval_random_range(r, 0.05, 1.0);
    out->restitution = eval_random_range(r, 0.3, 0.9);
    out->friction = eval_random_range(r, 0.0, 0.8);
    double speed = eval_random_range(r, 0.5, is_aimed ? 5.0 : 10.0);
    rlf_vec3 turn = eval_random_in_box(r, rlf_vec3_make(-3, -3, -3), rlf_vec3_make(3, 3, 3));
    rlf_vec3 spin = eval_random_in_box(r, rlf_vec3_make(-8, -8, -8), rlf_vec3_make(8, 8, 8));
    out->orientation = rlf_quat_from_rotation_vector(turn);
    out->velocity = rlf_scale(rlf_normalize(rlf_sub(to, out->position)), speed);
    out->angular_velocity = spin;
    out->gravity_scale = is_aimed ? 0.0 : 1.0;
    out->collides_with_bodies = false;
    rlf_synthetic_hit hit;
    double now = stage->frame.time_s;
    return rlf_synthetic_nearest(stage->truth, now, out->position, &hit) == RLF_OK &&
           hit.distance > rlf_shape_radius(&out->shape) + 0.08;
}
