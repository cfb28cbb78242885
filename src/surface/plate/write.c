/* How thick plates are where they are seen, how they move, and where they are when they are not. */
#include "surface/past/past.h"
#include "surface/plate/plate.h"

static const double thing_m = 0.03;
static const double edge_on = 0.2;  /* sine of the angle between the face and the view */
static const double slowest = 0.08; /* m/s: what is slower may rest */
static const double least_m = 0.02; /* as of all else: thickness/thickness.c */

/* The cut of the pixel's ray, or of the nearest one about it that meets the plate. */
static bool cut_near(const rlf_grid *grid, const rlf_plate_view *view, int32_t x, int32_t y,
                     rlf_plate_cut *out)
{
    static const int32_t about[9][2] = {{0, 0}, {1, 0},   {-1, 0}, {0, 1}, {0, -1},
                                        {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    for (int32_t k = 0; k < 9; k++) {
        int32_t u = x + about[k][0], v = y + about[k][1];
        ptrdiff_t i = (ptrdiff_t)v * grid->width + u;
        bool is_inside = u >= 0 && v >= 0 && u < grid->width && v < grid->height;
        if (is_inside && rlf_plate_cut_ray(view, grid->ray_x[i], grid->ray_y[i], out)) {
            return true;
        }
    }
    return false;
}

/* An edge shows little of its motion: what was filled of it has the plate's. */
static void move_pixel(const rlf_plate *plate, rlf_vec3 p, int32_t x, int32_t y, ptrdiff_t i,
                       rlf_slot *slot)
{
    rlf_vec3 arm = rlf_sub(p, plate->pose.p);
    rlf_vec3 v = rlf_add(plate->speed, rlf_cross(plate->spin, arm));
    if (rlf_length(v) > slowest) {
        const rlf_span here = {x, x + 1};
        slot->moved[y] = rlf_span_unite(slot->moved[y], here);
        slot->velocity[0][i] = (float)v.x;
        slot->velocity[1][i] = (float)v.y;
        slot->velocity[2][i] = (float)v.z;
    }
}

static void write_pixel(const rlf_reconstruct *stage, const rlf_plate *plate,
                        const rlf_plate_view *view, int32_t x, int32_t y, rlf_slot *slot)
{
    const rlf_grid *grid = &stage->grid;
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    double z = slot->depth[i], behind = stage->background.mean[i];
    rlf_plate_cut cut;
    rlf_vec3 p = rlf_vec3_make(z * grid->ray_x[i], z * grid->ray_y[i], z);
    if (slot->foreground[i] == 0 || !(z > 0.0) || rlf_plate_distance(view, p) > thing_m ||
        !cut_near(grid, view, x, y, &cut)) {
        return;
    }
    double thickness = rlf_max(cut.leave - z, least_m);
    slot->thickness[i] =
        (float)(behind > 0.0 && z + thickness > behind ? rlf_max(behind - z, 0.0) : thickness);
    double facing = rlf_dot(view->axis[2], rlf_normalize(view->centre));
    if (slot->reason[i] != RLF_REASON_OK && facing < edge_on && facing > -edge_on) {
        move_pixel(plate, p, x, y, i, slot);
    }
}

void rlf_plates_write(const rlf_reconstruct *stage, rlf_slot *slot)
{
    for (int32_t k = 0; k < stage->plates.count; k++) {
        const rlf_plate_view view = rlf_plate_look(&stage->plates.item[k]);
        rlf_plate_window w = rlf_plate_window_of(&stage->grid, &view, 1);
        for (int32_t y = w.y0; y < w.y1; y++) {
            for (int32_t x = w.x0; x < w.x1; x++) {
                write_pixel(stage, &stage->plates.item[k], &view, x, y, slot);
            }
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
