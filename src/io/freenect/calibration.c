/* Kinect v1: depth from disparity, and the factory's mapping of depth to colour. */
#include "io/freenect/freenect.h"

#include <math.h>
#include <stddef.h>

/* A typical device (PrimeSense's reference design), where the factory's values cannot be had. */
#define EMITTER_CM 7.5
#define REFERENCE_CM 120.0
#define PIXEL_MM 0.1042
#define CONST_SHIFT 200.0
#define COLOR_FOCAL 525.0 /* of the colour camera, as ROS and the TUM data set take it */
#define COLOR_RIGHT_M 0.025

#define RAW_PER_SHIFT 4.0
#define SHIFT_OFFSET 0.375
#define MM_PER_CM 10.0

#define DEPTH_MAX_M 10.0

#define SAMPLE_STEP 16
#define SAMPLES_MIN 100
#define FIT_ROUNDS 300

/* Whether the device told its reference plane. */
static bool has_reference(const freenect_registration *r)
{
    return r->emitter_cm > 1.0f && r->emitter_cm < 100.0f && r->reference_cm > 10.0f &&
           r->reference_cm < 1000.0f && r->pixel_mm > 0.01f && r->pixel_mm < 1.0f;
}

void freenect_depth_table(const freenect_registration *r, uint16_t out[FREENECT_RAW_COUNT])
{
    const bool has = r != NULL && has_reference(r);
    const double emitter = has ? (double)r->emitter_cm : EMITTER_CM;
    const double reference = has ? (double)r->reference_cm : REFERENCE_CM;
    const double pixel = has ? (double)r->pixel_mm : PIXEL_MM;
    const double shift = has && r->const_shift > 0.0 ? r->const_shift : CONST_SHIFT;
    for (int raw = 0; raw < FREENECT_RAW_COUNT; raw++) {
        const double disparity =
            (raw - RAW_PER_SHIFT * shift) / RAW_PER_SHIFT - SHIFT_OFFSET; /* from the plane's */
        const double metric = disparity * pixel;
        const double mm = MM_PER_CM * (metric * reference / (emitter - metric) + reference);
        const bool is_depth = raw < FREENECT_RAW_MISSING && metric < emitter && mm >= 1.0 &&
                              mm <= DEPTH_MAX_M * 1000.0;
        out[raw] = is_depth ? (uint16_t)(mm + 0.5) : 0;
    }
}

static rlf_camera camera_of(double focal)
{
    return (rlf_camera){.width = FREENECT_WIDTH,
                        .height = FREENECT_HEIGHT,
                        .fx = focal,
                        .fy = focal,
                        .cx = 0.5 * (FREENECT_WIDTH - 1),
                        .cy = 0.5 * (FREENECT_HEIGHT - 1)};
}

/* Colour shift in pixels by depth: offset - slope / z, z in metres. */
typedef struct parallax {
    double offset, slope;
} parallax;

static parallax parallax_of(const freenect_registration *r)
{
    const int near_mm = 1000;
    const int far_mm = 4000;
    const double near_px = r->depth_to_rgb_shift[near_mm] / FREENECT_TABLE_SCALE;
    const double far_px = r->depth_to_rgb_shift[far_mm] / FREENECT_TABLE_SCALE;
    const double slope = (far_px - near_px) / (1000.0 / near_mm - 1000.0 / far_mm);
    return (parallax){far_px + slope * 1000.0 / far_mm, slope};
}

/* Where the factory's table puts a depth pixel that is infinitely far. The table's numbers are cut
 * down to whole pixels by its users: a pixel's centre is half a pixel lower. */
static bool far_pixel(const freenect_registration *r, const parallax *p, int x, int y,
                      double *out_x, double *out_y)
{
    const int32_t *entry = r->table[y * FREENECT_WIDTH + x];
    *out_x = entry[0] / FREENECT_TABLE_SCALE + p->offset - 0.5;
    *out_y = entry[1];
    return entry[0] < FREENECT_WIDTH * FREENECT_TABLE_SCALE && entry[1] < FREENECT_HEIGHT;
}

/* Radial distortion of the colour camera: what both lenses together do. */
typedef struct radial {
    double k1, k2;
} radial;

/* One sample of the tables. */
typedef struct sample {
    double x, y;   /* ray of the depth pixel */
    double px, py; /* where it lands in the colour picture */
} sample;

/* Samples in turn; `at` starts with 0. False when there are no more. */
static bool next_sample(const freenect_registration *r, const parallax *p, const rlf_camera *depth,
                        int *at, sample *out)
{
    const int columns = FREENECT_WIDTH / SAMPLE_STEP;
    while (*at < columns * (FREENECT_HEIGHT / SAMPLE_STEP)) {
        const int x = *at % columns * SAMPLE_STEP;
        const int y = *at / columns * SAMPLE_STEP;
        ++*at;
        if (far_pixel(r, p, x, y, &out->px, &out->py)) {
            out->x = (x - depth->cx) / depth->fx;
            out->y = (y - depth->cy) / depth->fy;
            return true;
        }
    }
    return false;
}

static double bend(const radial *k, const sample *s)
{
    const double r2 = s->x * s->x + s->y * s->y;
    return 1.0 + r2 * (k->k1 + r2 * k->k2);
}

/* Sums of a least-squares fit of px and py by a (x, y, 1), x and y bent by the lens. */
typedef struct sums {
    double m[3][3], x[3], y[3];
    int count;
} sums;

static sums sum_up(const freenect_registration *r, const parallax *p, const rlf_camera *depth,
                   const radial *k)
{
    sums s = {0};
    sample t;
    for (int at = 0; next_sample(r, p, depth, &at, &t);) {
        const double a[3] = {t.x * bend(k, &t), t.y * bend(k, &t), 1.0};
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                s.m[i][j] += a[i] * a[j];
            }
            s.x[i] += a[i] * t.px;
            s.y[i] += a[i] * t.py;
        }
        s.count++;
    }
    return s;
}

/* Solves the symmetric 3x3 system by Cramer's rule. */
static bool solve(const double m[3][3], const double b[3], double out[3])
{
    const rlf_vec3 c0 = rlf_vec3_make(m[0][0], m[1][0], m[2][0]);
    const rlf_vec3 c1 = rlf_vec3_make(m[0][1], m[1][1], m[2][1]);
    const rlf_vec3 c2 = rlf_vec3_make(m[0][2], m[1][2], m[2][2]);
    const rlf_vec3 v = rlf_vec3_make(b[0], b[1], b[2]);
    const double det = rlf_dot(c0, rlf_cross(c1, c2));
    out[0] = rlf_dot(v, rlf_cross(c1, c2)) / det;
    out[1] = rlf_dot(c0, rlf_cross(v, c2)) / det;
    out[2] = rlf_dot(c0, rlf_cross(c1, v)) / det;
    return det > 1e-9;
}

/* Colour pixel = x by (x, y, 1), and so on: the affine part of the mapping. */
typedef struct affine {
    double x[3], y[3];
} affine;

/* Improves the distortion for a given affine part: least squares of what is left by r^2 and r^4
 * times the linear part. */
static bool improve_radial(const freenect_registration *r, const parallax *p,
                           const rlf_camera *depth, const affine *a, radial *k)
{
    double m11 = 0.0, m12 = 0.0, m22 = 0.0, b1 = 0.0, b2 = 0.0;
    sample t;
    for (int at = 0; next_sample(r, p, depth, &at, &t);) {
        const double r2 = t.x * t.x + t.y * t.y;
        const double lx = a->x[0] * t.x + a->x[1] * t.y;
        const double ly = a->y[0] * t.x + a->y[1] * t.y;
        const double ex = t.px - a->x[2] - lx * bend(k, &t);
        const double ey = t.py - a->y[2] - ly * bend(k, &t);
        const double l2 = lx * lx + ly * ly;
        m11 += l2 * r2 * r2;
        m12 += l2 * r2 * r2 * r2;
        m22 += l2 * r2 * r2 * r2 * r2;
        b1 += (lx * ex + ly * ey) * r2;
        b2 += (lx * ex + ly * ey) * r2 * r2;
    }
    const double det = m11 * m22 - m12 * m12;
    if (!(det > 0.0)) {
        return false;
    }
    k->k1 += (b1 * m22 - b2 * m12) / det;
    k->k2 += (b2 * m11 - b1 * m12) / det;
    return fabs(k->k1) < 2.0 && fabs(k->k2) < 10.0;
}

/* The affine part and the distortion in turn: they depend on each other weakly. */
static bool fit(const freenect_registration *r, const parallax *p, const rlf_camera *depth,
                affine *out, radial *k)
{
    for (int i = 0; i < FIT_ROUNDS; i++) {
        const sums s = sum_up(r, p, depth, k);
        if (s.count < SAMPLES_MIN || !solve(s.m, s.x, out->x) || !solve(s.m, s.y, out->y) ||
            !improve_radial(r, p, depth, out, k)) {
            return false;
        }
    }
    return true;
}

static double largest_error(const freenect_registration *r, const parallax *p, const rlf_rig *rig)
{
    double worst = 0.0;
    sample t;
    for (int at = 0; next_sample(r, p, &rig->depth, &at, &t);) {
        const rlf_vec3 ray = rlf_rotate(rig->T_color_depth.q, rlf_vec3_make(t.x, t.y, 1.0));
        double u = 0.0;
        double v = 0.0;
        if (rlf_camera_project(&rig->color, ray, &u, &v)) {
            worst = rlf_max(worst, sqrt((u - t.px) * (u - t.px) + (v - t.py) * (v - t.py)));
        }
    }
    return worst;
}

/* X = fx (cos x - sin y) + cx, Y = fy (sin x + cos y) + cy, x and y bent by the lens: a turn round
 * the optical axis and the colour camera's lens. */
static bool fit_color(const freenect_registration *r, rlf_rig *rig, double *out_error)
{
    const parallax p = parallax_of(r);
    affine a;
    radial k = {0.0, 0.0};
    if (!fit(r, &p, &rig->depth, &a, &k)) {
        return false;
    }
    const double fx = sqrt(a.x[0] * a.x[0] + a.x[1] * a.x[1]);
    const double fy = sqrt(a.y[0] * a.y[0] + a.y[1] * a.y[1]);
    const double right = p.slope / fx; /* metres from the depth camera */
    if (!(fx > 200.0 && fx < 2000.0 && fy > 200.0 && fy < 2000.0 && fabs(right) < 0.1)) {
        return false;
    }
    const double angle = rlf_atan2(a.y[0] / fy - a.x[1] / fx, a.x[0] / fx + a.y[1] / fy);
    rig->color.fx = fx;
    rig->color.fy = fy;
    rig->color.cx = a.x[2];
    rig->color.cy = a.y[2];
    rig->color.distortion_model = RLF_DISTORTION_PLUMB_BOB;
    rig->color.distortion[0] = k.k1;
    rig->color.distortion[1] = k.k2;
    rig->T_color_depth =
        (rlf_pose){.p = rlf_vec3_make(-right, 0.0, 0.0),
                   .q = {.x = 0.0, .y = 0.0, .z = rlf_sin(0.5 * angle), .w = rlf_cos(0.5 * angle)}};
    *out_error = largest_error(r, &p, rig);
    return true;
}

void freenect_make_rig(const freenect_registration *r, rlf_rig *out, double *out_error)
{
    const bool has = r != NULL && has_reference(r);
    const double focal = has ? (double)r->reference_cm / (2.0 * (double)r->pixel_mm)
                             : REFERENCE_CM / (2.0 * PIXEL_MM);
    *out = rlf_rig_default();
    out->depth = camera_of(focal);
    out->color = camera_of(COLOR_FOCAL);
    out->has_color = true;
    out->depth_max_m = DEPTH_MAX_M;
    out->T_color_depth.p.x = -COLOR_RIGHT_M;
    *out_error = -1.0;
    if (has && r->table != NULL && r->depth_to_rgb_shift != NULL) {
        (void)fit_color(r, out, out_error);
    }
}
