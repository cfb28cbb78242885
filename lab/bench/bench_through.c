/* Cubes that go through the person, against the true one. */
#include "bench_physics.h"

#define APART 0.02      /* m between the places looked at on a cube's way */
#define OPPOSITE (-0.3) /* cosine between the normals of two sides of a solid */

/* Of the person beyond the picture nothing is known. */
static bool is_in_view(const room *r, rlf_vec3 p)
{
    const rlf_grid *grid = &r->grid;
    double u, v;
    return grid->project(grid->project_context, p, &u, &v) && u >= 0.0 && v >= 0.0 &&
           u <= grid->width - 1 && v <= grid->height - 1;
}

static rlf_synthetic_hit nearest(const room *r, double time_s, rlf_vec3 p)
{
    rlf_synthetic_hit hit = {.distance = 1.0};
    if (is_in_view(r, p)) {
        (void)rlf_synthetic_nearest(r->source, time_s, p, &hit);
    }
    return hit;
}

/* Follows the centre to its next place. Coming out on another side than it got in is to have gone
 * through, if it was deep in. */
static bool follow(shower_passage *way, const rlf_synthetic_hit *hit)
{
    bool is_inside = hit->label == RLF_SYNTHETIC_LABEL_PERSON && hit->distance < 0.0;
    bool is_out = way->is_inside && !is_inside;
    bool is_across = is_out && way->is_deep && rlf_dot(way->entry, way->last) < OPPOSITE;
    way->entry = is_inside && !way->is_inside ? hit->normal : way->entry;
    way->last = is_inside ? hit->normal : way->last;
    way->is_deep = is_inside && (way->is_deep || hit->distance < -SHOWER_DEEP);
    way->is_inside = is_inside;
    return is_across;
}

/* Follows the centre from place to place in the step that ends at `time_s` of the source. */
static bool follow_way(shower_passage *way, const room *r, rlf_vec3 from, rlf_vec3 to,
                       double time_s)
{
    rlf_vec3 path = rlf_sub(to, from);
    int32_t places = 1 + (int32_t)(rlf_length(path) / APART);
    bool is_across = false;
    for (int32_t j = 1; j <= places; j++) {
        double share = (double)j / places;
        double before = (1.0 - share) * 0.5 / ROOM_HZ;
        rlf_synthetic_hit hit =
            nearest(r, rlf_max(time_s - before, 0.0), rlf_mad(from, path, share));
        is_across = follow(way, &hit) || is_across;
    }
    way->steps = way->is_deep ? way->steps + 1 : 0;
    return is_across;
}

void shower_note_places(shower *s)
{
    const rlf_snapshot *snapshot = rlf_world_get_snapshot(s->world);
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        const rlf_body_state *body = &snapshot->bodies[i];
        s->places[1][body->id.index1 - 1] = body->T_world_body.p;
    }
}

void shower_look_for_passages(shower *s, const room *r)
{
    const int32_t STAYS = 2 * SHOWER_LOST; /* steps */
    const rlf_snapshot *snapshot = rlf_world_get_snapshot(s->world);
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        const rlf_body_state *body = &snapshot->bodies[i];
        int32_t k = (int32_t)body->id.index1 - 1;
        shower_passage *way = &s->passages[k];
        rlf_vec3 from = s->places[0][k], between = s->places[1][k], to = body->T_world_body.p;
        bool is_across = follow_way(way, r, from, between, r->time_s);
        is_across = follow_way(way, r, between, to, r->time_s + 0.5 / ROOM_HZ) || is_across;
        if (!way->is_through && (is_across || way->steps >= STAYS)) {
            way->is_through = true;
            s->through_count++;
        }
        s->places[0][k] = to;
    }
}
