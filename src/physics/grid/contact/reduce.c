/* Contact reduction and persistence. */
#include "physics/grid/contact/search.h"

/* The deepest; among equals (a face lying flat) always the same corner, so that contacts persist.
 */
static int32_t deepest(const grid_job *job, const bool *is_used)
{
    const rlf_vec3 LEAN = {0.0028, 0.0033, 0.0025};
    int32_t best = -1;
    double best_value = 0.0;
    for (int32_t i = 0; i < job->hit_count; i++) {
        const grid_hit *hit = &job->hits[i];
        double value = hit->separation - rlf_dot(hit->anchor, LEAN);
        if (!is_used[i] && (best < 0 || value < best_value)) {
            best_value = value;
            best = i;
        }
    }
    return best;
}

static rlf_vec3 point_of(const grid_job *job, int32_t i)
{
    return job->hits[i].anchor;
}

/* How far apart hits i and k are along the face, metres. */
static rlf_vec3 along_face(const grid_job *job, int32_t i, int32_t k, rlf_vec3 normal)
{
    rlf_vec3 d = rlf_sub(point_of(job, i), point_of(job, k));
    return rlf_mad(d, normal, -rlf_dot(d, normal));
}

/* How much farther out a hit must be for its height over the face, metres: what touches only after
 * a tilt by more than 6 degrees carries nothing yet. A body with a round bottom rocked for ever on
 * four places of its rim. */
static double out_for_height(const grid_job *job, int32_t i)
{
    return 10.0 * rlf_max(0.0, job->hits[i].separation);
}

/* How much choosing hit i widens the support that `chosen` gives along the face, metres: from a
 * point, from a line, then on the line's other side. What is higher over the face touches later, or
 * never. */
static double spread(const grid_job *job, const int32_t *chosen, int32_t count, int32_t i,
                     rlf_vec3 normal)
{
    double height = out_for_height(job, i) - out_for_height(job, chosen[0]);
    rlf_vec3 d = along_face(job, i, chosen[0], normal);
    if (count == 1) {
        return rlf_length(d) - height;
    }
    rlf_vec3 e = rlf_normalize(along_face(job, chosen[1], chosen[0], normal));
    rlf_vec3 beside = rlf_mad(d, e, -rlf_dot(d, e));
    if (count == 2) {
        return rlf_length(beside) - height;
    }
    rlf_vec3 f = along_face(job, chosen[2], chosen[0], normal);
    rlf_vec3 other = rlf_normalize(rlf_mad(f, e, -rlf_dot(f, e)));
    return -rlf_dot(beside, other) - height;
}

/* Up to four hits of one direction; all of that direction are marked as used. */
static int32_t choose_cluster(const grid_job *job, bool *is_used, int32_t chosen[4])
{
    bool is_member[GRID_HITS_MAX] = {false};
    double radius = job->body->shape.radius;
    chosen[0] = deepest(job, is_used);
    if (chosen[0] < 0) {
        return 0;
    }
    const grid_hit *first = &job->hits[chosen[0]];
    rlf_vec3 normal = rlf_mat3_mul_vec(&job->motion.R_body_grid, first->normal);
    for (int32_t i = 0; i < job->hit_count; i++) {
        is_member[i] = !is_used[i] && rlf_dot(job->hits[i].normal, first->normal) > SAME_FACE_COS;
        is_used[i] = is_used[i] || is_member[i];
    }
    is_member[chosen[0]] = false;
    int32_t count = 1;
    while (count < 4) {
        int32_t best = -1;
        double best_value = 1e-3 * radius;
        for (int32_t i = 0; i < job->hit_count; i++) {
            double value = is_member[i] ? spread(job, chosen, count, i, normal) : 0.0;
            if (value > best_value) {
                best_value = value;
                best = i;
            }
        }
        if (best < 0) {
            break;
        }
        is_member[best] = false;
        chosen[count++] = best;
    }
    return count;
}

static void add_contact(const grid_job *job, const grid_hit *hit, phys_body *body,
                        phys_contact *prototype)
{
    const rlf_pose *T_world_grid = &job->query->grid->T_world_grid;
    phys_contact *contact = &body->surface[body->surface_count++];
    *contact = *prototype;
    contact->label = hit->label;
    contact->anchor_a = hit->anchor;
    contact->rounding_a = hit->rounding;
    contact->anchor_b = rlf_transform(T_world_grid, hit->point);
    contact->normal = rlf_rotate(T_world_grid->q, hit->normal);
    if (job->query->is_moving) {
        contact->surface_velocity = rlf_rotate(T_world_grid->q, hit->velocity);
    }
}

void grid_reduce(grid_job *job, phys_body *body, int32_t body_index, rlf_contact_other other)
{
    bool is_used[GRID_HITS_MAX] = {false};
    phys_contact prototype = {.a = body_index, .b = -1, .other = other, .log = -1};
    prototype.surface_time = job->query->time;
    for (int32_t cluster = 0; cluster < 3; cluster++) {
        int32_t chosen[4];
        int32_t count = choose_cluster(job, is_used, chosen);
        for (int32_t i = 0; i < count && body->surface_count < PHYS_SURFACE_CONTACTS; i++) {
            add_contact(job, &job->hits[chosen[i]], body, &prototype);
        }
    }
}

void grid_keep_impulses(phys_body *body, const phys_trace *old, int32_t old_count)
{
    bool is_taken[PHYS_SURFACE_CONTACTS] = {false};
    double limit = 0.3 * body->shape.radius;
    for (int32_t i = 0; i < body->surface_count; i++) {
        phys_contact *contact = &body->surface[i];
        int32_t best = -1;
        double best2 = limit * limit;
        for (int32_t k = 0; k < old_count; k++) {
            rlf_vec3 d = rlf_sub(old[k].anchor_a, contact->anchor_a);
            if (!is_taken[k] && old[k].other == contact->other && rlf_dot(d, d) < best2 &&
                rlf_dot(old[k].normal, contact->normal) > NOISY_FACE_COS) {
                best2 = rlf_dot(d, d);
                best = k;
            }
        }
        if (best >= 0) {
            is_taken[best] = true;
            phys_trace_follow(&old[best], contact);
        }
    }
}
