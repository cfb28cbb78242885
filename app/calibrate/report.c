/* The report: one page with figures, plots and pictures; it loads nothing from elsewhere. */
#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "calibrate/calibrate.h"

#include "relief/io.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
    "<title>Calibration</title><style>\n"
    "body{font:15px/1.45 sans-serif;max-width:1300px;margin:2em auto;padding:0 1em;color:#222}\n"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.15em .8em;text-align:right;"
    "border-bottom:1px solid #ddd}td:first-child,th:first-child{text-align:left}\n"
    "svg{margin:.3em}figure{display:inline-block;margin:.5em;vertical-align:top}"
    "img{max-width:100%}\n"
    ".frame{fill:#fff;stroke:#888;stroke-width:1;vector-effect:non-scaling-stroke}\n"
    ".empty{fill:#f3d9c4}.corner{fill:#1f5fa8}.left{fill:#c33}\n"
    ".error{stroke:#1f5fa8;stroke-width:1;vector-effect:non-scaling-stroke;fill:none}\n"
    ".axis{stroke:#bbb;stroke-width:1;vector-effect:non-scaling-stroke;fill:none}\n"
    "</style></head><body>\n";

/* Text with the characters that HTML keeps for itself written out. */
static void print_text(FILE *out, const char *text)
{
    for (const char *p = text; *p != '\0'; p++) {
        switch (*p) {
        case '<': fputs("&lt;", out); break;
        case '>': fputs("&gt;", out); break;
        case '&': fputs("&amp;", out); break;
        default: fputc(*p, out);
        }
    }
}

static void print_summary(FILE *out, const calibration *c)
{
    fprintf(out,
            "<h1>Calibration</h1>\n<p>%d views of a board of %d x %d inner corners with squares of "
            "%g m: %.4f pixels RMS over all corners.</p>\n",
            (int)calibrate_views_used(&c->views, -1), (int)c->views.board.columns,
            (int)c->views.board.rows, c->views.board.square_m, c->fit.rms);
    if (c->views.camera_count == CALIBRATE_CAMERAS) {
        fprintf(out,
                "<p>Baseline %.3f mm. Depth lands in colour with a standard deviation of at most "
                "%.2f px in 95 %% of the picture.",
                1e3 * rlf_length(c->model.T_second_first.p), c->mapping_p95);
        if (!isnan(c->epipolar)) {
            fprintf(out, " Mean distance from the epipolar line: %.4f px.", c->epipolar);
        }
        fprintf(out, "</p>\n");
    }
    if (c->offset_boards > 0) {
        fprintf(out, "<p>Depth is too far by %.2f &plusmn; %.2f mm (%d boards).</p>\n",
                1e3 * c->offset_m, 1e3 * c->offset_deviation_m, (int)c->offset_boards);
    }
    if (c->is_thesis_way) {
        fprintf(out, "<p>The depth camera was found by the board's outline in depth; infrared "
                     "pictures are more exact.</p>\n");
    }
}

static void print_unknown(FILE *out, const calibration *c, const char *name, int index,
                          double value)
{
    if (c->model.is_fixed[index]) {
        fprintf(out, "<tr><td>%s</td><td>%.6g</td><td>kept</td></tr>\n", name, value);
    } else {
        fprintf(out, "<tr><td>%s</td><td>%.6g</td><td>%.2g</td></tr>\n", name, value,
                calibrate_deviation(&c->fit, index));
    }
}

/* Nothing where it was not measured. */
static void print_pixels(FILE *out, const char *name, double value)
{
    if (!isnan(value)) {
        fprintf(out, "<tr><td>%s</td><td>%.4f</td><td></td></tr>\n", name, value);
    }
}

static void print_parameters(FILE *out, const calibration *c)
{
    static const char *const lens[CALIBRATE_LENS] = {"fx, px", "fy, px", "cx, px", "cy, px", "k1",
                                                     "k2",     "p1",     "p2",     "k3"};
    static const char *const place[3] = {"x, m", "y, m", "z, m"};
    for (int k = 0; k < c->views.camera_count; k++) {
        const rlf_camera *m = &c->model.camera[k];
        const double *d = m->distortion;
        const double values[CALIBRATE_LENS] = {m->fx, m->fy, m->cx, m->cy, d[0],
                                               d[1],  d[2],  d[3],  d[4]};
        fprintf(out,
                "<table><tr><th>%s camera</th><th>value</th><th>standard deviation</th></tr>\n",
                c->views.camera_name[k]);
        for (int i = 0; i < CALIBRATE_LENS; i++) {
            print_unknown(out, c, lens[i], k * CALIBRATE_LENS + i, values[i]);
        }
        print_pixels(out, "RMS, px", c->fit.rms_of[k]);
        print_pixels(out, "leave-one-out, px", c->leave_one_out[k]);
        fprintf(out, "</table>\n");
    }
    if (c->views.camera_count == CALIBRATE_CAMERAS) {
        const rlf_vec3 p = c->model.T_second_first.p;
        const double values[3] = {p.x, p.y, p.z};
        fprintf(out,
                "<table><tr><th>from %s to %s</th><th>value</th><th>standard deviation</th>"
                "</tr>\n",
                c->views.camera_name[0], c->views.camera_name[1]);
        for (int i = 0; i < 3; i++) {
            print_unknown(out, c, place[i], CALIBRATE_MOTION + 3 + i, values[i]);
        }
        fprintf(out, "</table>\n");
    }
}

static void print_plots(FILE *out, const calibration *c)
{
    for (int k = 0; k < c->views.camera_count; k++) {
        if (calibrate_views_used(&c->views, k) == 0) {
            continue;
        }
        fprintf(out, "<h2>%s camera</h2>\n<figure>", c->views.camera_name[k]);
        svg_coverage(out, c, k);
        fprintf(out, "<figcaption>Corners; shaded: never seen there</figcaption></figure>\n"
                     "<figure>");
        svg_residuals(out, c, k);
        fprintf(out, "<figcaption>Errors, enlarged</figcaption></figure>\n<figure>");
        svg_scatter(out, c, k);
        fprintf(out, "<figcaption>All errors; circle: the RMS of %.3f px</figcaption></figure>\n",
                c->fit.rms_of[k]);
    }
    fprintf(out, "<h2>Tilts</h2>\n<figure>");
    svg_tilts(out, c);
    fprintf(out, "<figcaption>Where the boards faced; circles: 20 and 40 degrees</figcaption>"
                 "</figure>\n");
}

static void print_views(FILE *out, const calibration *c)
{
    fprintf(out, "<h2>Views</h2>\n<table><tr><th>view</th><th>corners</th><th>RMS, px</th>"
                 "<th>depth too far by, mm</th><th></th></tr>\n");
    for (int32_t i = 0; i < c->views.count; i++) {
        const calibrate_view *view = &c->views.views[i];
        fprintf(out, "<tr><td>");
        print_text(out, calibrate_view_name(view));
        fprintf(out, "</td><td>%d + %d</td><td>", (int)view->sight[0].count,
                (int)view->sight[1].count);
        if (view->is_used) {
            fprintf(out, "%.4f", calibrate_view_rms(view, &c->model));
        }
        fprintf(out, "</td><td>");
        if (!isnan(view->offset_m)) {
            fprintf(out, "%.2f", 1e3 * view->offset_m);
        }
        fprintf(out, "</td><td>");
        if (!view->is_used) {
            print_text(out, "left out: ");
            print_text(out, view->reason);
        }
        fprintf(out, "</td></tr>\n");
    }
    fprintf(out, "</table>\n");
}

static rlf_result write_page(const calibrate_options *o, const calibration *c, int pictures)
{
    char path[4096], *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL) {
        return RLF_ERROR_MEMORY;
    }
    fputs(head, out);
    print_summary(out, c);
    if (pictures > 0) {
        const bool is_pair = o->source == NULL;
        fprintf(out,
                "<h2>Before and after</h2>\n<p>%s</p>\n<img src=\"before.png\" alt=\"before\">"
                "<img src=\"after.png\" alt=\"after\">\n",
                is_pair ? "One pair as it is, and rectified: what is on a line in one picture is "
                          "on it in the other."
                        : "Edges of depth (red) in colour, as the source had it and now.");
    }
    print_parameters(out, c);
    print_plots(out, c);
    print_views(out, c);
    fputs("</body></html>\n", out);
    const bool is_whole = fclose(out) == 0;
    snprintf(path, sizeof(path), "%.4000s/index.html", o->report);
    rlf_result result = is_whole ? rlf_file_write(path, text, size) : RLF_ERROR_MEMORY;
    free(text);
    if (result == RLF_OK) {
        printf("written: %s\n", path);
    }
    return result;
}

rlf_result calibrate_report(const calibrate_options *options, const calibration *c)
{
    int pictures = 0;
    rlf_result result = rlf_make_folder(options->report);
    if (result == RLF_OK) {
        result = calibrate_report_pictures(options, c, &pictures);
    }
    return result == RLF_OK ? write_page(options, c, pictures) : result;
}
