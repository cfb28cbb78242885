/* Nearest hits and exits among the parts of the room. */
#include "sim/cast.h"

#define SLACK 1e-9 /* metres: far more than what a ball's rounding can hide */

/* Rays about `axis`, and those at the corners. */
typedef struct cone {
    rlf_vec3 axis, corner[4];
    double cosine, sine; /* of half its angle */
    double longest;      /* direction */
} cone;

static cone cone_about(const synth_view *view, synth_rect tile)
{
    const double u = 0.5 * (tile.x0 + tile.x1 - 1), v = 0.5 * (tile.y0 + tile.y1 - 1);
    cone out = {.axis = rlf_normalize(synth_view_ray(view, u, v).direction), .cosine = 1.0};
    for (int i = 0; i < 4; i++) {
        const double corner_u = (i & 1) != 0 ? tile.x0 - 1 : tile.x1;
        const double corner_v = (i & 2) != 0 ? tile.y0 - 1 : tile.y1;
        out.corner[i] = synth_view_ray(view, corner_u, corner_v).direction;
        out.cosine = rlf_min(out.cosine, rlf_dot(out.axis, rlf_normalize(out.corner[i])));
        out.longest = rlf_max(out.longest, rlf_length(out.corner[i]));
    }
    out.sine = sqrt(1.0 - out.cosine * out.cosine);
    return out;
}

/* A sphere can be hit by a ray inside the cone when its centre is no farther outside the cone's
 * side than its radius: aside cos(a) - along sin(a) <= radius. */
static bool may_hit_ball(const cone *c, const synth_candidate *ball, double radius)
{
    const double along = rlf_dot(ball->centre, c->axis);
    const double aside = rlf_length(rlf_mad(ball->centre, c->axis, -along));
    return aside * c->cosine - along * c->sine <= radius;
}

/* A plane from in front, by rays of which some go towards it. */
static bool may_hit_plane(const cone *c, const synth_candidate *plane)
{
    bool is_ahead = false;
    for (int i = 0; i < 4; i++) {
        is_ahead = is_ahead || rlf_dot(plane->centre, c->corner[i]) > -SLACK;
    }
    return is_ahead && plane->origin.y < 0.0;
}

void synth_tile_candidates(const synth_scene *scene, int32_t count, const synth_view *view,
                           synth_rect tile, synth_candidates *out)
{
    const cone rays = cone_about(view, tile);
    out->count = out->last = 0;
    for (int32_t i = 0; i < count; i++) {
        const synth_shape *shape = &scene->statics[i].shape;
        synth_candidate c = {.part = i,
                             .is_plane = shape->type == SYNTH_HALF_SPACE,
                             .centre = rlf_sub(scene->bounds[i].centre, view->origin)};
        const double radius = scene->bounds[i].radius;
        if (c.is_plane) {
            c.centre = rlf_rotate(shape->T_camera_shape.q, rlf_vec3_make(0, 1, 0));
        } else if (!may_hit_ball(&rays, &c, radius)) {
            continue;
        }
        c.origin = rlf_transform_inverse(&shape->T_camera_shape, view->origin);
        c.beyond2 = rlf_dot(c.centre, c.centre) - radius * radius - SLACK;
        c.reach = radius * rays.longest + SLACK;
        if (!c.is_plane || may_hit_plane(&rays, &c)) {
            out->of[out->count++] = c;
        }
    }
}

/* Takes a candidate that is nearer than the best, or as near and before it in the order. */
static bool try_candidate(const synth_scene *scene, const synth_candidate *c, const synth_ray *ray,
                          synth_hit *best)
{
    synth_interval hit;
    if (!synth_shape_meet(&scene->statics[c->part].shape, c->origin, ray->direction, &hit) ||
        !(hit.near > 0.0) || hit.near > best->t ||
        (hit.near == best->t && (best->part < 0 || c->part > best->part))) {
        return false;
    }
    *best = (synth_hit){c->part, hit.near};
    return true;
}

/* Whether the ray passes by a candidate, or meets it behind the best; length2 is the direction's,
 * squared. */
static bool is_out_of_the_way(const synth_candidate *c, rlf_vec3 direction, double length2,
                              const synth_hit *best)
{
    const double along = rlf_dot(c->centre, direction);
    if (c->is_plane) {
        return along < -SLACK || -c->origin.y > (best->t + SLACK) * (along + SLACK);
    }
    const bool is_behind = along < 0.0 && c->beyond2 > 0.0;
    return is_behind || c->beyond2 * length2 > along * along ||
           along - c->reach > best->t * length2;
}

synth_hit synth_cast(const synth_scene *scene, synth_candidates *candidates, const synth_ray *ray)
{
    const double length2 = rlf_dot(ray->direction, ray->direction);
    const int32_t first = candidates->last;
    synth_hit best = {-1, 1e9};
    if (first < candidates->count) {
        (void)try_candidate(scene, &candidates->of[first], ray, &best);
    }
    for (int32_t k = 0; k < candidates->count; k++) {
        const synth_candidate *c = &candidates->of[k];
        if (k != first && !is_out_of_the_way(c, ray->direction, length2, &best) &&
            try_candidate(scene, c, ray, &best)) {
            candidates->last = k;
        }
    }
    return best;
}

double synth_exit(const synth_part *parts, const synth_candidates *candidates, int32_t label,
                  const synth_ray *ray, double t)
{
    synth_interval intervals[SYNTH_PART_MAX];
    int32_t interval_count = 0;
    for (int32_t k = 0; k < candidates->count; k++) {
        const synth_part *part = &parts[candidates->of[k].part];
        if (part->label == label &&
            synth_shape_intersect(&part->shape, ray, &intervals[interval_count])) {
            interval_count++;
        }
    }
    double end = t;
    bool has_grown = true;
    while (has_grown) {
        has_grown = false;
        for (int32_t i = 0; i < interval_count; i++) {
            if (intervals[i].near <= end + 1e-6 && intervals[i].far > end) {
                end = intervals[i].far;
                has_grown = true;
            }
        }
    }
    return end;
}
