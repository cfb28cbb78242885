/* Depth edges in the colour picture. Each side of near things has its own profile: the mean
 * response of the colour picture's gradient over the shift. Depth sensors make near things wider or
 * narrower by a pixel or two; that moves the peaks of the two sides apart and leaves their middle
 * alone. The error comes from leaving out one part of the picture, or of the time, after the other.
 */
#include "info/info.h"

#include <math.h>
#include <string.h>

#define SHIFTS 65      /* half a pixel apart */
#define WIDENING_MAX 6 /* places: three pixels on each side */
#define HILL 10        /* places on each side: five pixels */
#define TILES 8        /* of the depth picture, 4 x 2 */
#define TIMES 8
#define TIME_FRAMES 5 /* frames in a row that count as one time */
#define EDGES_MIN 100 /* of each side */
#define HOLE_MAX 16   /* missing depth pixels between the near and the far side of an edge */

/* What is left out: a tile, a time, or nothing (both -1). */
typedef struct omission {
    int tile, time;
} omission;
static const omission nothing = {-1, -1};

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
    profile profiles[HALF_COUNT][SIDE_COUNT][TILES][TIMES];
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
    return (place / (SHIFTS - 1) * 2.0 - 1.0) * COLOR_FIT_REACH * fit->pixel;
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
    const int32_t time = fit->frames / TIME_FRAMES % TIMES;
    const int32_t group = (tile_x > 3 ? 3 : tile_x) + 4 * (tile_y > 1 ? 1 : tile_y);
    profile *to = &fit->profiles[z < fit->split_z ? HALF_NEAR : HALF_FAR][side][group][time];
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
    ptrdiff_t step, across;
    int32_t count, at, lines; /* pixels; which row or column it is, and of how many */
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

/* Whether the lines beside have the edge within two pixels of here: it runs straight across, and is
 * no speck. `away` leads from the edge into the near side. */
static bool is_straight(const color_fit *fit, const line *l, int32_t near, int32_t away)
{
    const double z = z_at(l, near);
    const double step = info_step(&fit->rig, z, 3);
    const int32_t in = near + 2 * away;
    const int32_t out = near - 3 * away;
    for (int32_t k = -2; k <= 2; k += 4) {
        if (l->at + k < 0 || l->at + k >= l->lines || out < 0 || out >= l->count) {
            return false;
        }
        const float *beside = l->first + k * l->across;
        const double z_in = beside[in * l->step];
        const double z_out = beside[out * l->step];
        if (fabs(z_in - z) > step || (z_out > 0.0 && z_out < z + step)) {
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
    const int32_t away = is_first ? 1 : -1;
    if (!is_surface(fit, l, i, away) || !is_straight(fit, l, i, away)) {
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
        const line l = {depth + (ptrdiff_t)y * width, 1, width, width, y, height, true};
        walk(fit, &l);
    }
    for (int32_t x = 0; x < width; x++) {
        const line l = {depth + x, width, 1, height, x, width, false};
        walk(fit, &l);
    }
    fit->frames++;
}

/* ---- the offset ----------------------------------------------------------------------------- */

static bool is_in(const omission *without, int tile, int time)
{
    return tile != without->tile && time != without->time;
}

/* Mean profile of a side over all parts but what is left out, over the halves of the mask. */
static int64_t mean_profile(const color_fit *fit, int side, omission without, unsigned halves,
                            double *out)
{
    int64_t count = 0;
    memset(out, 0, SHIFTS * sizeof(out[0]));
    for (int k = 0; k < HALF_COUNT * TILES * TIMES; k++) {
        const int half = k / (TILES * TIMES);
        const int tile = k / TIMES % TILES;
        const int time = k % TIMES;
        const profile *p = &fit->profiles[half][side][tile][time];
        if (p->count == 0 || (halves & (1u << half)) == 0 || !is_in(&without, tile, time)) {
            continue;
        }
        count += p->count;
        for (int i = 0; i < SHIFTS; i++) {
            out[i] += p->sum[i];
        }
    }
    for (int i = 0; i < SHIFTS; i++) {
        out[i] /= count > 0 ? (double)count : 1.0;
    }
    return count;
}

/* Both sides of one direction; what a curve stands out of its surroundings, summed over the
 * edges. Other things' edges run at any distance from depth's: they make hills and no peaks. */
typedef struct side_pair {
    double first[SHIFTS], second[SHIFTS];
} side_pair;

static void sharpen(const double *curve, double weight, double *out)
{
    for (int i = 0; i < SHIFTS; i++) {
        double sum = 0.0;
        int count = 0;
        for (int k = i - HILL; k <= i + HILL; k++) {
            if (k >= 0 && k < SHIFTS) {
                sum += curve[k];
                count++;
            }
        }
        out[i] = weight * (curve[i] - sum / count);
    }
}

static void load_pair(const color_fit *fit, int first, omission without, unsigned halves,
                      side_pair *out)
{
    double *const sides[2] = {out->first, out->second};
    for (int k = 0; k < 2; k++) {
        double curve[SHIFTS];
        const int64_t count = mean_profile(fit, first + k, without, halves, curve);
        sharpen(curve, (double)count, sides[k]);
    }
}

/* Both sides when the offset is at place `i` and each side is widened by `w` places. */
static double pair_at(const side_pair *p, int i, int w)
{
    const int a = i - w;
    const int b = i + w;
    return a >= 0 && b >= 0 && a < SHIFTS && b < SHIFTS ? p->first[a] + p->second[b] : -INFINITY;
}

static double best_place(const side_pair *p, int w, int *out)
{
    double best = -INFINITY;
    for (int i = 0; i < SHIFTS; i++) {
        const double value = pair_at(p, i, w);
        if (value > best) {
            best = value;
            *out = i;
        }
    }
    return best;
}

/* A parabola through the best place and its neighbours tells the parts of a place. */
static double refine(const side_pair *p, int i, int w)
{
    const double before = pair_at(p, i - 1, w);
    const double after = pair_at(p, i + 1, w);
    const double bend = before - 2.0 * pair_at(p, i, w) + after;
    return isfinite(bend) && bend < 0.0 ? i + 0.5 * (before - after) / bend : i;
}

typedef struct offset {
    double x, y, widening;
} offset;

/* Widening is the sensor's: the same for both directions. */
static offset find_offset(const color_fit *fit, omission without, unsigned halves)
{
    side_pair x, y;
    load_pair(fit, SIDE_LEFT, without, halves, &x);
    load_pair(fit, SIDE_TOP, without, halves, &y);
    double best = -INFINITY;
    int best_w = 0, best_x = SHIFTS / 2, best_y = SHIFTS / 2;
    for (int w = -WIDENING_MAX; w <= WIDENING_MAX; w++) {
        int at_x = 0, at_y = 0;
        const double value = best_place(&x, w, &at_x) + best_place(&y, w, &at_y);
        if (value > best) {
            best = value;
            best_w = w;
            best_x = at_x;
            best_y = at_y;
        }
    }
    const offset result = {shift_at(fit, refine(&x, best_x, best_w)),
                           shift_at(fit, refine(&y, best_y, best_w)),
                           -best_w * COLOR_FIT_REACH * fit->pixel * 2.0 / (SHIFTS - 1)};
    return result;
}

/* Jackknife (Quenouille 1956): how the offset changes when one part is left out. */
static offset jackknife(const offset *parts, int count)
{
    double sum[2] = {0}, square[2] = {0};
    for (int i = 0; i < count; i++) {
        sum[0] += parts[i].x / count;
        sum[1] += parts[i].y / count;
        square[0] += parts[i].x * parts[i].x / count;
        square[1] += parts[i].y * parts[i].y / count;
    }
    const offset error = {sqrt((count - 1) * fmax(square[0] - sum[0] * sum[0], 0.0)),
                          sqrt((count - 1) * fmax(square[1] - sum[1] * sum[1], 0.0)), 0.0};
    return error;
}

/* The larger of two errors: things differ from place to place, and while the camera moves, pictures
 * taken at different times differ from time to time. */
static offset find_error(const color_fit *fit, unsigned halves)
{
    offset parts[TILES + TIMES];
    const int times = (fit->frames + TIME_FRAMES - 1) / TIME_FRAMES;
    for (int i = 0; i < TILES; i++) {
        parts[i] = find_offset(fit, (omission){i, -1}, halves);
    }
    const int count = times < TIMES ? times : TIMES;
    for (int i = 0; i < count; i++) {
        parts[TILES + i] = find_offset(fit, (omission){-1, i}, halves);
    }
    offset error = jackknife(parts, TILES);
    if (count > 1) {
        const offset other = jackknife(parts + TILES, count);
        error.x = fmax(error.x, other.x);
        error.y = fmax(error.y, other.y);
    }
    return error;
}

static int64_t count_side(const color_fit *fit, int side, unsigned halves)
{
    double unused[SHIFTS];
    return mean_profile(fit, side, nothing, halves, unused);
}

/* Each side must be there: of one alone an offset cannot be told from a widening. And where the
 * parts of the picture do not agree within a pixel, nothing is known. */
static bool is_sure(const color_fit *fit, unsigned halves, const offset *error)
{
    for (int side = 0; side < SIDE_COUNT; side++) {
        if (count_side(fit, side, halves) < EDGES_MIN) {
            return false;
        }
    }
    return error->x <= fit->pixel && error->y <= fit->pixel;
}

/* The offset from some of the edges; false = not known. */
static bool find_part(const color_fit *fit, unsigned halves, color_fit_result *out)
{
    const offset o = find_offset(fit, nothing, halves);
    const offset error = find_error(fit, halves);
    out->x = o.x;
    out->y = o.y;
    out->widening = o.widening;
    out->error_x = error.x;
    out->error_y = error.y;
    return is_sure(fit, halves, &error);
}

void color_fit_get(const color_fit *fit, color_fit_result *out)
{
    color_fit_result near = {0}, far = {0};
    memset(out, 0, sizeof(*out));
    const bool is_near_known = find_part(fit, 1u << HALF_NEAR, &near);
    const bool is_far_known = find_part(fit, 1u << HALF_FAR, &far);
    out->is_known = find_part(fit, 3u, out);
    if (!out->is_known && is_far_known) {
        *out = far;
        out->is_known = out->is_far_only = true;
    }
    for (int side = 0; side < SIDE_COUNT; side++) {
        out->edges += count_side(fit, side, 3u);
    }
    out->frames = fit->frames;
    out->pixel = fit->pixel;
    out->apart_x = hypot(near.error_x, far.error_x);
    out->apart_y = hypot(near.error_y, far.error_y);
    out->near_x = is_near_known ? near.x : NAN;
    out->near_y = is_near_known ? near.y : NAN;
    out->far_x = is_far_known ? far.x : NAN;
    out->far_y = is_far_known ? far.y : NAN;
}

double color_fit_length(const color_fit_result *r)
{
    return sqrt(r->x * r->x + r->y * r->y);
}

double color_fit_error(const color_fit_result *r)
{
    return sqrt(r->error_x * r->error_x + r->error_y * r->error_y);
}

bool color_fit_is_off(const color_fit_result *r)
{
    return r->is_known && color_fit_length(r) > r->pixel + 2.0 * color_fit_error(r);
}

static bool is_apart(double near, double far, double error, double pixel)
{
    const double apart = fabs(near - far); /* NAN: false */
    return apart > 2.0 * pixel && apart > pixel + 2.0 * error;
}

bool color_fit_is_parallax_wrong(const color_fit_result *r)
{
    return r->is_known && (is_apart(r->near_x, r->far_x, r->apart_x, r->pixel) ||
                           is_apart(r->near_y, r->far_y, r->apart_y, r->pixel));
}
