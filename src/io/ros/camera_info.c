/* CameraInfo to a camera, and what of it is lost. */
#include "io/live/driver.h"
#include "io/ros/messages.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Numbers that differ by less come of rounding. */
#define ROUNDING 1e-6

/* A fit of another lens is as good as the lens: calibrations are no better. */
#define FIT_PX 0.5

/* ---- the equidistant lens (Kannala and Brandt 2006, OpenCV's fisheye): the distance from the
 * centre goes as t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8) of the angle t. Relief's lens is fitted
 * to it ---- */

#define SAMPLES_WIDE 24
#define SAMPLES_HIGH 18
#define SAMPLE_COUNT (SAMPLES_WIDE * SAMPLES_HIGH)
/* A ray farther from the axis leaves a pinhole's picture: 80 degrees. */
#define ANGLE_MAX 1.4
#define STEPS 20

static double distorted(const double k[4], double t)
{
    const double s = t * t;
    return t * (1.0 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
}

static double slope(const double k[4], double t)
{
    const double s = t * t;
    return 1.0 + s * (3.0 * k[0] + s * (5.0 * k[1] + s * (7.0 * k[2] + s * 9.0 * k[3])));
}

/* The angle of a distance; false when the lens does not see that far, or not this way round. */
static bool angle_of(const double k[4], double distance, double *out)
{
    double t = distance;
    for (int i = 0; i < STEPS; i++) {
        const double down = slope(k, t);
        if (!(down > 0.1)) {
            return false;
        }
        t -= (distorted(k, t) - distance) / down;
    }
    *out = t;
    return t >= 0.0 && t < ANGLE_MAX && fabs(distorted(k, t) - distance) < 1e-9;
}

double io_equidistant_lens(const double k[4], rlf_camera *c)
{
    io_lens_sample samples[SAMPLE_COUNT];
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        const double u = (c->width - 1.0) * (i % SAMPLES_WIDE) / (SAMPLES_WIDE - 1);
        const double v = (c->height - 1.0) * (i / SAMPLES_WIDE) / (SAMPLES_HIGH - 1);
        const double x = (u - c->cx) / c->fx, y = (v - c->cy) / c->fy;
        const double distance = sqrt(x * x + y * y);
        double t;
        if (!angle_of(k, distance, &t)) {
            return INFINITY;
        }
        const double scale = distance > 1e-9 ? rlf_sin(t) / (rlf_cos(t) * distance) : 1.0;
        samples[i] = (io_lens_sample){x * scale, y * scale, u, v};
    }
    return io_lens_fit(samples, SAMPLE_COUNT, c);
}

/* ---- what is lost ---------------------------------------------------------------------------- */

/* What cannot be used, as a list for one line. */
typedef struct losses {
    char text[256];
    size_t length;
} losses;

RLF_PRINTF(2, 3) static void lose(losses *l, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const size_t room = sizeof(l->text) - l->length;
    const int comma = snprintf(l->text + l->length, room, "%s", l->length > 0 ? ", " : "");
    l->length += comma > 0 ? (size_t)comma : 0;
    const int got =
        l->length < sizeof(l->text)
            ? vsnprintf(l->text + l->length, sizeof(l->text) - l->length, format, arguments)
            : 0;
    l->length += got > 0 ? (size_t)got : 0;
    l->length = l->length < sizeof(l->text) ? l->length : sizeof(l->text) - 1;
    va_end(arguments);
}

static bool is_any(const double *numbers, int first, int end)
{
    for (int i = first; i < end; i++) {
        if (numbers[i] != 0.0) { /* NaN too: it is refused later, by its name */
            return true;
        }
    }
    return false;
}

/* The words of ROS, and of librealsense, which projects with all three of its Brown models alike:
 * from the ray to the distorted picture. */
static bool is_brown(const char *model)
{
    static const char *const names[] = {"",
                                        "plumb_bob",
                                        "rational_polynomial",
                                        "Brown Conrady",
                                        "Modified Brown Conrady",
                                        "Inverse Brown Conrady"};
    for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
        if (strcmp(model, names[i]) == 0) {
            return true;
        }
    }
    return false;
}

static void set_distortion(const io_camera_info *info, rlf_camera *out, losses *lost)
{
    if (!is_any(info->d, 0, IO_ROS_DISTORTION_MAX)) {
        return;
    }
    const bool is_fisheye =
        strcmp(info->model, "equidistant") == 0 || strcmp(info->model, "fisheye") == 0;
    if (is_fisheye) {
        const rlf_camera pinhole = *out;
        const double off_px = io_equidistant_lens(info->d, out);
        if (off_px <= FIT_PX) {
            return;
        }
        *out = pinhole;
    }
    if (!is_brown(info->model)) {
        lose(lost, "the lens model \"%.40s\"", info->model);
        return;
    }
    if (is_any(info->d, 8, 12)) {
        lose(lost, "thin prism (s1 to s4 = %g %g %g %g)", info->d[8], info->d[9], info->d[10],
             info->d[11]);
    }
    if (is_any(info->d, 12, 14)) {
        lose(lost, "tilt (tauX, tauY = %g %g)", info->d[12], info->d[13]);
    }
    if (info->d_count > IO_ROS_DISTORTION_MAX) {
        lose(lost, "%u more coefficients", (unsigned)(info->d_count - IO_ROS_DISTORTION_MAX));
    }
    const bool is_rational =
        strcmp(info->model, "rational_polynomial") == 0 || is_any(info->d, 5, 8);
    if (is_any(info->d, 0, 8)) {
        out->distortion_model =
            is_rational ? RLF_DISTORTION_RATIONAL_POLYNOMIAL : RLF_DISTORTION_PLUMB_BOB;
        memcpy(out->distortion, info->d, (is_rational ? 8 : 5) * sizeof(info->d[0]));
    }
}

/* Degrees that R turns by; 0 where it is not filled in. */
static double turn_of(const io_camera_info *info)
{
    const double *r = info->r;
    if (!is_any(r, 0, 9)) {
        return 0.0;
    }
    /* The sine of half the angle, which small angles do not lose. */
    const double x = r[7] - r[5], y = r[2] - r[6], z = r[3] - r[1];
    const double sine = 0.5 * sqrt(x * x + y * y + z * z);
    const double cosine = 0.5 * (r[0] + r[4] + r[8] - 1.0);
    return atan2(sine, cosine) * 180.0 / RLF_PI;
}

static bool differ(double a, double b)
{
    return fabs(a - b) > ROUNDING * (fabs(a) + fabs(b));
}

/* Whether P is of another lens than K. */
static bool has_other_p(const io_camera_info *info)
{
    return info->p[0] > 0.0 && (differ(info->p[0], info->k[0]) || differ(info->p[5], info->k[4]) ||
                                differ(info->p[2], info->k[2]) || differ(info->p[6], info->k[5]));
}

/* R and P are of rectified pictures. Where the topic does not say so and there is no distortion to
 * take away, the pictures might be either. */
static void check_rectification(const io_camera_info *info, bool uses_p, losses *lost)
{
    const double degrees = turn_of(info);
    if (uses_p) {
        if (degrees > ROUNDING) {
            lose(lost, "a rectification that turns the camera by %.3g degrees", degrees);
        }
        if (fabs(info->p[3]) > ROUNDING * info->p[0] || fabs(info->p[7]) > ROUNDING * info->p[5]) {
            lose(lost, "a baseline in P (%.4g m)", -info->p[3] / info->p[0]);
        }
    } else if (!is_any(info->d, 0, IO_ROS_DISTORTION_MAX)) {
        if (degrees > ROUNDING) {
            lose(lost,
                 "a rectification (R turns by %.3g degrees; pictures are taken as not "
                 "rectified)",
                 degrees);
        }
        if (has_other_p(info)) {
            lose(lost, "a P that differs from K (fx %.6g and %.6g; K is taken)", info->p[0],
                 info->k[0]);
        }
    }
}

bool io_camera_info_size(const io_camera_info *info, int32_t *out_width, int32_t *out_height)
{
    if (info->width > RLF_IMAGE_SIZE_MAX || info->height > RLF_IMAGE_SIZE_MAX) {
        return false;
    }
    rlf_camera camera = {.width = (int32_t)info->width, .height = (int32_t)info->height};
    const bool is_some = io_camera_window_apply(&info->window, &camera);
    *out_width = camera.width;
    *out_height = camera.height;
    return is_some;
}

static rlf_result fail_lens(const char *name, const char *topic, const char *problem)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: the CameraInfo of %s cannot be used (%s): give a calibration with "
                    "?camera=FILE",
                    name, topic, problem);
}

/* The first three columns of P, or K. */
static rlf_camera pinhole_of(const io_camera_info *info, bool uses_p)
{
    const double *m = uses_p ? info->p : info->k;
    const int row = uses_p ? 4 : 3;
    return (rlf_camera){.width = (int32_t)info->width,
                        .height = (int32_t)info->height,
                        .fx = m[0],
                        .fy = m[row + 1],
                        .cx = m[2],
                        .cy = m[row + 2]};
}

rlf_result io_camera_info_lens(const io_camera_info *info, const char *name, const char *topic,
                               rlf_camera *out)
{
    const bool uses_p = strstr(topic, "rect") != NULL && info->p[0] > 0.0;
    const double skew = uses_p ? info->p[1] : info->k[1];
    losses lost = {.length = 0};
    char problem[128];
    int32_t width, height;
    if (!io_camera_info_size(info, &width, &height)) {
        return fail_lens(name, topic, "it describes no picture");
    }
    *out = pinhole_of(info, uses_p);
    if (!(out->fx > 0.0 && out->fy > 0.0)) {
        return fail_lens(name, topic, "it is not calibrated, its focal length is not > 0");
    }
    if (skew != 0.0) {
        lose(&lost, "skew (%g)", skew);
    }
    if (!uses_p) {
        set_distortion(info, out, &lost);
    }
    check_rectification(info, uses_p, &lost);
    io_camera_window_apply(&info->window, out);
    if (rlf_camera_check(out, "it") != RLF_OK) {
        snprintf(problem, sizeof(problem), "%.120s", rlf_error_text());
        return fail_lens(name, topic, problem);
    }
    if (lost.length > 0) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the CameraInfo of %s has %s, which Relief does not have: it is left out; give "
                "a calibration with ?camera=FILE",
                name, topic, lost.text);
    }
    return RLF_OK;
}
