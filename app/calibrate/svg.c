/* Coverage, residuals and tilts. Coordinates are pixels of the camera, scaled by the viewBox. */
#include "calibrate/calibrate.h"

#include <math.h>

#define WIDTH 420 /* of a plot on the page */
#define DEGREES 57.29577951308232

static void begin(FILE *out, double left, double top, double width, double height)
{
    fprintf(out,
            "<svg width=\"%d\" height=\"%d\" viewBox=\"%g %g %g %g\">"
            "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" class=\"frame\"/>\n",
            WIDTH, (int)(WIDTH * height / width), left, top, width, height, left, top, width,
            height);
}

static void begin_picture(FILE *out, const calibration *c, int camera)
{
    begin(out, -0.5, -0.5, c->views.width[camera], c->views.height[camera]);
}

void svg_coverage(FILE *out, const calibration *c, int camera)
{
    calibrate_coverage cover;
    calibrate_cover(&c->views, camera, &cover);
    const double w = (double)c->views.width[camera] / COVERAGE_COLUMNS;
    const double h = (double)c->views.height[camera] / COVERAGE_ROWS;
    begin_picture(out, c, camera);
    for (int i = 0; i < COVERAGE_ROWS * COVERAGE_COLUMNS; i++) {
        const int x = i % COVERAGE_COLUMNS, y = i / COVERAGE_COLUMNS;
        if (!cover.cells[y][x]) {
            fprintf(out, "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" class=\"empty\"/>",
                    x * w, y * h, w, h);
        }
    }
    for (int32_t i = 0; i < c->views.count; i++) {
        const calibrate_view *view = &c->views.views[i];
        for (int32_t k = 0; k < view->sight[camera].count; k++) {
            const calibrate_point *p = &view->sight[camera].points[k];
            fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%g\" class=\"%s\"/>", p->u, p->v,
                    0.004 * c->views.width[camera], view->is_used ? "corner" : "left");
        }
    }
    fprintf(out, "</svg>\n");
}

/* Calls for every error of the used views: place and error, pixels. */
static void for_errors(FILE *out, const calibration *c, int camera,
                       void (*draw)(FILE *out, const calibrate_point *p, const double e[2],
                                    double scale),
                       double scale)
{
    double errors[2 * RELIEF_OPENCV_CORNERS_MAX];
    for (int32_t i = 0; i < c->views.count; i++) {
        const calibrate_view *view = &c->views.views[i];
        if (!view->is_used) {
            continue;
        }
        calibrate_errors(view, &c->model, camera, errors);
        for (int32_t k = 0; k < view->sight[camera].count; k++) {
            draw(out, &view->sight[camera].points[k], &errors[2 * k], scale);
        }
    }
}

static void draw_error(FILE *out, const calibrate_point *p, const double e[2], double scale)
{
    fprintf(out, "<path d=\"M%.1f %.1fl%.1f %.1f\" class=\"error\"/>", p->u, p->v, -scale * e[0],
            -scale * e[1]);
}

void svg_residuals(FILE *out, const calibration *c, int camera)
{
    begin_picture(out, c, camera);
    /* An error of the RMS is a line of a fortieth of the picture. */
    for_errors(out, c, camera, draw_error,
               c->views.width[camera] / 40.0 / rlf_max(c->fit.rms_of[camera], 1e-6));
    fprintf(out, "</svg>\n");
}

static void draw_dot(FILE *out, const calibrate_point *p, const double e[2], double scale)
{
    (void)p;
    fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"1.2\" class=\"corner\"/>", -scale * e[0],
            -scale * e[1]);
}

void svg_scatter(FILE *out, const calibration *c, int camera)
{
    begin(out, -100, -100, 200, 200);
    fprintf(out, "<path d=\"M-100 0H100M0 -100V100\" class=\"axis\"/>"
                 "<circle cx=\"0\" cy=\"0\" r=\"25\" class=\"axis\"/>");
    for_errors(out, c, camera, draw_dot, 25.0 / rlf_max(c->fit.rms_of[camera], 1e-6));
    fprintf(out, "</svg>\n");
}

void svg_tilts(FILE *out, const calibration *c)
{
    begin(out, -60, -60, 120, 120);
    fprintf(out, "<path d=\"M-60 0H60M0 -60V60\" class=\"axis\"/>");
    for (int r = 20; r <= 40; r += 20) {
        fprintf(out, "<circle cx=\"0\" cy=\"0\" r=\"%d\" class=\"axis\"/>", r);
    }
    for (int32_t i = 0; i < c->views.count; i++) {
        const calibrate_view *view = &c->views.views[i];
        if (view->is_used) {
            rlf_vec3 n = rlf_rotate(view->T_first_board.q, rlf_vec3_make(0, 0, 1));
            n = n.z < 0.0 ? rlf_neg(n) : n;
            fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"1.5\" class=\"corner\"/>",
                    DEGREES * rlf_atan2(n.x, n.z), DEGREES * rlf_atan2(n.y, n.z));
        }
    }
    fprintf(out, "</svg>\n");
}
