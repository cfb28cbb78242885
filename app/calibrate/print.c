/* The result as text. */
#include "calibrate/calibrate.h"

#include <math.h>
#include <stdio.h>

#define DEGREES 57.29577951308232

static void print_number(const char *name, double value, double deviation, const char *unit,
                         bool is_fixed)
{
    if (is_fixed) {
        printf("    %-10s %11.5g          kept%s%s\n", name, value, *unit != '\0' ? ", " : "",
               unit);
    } else {
        printf("    %-10s %11.5g +- %-8.2g %s\n", name, value, deviation, unit);
    }
}

/* Nothing where it was not measured. */
static void print_pixels(const char *name, double value)
{
    if (!isnan(value)) {
        printf(" %s %.4f px,", name, value);
    }
}

static void print_camera(const calibration *c, int k)
{
    static const char *const names[CALIBRATE_LENS] = {"fx", "fy", "cx", "cy", "k1",
                                                      "k2", "p1", "p2", "k3"};
    const rlf_camera *m = &c->model.camera[k];
    const double values[CALIBRATE_LENS] = {m->fx,
                                           m->fy,
                                           m->cx,
                                           m->cy,
                                           m->distortion[0],
                                           m->distortion[1],
                                           m->distortion[2],
                                           m->distortion[3],
                                           m->distortion[4]};
    calibrate_coverage cover;
    calibrate_cover(&c->views, k, &cover);
    printf("  %s camera, %dx%d:", c->views.camera_name[k], (int)m->width, (int)m->height);
    print_pixels("RMS", c->fit.rms_of[k]);
    print_pixels("leave-one-out", c->leave_one_out[k]);
    printf(" %.0f %% of the picture covered\n", 100.0 * cover.share);
    for (int i = 0; i < CALIBRATE_LENS; i++) {
        const int index = k * CALIBRATE_LENS + i;
        print_number(names[i], values[i], calibrate_deviation(&c->fit, index), i < 4 ? "px" : "",
                     c->model.is_fixed[index]);
    }
}

static void print_motion(const calibration *c)
{
    const rlf_vec3 p = c->model.T_second_first.p;
    const rlf_quat q = c->model.T_second_first.q;
    const double mm[3] = {1e3 * p.x, 1e3 * p.y, 1e3 * p.z};
    const double s = 2.0 * (q.w < 0.0 ? -1.0 : 1.0) * DEGREES; /* small turns: 2 sin(a/2) */
    const double deg[3] = {s * q.x, s * q.y, s * q.z};
    static const char *const names[3] = {"x", "y", "z"};
    printf("  from the %s camera to the %s one:", c->views.camera_name[0], c->views.camera_name[1]);
    print_pixels("mean epipolar error", c->epipolar);
    printf(" baseline %.3f mm\n", 1e3 * rlf_length(p));
    for (int i = 0; i < 3; i++) {
        print_number(names[i], mm[i], 1e3 * calibrate_deviation(&c->fit, CALIBRATE_MOTION + 3 + i),
                     "mm", c->model.is_fixed[CALIBRATE_MOTION + 3 + i]);
    }
    for (int i = 0; i < 3; i++) {
        print_number(names[i], deg[i], DEGREES * calibrate_deviation(&c->fit, CALIBRATE_MOTION + i),
                     "deg", c->model.is_fixed[CALIBRATE_MOTION + i]);
    }
    printf("  where depth lands in colour: standard deviation below %.2f px in 95 %% of the "
           "picture\n",
           c->mapping_p95);
}

void calibrate_print_views(const calibrate_views *views)
{
    for (int32_t i = 0; i < views->count; i++) {
        const calibrate_view *view = &views->views[i];
        const bool has_board = view->sight[0].count + view->sight[1].count > 0;
        if (!view->is_used && has_board) { /* a warning has named the others */
            printf("  left out: %s: %s\n", calibrate_view_name(view), view->reason);
        }
    }
}

void calibrate_print(const calibration *c)
{
    printf("%d views of a %dx%d board, %g m squares: RMS %.4f px\n",
           (int)calibrate_views_used(&c->views, -1), (int)c->views.board.columns,
           (int)c->views.board.rows, c->views.board.square_m, c->fit.rms);
    calibrate_print_views(&c->views);
    for (int k = 0; k < c->views.camera_count; k++) {
        print_camera(c, k);
    }
    if (c->views.camera_count == CALIBRATE_CAMERAS) {
        print_motion(c);
    }
    if (c->offset_boards > 0) {
        printf("  depth is too far by %.2f +- %.2f mm (%d boards)\n", 1e3 * c->offset_m,
               1e3 * c->offset_deviation_m, (int)c->offset_boards);
    }
    if (c->is_thesis_way) {
        printf("  the depth camera was found by the board's outline in depth; infrared pictures "
               "are more exact\n");
    }
}
