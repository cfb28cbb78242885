/* Views of the surface's planes, in the grid's own image, enlarged into the picture. */
#include "render/soft/views.h"

#include "render/soft/draw.h"
#include "render/soft/soft.h"

#include <string.h>

#define NEARER 0.98 /* of a point's depth: what is nearer hides it */

typedef struct grid_view {
    const soft *s;
    const rlf_render_input *input;
    double near_z, far_z;
    void (*draw_pixel)(const struct grid_view *view, int32_t i, uint8_t *out);
} grid_view;

static grid_view range_of(const soft *s, const rlf_render_input *input)
{
    grid_view view = {s, input, s->def.rig.depth_min_m, s->def.rig.depth_max_m, NULL};
    if (!(view.far_z > view.near_z)) {
        view.near_z = 0.5;
        view.far_z = 4.5;
    }
    return view;
}

static soft_color depth_color(const grid_view *view, float z)
{
    if (!(z > 0.0f)) {
        return soft_rgb(0, 0, 0);
    }
    return soft_color_near_far((z - view->near_z) / (view->far_z - view->near_z));
}

static soft_color dim_depth(const grid_view *view, float z)
{
    double t = (z - view->near_z) / (view->far_z - view->near_z);
    int32_t grey = z > 0.0f ? (int32_t)(110.0 - 80.0 * rlf_clamp(t, 0.0, 1.0)) : 0;
    return soft_rgb(grey, grey, grey);
}

/* Whether something stands between the colour camera and a point that it would see at (u, v) of the
 * picture, z metres deep: the colour there is not the point's. */
static bool is_hidden(const soft *s, const rlf_image_rgba8 *image, double u, double v, double z)
{
    const rlf_plane_f32 *real = &s->real.z;
    int32_t x = (int32_t)((u + 0.5) * real->width / image->width);
    int32_t y = (int32_t)((v + 0.5) * real->height / image->height);
    x = x < real->width ? x : real->width - 1; /* by rounding alone */
    y = y < real->height ? y : real->height - 1;
    float nearest = rlf_f32_row(real, y)[x];
    return nearest > 0.0f && nearest < NEARER * z;
}

bool soft_view_has_colors(const rlf_render_input *input)
{
    bool shows = input->view == RLF_VIEW_REGIONS || input->view == RLF_VIEW_FOREGROUND ||
                 input->view == RLF_VIEW_POINTS;
    return shows && input->frame->color.data != NULL;
}

soft_color soft_grid_color(const soft *s, const rlf_render_input *input, int32_t i, float z)
{
    const rlf_surface *surface = input->surface;
    const rlf_image_rgba8 *image = &input->frame->color;
    const grid_view range = range_of(s, input);
    if (image->data == NULL || !(z > 0.0f)) {
        return dim_depth(&range, z);
    }
    rlf_vec3 p = rlf_vec3_make(z * surface->ray_x[i], z * surface->ray_y[i], z);
    double u, v;
    p = rlf_transform(&s->def.rig.T_color_depth, p);
    if (!rlf_camera_project(s->def.rig.has_color ? &s->def.rig.color : &s->def.rig.depth, p, &u,
                            &v) ||
        !(u > -0.5 && v > -0.5 && u < image->width - 0.5 && v < image->height - 0.5) ||
        is_hidden(s, image, u, v, p.z)) {
        return dim_depth(&range, z);
    }
    const uint8_t *pixel = rlf_rgba8_row(image, (int32_t)(v + 0.5)) + 4 * (ptrdiff_t)(u + 0.5);
    return soft_rgb(pixel[0], pixel[1], pixel[2]);
}

static soft_color camera_color(const grid_view *view, int32_t i)
{
    const rlf_surface *surface = view->input->surface;
    float z = surface->depth[i];
    if (!(z > 0.0f) && surface->background_depth != NULL) {
        z = surface->background_depth[i];
    }
    return soft_grid_color(view->s, view->input, i, z);
}

static void draw_depth(const grid_view *view, int32_t i, uint8_t *out)
{
    soft_put(out, depth_color(view, view->input->surface->depth[i]));
}

static void draw_background_depth(const grid_view *view, int32_t i, uint8_t *out)
{
    const float *z = view->input->surface->background_depth;
    soft_put(out, depth_color(view, z != NULL ? z[i] : 0.0f));
}

static void draw_normal(const grid_view *view, int32_t i, uint8_t *out)
{
    const rlf_surface *s = view->input->surface;
    soft_put(out, soft_color_normal(rlf_vec3_make(s->normal_x[i], s->normal_y[i], s->normal_z[i])));
}

static void draw_region(const grid_view *view, int32_t i, uint8_t *out)
{
    const rlf_surface *s = view->input->surface;
    int32_t label = s->label[i];
    if (label == 0 && s->background_label != NULL) {
        label = s->background_label[i];
    }
    soft_put(out, camera_color(view, i));
    if (label > 0) {
        soft_blend(out, soft_color_label(label), 170);
    } else {
        soft_blend(out, soft_rgb(0, 0, 0), 150);
    }
}

static void draw_foreground(const grid_view *view, int32_t i, uint8_t *out)
{
    soft_put(out, camera_color(view, i));
    if (view->input->surface->foreground[i] != 0) {
        soft_blend(out, soft_color_foreground(), 120);
    } else {
        soft_blend(out, soft_rgb(0, 0, 0), 110);
    }
}

static void draw_velocity(const grid_view *view, int32_t i, uint8_t *out)
{
    const rlf_surface *s = view->input->surface;
    rlf_vec3 v = {s->velocity_x[i], s->velocity_y[i], s->velocity_z[i]};
    bool moves = rlf_dot(v, v) > 0.0;
    soft_put(out, moves ? soft_color_velocity(v) : dim_depth(view, s->depth[i]));
}

static void draw_thickness(const grid_view *view, int32_t i, uint8_t *out)
{
    const rlf_surface *s = view->input->surface;
    bool stands = s->background_thickness != NULL && s->foreground[i] == 0;
    float thickness = stands ? s->background_thickness[i] : s->thickness[i];
    soft_put(out,
             thickness > 0.0f ? soft_color_thickness(thickness) : dim_depth(view, s->depth[i]));
}

static void draw_reason(const grid_view *view, int32_t i, uint8_t *out)
{
    soft_put(out, soft_color_reason((rlf_reason)view->input->surface->reason[i]));
}

static void draw_grid_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const grid_view *view = context;
    const rlf_image_rgba8 *image = &view->s->grid_image;
    for (int32_t y = begin; y < end; y++) {
        uint8_t *out = rlf_rgba8_row(image, y);
        for (int32_t x = 0; x < image->width; x++) {
            view->draw_pixel(view, y * image->width + x, out + 4 * (ptrdiff_t)x);
        }
    }
}

/* The largest enlargement of the grid that fits the picture, in the middle. */
static soft_fit fit_grid(const soft *s)
{
    double scale_x = (double)s->image.width / s->grid_image.width;
    double scale_y = (double)s->image.height / s->grid_image.height;
    soft_fit fit = {.scale = rlf_min(scale_x, scale_y)};
    fit.width = (int32_t)(s->grid_image.width * fit.scale + 0.5);
    fit.height = (int32_t)(s->grid_image.height * fit.scale + 0.5);
    fit.x0 = (s->image.width - fit.width) / 2;
    fit.y0 = (s->image.height - fit.height) / 2;
    return fit;
}

static void clear_image(const rlf_image_rgba8 *image)
{
    for (int32_t y = 0; y < image->height; y++) {
        uint8_t *row = rlf_rgba8_row(image, y);
        for (int32_t x = 0; x < image->width; x++) {
            soft_put(row + 4 * (ptrdiff_t)x, soft_rgb(0, 0, 0));
        }
    }
}

static void enlarge(soft *s, const soft_fit *fit)
{
    clear_image(&s->image);
    for (int32_t y = 0; y < fit->height; y++) {
        int32_t from_y = (int32_t)((int64_t)y * s->grid_image.height / fit->height);
        const uint8_t *from = rlf_rgba8_row(&s->grid_image, from_y);
        uint8_t *to = rlf_rgba8_row(&s->image, fit->y0 + y) + 4 * (ptrdiff_t)fit->x0;
        for (int32_t x = 0; x < fit->width; x++) {
            int64_t from_x = (int64_t)x * s->grid_image.width / fit->width;
            memcpy(to + 4 * (ptrdiff_t)x, from + 4 * from_x, 4);
        }
    }
}

void soft_draw_view(soft *s, const rlf_render_input *input)
{
    grid_view view = range_of(s, input);
    switch (input->view) {
    case RLF_VIEW_NORMALS: view.draw_pixel = draw_normal; break;
    case RLF_VIEW_REGIONS: view.draw_pixel = draw_region; break;
    case RLF_VIEW_FOREGROUND: view.draw_pixel = draw_foreground; break;
    case RLF_VIEW_BACKGROUND: view.draw_pixel = draw_background_depth; break;
    case RLF_VIEW_VELOCITY: view.draw_pixel = draw_velocity; break;
    case RLF_VIEW_THICKNESS: view.draw_pixel = draw_thickness; break;
    case RLF_VIEW_REASON: view.draw_pixel = draw_reason; break;
    default: view.draw_pixel = draw_depth; break;
    }
    rlf_parallel_for(s->def.pool, s->grid_image.height, SOFT_BAND_ROWS, draw_grid_rows, &view);
    soft_fit fit = fit_grid(s);
    enlarge(s, &fit);
    if (input->view == RLF_VIEW_REGIONS) {
        soft_draw_region_marks(s, input->surface, &fit);
    } else if (input->view == RLF_VIEW_VELOCITY) {
        soft_draw_velocity_marks(s, input->surface, &fit);
    }
}
