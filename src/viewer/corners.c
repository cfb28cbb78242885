/* The four corners of the output, for a projector that stands askew: dragged, nudged and kept. */
#include "viewer/corners.h"

#include "relief/io.h"

#include <stdio.h>
#include <string.h>

#define HEAD "relief corners 1"
#define STEP (1.0 / 1000.0) /* of the window, by an arrow: two pixels of a projector */
#define FAR 1.0             /* so far outside the window a corner may lie, of its size */
#define TURN 1e-3           /* least product of two sides, so that the picture stays a picture */

static const double straight[8] = {0, 0, 1, 0, 1, 1, 0, 1};

void viewer_corners_reset(viewer_corners *c)
{
    memcpy(c->at, straight, sizeof c->at);
    c->is_askew = false;
}

/* Convex, and not turned over. */
static bool is_usable(const double at[8])
{
    bool is_good = true;
    for (int i = 0; i < 4; i++) {
        const double *a = at + 2 * i, *b = at + 2 * ((i + 1) % 4), *d = at + 2 * ((i + 2) % 4);
        const double turn = (b[0] - a[0]) * (d[1] - b[1]) - (b[1] - a[1]) * (d[0] - b[0]);
        is_good = is_good && turn > TURN && a[0] >= -FAR && a[0] <= 1.0 + FAR && a[1] >= -FAR &&
                  a[1] <= 1.0 + FAR;
    }
    return is_good;
}

/* From the straight square to four corners: Heckbert, Fundamentals of Texture Mapping and Image
 * Warping, 1989, section 2.2.3. */
static rlf_mat3 from_square(const double p[8])
{
    const double sum_x = p[0] - p[2] + p[4] - p[6], sum_y = p[1] - p[3] + p[5] - p[7];
    const double x1 = p[2] - p[4], x2 = p[6] - p[4], y1 = p[3] - p[5], y2 = p[7] - p[5];
    const double area = x1 * y2 - x2 * y1;
    const double g = (sum_x * y2 - x2 * sum_y) / area, h = (x1 * sum_y - sum_x * y1) / area;
    return (rlf_mat3){{{p[2] - p[0] + g * p[2], p[6] - p[0] + h * p[6], p[0]},
                       {p[3] - p[1] + g * p[3], p[7] - p[1] + h * p[7], p[1]},
                       {g, h, 1.0}}};
}

bool viewer_corners_set(viewer_corners *c, const double at[8])
{
    rlf_mat3 back;
    const rlf_mat3 m = from_square(at);
    if (!is_usable(at) || !rlf_mat3_invert(&m, &back)) {
        return false;
    }
    memcpy(c->at, at, sizeof c->at);
    c->map = back;
    c->is_askew = memcmp(c->at, straight, sizeof c->at) != 0;
    return true;
}

void viewer_corners_pick(viewer_corners *c, double x, double y)
{
    double nearest = 1e9;
    for (int i = 0; i < 4; i++) {
        const double dx = c->at[2 * i] - x, dy = c->at[2 * i + 1] - y;
        if (dx * dx + dy * dy < nearest) {
            nearest = dx * dx + dy * dy;
            c->selected = i;
        }
    }
}

bool viewer_corners_move(viewer_corners *c, double x, double y)
{
    double at[8];
    memcpy(at, c->at, sizeof at);
    at[2 * c->selected] = x;
    at[2 * c->selected + 1] = y;
    return viewer_corners_set(c, at);
}

void viewer_corners_nudge(viewer_corners *c, double steps_x, double steps_y)
{
    const double *at = c->at + 2 * c->selected;
    (void)viewer_corners_move(c, at[0] + STEP * steps_x, at[1] + STEP * steps_y);
}

/* ---- kept ----------------------------------------------------------------------------------- */

void viewer_corners_load(viewer_corners *c, const char *path)
{
    double at[8];
    char head[sizeof HEAD] = "";
    viewer_corners_reset(c);
    FILE *file = path != NULL ? fopen(path, "r") : NULL;
    if (file == NULL) {
        return;
    }
    bool is_good = fgets(head, sizeof head, file) != NULL && strcmp(head, HEAD) == 0;
    for (int i = 0; i < 8 && is_good; i++) {
        long million;
        is_good = fscanf(file, "%ld", &million) == 1 && million > -9000000 && million < 9000000;
        at[i] = is_good ? 1e-6 * (double)million : 0.0;
    }
    (void)fclose(file);
    if (!is_good || !viewer_corners_set(c, at)) {
        rlf_log(RLF_LOG_WARNING, "%s: no four corners of a picture: it stays straight", path);
    }
}

rlf_result viewer_corners_save(const viewer_corners *c, const char *path)
{
    char text[256];
    int length = snprintf(text, sizeof text, "%s\n", HEAD);
    for (int i = 0; i < 8; i++) { /* in millionths: no locale's point */
        const double million = 1e6 * c->at[i];
        length += snprintf(text + length, sizeof text - (size_t)length, "%ld%c",
                           (long)(million < 0.0 ? million - 0.5 : million + 0.5),
                           i % 2 == 0 ? ' ' : '\n');
    }
    return rlf_file_write(path, text, (size_t)length);
}
