/* Undistorting what was distorted, at every pixel of the picture: needs no OpenCV. */
#include "eval/calibration/calibration.h"

#include "eval/table.h"
#include "relief/camera.h"

#include <math.h>

/* A Kinect v2's and an Azure Kinect's lens, by their makers' calibrations rounded. */
static const struct {
    const char *key, *title, *float_key, *float_title;
    rlf_camera camera;
} lenses[] = {
    {"undistort_none_px",
     "no distortion: there and back, worst pixel, px",
     "undistort_none_float_px",
     "no distortion: by the float table, worst pixel, px",
     {512, 424, 365.5, 365.5, 255.5, 211.5, RLF_DISTORTION_NONE, {0}}},
    {"undistort_plumb_bob_px",
     "plumb_bob: there and back, worst pixel, px",
     "undistort_plumb_bob_float_px",
     "plumb_bob: by the float table, worst pixel, px",
     {512,
      424,
      365.5,
      365.5,
      255.5,
      211.5,
      RLF_DISTORTION_PLUMB_BOB,
      {0.09, -0.27, 0.001, -0.002, 0.09}}},
    {"undistort_rational_px",
     "rational_polynomial: there and back, worst pixel, px",
     "undistort_rational_float_px",
     "rational_polynomial: by the float table, worst pixel, px",
     {640,
      576,
      505.0,
      505.0,
      327.5,
      340.5,
      RLF_DISTORTION_RATIONAL_POLYNOMIAL,
      {0.5, 0.08, -0.00006, 0.00003, 0.004, 0.84, 0.2, 0.03}}},
};

/* How far pixel (u, v) comes back from itself by the ray given; infinite where it does not. */
static double off(const rlf_camera *c, rlf_vec3 ray, double u, double v)
{
    double back_u, back_v;
    return rlf_camera_project(c, ray, &back_u, &back_v) ? hypot(back_u - u, back_v - v) : INFINITY;
}

static void measure(const rlf_camera *c, double *out_exact, double *out_float)
{
    *out_exact = *out_float = 0.0;
    for (int32_t i = 0; i < c->width * c->height; i++) {
        const double u = i % c->width, v = i / c->width;
        rlf_vec3 ray;
        const bool is_inside = rlf_camera_unproject(c, u, v, &ray);
        /* Through memory: with -fno-trapping-math GCC drops a cast to float and back. */
        const volatile float kept[2] = {(float)ray.x, (float)ray.y};
        const rlf_vec3 rounded = {kept[0], kept[1], 1.0};
        *out_exact = fmax(*out_exact, is_inside ? off(c, ray, u, v) : INFINITY);
        *out_float = fmax(*out_float, is_inside ? off(c, rounded, u, v) : INFINITY);
    }
}

void eval_calibration_lenses(eval_table *table)
{
    for (size_t i = 0; i < sizeof(lenses) / sizeof(lenses[0]); i++) {
        double exact, table_of_floats;
        measure(&lenses[i].camera, &exact, &table_of_floats);
        eval_table_add(table, "calibration", lenses[i].key, lenses[i].title, RLF_PROFILE_LIVE,
                       exact);
        eval_table_add(table, "calibration", lenses[i].float_key, lenses[i].float_title,
                       RLF_PROFILE_LIVE, table_of_floats);
    }
}
