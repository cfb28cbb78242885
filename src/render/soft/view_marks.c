/* Boxes, labels and arrows over the views. */
#include "render/soft/views.h"

#include "render/soft/draw.h"
#include "render/soft/soft.h"

#include <stdio.h>

#define ARROW_STEP_PX 16 /* grid pixels between arrows */

/* The part of the picture that the enlarged grid image fills: marks do not leave it. */
static rlf_image_rgba8 fitted_part(const soft *s, const soft_fit *fit)
{
    rlf_image_rgba8 part = s->image;
    part.data = rlf_rgba8_row(&s->image, fit->y0) + 4 * (ptrdiff_t)fit->x0;
    part.width = fit->width;
    part.height = fit->height;
    return part;
}

/* Pixel centres of the grid to pixel centres of that part. */
static bool place(const soft *s, const soft_fit *fit, rlf_vec3 p, soft_point *out)
{
    double u, v;
    if (p.z < SOFT_NEAR_Z || !rlf_camera_project(&s->def.grid, p, &u, &v)) {
        return false;
    }
    out->x = (u + 0.5) * fit->scale - 0.5;
    out->y = (v + 0.5) * fit->scale - 0.5;
    return true;
}

static void draw_segment(soft *s, const soft_fit *fit, const rlf_vec3 ends[2], soft_color color)
{
    soft_point a, b;
    if (place(s, fit, ends[0], &a) && place(s, fit, ends[1], &b)) {
        rlf_image_rgba8 part = fitted_part(s, fit);
        soft_draw_line(&part, a, b, color);
    }
}

/* The twelve edges of a region's axis-aligned box (fig. 4.18). */
static void draw_box(soft *s, const soft_fit *fit, const rlf_aabb *box, soft_color color)
{
    for (int i = 0; i < 8; i++) {
        rlf_vec3 ends[2];
        ends[0] = rlf_vec3_make(i & 1 ? box->max.x : box->min.x, i & 2 ? box->max.y : box->min.y,
                                i & 4 ? box->max.z : box->min.z);
        for (int axis = 0; axis < 3; axis++) {
            if ((i >> axis & 1) == 0) {
                ends[1] = ends[0];
                ends[1].x = axis == 0 ? box->max.x : ends[1].x;
                ends[1].y = axis == 1 ? box->max.y : ends[1].y;
                ends[1].z = axis == 2 ? box->max.z : ends[1].z;
                draw_segment(s, fit, ends, color);
            }
        }
    }
}

void soft_draw_region_marks(soft *s, const rlf_surface *surface, const soft_fit *fit)
{
    int32_t scale = soft_text_scale(s->image.height);
    const rlf_image_rgba8 part = fitted_part(s, fit);
    for (int32_t i = 0; i < surface->region_count; i++) {
        const rlf_region *region = &surface->regions[i];
        draw_box(s, fit, &region->box, soft_color_label(region->label));
    }
    for (int32_t i = 0; i < surface->region_count; i++) {
        const rlf_region *region = &surface->regions[i];
        char line[48];
        snprintf(line, sizeof(line), "%s%d", region->layer == RLF_LAYER_FOREGROUND ? "fg " : "",
                 (int)region->label);
        double middle_x = 0.5 * (region->x0 + region->x1);
        double middle_y = 0.5 * (region->y0 + region->y1);
        soft_text style = {(int32_t)(middle_x * fit->scale) - soft_text_width(line, scale) / 2,
                           (int32_t)(middle_y * fit->scale), scale, soft_rgb(255, 255, 255), true};
        soft_draw_text(&part, &style, line);
    }
}

void soft_draw_velocity_marks(soft *s, const rlf_surface *surface, const soft_fit *fit)
{
    int32_t factor = surface->scale_factor > 0 ? surface->scale_factor : 1;
    rlf_image_rgba8 part = fitted_part(s, fit);
    int32_t step = ARROW_STEP_PX / factor > 1 ? ARROW_STEP_PX / factor : 1;
    for (int32_t y = step / 2; y < surface->height; y += step) {
        for (int32_t x = step / 2; x < surface->width; x += step) {
            int32_t i = y * surface->width + x;
            rlf_vec3 v = {surface->velocity_x[i], surface->velocity_y[i], surface->velocity_z[i]};
            soft_point from, to;
            if (!(surface->depth[i] > 0.0f) || !(rlf_dot(v, v) > 0.0)) {
                continue;
            }
            rlf_vec3 p = rlf_surface_point(surface, i);
            if (place(s, fit, p, &from) && place(s, fit, rlf_mad(p, v, SOFT_ARROW_S), &to)) {
                soft_draw_arrow(&part, from, to, soft_rgb(255, 255, 255));
            }
        }
    }
}
