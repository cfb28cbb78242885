/* Whether what touches a body holds it: two contacts with friction, antipodal (Nguyen 1988,
 * "Constructing force-closure grasps"). The normals are the body's own: a depth camera sees those
 * of a finger's contact least of all. */
#include "physics/grab/grab.h"

/* Cosine of the friction cone of skin, whose coefficient is 0.8. */
#define CONE_COS 0.78
/* Cosine between the normals of two sides that hold a body between them: with what is hidden
 * behind it they leave it no way out. */
#define OPPOSED_COS (-0.35)
/* A side is touched by so many pixels, or it is noise. */
#define PIXELS_MIN 6.0
/* More pixels deep in the body than this share of those that touch it: it is passed through. */
#define DEEP_SHARE 0.5

static bool is_in_cone(rlf_vec3 normal, rlf_vec3 along)
{
    return rlf_dot(normal, along) >= CONE_COS * rlf_length(normal) * rlf_length(along);
}

static grab_patch mean_of(const grab_patch *sum)
{
    double scale = 1.0 / rlf_max(sum->weight, 1.0);
    grab_patch mean = {rlf_scale(sum->point, scale), rlf_scale(sum->normal, scale),
                       rlf_scale(sum->velocity, scale), sum->off, sum->weight};
    return mean;
}

grab_patch grab_side(const grab_touches *touches, rlf_vec3 axis, double sign)
{
    grab_patch sum = {.off = 1.0};
    rlf_vec3 outward = rlf_scale(axis, sign);
    for (int32_t i = 0; i < touches->count; i++) {
        const grab_patch *patch = &touches->patches[i];
        if (is_in_cone(patch->normal, outward)) {
            sum.point = rlf_add(sum.point, patch->point);
            sum.normal = rlf_add(sum.normal, patch->normal);
            sum.velocity = rlf_add(sum.velocity, patch->velocity);
            sum.off = rlf_min(sum.off, patch->off);
            sum.weight += patch->weight;
        }
    }
    return mean_of(&sum);
}

/* The grip of two patches that face each other. */
static bool try_pair(const grab_touches *touches, int32_t i, int32_t k, grab_grip *out)
{
    rlf_vec3 a = rlf_normalize(touches->patches[i].normal);
    rlf_vec3 b = rlf_normalize(touches->patches[k].normal);
    if (rlf_dot(a, b) > OPPOSED_COS) {
        return false;
    }
    out->axis = rlf_normalize(rlf_sub(b, a));
    out->sides[0] = grab_side(touches, out->axis, -1.0);
    out->sides[1] = grab_side(touches, out->axis, 1.0);
    rlf_vec3 line = rlf_sub(out->sides[1].point, out->sides[0].point);
    return is_in_cone(out->axis, line);
}

bool grab_find_grip(const grab_touches *touches, grab_grip *out)
{
    double best = PIXELS_MIN - 0.5;
    bool is_found = false;
    if (touches->deep > DEEP_SHARE * touches->weight) {
        return false;
    }
    for (int32_t i = 0; i < touches->count; i++) {
        for (int32_t k = i + 1; k < touches->count; k++) {
            grab_grip grip;
            if (!try_pair(touches, i, k, &grip)) {
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
