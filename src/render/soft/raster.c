/* Which face every sample sees, row by row.
 *
 * Four samples per pixel lie on a rotated grid. Along one line of samples a convex face is one run
 * of pixels, whose ends come from its edges; a shared edge is worked out from the same two corners
 * in the same order, so neighbouring faces neither overlap nor leave gaps. */
#include "render/soft/passes.h"

#include "kernel/kernel.h"
#include "render/soft/soft.h"

#define NOWHERE 1e30

/* Offsets from the pixel's centre: no two share a row or a column. */
static const double sample_x[SOFT_SAMPLES] = {-0.125, 0.375, -0.375, 0.125};
static const double sample_y[SOFT_SAMPLES] = {-0.375, -0.125, 0.125, 0.375};

/* The same on each line of samples of a group, below the centres of its first row. */
static const double line_x[SOFT_GROUP_LINES] = {-0.125, 0.375, -0.375, 0.125, -0.125, 0.375,
                                                -0.375, 0.125, -0.125, 0.375, -0.375, 0.125,
                                                -0.125, 0.375, -0.375, 0.125};
static const double line_y[SOFT_GROUP_LINES] = {-0.375, -0.125, 0.125, 0.375, 0.625, 0.875,
                                                1.125,  1.375,  1.625, 1.875, 2.125, 2.375,
                                                2.625,  2.875,  3.125, 3.375};

/* Where a face begins and ends on the lines. */
typedef struct lines {
    double y[SOFT_GROUP_LINES], left[SOFT_GROUP_LINES], right[SOFT_GROUP_LINES];
} lines;

RLF_KERNEL_PART void place_lines(double y, lines *out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_GROUP_LINES; i++) {
        out->y[i] = y + line_y[i];
        out->left[i] = NOWHERE;
        out->right[i] = -NOWHERE;
    }
}

RLF_KERNEL_PART void meet_edge(const soft_edge edge, const double *restrict y,
                               double *restrict left, double *restrict right)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_GROUP_LINES; i++) {
        double at = edge.x + edge.slope * (y[i] - edge.y);
        bool meets = (y[i] >= edge.y) & (y[i] < edge.end);
        double low = meets ? at : NOWHERE;
        double high = meets ? at : -NOWHERE;
        left[i] = low < left[i] ? low : left[i];
        right[i] = high > right[i] ? high : right[i];
    }
}

/* First pixels whose sample is at or beyond x, within 0..width. */
RLF_KERNEL_PART void first_pixels(const double *restrict x, double width, int32_t *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_GROUP_LINES; i++) {
        double at = x[i] - line_x[i];
        at = at > 0.0 ? at : 0.0;
        at = at < width ? at : width;
        int32_t cell = (int32_t)at;
        out[i] = cell + ((double)cell < at ? 1 : 0);
    }
}

/* First pixel and the one after the last of all lines. */
RLF_KERNEL_PART void bound_lines(int32_t count, soft_ends *ends)
{
    int32_t x0 = INT32_MAX;
    int32_t x1 = 0;
    for (int32_t i = 0; i < count; i++) {
        const bool is_some = ends->begin[i] < ends->end[i];
        const int32_t begin = is_some ? ends->begin[i] : INT32_MAX;
        const int32_t end = is_some ? ends->end[i] : 0;
        x0 = begin < x0 ? begin : x0;
        x1 = end > x1 ? end : x1;
    }
    ends->x0 = x0;
    ends->x1 = x1;
}

RLF_KERNEL bool soft_find_ends(const soft_face *f, const soft_group *group, soft_ends *out)
{
    lines l;
    const int32_t y = group->rows[0].y;
    place_lines(y, &l);
    for (int e = 0; e < SOFT_CORNERS; e++) {
        if (f->edge[e].end >= y - 1.0 && f->edge[e].y <= y + group->row_count) {
            meet_edge(f->edge[e], l.y, l.left, l.right);
        }
    }
    first_pixels(l.left, group->width, out->begin);
    first_pixels(l.right, group->width, out->end);
    if (group->row_count == SOFT_GROUP_ROWS) { /* its own case, for a count that is known */
        bound_lines(SOFT_GROUP_LINES, out);
    } else {
        bound_lines(group->row_count * SOFT_SAMPLES, out);
    }
    return out->x0 < out->x1;
}

/* Keeps the larger 1/z, in whole SOFT_LANES: those beyond the count lose. Without a branch that the
 * compiler could make a store depend on. */
RLF_KERNEL_PART void test_run(float *restrict inverse_z, int32_t *restrict face, int32_t count,
                              float at0, float step, int32_t id)
{
    const uint32_t blocks = ((uint32_t)count + SOFT_LANES - 1) / SOFT_LANES;
    for (uint32_t i = 0; i < blocks * SOFT_LANES; i++) {
        float value = at0 + step * (float)(int32_t)i;
        float before = inverse_z[i];
        int32_t last = face[i];
        value = (int32_t)i < count ? value : 0.0f;
        int32_t wins = -(int32_t)(value > before);
        inverse_z[i] = value > before ? value : before;
        face[i] = last ^ ((last ^ id) & wins);
    }
}

/* Parts of a row with pixels between the least begin and the greatest end of its lines. */
RLF_KERNEL_PART void touch_parts(const int32_t *restrict begin, const int32_t *restrict end,
                                 soft_touch touch, uint8_t *restrict touched)
{
    int32_t x0 = INT32_MAX;
    int32_t x1 = 0;
    for (int32_t i = 0; i < SOFT_SAMPLES; i++) {
        const bool is_some = begin[i] < end[i];
        x0 = is_some && begin[i] < x0 ? begin[i] : x0;
        x1 = is_some && end[i] > x1 ? end[i] : x1;
    }
    for (int32_t part = x0 / SOFT_PART; part * SOFT_PART < x1; part++) {
        touched[part] = touched[part] > touch ? touched[part] : (uint8_t)touch;
    }
}

RLF_KERNEL void soft_raster_face(const soft_face *f, const soft_ends *ends, soft_group *group)
{
    const soft_plane plane = f->inverse_z;
    for (int32_t r = 0; r < group->row_count; r++) {
        const soft_row *row = &group->rows[r];
        const int32_t *begin = ends->begin + r * SOFT_SAMPLES;
        const int32_t *end = ends->end + r * SOFT_SAMPLES;
        touch_parts(begin, end, ends->is_alone ? SOFT_TOUCHED_ALONE : SOFT_TOUCHED, row->touched);
        for (int32_t k = 0; k < SOFT_SAMPLES && !ends->is_alone; k++) {
            if (begin[k] < end[k]) {
                float across = (float)begin[k] + (float)sample_x[k] - f->origin_x;
                float down = (float)row->y - f->origin_y + (float)sample_y[k];
                float at0 = plane.at0 + plane.dx * across + plane.dy * down;
                ptrdiff_t first = k * group->stride + begin[k];
                test_run(row->inverse_z + first, row->face + first, end[k] - begin[k], at0,
                         plane.dx, ends->face);
            }
        }
    }
}

/* ---- faces that are alone ----------------------------------------------------------------------
 *
 * Faces that nothing else is before or behind need no depth of samples. The faces of a convex body
 * that are turned to the eye share edges, but no samples. */

enum { PX = SOFT_CROWD_PX, MANY = 2 };

/* Ends [first, end) of one body, and its columns. */
typedef struct group_body {
    int32_t first, end;
    soft_span columns;
    bool is_convex;
} group_body;

static group_body next_body(const soft_scene *scene, const soft_ends *ends, int32_t first,
                            int32_t count)
{
    const int32_t body = scene->faces[ends[first].face].body;
    group_body out = {first, first, {INT32_MAX, 0}, true};
    for (; out.end < count && scene->faces[ends[out.end].face].body == body; out.end++) {
        const soft_ends *e = &ends[out.end];
        out.columns.x0 = e->x0 / PX < out.columns.x0 ? e->x0 / PX : out.columns.x0;
        out.columns.x1 = e->x1 > out.columns.x1 ? e->x1 : out.columns.x1;
        out.is_convex = out.is_convex && scene->faces[e->face].skin == 0;
    }
    out.columns.x1 = (out.columns.x1 + PX - 1) / PX;
    return out;
}

static bool is_alone(const uint8_t *crowd, soft_span columns)
{
    int32_t most = 0;
    for (int32_t x = columns.x0; x < columns.x1; x++) {
        most = crowd[x] > most ? crowd[x] : most;
    }
    return most < MANY;
}

void soft_find_alone(const soft_scene *scene, int32_t count, soft_group *group)
{
    uint8_t *crowd = group->crowd;
    memset(crowd, 0, (size_t)(group->width + PX - 1) / PX);
    for (int32_t i = 0; i < count;) {
        const group_body body = next_body(scene, group->ends, i, count);
        for (int32_t x = body.columns.x0; x < body.columns.x1; x++) {
            crowd[x] = crowd[x] < MANY ? crowd[x] + 1 : MANY;
        }
        i = body.end;
    }
    for (int32_t i = 0; i < count;) {
        const group_body body = next_body(scene, group->ends, i, count);
        const bool alone = body.is_convex && is_alone(crowd, body.columns);
        for (; i < body.end; i++) {
            group->ends[i].is_alone = alone;
        }
    }
}
