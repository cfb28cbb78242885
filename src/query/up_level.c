/* What lies must not roll: `up` is made to stand on floors and tables, by chords between points of
 * one height, which noise turns less than normals the longer they are. */
#include "query/up.h"

enum { STEP = 4 }; /* pixels between samples, both ways */

static const double sure_share = 0.03; /* of the squares: the next direction must be worse by it */

static void add_square(double a[6][6], rlf_vec3 d, double weight)
{
    const double v[3] = {d.x, d.y, d.z};
    for (int32_t k = 0; k < 9; k++) {
        a[k / 3][k % 3] += weight * v[k / 3] * v[k % 3];
    }
}

/* Or ceiling. */
static bool is_floor(const rlf_surface *s, int32_t i, rlf_vec3 up)
{
    rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
    double c = rlf_dot(n, up);
    return c > RLF_UP_ALONG || -c > RLF_UP_ALONG;
}

/* Adds what lies between two floor pixels, weighed by how exact depth is there. */
static double add_chord(double a[6][6], const rlf_surface *s, int32_t i, int32_t k, rlf_vec3 up,
                        double most_sin)
{
    rlf_vec3 d = rlf_sub(rlf_surface_point(s, k), rlf_surface_point(s, i));
    double rise = rlf_dot(d, up), z = rlf_max(s->depth[i], s->depth[k]);
    if (rise * rise < most_sin * most_sin * rlf_dot(d, d)) {
        double weight = 1.0 / (z * z * z * z);
        add_square(a, d, weight);
        return weight * rlf_dot(d, d);
    }
    return 0.0;
}

/* Chords of `length` pixels to the right and down from every floor pixel; returns their weight. */
static double add_chords(double a[6][6], const rlf_surface *s, int32_t length, rlf_vec3 up,
                         double most_sin)
{
    double weight = 0.0;
    for (int32_t y = 0; y + length < s->height; y += STEP) {
        for (int32_t x = 0; x + length < s->width; x += STEP) {
            int32_t i = y * s->width + x, right = i + length, below = i + length * s->width;
            if (!is_floor(s, i, up)) {
                continue;
            }
            weight += is_floor(s, right, up) ? add_chord(a, s, i, right, up, most_sin) : 0.0;
            weight += is_floor(s, below, up) ? add_chord(a, s, i, below, up, most_sin) : 0.0;
        }
    }
    return weight;
}

rlf_vec3 rlf_up_level(const rlf_surface *s, rlf_vec3 up)
{
    double most_sin = 0.14;
    for (int32_t round = 0; round < 3; round++, most_sin *= 0.6) {
        double a[6][6] = {{0}};
        double weight = add_chords(a, s, s->width / 10, up, most_sin);
        weight += add_chords(a, s, s->width / 40, up, most_sin);
        rlf_vec3 next = up;
        if (!(weight > 0.0) || rlf_up_least(a, &next) < sure_share * weight) {
            break;
        }
        up = next;
    }
    return up;
}
