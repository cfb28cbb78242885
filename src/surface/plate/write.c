/* How thick plates are where they are seen, how they move, and where they are when they are not. */
#include "kernel/plate.h"
#include "surface/past/past.h"
#include "surface/plate/plate.h"

#include <string.h>

static const float thing_m = 0.03f;
static const double edge_on = 0.2;  /* sine of the angle between the face and the view */
static const double slowest = 0.08; /* m/s: what is slower may rest */
static const float least_m = 0.02f; /* as of all else: thickness/thickness.c */

/* The cut of the nearest ray about the pixel's that meets the plate. */
static bool cut_beside(const rlf_grid *grid, const rlf_plate_view *view, int32_t x, int32_t y,
                       rlf_plate_cut *out)
{
    static const int32_t about[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                        {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    for (int32_t k = 0; k < 8; k++) {
        int32_t u = x + about[k][0], v = y + about[k][1];
        ptrdiff_t i = (ptrdiff_t)v * grid->width + u;
        bool is_inside = u >= 0 && v >= 0 && u < grid->width && v < grid->height;
        if (is_inside && rlf_plate_cut_ray(view, grid->ray_x[i], grid->ray_y[i], out)) {
            return true;
        }
    }
    return false;
}

/* One plate and the frame that it is written to. */
typedef struct writer {
    const rlf_reconstruct *stage;
    const rlf_plate *plate;
    rlf_plate_view view;
    rlf_kernel_plate box; /* the same for rows of pixels */
    bool is_edge_on;
    rlf_slot *slot;
} writer;

static writer begin(const rlf_reconstruct *stage, const rlf_plate *plate, rlf_slot *slot)
{
    writer w = {.stage = stage, .plate = plate, .view = rlf_plate_look(plate), .slot = slot};
    for (int k = 0; k < 3; k++) {
        const rlf_vec3 axis = w.view.axis[k];
        const float part[3] = {(float)axis.x, (float)axis.y, (float)axis.z};
        memcpy(w.box.axis[k], part, sizeof part);
        w.box.from[k] = (float)rlf_dot(w.view.centre, axis);
        w.box.half[k] = (float)w.view.half[k];
    }
    double facing = rlf_dot(w.view.axis[2], rlf_normalize(w.view.centre));
    w.is_edge_on = facing < edge_on && facing > -edge_on;
    return w;
}

/* An edge shows little of its motion: what was filled of it has the plate's. */
static void move_pixel(const writer *w, int32_t x, int32_t y)
{
    const rlf_grid *grid = &w->stage->grid;
    const ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    const double z = w->slot->depth[i];
    rlf_vec3 p = rlf_vec3_make(z * grid->ray_x[i], z * grid->ray_y[i], z);
    rlf_vec3 arm = rlf_sub(p, w->plate->pose.p);
    rlf_vec3 v = rlf_add(w->plate->speed, rlf_cross(w->plate->spin, arm));
    if (rlf_length(v) > slowest) {
        const rlf_span here = {x, x + 1};
        w->slot->moved[y] = rlf_span_unite(w->slot->moved[y], here);
        w->slot->velocity[0][i] = (float)v.x;
        w->slot->velocity[1][i] = (float)v.y;
        w->slot->velocity[2][i] = (float)v.z;
    }
}

/* Of a pixel whose ray leaves the plate at depth `leave`. */
static void write_pixel(const writer *w, float leave, int32_t x, int32_t y)
{
    const ptrdiff_t i = (ptrdiff_t)y * w->stage->grid.width + x;
    const float z = w->slot->depth[i], behind = w->stage->background.mean[i];
    const float thickness = leave - z > least_m ? leave - z : least_m;
    const bool is_cut = behind > 0.0f && z + thickness > behind;
    w->slot->thickness[i] = !is_cut ? thickness : behind > z ? behind - z : 0.0f;
    if (w->is_edge_on && w->slot->reason[i] != RLF_REASON_OK) {
        move_pixel(w, x, y);
    }
}

static void write_row(const writer *w, rlf_span span, int32_t y)
{
    enum { CHUNK = 128 };
    const rlf_grid *grid = &w->stage->grid;
    for (int32_t first = span.x0; first < span.x1; first += CHUNK) {
        const int32_t count = span.x1 - first < CHUNK ? span.x1 - first : CHUNK;
        const ptrdiff_t at = (ptrdiff_t)y * grid->width + first;
        float leave[CHUNK];
        int32_t is_near[CHUNK];
        rlf_kernel_plate_row(&w->box, thing_m, grid->ray_x + at, grid->ray_y + at,
                             w->slot->depth + at, count, leave, is_near);
        for (int32_t k = 0; k < count; k++) {
            if (is_near[k] != 0 && w->slot->foreground[at + k] != 0) {
                rlf_plate_cut beside;
                if (leave[k] > 0.0f) {
                    write_pixel(w, leave[k], first + k, y);
                } else if (cut_beside(grid, &w->view, first + k, y, &beside)) {
                    write_pixel(w, (float)beside.leave, first + k, y);
                }
            }
        }
    }
}

void rlf_plates_write(const rlf_reconstruct *stage, rlf_slot *slot)
{
    for (int32_t k = 0; k < stage->plates.count; k++) {
        const writer w = begin(stage, &stage->plates.item[k], slot);
        const rlf_plate_window window = rlf_plate_window_of(&stage->grid, &w.view, 1);
        for (int32_t y = window.y0; y < window.y1; y++) {
            write_row(&w, (rlf_span){window.x0, window.x1}, y);
        }
    }
}

/* Where the plate is though `depth` has nothing. */
void rlf_plates_expect(rlf_reconstruct *stage, const float *depth)
{
    const rlf_grid *grid = &stage->grid;
    for (int32_t k = 0; k < stage->plates.count; k++) {
        const rlf_plate_view view = rlf_plate_look(&stage->plates.item[k]);
        rlf_plate_window w = rlf_plate_window_of(grid, &view, 0);
        for (int32_t y = w.y0; y < w.y1; y++) {
            for (int32_t x = w.x0; x < w.x1; x++) {
                ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
                rlf_plate_cut cut;
                if (!(depth[i] > 0.0f) &&
                    rlf_plate_cut_ray(&view, grid->ray_x[i], grid->ray_y[i], &cut)) {
                    rlf_past_know(&stage->past, i, (float)cut.enter);
                }
            }
        }
    }
}
