/* Nearest hits and exits among the parts of the room. */
#include "capture/synthetic/cast.h"

/* A sphere can be hit by a ray inside the cone about `axis` of half angle a when its centre is no
 * farther outside the cone's side than its radius: aside cos(a) - along sin(a) <= radius. */
void synth_tile_candidates(const synth_scene *scene, int32_t count, const synth_view *view,
                           synth_rect tile, synth_candidates *out)
{
    double u = 0.5 * (tile.x0 + tile.x1 - 1);
    double v = 0.5 * (tile.y0 + tile.y1 - 1);
    rlf_vec3 axis = rlf_normalize(synth_view_ray(view, u, v).direction);
    double cosine = 1.0;
    for (int i = 0; i < 4; i++) {
        double corner_u = (i & 1) != 0 ? tile.x0 - 1 : tile.x1;
        double corner_v = (i & 2) != 0 ? tile.y0 - 1 : tile.y1;
        rlf_vec3 d = rlf_normalize(synth_view_ray(view, corner_u, corner_v).direction);
        cosine = rlf_min(cosine, rlf_dot(axis, d));
    }
    double sine = sqrt(1.0 - cosine * cosine);
    out->count = 0;
    for (int32_t i = 0; i < count; i++) {
        const double radius = scene->bounds[i].radius;
        rlf_vec3 offset = rlf_sub(scene->bounds[i].centre, view->origin);
        double along = rlf_dot(offset, axis);
        double aside = rlf_length(rlf_mad(offset, axis, -along));
        if (aside * cosine - along * sine <= radius) {
            out->index[out->count++] = i;
        }
    }
}

synth_hit synth_cast(const synth_scene *scene, const synth_candidates *candidates,
                     const synth_ray *ray)
{
    synth_hit best = {-1, 1e9};
    for (int32_t k = 0; k < candidates->count; k++) {
        int32_t i = candidates->index[k];
        synth_interval hit;
        if (synth_shape_intersect(&scene->statics[i].shape, ray, &hit) && hit.near > 0.0 &&
            hit.near < best.t) {
            best.part = i;
            best.t = hit.near;
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
        const synth_part *part = &parts[candidates->index[k]];
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
