/* Depth edges in the colour picture. Each side of near things has its own profile: the mean
 * response of the colour picture's gradient over the shift. Depth sensors make near things wider or
 * narrower by a pixel or two; that moves the peaks of the two sides apart and leaves their middle
 * alone. The error comes from leaving out one part of the picture after the other (jackknife). */
#include "info/color_fit.h"

#include "info/depth_plane.h"

#include <math.h>
#include <string.h>

#define SHIFT_MAX 16.0 /* pixels of the coarser picture */
#define SHIFTS 65      /* half a pixel apart */
#define WIDENING_MAX 6 /* places: three pixels on each side */
#define GROUPS 8       /* tiles of the depth picture, 4 x 2 */
#define EDGES_MIN 200
#define HOLE_MAX 16 /* missing depth pixels between the near and the far side of an edge */

enum { SIDE_LEFT, SIDE_RIGHT, SIDE_TOP, SIDE_BOTTOM, SIDE_COUNT };
enum { HALF_NEAR, HALF_FAR, HALF_COUNT };

typedef struct profile {
    int64_t count;
    double sum[SHIFTS];
} profile;

struct color_fit {
    rlf_rig rig;
    double pixel;   /* colour pixels per place of two */
    double split_z; /* between the nearer and the farther edges; 0 = not yet known */
    int32_t frames;
    float *luma;
    profile profiles[HALF_COUNT][SIDE_COUNT][GROUPS];
};

color_fit *color_fit_create(const rlf_rig *rig)
{
    color_fit *fit = rlf_alloc(sizeof(*fit));
    if (fit == NULL) {
        return NULL;
    }
    fit->rig = *rig;
    fit->pixel = fmax(1.0, rig->color.fx / rig->depth.fx);
    fit->luma =
        rlf_alloc_array((size_t)rig->color.width * (size_t)rig->color.height, sizeof(float));
    if (fit->luma == NULL) {
        color_fit_destroy(&fit);
    }
    return fit;
}

void color_fit_destroy(color_fit **fit)
{
    if (*fit != NULL) {
        rlf_free((*fit)->luma);
        rlf_free(*fit);
        *fit = NULL;
    }
}

/* ---- one edge point ------------------------------------------------------------------------- */

/* ITU-R BT.601. */
static void make_luma(color_fit *fit, const rlf_image_rgba8 *color)
{
    float *out = fit->luma;
    for (ptrdiff_t y = 0; y < color->height; y++) {
        const uint8_t *p = color->data + y * color->stride;
        for (int32_t x = 0; x < color->width; x++, p += 4) {
            *out++ = 0.299f * p[0] + 0.587f * p[1] + 0.114f * p[2];
        }
    }
}

/* Bilinear; false outside. */
static bool sample(const color_fit *fit, double u, double v, double *out)
{
    const int32_t width = fit->rig.color.width;
    const int32_t x = (int32_t)floor(u);
    const int32_t y = (int32_t)floor(v);
    if (x < 0 || y < 0 || x + 1 >= width || y + 1 >= fit->rig.color.height) {
        return false;
    }
    const float *p = fit->luma + (ptrdiff_t)y * width + x;
    const double a = u - x;
    const double b = v - y;
    *out =
        (1.0 - b) * ((1.0 - a) * p[0] + a * p[1]) + b * ((1.0 - a) * p[width] + a * p[width + 1]);
    return true;
}

static double shift_at(const color_fit *fit, double place)
{
    return (place / (SHIFTS - 1) * 2.0 - 1.0) * SHIFT_MAX * fit->pixel;
}

/* Gradients across the edge at every shift; false when one of them lies outside the picture. */
static bool respond(const color_fit *fit, double u, double v, bool is_vertical, double *out)
{
    const double h = 0.5 * fit->pixel;
    for (int i = 0; i < SHIFTS; i++) {
        const double s = shift_at(fit, i);
        double before, after;
        const double du = is_vertical ? s : 0.0;
        const double dv = is_vertical ? 0.0 : s;
        const double hu = is_vertical ? h : 0.0;
        const double hv = is_vertical ? 0.0 : h;
        if (!sample(fit, u + du - hu, v + dv - hv, &before) ||
            !sample(fit, u + du + hu, v + dv + hv, &after)) {
            return false;
        }
        out[i] = fabs(after - before);
    }
    return true;
}

/* Adds the edge at depth pixel (u, v), between pixels, of something at z. */
static void add_edge(color_fit *fit, int side, double u, double v, double z)
{
    rlf_vec3 ray;
    double response[SHIFTS];
    double cu, cv;
    if (!rlf_camera_unproject(&fit->rig.depth, u, v, &ray)) {
        return;
    }
    const rlf_vec3 p = rlf_transform(&fit->rig.T_color_depth, rlf_scale(ray, z));
    if (!rlf_camera_project(&fit->rig.color, p, &cu, &cv) ||
        !respond(fit, cu, cv, side == SIDE_LEFT || side == SIDE_RIGHT, response)) {
        return;
    }
    double mean = 0.0;
    for (int i = 0; i < SHIFTS; i++) {
        mean += response[i] / SHIFTS;
    }
    const int32_t tile_x = (int32_t)(4.0 * u / fit->rig.depth.width);
    const int32_t tile_y = (int32_t)(2.0 * v / fit->rig.depth.height);
    const int32_t group = (tile_x > 3 ? 3 : tile_x) + 4 * (tile_y > 1 ? 1 : tile_y);
    profile *to = &fit->profiles[z < fit->split_z ? HALF_NEAR : HALF_FAR][side][group];
    /* Each point has the same weight, however strong its contrast; two grey levels are noise. */
    for (int i = 0; i < SHIFTS; i++) {
        to->sum[i] += response[i] / (mean + response[i] + 2.0);
    }
    to->count++;
}

/* ---- edges of the depth picture ------------------------------------------------------------- */

/* What one line of the depth picture, a row or a column, is made of. */
typedef struct line {
    const float *first;
    ptrdiff_t step;
    int32_t count, at; /* pixels; which row or column it is */
    bool is_row;
} line;

static float z_at(const line *l, int32_t i)
{
    return l->first[i * l->step];
}

/* The near side goes on behind the edge: no spike of noise. */
static bool is_surface(const color_fit *fit, const line *l, int32_t near, int32_t away)
{
    const double z = z_at(l, near);
    for (int32_t k = 1; k <= 2; k++) {
        const int32_t i = near + k * away;
        if (i < 0 || i >= l->count || z_at(l, i) <= 0.0f ||
            fabs(z_at(l, i) - z) > info_step(&fit->rig, z, k)) {
            return false;
        }
    }
    return true;
}

/* The edge between pixels a < b with nothing measured between. */
static void check_pair(color_fit *fit, const line *l, int32_t a, int32_t b)
{
    const double z_a = z_at(l, a);
    const double z_b = z_at(l, b);
    const double far = fmax(z_a, z_b);
    const double near = fmin(z_a, z_b);
    if (b - a > HOLE_MAX || far - near < info_step(&fit->rig, far, b - a) + 0.05 * near) {
        return;
    }
    const bool is_first = z_a > z_b; /* the near thing begins here, seen from the left or top */
    const int32_t i = is_first ? b : a;
    if (!is_surface(fit, l, i, is_first ? 1 : -1)) {
        return;
    }
    const double place = is_first ? i - 0.5 : i + 0.5;
    const int side =
        l->is_row ? (is_first ? SIDE_LEFT : SIDE_RIGHT) : (is_first ? SIDE_TOP : SIDE_BOTTOM);
    add_edge(fit, side, l->is_row ? place : l->at, l->is_row ? l->at : place, near);
}

static void walk(color_fit *fit, const line *l)
{
    int32_t last = -1;
    for (int32_t i = 0; i < l->count; i++) {
        if (z_at(l, i) <= 0.0f) {
            continue;
        }
        if (last >= 0) {
            check_pair(fit, l, last, i);
        }
        last = i;
    }
}

/* Half of the range of what is seen, in 1/z, as parallax goes. */
static double find_split(const float *depth, size_t count)
{
    double sum = 0.0;
    int64_t n = 0;
    for (size_t i = 0; i < count; i++) {
        if (depth[i] > 0.0f) {
            sum += 1.0 / depth[i];
            n++;
        }
    }
    return n > 0 ? (double)n / sum : 0.0;
}

void color_fit_add(color_fit *fit, const float *depth, const rlf_image_rgba8 *color)
{
    const int32_t width = fit->rig.depth.width;
    const int32_t height = fit->rig.depth.height;
    make_luma(fit, color);
    if (fit->split_z <= 0.0) {
        fit->split_z = find_split(depth, (size_t)width * (size_t)height);
    }
    for (int32_t y = 0; y < height; y++) {
        const line l = {depth + (ptrdiff_t)y * width, 1, width, y, true};
        walk(fit, &l);
    }
    for (int32_t x = 0; x < width; x++) {
        const line l = {depth + x, width, height, x, false};
        walk(fit, &l);
    }
    fit->frames++;
}

/* ---- the offset ----------------------------------------------------------------------------- */

/* Mean profile of a side over the groups but `without`, over the halves of the mask. */
static int64_t mean_profile(const color_fit *fit, int side, int without, unsigned halves,
                            double *out)
{
    int64_t count = 0;
    memset(out, 0, SHIFTS * sizeof(out[0]));
    for (int h = 0; h < HALF_COUNT; h++) {
        for (int g = 0; g < GROUPS; g++) {
            const profile *p = &fit->profiles[h][side][g];
            if (g == without || (halves & (1u << h)) == 0) {
                continue;
            }
            count += p->count;
            for (int i = 0; i < SHIFTS; i++) {
                out[i] += p->sum[i];
            }
        }
    }
    for (int i = 0; i < SHIFTS; i++) {
        out[i] /= count > 0 ? (double)count : 1.0;
    }
    return count;
}

/* Where a parabola through the peak and its neighbours is highest. */
static double refine(const double *p, int i)
{
    if (i <= 0 || i >= SHIFTS - 1) {
        return i;
    }
    const double bend = p[i - 1] - 2.0 * p[i] + p[i + 1];
    return bend < 0.0 ? i + 0.5 * (p[i - 1] - p[i + 1]) / bend : i;
}

/* Best places of the two sides, not farther apart than a widening can be. */
static void find_axis(const color_fit *fit, int first, int without, unsigned halves,
                      color_fit_axis *out)
{
    double a[SHIFTS], b[SHIFTS];
    mean_profile(fit, first, without, halves, a);
    mean_profile(fit, first + 1, without, halves, b);
    int best_a = SHIFTS / 2, best_b = SHIFTS / 2;
    double best = -1.0;
    for (int i = 0; i < SHIFTS; i++) {
        for (int k = i - 2 * WIDENING_MAX; k <= i + 2 * WIDENING_MAX; k++) {
            if (k >= 0 && k < SHIFTS && a[i] + b[k] > best) {
                best = a[i] + b[k];
                best_a = i;
                best_b = k;
            }
        }
    }
    const double at_a = shift_at(fit, refine(a, best_a));
    const double at_b = shift_at(fit, refine(b, best_b));
    out->offset = 0.5 * (at_a + at_b);
    out->widening = 0.5 * (at_a - at_b);
}

static void find_error(const color_fit *fit, int first, color_fit_axis *axis)
{
    double sum = 0.0, square = 0.0;
    for (int g = 0; g < GROUPS; g++) {
        color_fit_axis part;
        find_axis(fit, first, g, 3u, &part);
        sum += part.offset;
        square += part.offset * part.offset;
    }
    const double variance = fmax(square / GROUPS - sum / GROUPS * (sum / GROUPS), 0.0);
    axis->error = sqrt((GROUPS - 1) * variance);
}

static int64_t count_axis(const color_fit *fit, int first, unsigned halves)
{
    double unused[SHIFTS];
    return mean_profile(fit, first, -1, halves, unused) +
           mean_profile(fit, first + 1, -1, halves, unused);
}

static double half_offset(const color_fit *fit, int first, int half)
{
    color_fit_axis axis;
    if (count_axis(fit, first, 1u << half) < EDGES_MIN) {
        return NAN;
    }
    find_axis(fit, first, -1, 1u << half, &axis);
    return axis.offset;
}

void color_fit_get(const color_fit *fit, color_fit_result *out)
{
    memset(out, 0, sizeof(*out));
    const int64_t edges_x = count_axis(fit, SIDE_LEFT, 3u);
    const int64_t edges_y = count_axis(fit, SIDE_TOP, 3u);
    out->edges = edges_x + edges_y;
    out->frames = fit->frames;
    out->pixel = fit->pixel;
    find_axis(fit, SIDE_LEFT, -1, 3u, &out->x);
    find_axis(fit, SIDE_TOP, -1, 3u, &out->y);
    find_error(fit, SIDE_LEFT, &out->x);
    find_error(fit, SIDE_TOP, &out->y);
    out->near_x = half_offset(fit, SIDE_LEFT, HALF_NEAR);
    out->far_x = half_offset(fit, SIDE_LEFT, HALF_FAR);
    out->near_y = half_offset(fit, SIDE_TOP, HALF_NEAR);
    out->far_y = half_offset(fit, SIDE_TOP, HALF_FAR);
    /* Where the parts of the picture do not agree within a pixel, nothing is known. */
    out->is_known = edges_x >= EDGES_MIN && edges_y >= EDGES_MIN && out->x.error <= fit->pixel &&
                    out->y.error <= fit->pixel;
}

double color_fit_length(const color_fit_result *r)
{
    return sqrt(r->x.offset * r->x.offset + r->y.offset * r->y.offset);
}

bool color_fit_is_off(const color_fit_result *r)
{
    const double error = sqrt(r->x.error * r->x.error + r->y.error * r->y.error);
    return r->is_known && color_fit_length(r) > r->pixel + 2.0 * error;
}
