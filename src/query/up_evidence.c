/* What speaks for a direction being up. Floors, tables and seats look up and are seen from above.
 * What stands on one is seen against it, nearer to the camera, and touches it at its foot; before
 * a wall things hang in the air, and their outlines are jumps of depth all around. */
#include "query/up.h"

enum { BINS = 256 };

static const double bin_m = 0.04;          /* of heights */
static const double widest_m = 1.0;        /* that a small thing hides of what it stands on */
static const double least_height_m = 0.02; /* of a thing */

/* The plane under things. */
typedef struct ground {
    const rlf_surface *surface;
    rlf_vec3 up;
    double height; /* of its points along up */
} ground;

void rlf_up_samples_take(const rlf_surface *surface, rlf_up_samples *out)
{
    int32_t w = surface->width, h = surface->height;
    out->surface = surface;
    out->count = 0;
    out->step = 1;
    do {
        out->step++;
        out->columns = (w + out->step - 1) / out->step;
        out->rows = (h + out->step - 1) / out->step;
    } while ((int64_t)out->columns * out->rows > RLF_UP_SAMPLES);
    for (int32_t y = 0; y < h; y += out->step) {
        for (int32_t x = 0; x < w; x += out->step) {
            int32_t i = y * w + x;
            rlf_vec3 n = {surface->normal_x[i], surface->normal_y[i], surface->normal_z[i]};
            if (surface->depth[i] > 0.0f && (n.x != 0.0 || n.y != 0.0 || n.z != 0.0)) {
                out->normal[out->count] = n;
                out->pixel[out->count++] = i;
            }
        }
    }
}

/* The height along up that most normals along it have. */
static double find_height(const rlf_up_samples *samples, rlf_vec3 up)
{
    int32_t bins[BINS] = {0}, best = 0;
    double sums[BINS] = {0.0};
    for (int32_t i = 0; i < samples->count; i++) {
        double height = rlf_dot(rlf_surface_point(samples->surface, samples->pixel[i]), up);
        double bin = height / bin_m + BINS / 2;
        if (rlf_dot(samples->normal[i], up) > RLF_UP_ALONG && bin >= 0.0 && bin < BINS) {
            bins[(int32_t)bin]++;
            sums[(int32_t)bin] += height;
        }
    }
    int32_t most = 0;
    for (int32_t k = 0; k + 1 < BINS; k++) {
        if (bins[k] + bins[k + 1] > most) {
            most = bins[k] + bins[k + 1];
            best = k;
        }
    }
    return most > 0 ? (sums[best] + sums[best + 1]) / most : 0.0;
}

/* A walk along a row or a column. */
typedef struct walk {
    int32_t last;   /* pixel with depth; -1 = none */
    int32_t left;   /* pixel of the ground that was left last; -1 = none, or what lies lower came
                       between */
    bool touches;   /* a thing that is being passed touches the ground */
    bool is_away;   /* since then something stood there */
    int32_t passed; /* pixels of it */
    int32_t standing;
} walk;

static double noise_at(const rlf_surface *s, int32_t i)
{
    return rlf_depth_noise_sigma(&s->noise, s->depth[i]);
}

static bool is_continuous(const rlf_surface *s, int32_t a, int32_t b)
{
    double z = rlf_min(s->depth[a], s->depth[b]), step = s->depth[a] - s->depth[b];
    double most = 4.0 * z / s->camera.fx + 4.0 * noise_at(s, a);
    return step < most && -step < most;
}

static void come_to_ground(walk *w, const rlf_surface *s, int32_t i)
{
    bool touches = w->touches || (w->last >= 0 && is_continuous(s, w->last, i));
    if (w->is_away && w->left >= 0 && touches) {
        rlf_vec3 hidden = rlf_sub(rlf_surface_point(s, i), rlf_surface_point(s, w->left));
        w->standing += rlf_length(hidden) < widest_m ? w->passed : 0;
    }
    w->left = i;
    w->touches = w->is_away = false;
    w->passed = 0;
}

static void pass(walk *w, const ground *g, int32_t i)
{
    const rlf_surface *s = g->surface;
    if (!(s->depth[i] > 0.0f)) {
        return;
    }
    double height = rlf_dot(rlf_surface_point(s, i), g->up) - g->height;
    double slack = least_height_m + 3.0 * noise_at(s, i) + 0.01 * s->depth[i];
    if (height < -slack) {
        w->left = -1;
    } else if (height < slack) {
        rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
        if (rlf_dot(n, g->up) > RLF_UP_ALONG) {
            come_to_ground(w, s, i);
        }
    } else {
        if (!w->is_away) {
            w->touches = w->last >= 0 && is_continuous(s, w->last, i);
        }
        w->is_away = true;
        w->passed++;
    }
    w->last = i;
}

/* Pixels of small things along a row (stride 1) or a column (stride: the width). */
static int32_t walk_along(const ground *g, int32_t first, int32_t stride, int32_t count)
{
    walk w = {.last = -1, .left = -1};
    for (int32_t k = 0; k < count; k++) {
        pass(&w, g, first + k * stride);
    }
    return w.standing;
}

static double find_standing(const rlf_up_samples *samples, const ground *g)
{
    const rlf_surface *s = g->surface;
    int32_t standing = 0, seen = 2 * samples->count * samples->step;
    for (int32_t y = 0; y < s->height; y += samples->step) {
        standing += walk_along(g, y * s->width, 1, s->width);
    }
    for (int32_t x = 0; x < s->width; x += samples->step) {
        standing += walk_along(g, x, s->width, s->height);
    }
    return seen > 0 ? rlf_min((double)standing / seen, 1.0) : 0.0;
}

/* Logarithm of how likely a ray that goes down by the sine `down` ends on a face that looks up (c:
 * cosine of its normal to up), down, across, or none of these. Rays that go down end on floors and
 * tables, the steeper the more; level ones on walls and sides; few that go up reach a ceiling. */
static double likelihood(double down, double c)
{
    const double other = 0.2;
    double up_share = down > 0.0 ? 0.02 + 0.7 * down : 0.01;
    double down_share = down < 0.0 ? 0.02 - 0.6 * down : 0.01;
    double across_share = 1.0 - other - up_share - down_share;
    double most = rlf_max(across_share, rlf_max(up_share, down_share));
    bool is_across = c < RLF_UP_ACROSS && -c < RLF_UP_ACROSS;
    double share = is_across ? across_share : other;
    share = c > RLF_UP_ALONG ? up_share : -c > RLF_UP_ALONG ? down_share : share;
    return rlf_log_e(share / most);
}

rlf_up_evidence rlf_up_ask(const rlf_up_samples *samples, rlf_vec3 up)
{
    rlf_up_evidence e = {0};
    for (int32_t i = 0; i < samples->count; i++) {
        double c = rlf_dot(samples->normal[i], up);
        rlf_vec3 ray = rlf_normalize(rlf_surface_point(samples->surface, samples->pixel[i]));
        e.likelihood += likelihood(-rlf_dot(ray, up), c);
        e.up += c > RLF_UP_ALONG;
        e.down += -c > RLF_UP_ALONG;
        e.across += c < RLF_UP_ACROSS && -c < RLF_UP_ACROSS;
        e.square += c < RLF_UP_ACROSS / 3 && -c < RLF_UP_ACROSS / 3;
    }
    if (samples->count > 0) {
        e.likelihood /= samples->count;
        e.up /= samples->count;
        e.down /= samples->count;
        e.across /= samples->count;
        e.square /= samples->count;
    }
    const ground g = {samples->surface, up, find_height(samples, up)};
    e.standing = find_standing(samples, &g);
    return e;
}
