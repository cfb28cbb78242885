/* Kinect v1: depth from disparity, and the factory's mapping of depth to colour. */
#include "io/freenect/calibration.h"

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

#define DEPTH_MIN_M 0.1
#define DEPTH_MAX_M 10.0

/* Structured light, as for camera.json: 2 mm at 1 m, 6 mm at 2 m. */
static const rlf_depth_noise structured_light = {0.0008, 0.0, 0.0012};

#define SAMPLE_STEP 16

bool freenect_has_reference(const freenect_registration *r)
{
    return r->emitter_cm > 1.0f && r->emitter_cm < 100.0f && r->reference_cm > 10.0f &&
           r->reference_cm < 1000.0f && r->pixel_mm > 0.01f && r->pixel_mm < 1.0f;
}

void freenect_depth_table(const freenect_registration *r, uint16_t out[FREENECT_RAW_COUNT])
{
    const bool has = r != NULL && freenect_has_reference(r);
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

/* Sums of a least-squares fit of x and y by a (rx, ry, 1). */
typedef struct sums {
    double m[3][3], x[3], y[3];
    int count;
} sums;

static sums sum_up(const freenect_registration *r, const parallax *p, const rlf_camera *depth)
{
    sums s = {0};
    for (int y = 0; y < FREENECT_HEIGHT; y += SAMPLE_STEP) {
        for (int x = 0; x < FREENECT_WIDTH; x += SAMPLE_STEP) {
            double px, py;
            if (!far_pixel(r, p, x, y, &px, &py)) {
                continue;
            }
            const double a[3] = {(x - depth->cx) / depth->fx, (y - depth->cy) / depth->fy, 1.0};
            for (int i = 0; i < 3; i++) {
                for (int k = 0; k < 3; k++) {
                    s.m[i][k] += a[i] * a[k];
                }
                s.x[i] += a[i] * px;
                s.y[i] += a[i] * py;
            }
            s.count++;
        }
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

static double largest_error(const freenect_registration *r, const parallax *p, const rlf_rig *rig)
{
    double worst = 0.0;
    for (int y = 0; y < FREENECT_HEIGHT; y += SAMPLE_STEP) {
        for (int x = 0; x < FREENECT_WIDTH; x += SAMPLE_STEP) {
            rlf_vec3 ray;
            double px, py, u, v;
            if (!far_pixel(r, p, x, y, &px, &py) ||
                !rlf_camera_unproject(&rig->depth, x, y, &ray) ||
                !rlf_camera_project(&rig->color, rlf_rotate(rig->T_color_depth.q, ray), &u, &v)) {
                continue;
            }
            const double distance = sqrt((u - px) * (u - px) + (v - py) * (v - py));
            worst = rlf_max(worst, distance);
        }
    }
    return worst;
}

/* X = fx (cos rx - sin ry) + cx, Y = fy (sin rx + cos ry) + cy: the part of the factory's mapping
 * that is a turn round the optical axis and a lens without distortion. */
static bool fit_color(const freenect_registration *r, rlf_rig *rig, double *out_error)
{
    const parallax p = parallax_of(r);
    const sums s = sum_up(r, &p, &rig->depth);
    double x[3], y[3];
    if (s.count < 100 || !solve(s.m, s.x, x) || !solve(s.m, s.y, y)) {
        return false;
    }
    const double fx = sqrt(x[0] * x[0] + x[1] * x[1]);
    const double fy = sqrt(y[0] * y[0] + y[1] * y[1]);
    const double right = p.slope / fx; /* metres from the depth camera */
    if (!(fx > 200.0 && fx < 2000.0 && fy > 200.0 && fy < 2000.0 && fabs(right) < 0.1)) {
        return false;
    }
    const double angle = rlf_atan2(y[0] / fy - x[1] / fx, x[0] / fx + y[1] / fy);
    rig->color.fx = fx;
    rig->color.fy = fy;
    rig->color.cx = x[2];
    rig->color.cy = y[2];
    rig->T_color_depth =
        (rlf_pose){.p = rlf_vec3_make(-right, 0.0, 0.0),
                   .q = {.x = 0.0, .y = 0.0, .z = rlf_sin(0.5 * angle), .w = rlf_cos(0.5 * angle)}};
    *out_error = largest_error(r, &p, rig);
    return true;
}

void freenect_make_rig(const freenect_registration *r, rlf_rig *out, double *out_error)
{
    const bool has = r != NULL && freenect_has_reference(r);
    const double focal = has ? (double)r->reference_cm / (2.0 * (double)r->pixel_mm)
                             : REFERENCE_CM / (2.0 * PIXEL_MM);
    *out = (rlf_rig){.depth = camera_of(focal),
                     .color = camera_of(COLOR_FOCAL),
                     .T_color_depth = rlf_pose_identity(),
                     .has_color = true,
                     .depth_min_m = DEPTH_MIN_M,
                     .depth_max_m = DEPTH_MAX_M,
                     .noise = structured_light};
    out->T_color_depth.p.x = -COLOR_RIGHT_M;
    *out_error = -1.0;
    if (has && r->table != NULL && r->depth_to_rgb_shift != NULL) {
        (void)fit_color(r, out, out_error);
    }
}
