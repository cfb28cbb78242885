/* The Kinect v2 does not tell its colour camera: the factory stores two cubic polynomials that map
 * depth pixels to colour pixels. A pinhole with a plumb_bob lens and a pose is fitted to them by
 * Gauss and Newton's method, so that Relief treats this camera as any other. */
#include "io/freenect2/freenect2.h"

#include <math.h>

/* Kinect v2 as it is sold: 0.5 to 4.5 m. */
#define DEPTH_MIN_M 0.5
#define DEPTH_MAX_M 4.5

#define STEP 16 /* pixels between samples */
#define SAMPLES_MAX (KINECT2_DEPTH_WIDTH / STEP * (KINECT2_DEPTH_HEIGHT / STEP) * 4)
#define ITERATIONS 6
#define DAMPING 1e-6 /* share of the diagonal: the lens and the pose are nearly exchangeable */

/* Metres. Nearer the factory's parallax is itself an approximation, as it knows no lens: there the
 * two differ by up to 1.8 pixels in the corners. */
static const double sample_depths[4] = {0.8, 1.2, 2.0, 4.5};

/* fx fy cx cy, rotation vector, translation, k1 k2 p1 p2 k3 */
#define UNKNOWNS 15

typedef struct sample {
    rlf_vec3 point; /* in the depth camera, metres */
    double u, v;    /* in the colour picture */
} sample;

/* Scales of the factory's polynomial: depth pixels and colour pixels to its units. */
static const float depth_scale = 0.01F;
static const float color_scale = 0.002199F;

/* The factory's cubics: x of the colour picture in units of its focal length without parallax, and
 * y in pixels. */
static void map_pixel(const kinect2_ir *ir, const kinect2_color *color, float u, float v,
                      float out[2])
{
    const float a = (u - ir->cx) * depth_scale;
    const float b = (v - ir->cy) * depth_scale;
    const float terms[10] = {a * a * a, b * b * b, a * a * b, b * b * a, a * a,
                             b * b,     a * b,     a,         b,         1.0F};
    float sum_x = terms[0] * color->mx[0];
    float sum_y = terms[0] * color->my[0];
    for (int i = 1; i < 10; i++) {
        sum_x = sum_x + terms[i] * color->mx[i];
        sum_y = sum_y + terms[i] * color->my[i];
    }
    out[0] = sum_x / (color->fx * color_scale) - color->shift_m / color->shift_d;
    out[1] = sum_y / color_scale + color->cy;
}

void kinect2_project(const kinect2_ir *ir, const kinect2_color *color, float u, float v, float z,
                     float out[2])
{
    float mapped[2];
    map_pixel(ir, color, u, v, mapped);
    out[0] = (mapped[0] + color->shift_m / z) * color->fx + color->cx;
    out[1] = mapped[1];
}

static double mirror(double x, int width)
{
    return width - 1 - x;
}

rlf_camera kinect2_undistorted_camera(const kinect2_ir *ir)
{
    return (rlf_camera){.width = KINECT2_DEPTH_WIDTH,
                        .height = KINECT2_DEPTH_HEIGHT,
                        .fx = (double)ir->fx,
                        .fy = (double)ir->fy,
                        .cx = mirror((double)ir->cx - 0.5, KINECT2_DEPTH_WIDTH),
                        .cy = (double)ir->cy - 0.5};
}

/* In a mirrored picture x changes its sign, and with it p2. */
static rlf_camera raw_camera(const kinect2_ir *ir)
{
    return (rlf_camera){.width = KINECT2_DEPTH_WIDTH,
                        .height = KINECT2_DEPTH_HEIGHT,
                        .fx = (double)ir->fx,
                        .fy = (double)ir->fy,
                        .cx = mirror((double)ir->cx, KINECT2_DEPTH_WIDTH),
                        .cy = (double)ir->cy,
                        .distortion_model = RLF_DISTORTION_PLUMB_BOB,
                        .distortion = {(double)ir->k1, (double)ir->k2, (double)ir->p1,
                                       -(double)ir->p2, (double)ir->k3}};
}

/* Points that both cameras see. */
static int32_t make_samples(const kinect2_ir *ir, const kinect2_color *color, sample *out)
{
    int32_t count = 0;
    for (int32_t i = 0; i < SAMPLES_MAX; i++) {
        const int32_t at = i / 4;
        const int32_t u = at % (KINECT2_DEPTH_WIDTH / STEP) * STEP;
        const int32_t v = at / (KINECT2_DEPTH_WIDTH / STEP) * STEP;
        const double z = sample_depths[i % 4];
        float pixel[2];
        kinect2_project(ir, color, (float)u, (float)v, (float)(z * 1000.0), pixel);
        if (pixel[0] >= 0.0F && pixel[0] < KINECT2_COLOR_WIDTH && pixel[1] >= 0.0F &&
            pixel[1] < KINECT2_COLOR_HEIGHT) {
            const double x = -((double)u - (double)ir->cx) / (double)ir->fx;
            const double y = ((double)v - (double)ir->cy) / (double)ir->fy;
            out[count++] =
                (sample){rlf_vec3_make(x * z, y * z, z),
                         mirror((double)pixel[0], KINECT2_COLOR_WIDTH), (double)pixel[1]};
        }
    }
    return count;
}

static void to_rig(const double p[UNKNOWNS], rlf_rig *rig)
{
    rig->color = (rlf_camera){.width = KINECT2_COLOR_WIDTH,
                              .height = KINECT2_COLOR_HEIGHT,
                              .fx = p[0],
                              .fy = p[1],
                              .cx = p[2],
                              .cy = p[3],
                              .distortion_model = RLF_DISTORTION_PLUMB_BOB,
                              .distortion = {p[10], p[11], p[12], p[13], p[14]}};
    rig->T_color_depth.q = rlf_quat_from_rotation_vector(rlf_vec3_make(p[4], p[5], p[6]));
    rig->T_color_depth.p = rlf_vec3_make(p[7], p[8], p[9]);
}

static bool see(const rlf_rig *rig, const sample *s, double out[2])
{
    return rlf_camera_project(&rig->color, rlf_transform(&rig->T_color_depth, s->point), &out[0],
                              &out[1]);
}

/* Two equations per sample, linear near p. */
static void add_equations(io_least_squares *ls, const double p[UNKNOWNS], const sample *s)
{
    rlf_rig rig;
    double at[2];
    double rows[2][UNKNOWNS];
    to_rig(p, &rig);
    if (!see(&rig, s, at)) {
        return;
    }
    for (int i = 0; i < UNKNOWNS; i++) {
        double moved[UNKNOWNS];
        double there[2];
        const double step = i < 4 ? 1e-3 : 1e-6; /* pixels; radians, metres, coefficients */
        for (int k = 0; k < UNKNOWNS; k++) {
            moved[k] = p[k] + (k == i ? step : 0.0);
        }
        to_rig(moved, &rig);
        if (!see(&rig, s, there)) {
            return;
        }
        rows[0][i] = (there[0] - at[0]) / step;
        rows[1][i] = (there[1] - at[1]) / step;
    }
    io_least_squares_add(ls, rows[0], s->u - at[0]);
    io_least_squares_add(ls, rows[1], s->v - at[1]);
}

static bool improve(double p[UNKNOWNS], const sample *samples, int32_t count)
{
    io_least_squares ls = {.count = UNKNOWNS};
    for (int32_t i = 0; i < count; i++) {
        add_equations(&ls, p, &samples[i]);
    }
    for (int i = 0; i < UNKNOWNS; i++) {
        ls.a[i][i] *= 1.0 + DAMPING;
    }
    double change[UNKNOWNS];
    if (!io_least_squares_solve(&ls, change)) {
        return false;
    }
    for (int i = 0; i < UNKNOWNS; i++) {
        p[i] += change[i];
    }
    return true;
}

static kinect2_fit measure(const rlf_rig *rig, const sample *samples, int32_t count)
{
    kinect2_fit fit = {0};
    for (int32_t i = 0; i < count; i++) {
        double at[2];
        const bool is_seen = see(rig, &samples[i], at);
        const double off = is_seen ? hypot(at[0] - samples[i].u, at[1] - samples[i].v) : INFINITY;
        fit.worst_px = fmax(fit.worst_px, off);
        fit.rms_px += off * off;
    }
    fit.rms_px = sqrt(fit.rms_px / (count > 0 ? count : 1));
    return fit;
}

static rlf_result fit_color(const kinect2_ir *ir, const kinect2_color *color, rlf_rig *rig,
                            kinect2_fit *out_fit)
{
    sample *samples = rlf_alloc_array(SAMPLES_MAX, sizeof(samples[0]));
    if (samples == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const int32_t count = make_samples(ir, color, samples);
    double p[UNKNOWNS] = {(double)color->fx, (double)color->fy,
                          mirror((double)color->cx, KINECT2_COLOR_WIDTH), (double)color->cy};
    p[7] = -(double)color->shift_m / 1000.0; /* the baseline, mirrored */
    bool is_solved = count > UNKNOWNS;
    for (int i = 0; i < ITERATIONS && is_solved; i++) {
        is_solved = improve(p, samples, count);
    }
    to_rig(p, rig);
    *out_fit = measure(rig, samples, count);
    rlf_free(samples);
    return is_solved && isfinite(out_fit->worst_px)
               ? RLF_OK
               : rlf_fail(RLF_ERROR_DEVICE,
                          "freenect2: the camera's own calibration fits no camera: give one by "
                          "?camera=FILE");
}

rlf_result kinect2_rig_fit(const kinect2_ir *ir, const kinect2_color *color, rlf_rig *out,
                           kinect2_fit *out_fit)
{
    *out = (rlf_rig){.depth = raw_camera(ir),
                     .has_color = true,
                     .depth_min_m = DEPTH_MIN_M,
                     .depth_max_m = DEPTH_MAX_M,
                     .noise = IO_TIME_OF_FLIGHT_NOISE};
    rlf_result result = rlf_camera_check(&out->depth, "freenect2: the camera's own calibration");
    result = result == RLF_OK ? fit_color(ir, color, out, out_fit) : result;
    return result == RLF_OK ? rlf_camera_check(&out->color, "freenect2: the fitted colour camera")
                            : result;
}
