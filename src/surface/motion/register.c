/* The rigid motion of a keyframe into a frame: point-to-plane inside (Chen and Medioni 1991), along
 * the normals of the outline at its edge (Harris 1990, "RAPID"), by Gauss and Newton. */
#include "surface/motion/keyframe.h"

#include <math.h>
#include <string.h>

enum { PASSES = 3, COARSE_PASSES = 6 };

/* How well a window's fill places an outline, pixels: it runs along the pixels in the worst case.
 */
static const double rim_sigma_px = 0.4;
/* Neighbouring pixels share noise, and windows share pixels: so many count as one. */
static const double points_shared = 2.0, rims_shared = 3.0;
/* An outline by one pixel in so many across the rows or columns is as any other; one along them
 * tells so much of that. */
static const double slant = 10.0, aligned = 0.1;
/* A pose is no better than this, however many pixels tell it: errors that all of them share. */
static const double shared_px = 0.15, shared_depth = 0.001;
/* Prior of a pose: what nothing is seen of stays as it is, metres. */
static const double loose_m = 0.02;
/* A turn that is told by less than this share of all is chance: a disc's about its axis. */
static const double held_share = 0.01;
/* What is farther off is something else: it costs no more, as what is hidden does. */
static const double sigmas = 3.0;

/* Of what is seen so much agrees with a motion; and of the keyframe so much is seen. */
static const double agree_share = 0.6, seen_share = 0.4;
/* Of all of the keyframe so much agrees: there is no better. */
static const double sure_share = 0.9;

typedef struct placed {
    const rlf_keyframe *key;
    double r[3][3]; /* rotation */
    rlf_vec3 centre;
} placed;

static placed place(const rlf_keyframe *key, const double x[6])
{
    placed out = {.key = key};
    const double s = 1.0 / key->length;
    const rlf_quat by = rlf_quat_from_rotation_vector(rlf_vec3_make(s * x[3], s * x[4], s * x[5]));
    const rlf_quat q = rlf_quat_mul(by, key->turn);
    for (int c = 0; c < 3; c++) {
        const rlf_vec3 axis = {c == 0, c == 1, c == 2}, to = rlf_rotate(q, axis);
        out.r[0][c] = to.x;
        out.r[1][c] = to.y;
        out.r[2][c] = to.z;
    }
    out.centre = rlf_add(key->centre, rlf_vec3_make(x[0], x[1], x[2]));
    return out;
}

static rlf_vec3 turned(const placed *at, const float v[3])
{
    const double x = v[0], y = v[1], z = v[2];
    return rlf_vec3_make(at->r[0][0] * x + at->r[0][1] * y + at->r[0][2] * z,
                         at->r[1][0] * x + at->r[1][1] * y + at->r[1][2] * z,
                         at->r[2][0] * x + at->r[2][1] * y + at->r[2][2] * z);
}

/* The point at `arm` from the centre is seen `off` metres farther along n. */
static void add_row(keyframe_fit *fit, const rlf_keyframe *key, rlf_vec3 arm, rlf_vec3 n,
                    double off, double weight)
{
    const rlf_vec3 turn = rlf_scale(rlf_cross(arm, n), 1.0 / key->length);
    math_rigid_add(&fit->sums, n, turn, off, weight);
}

/* Pixel of a point; false out of view. u, v: where exactly. */
static bool pixel_of(const image_grid *grid, rlf_vec3 p, double *u, double *v, int32_t *x,
                     int32_t *y)
{
    if (!(p.z > 0.05) || !rlf_camera_project(&grid->camera, p, u, v) || !(*u > -0.5) ||
        !(*v > -0.5) || !(*u < grid->width - 0.5) || !(*v < grid->height - 0.5)) {
        return false;
    }
    *x = (int32_t)(*u + 0.5);
    *y = (int32_t)(*v + 0.5);
    return true;
}

/* Metres that the frame shows a point beyond its plane; false without depth there. */
static bool point_off(const keyframe_frame *frame, rlf_vec3 p, rlf_vec3 n, double *off,
                      double *sigma)
{
    double u, v;
    int32_t x, y;
    if (!pixel_of(frame->grid, p, &u, &v, &x, &y)) {
        return false;
    }
    const ptrdiff_t i = (ptrdiff_t)y * frame->grid->width + x;
    const double z = frame->depth[i];
    const rlf_vec3 ray = {frame->grid->ray_x[i], frame->grid->ray_y[i], 1.0};
    const double facing = -rlf_dot(n, ray);
    if (!(z > 0.0) || !(facing > 0.05)) {
        return false;
    }
    *off = rlf_dot(n, rlf_sub(rlf_scale(ray, z), p));
    *sigma = (double)rlf_kernel_sigma(frame->noise, (float)p.z) * facing;
    return true;
}

/* Of the squares that a row costs at most, what it does not cost. */
static double squares_left(double x)
{
    return rlf_max(sigmas * sigmas - x * x, 0.0);
}

static void add_point(const keyframe_frame *frame, const placed *at, const keyframe_point *point,
                      double slack, keyframe_fit *fit)
{
    const rlf_vec3 arm = turned(at, point->p), n = turned(at, point->n);
    double off, sigma;
    if (!point_off(frame, rlf_add(at->centre, arm), n, &off, &sigma)) {
        return;
    }
    off -= (double)point->bias;
    const double bound = slack + sigmas * sigma + 0.002;
    if (off > bound) {
        return; /* hidden: the normal faces the camera */
    }
    fit->points++;
    fit->cost -= squares_left(off / sigma) / points_shared;
    if (off >= -bound) {
        fit->agree++;
        add_row(fit, at->key, arm, n, off, 1.0 / (points_shared * sigma * sigma));
    }
}

static double size_of(double x)
{
    return x < 0.0 ? -x : x;
}

/* Of the way along (x, y), that in the direction of the pixels that is longer. */
static double per_step(double x, double y)
{
    return rlf_max(size_of(x), size_of(y));
}

/* Pixels that the outline is seen farther out than the rim says; false out of view or hidden, or
 * where something has come close behind the thing: more than a line of pixels may be of either. */
static bool rim_off(const keyframe_frame *frame, const placed *at, const keyframe_rim *rim,
                    rlf_vec3 p, rlf_vec3 out, double *pixels, bool *is_full)
{
    double u, v;
    int32_t x, y;
    rim_window window;
    *is_full = false;
    if (!pixel_of(frame->grid, p, &u, &v, &x, &y) ||
        !rim_look(frame->grid, frame->depth, &frame->noise, p, turned(at, rim->n), x, y, &window) ||
        window.between > rim->between + RIM_SIDE) {
        return false;
    }
    double ox = out.x - out.z * p.x / p.z, oy = out.y - out.z * p.y / p.z;
    const double length = sqrt(ox * ox + oy * oy);
    ox /= length;
    oy /= length;
    const double per_pixel = RIM_SIDE / per_step(ox, oy);
    *pixels = (double)(window.fill - rim->fill) / per_pixel - (u - x) * ox - (v - y) * oy;
    *is_full = window.fill < 1.0f || window.fill > (float)(RIM_SIDE * RIM_SIDE - 1);
    return true;
}

/* Of what a rim tells. An outline that runs along rows or columns is seen to jump by whole pixels,
 * all of it at once. */
static double own_part(rlf_vec3 out)
{
    const double x = size_of(out.x), y = size_of(out.y);
    return rlf_clamp(slant * rlf_min(x, y) / rlf_max(x, y), aligned, 1.0);
}

static void add_rim(const keyframe_frame *frame, const placed *at, const keyframe_rim *rim,
                    double slack, keyframe_fit *fit)
{
    const rlf_vec3 arm = turned(at, rim->p), out = turned(at, rim->out);
    const rlf_vec3 p = rlf_add(at->centre, arm);
    double pixels;
    bool is_full;
    if (!rim_off(frame, at, rim, p, out, &pixels, &is_full)) {
        return;
    }
    const double footprint = p.z / frame->grid->camera.fx, sigma = rim_sigma_px * footprint;
    fit->rims += pixels < 0.0 || !is_full ? 1 : 0; /* a full window: something is close behind */
    fit->cost -= is_full ? 0.0 : squares_left(pixels / rim_sigma_px) / rims_shared;
    const double bound = slack / footprint + sigmas * rim_sigma_px;
    const bool agrees = !is_full && pixels <= bound && pixels >= -bound;
    fit->rims_agree += agrees ? 1 : 0;
    if (agrees || slack > 0.0) {
        add_row(fit, at->key, arm, out, pixels * footprint,
                own_part(out) / (rims_shared * sigma * sigma));
    }
}

void keyframe_look(const keyframe_frame *frame, const rlf_keyframe *key, double slack,
                   keyframe_fit *fit)
{
    const placed at = place(key, fit->x);
    fit->sums = (math_rigid_sums){.weight = 0.0};
    fit->points = fit->rims = fit->agree = fit->rims_agree = 0;
    fit->cost = sigmas * sigmas * (key->point_count / points_shared + key->rim_count / rims_shared);
    for (int32_t k = 0; k < key->point_count; k++) {
        add_point(frame, &at, &key->point[k], slack, fit);
    }
    for (int32_t k = 0; k < key->rim_count; k++) {
        add_rim(frame, &at, &key->rim[k], slack, fit);
    }
}

/* The sums with the prior's information of each unknown, about the pose `start`. */
static math_rigid_sums with_prior(const keyframe_fit *fit, const double start[6])
{
    math_rigid_sums out = fit->sums;
    const double turns = fit->sums.a[3][3] + fit->sums.a[4][4] + fit->sums.a[5][5];
    for (int k = 0; k < 6; k++) {
        const double known = k < 3 ? 0.0 : held_share * turns;
        const double prior = rlf_max(1.0 / (loose_m * loose_m), known);
        out.a[k][k] += prior;
        out.b[k] += prior * (start[k] - fit->x[k]);
    }
    return out;
}

/* A step from fit->x; what nothing is seen of stays as it is in `start`. */
static void step(const keyframe_frame *frame, const rlf_keyframe *key, const double start[6],
                 double slack, keyframe_fit *fit)
{
    double x[6];
    keyframe_look(frame, key, slack, fit);
    const math_rigid_sums sums = with_prior(fit, start);
    (void)math_rigid_solve(&sums, 0.0, x);
    for (int k = 0; k < 6; k++) {
        fit->x[k] += x[k];
    }
}

void keyframe_register(const keyframe_frame *frame, const rlf_keyframe *key, keyframe_fit *fit)
{
    static const double slack[COARSE_PASSES] = {0.1, 0.1, 0.05, 0.05, 0.02, 0.02};
    double start[6];
    memcpy(start, fit->x, sizeof(start));
    keyframe_fit coarse = *fit;
    for (int pass = 0; pass < PASSES; pass++) {
        step(frame, key, start, 0.0, fit);
    }
    keyframe_look(frame, key, 0.0, fit);
    if (fit->agree >= sure_share * key->point_count &&
        fit->rims_agree >= sure_share * key->rim_count) {
        return;
    }
    for (int pass = 0; pass < COARSE_PASSES; pass++) { /* it may be farther off */
        step(frame, key, start, slack[pass], &coarse);
    }
    for (int pass = 0; pass < PASSES; pass++) {
        step(frame, key, start, 0.0, &coarse);
    }
    keyframe_look(frame, key, 0.0, &coarse);
    *fit = coarse.cost < fit->cost ? coarse : *fit;
}

bool keyframe_agrees(const rlf_keyframe *key, const keyframe_fit *fit)
{
    return fit->points >= seen_share * key->point_count &&
           fit->rims >= seen_share * key->rim_count && fit->agree >= agree_share * fit->points &&
           fit->rims_agree >= agree_share * fit->rims;
}

/* x' (A^-1 + F)^-1 x, where F is what all rows share; `out` is A^-1 with the scatter at rest. */
double keyframe_off(const keyframe_frame *frame, const rlf_keyframe *key, const keyframe_fit *fit,
                    const double x[6], double out[6][6])
{
    math_rigid_sums sums = with_prior(fit, fit->x), c;
    double y[6], sum = 0.0;
    for (int k = 0; k < 6; k++) {
        memset(sums.b, 0, sizeof(sums.b));
        sums.b[k] = 1.0;
        (void)math_rigid_solve(&sums, 0.0, out[k]);
        out[k][k] += key->scatter[k];
    }
    memcpy(c.a, out, sizeof(c.a));
    memcpy(c.b, x, sizeof(c.b));
    const double px = shared_px * key->centre.z / frame->grid->camera.fx;
    const double far = shared_depth * key->centre.z;
    for (int k = 0; k < 6; k++) {
        c.a[k][k] += k == 2 ? far * far + px * px : px * px;
    }
    (void)math_rigid_solve(&c, 0.0, y);
    for (int k = 0; k < 6; k++) {
        sum += x[k] * y[k];
    }
    return sum;
}

void keyframe_learn(const keyframe_frame *frame, rlf_keyframe *key)
{
    static const double none[6] = {0};
    const placed at = place(key, none);
    const float share = 1.0f / (float)key->rests;
    for (int32_t k = 0; k < key->point_count; k++) {
        keyframe_point *point = &key->point[k];
        const rlf_vec3 arm = turned(&at, point->p), n = turned(&at, point->n);
        double off, sigma;
        if (point_off(frame, rlf_add(at.centre, arm), n, &off, &sigma) &&
            size_of(off - (double)point->bias) < sigmas * sigma + 0.002) {
            point->bias += share * ((float)off - point->bias);
        }
    }
    for (int32_t k = 0; k < key->rim_count; k++) {
        keyframe_rim *rim = &key->rim[k];
        const rlf_vec3 p = rlf_add(at.centre, turned(&at, rim->p));
        double pixels;
        bool is_full;
        if (rim_off(frame, &at, rim, p, turned(&at, rim->out), &pixels, &is_full)) {
            const rlf_vec3 out = turned(&at, rim->out);
            const double per_pixel = RIM_SIDE / per_step(out.x, out.y);
            rim->fill += share * (float)(rlf_clamp(pixels, -1.0, 1.0) * per_pixel);
        }
    }
}

ptrdiff_t keyframe_pixel(const image_grid *grid, const rlf_keyframe *key, const float p[3])
{
    const placed at = place(key, key->x);
    double u, v;
    int32_t x, y;
    const bool is_in = pixel_of(grid, rlf_add(at.centre, turned(&at, p)), &u, &v, &x, &y);
    return is_in ? (ptrdiff_t)y * grid->width + x : -1;
}
