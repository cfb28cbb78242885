/* Inside the CPU renderer: the values its files share.
 *
 *   picture = background (colour, or depth in grey)
 *           + shadows of the bodies on it
 *           + bodies: unit meshes -> screen triangles -> what each of four samples per pixel sees
 *           - where the real depth is nearer
 *
 * The picture is drawn in bands of rows that know nothing of each other, so any number of workers
 * gives the same bits. */
#ifndef RLF_RENDER_SOFT_H
#define RLF_RENDER_SOFT_H

#include "render/body_texture.h"
#include "render/real_depth.h"
#include "render/shape_mesh.h"
#include "render/silhouette.h"

#define SOFT_SAMPLES 4    /* per pixel, against jagged edges */
#define SOFT_BAND_ROWS 16 /* rows that one worker draws at a time */
#define SOFT_NEAR_Z 0.02  /* metres: nothing nearer is drawn */

/* ---- scene: what is in the picture, as triangles of screen space --------------------------- */

enum { SOFT_S = 0, SOFT_T = 1, SOFT_LIGHT = 2, SOFT_ATTRIBUTES = 3 };

/* Corner of a triangle in the picture camera's frame, metres. */
typedef struct soft_corner {
    rlf_vec3 p;
    float attribute[SOFT_ATTRIBUTES];
} soft_corner;

/* at0 + dx (x - x0) + dy (y - y0), (x0, y0) being the triangle's first corner. */
typedef struct soft_plane {
    float at0, dx, dy;
} soft_plane;

typedef struct soft_triangle {
    double x[3], y[3]; /* pixels, sorted by y, then x */
    double slope[3];   /* dx / dy of the edges 0-1, 1-2, 0-2 */
    soft_plane inverse_z;
    float inverse_z_min, inverse_z_max;
    soft_plane attribute[SOFT_ATTRIBUTES]; /* divided by z: linear in the picture */
    int32_t y_begin, y_end;                /* rows it may touch */
    int32_t body;                          /* into soft_scene.bodies */
} soft_triangle;

typedef struct soft_body {
    int32_t first, end;     /* triangles */
    int32_t x0, y0, x1, y1; /* pixels it may touch: x0 <= x < x1, y0 <= y < y1 */
    float color[3];         /* times 255 */
    const uint8_t *texture; /* level to sample, RGBA8 */
    int32_t texture_size;   /* pixels, a power of two */
    rlf_vec3 center;        /* picture camera frame, metres */
    double radius;          /* of the bounding sphere, metres */
    int32_t index;          /* in the snapshot */
} soft_body;

typedef struct soft_scene {
    soft_triangle *triangles; /* entry 0 is not used: sample value 0 means nothing */
    int32_t triangle_count, triangle_capacity;
    soft_body *bodies; /* those in the picture, nearest first */
    int32_t body_count, body_capacity;
} soft_scene;

/* ---- the renderer --------------------------------------------------------------------------- */

/* One worker's samples, [row][sample][x]. */
typedef struct soft_band {
    float *inverse_z;  /* 0 = nothing */
    int32_t *triangle; /* 0 = nothing */
    float *layer;      /* RLF_OCCLUSION_THESIS: bodies so far, [row][x], premultiplied RGBA */
} soft_band;

typedef struct soft {
    rlf_compositor_def def;
    rlf_camera camera;        /* of the picture */
    rlf_pose T_picture_depth; /* identity without a colour camera */
    rlf_image_rgba8 image;
    rlf_plane_u8 matte;
    real_depth real;
    silhouette silhouette; /* RLF_OCCLUSION_SOFT only */

    shape_mesh_set meshes;
    uint8_t textures[BODY_TEXTURE_KINDS][BODY_TEXTURE_BYTES];
    soft_scene scene;
    soft_corner *corners; /* work memory: one mesh's vertices */
    soft_band *bands;     /* one per worker */
    int32_t band_count;

    int32_t *column_left; /* bilinear resize, per x: left column, weight of the next one (0..256) */
    int32_t *column_weight;
    rlf_image_rgba8 grid_image; /* views are drawn here, then enlarged into the picture */
} soft;

/* background.c: the colour picture, or registered depth in grey; real depth must be up to date for
 * the latter. */
void soft_draw_background(soft *s, const rlf_render_input *input);

/* scene.c: all bodies in the picture as triangles. */
rlf_result soft_scene_build(soft *s, const rlf_render_input *input);

/* triangle.c: clips at the near plane, drops what faces away or lies outside, and adds the rest. */
rlf_result soft_scene_reserve(soft_scene *scene, int32_t triangle_count);
void soft_scene_add_triangle(soft *s, const soft_corner corners[3], int32_t body);

/* raster.c: lets triangle `id` win the samples of row y where it is nearest so far. `samples` is
 * the row's part of a band. */
typedef struct soft_row {
    float *inverse_z;
    int32_t *triangle;
    int32_t y, width;
} soft_row;
void soft_raster_row(const soft_triangle *triangle, int32_t id, const soft_row *row);

/* shade.c: colour (0..255) and z of a triangle at a pixel centre. */
typedef struct soft_fragment {
    float color[3], z;
} soft_fragment;
soft_fragment soft_shade(const soft_scene *scene, const soft_triangle *triangle, float x, float y);

/* bodies.c: draws the scene over the image and writes the matte. */
void soft_draw_bodies(soft *s);

/* shadow.c: darkens the real surfaces of rows [begin, end) that the bodies keep the light from. */
void soft_draw_shadows(const soft *s, int32_t begin, int32_t end);

/* ---- drawing tools -------------------------------------------------------------------------- */

typedef struct soft_color {
    uint8_t r, g, b;
} soft_color;

static inline soft_color soft_rgb(int32_t r, int32_t g, int32_t b)
{
    soft_color c = {(uint8_t)r, (uint8_t)g, (uint8_t)b};
    return c;
}
static inline void soft_put(uint8_t *pixel, soft_color c)
{
    pixel[0] = c.r;
    pixel[1] = c.g;
    pixel[2] = c.b;
    pixel[3] = 255;
}
/* Blends c over the pixel; alpha 0..256. */
static inline void soft_blend(uint8_t *pixel, soft_color c, int32_t alpha)
{
    pixel[0] = (uint8_t)(pixel[0] + (c.r - pixel[0]) * alpha / 256);
    pixel[1] = (uint8_t)(pixel[1] + (c.g - pixel[1]) * alpha / 256);
    pixel[2] = (uint8_t)(pixel[2] + (c.b - pixel[2]) * alpha / 256);
}

/* palette.c */
soft_color soft_color_near_far(double t); /* 0 near, bright and warm .. 1 far, dark and cold */
soft_color soft_color_hue(double turn, double value); /* turn 0..1 round the wheel, value 0..1 */
soft_color soft_color_label(int32_t label);           /* neighbours differ; 0 is black */

/* draw.c: all clipped to the image. Points are pixels; rectangles x0 <= x < x1, y0 <= y < y1. */
typedef struct soft_point {
    double x, y;
} soft_point;
typedef struct soft_rect {
    int32_t x0, y0, x1, y1;
} soft_rect;
void soft_draw_line(const rlf_image_rgba8 *image, soft_point from, soft_point to, soft_color color);
void soft_fill_rect(const rlf_image_rgba8 *image, soft_rect rect, soft_color color, int32_t alpha);

/* text.c: letters of 5 x 7 dots, `scale` pixels a dot. */
typedef struct soft_text {
    int32_t x, y; /* top left, pixels */
    int32_t scale;
    soft_color color;
    bool has_backing; /* a dark translucent strip behind it */
} soft_text;
int32_t soft_text_scale(int32_t picture_height);
int32_t soft_text_width(const char *line, int32_t scale);
void soft_draw_text(const rlf_image_rgba8 *image, const soft_text *style, const char *line);
void soft_draw_overlay(soft *s, const rlf_render_input *input);
extern const uint8_t soft_font[95][7]; /* font.c: ' ' to '~', rows from the top, bit 4 is left */

/* views.c: everything but camera and mesh, in the grid's own image. */
void soft_draw_view(soft *s, const rlf_render_input *input);
/* view_marks.c: boxes, labels, arrows and legends over an enlarged grid image. */
typedef struct soft_fit {
    double scale;   /* picture pixels per grid pixel */
    int32_t x0, y0; /* of the grid image in the picture */
    int32_t width, height;
} soft_fit;
void soft_draw_region_marks(soft *s, const rlf_surface *surface, const soft_fit *fit);
void soft_draw_velocity_marks(soft *s, const rlf_surface *surface, const soft_fit *fit);
void soft_draw_reason_legend(soft *s);
soft_color soft_color_reason(rlf_reason reason);
/* view_mesh.c */
void soft_draw_mesh(soft *s, const rlf_surface *surface);

#endif
