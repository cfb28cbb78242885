/* Inside the CPU renderer: the values its files share.
 *
 *   picture = background (colour, or depth in grey)
 *           + shadows of the bodies on it
 *           + bodies: unit meshes -> screen faces -> what each of four samples per pixel sees
 *           - where the real depth is nearer
 *
 * The picture is drawn in bands of rows that know nothing of each other, so any number of workers
 * gives the same bits. */
#ifndef RLF_RENDER_SOFT_H
#define RLF_RENDER_SOFT_H

#include "base/inside.h"
#include "kernel/kernel.h"
#include "relief/model.h"
#include "render/body_texture.h"
#include "render/caster.h"
#include "environment/light_direction.h"
#include "render/obscurance.h"
#include "environment/room_light.h"
#include "environment/real_depth.h"
#include "render/real_shade.h"
#include "render/shape_mesh.h"
#include "environment/edge_matte.h"

#define SOFT_SAMPLES 4    /* per pixel, against jagged edges */
#define SOFT_BAND_ROWS 16 /* rows that one worker draws at a time */
#define SOFT_NEAR_Z 0.02  /* metres: nothing nearer is drawn */
#define SOFT_COARSE_PX 20 /* radius: 16 corners are off by less than 0.4 pixels */

/* ---- scene: what is in the picture, as faces of screen space -------------------------------- */

enum { SOFT_S = 0, SOFT_T = 1, SOFT_LIGHT = 2, SOFT_ATTRIBUTES = 3 };

/* Corner of a face in the picture camera's frame, metres. */
typedef struct soft_corner {
    rlf_vec3 p;
    float attribute[SOFT_ATTRIBUTES];
} soft_corner;

/* at0 + dx (x - x0) + dy (y - y0), (x0, y0) being the face's origin. */
typedef struct soft_plane {
    float at0, dx, dy;
} soft_plane;

enum { SOFT_CORNERS = 4 };

/* From its upper end (x, y) down to y = end; slope = dx / dy. A level or missing one has end = y.
 */
typedef struct soft_edge {
    double x, y, end, slope;
} soft_edge;

/* What real surfaces near its body take from a face: nothing, or by these normals. */
typedef enum soft_nearness { FACE_FAR, FACE_FLAT, FACE_ROUND } soft_nearness;

/* A convex face with three or four corners in one plane. */
typedef struct soft_face {
    soft_edge edge[SOFT_CORNERS];
    float origin_x, origin_y;
    soft_plane inverse_z;
    float inverse_z_min, inverse_z_max;
    soft_plane attribute[SOFT_ATTRIBUTES]; /* divided by z: linear in the picture */
    int32_t y_begin, y_end;                /* rows it may touch */
    int32_t body;                          /* into soft_scene.bodies */
    int32_t skin;                          /* into soft_scene.skins; 0 = as the body */
    bool is_lit;                           /* by more than the light around */
    soft_nearness nearness;                /* of bodies near real surfaces that are not round */
    float normal[3];                       /* alike; unit, picture camera frame */
} soft_face;

/* What a model's face takes its colours from. */
typedef struct soft_skin {
    const rlf_model_texture *texture; /* NULL = none */
    float color[3];                   /* of the part and the body, times 255 */
    float low[2], high[2];            /* texture coordinates of the face */
} soft_skin;

typedef struct soft_body {
    int32_t first, end;      /* faces */
    int32_t y0, y1;          /* rows it may touch: y0 <= y < y1 */
    float color[3];          /* times 255 */
    const uint32_t *texture; /* level to sample; a texel's bytes are itself, the next in the row,
                                and the two below them, the first being the lowest */
    int32_t texture_size;    /* pixels, a power of two */
    rlf_vec3 center;         /* picture camera frame, metres */
    double radius;           /* of the bounding sphere, metres */
    int32_t index;           /* in the snapshot */
    int32_t shaders[CASTER_BODIES]; /* casters that may take light from it */
    int32_t shader_count;
    const real_shade *real_shade; /* NULL = real things take no light from it */
    const obscurance *obscurance; /* NULL = no real surface is near it */
    bool is_round;                /* all of its faces; else they say */
    float per_round;              /* of round faces: one over the radius, */
    float core;                   /* and half the line that they are about */
} soft_body;

typedef struct soft_scene {
    soft_face *faces; /* entry 0 is not used: sample value 0 means nothing */
    int32_t face_count, face_capacity;
    soft_body *bodies; /* those in the picture, nearest first */
    int32_t body_count;
    caster *casters; /* as the snapshot's bodies; none without shadows */
    pixel_rect *reach;
    int32_t caster_count;
    soft_skin *skins; /* entry 0 is not used */
    int32_t skin_count, skin_capacity;
    real_shade *real_shades; /* as bodies */
    obscurance *obscurances; /* as bodies */
    int32_t body_capacity;   /* of the five */
} soft_scene;

/* ---- the renderer --------------------------------------------------------------------------- */

#define SOFT_LANES 16 /* pixels worked on at once; rows have room for so many beyond their end */
enum { SOFT_COVERED = 4, SOFT_SUMS = 5 };

#define SOFT_GROUP_ROWS 4 /* rows whose ends of a face are found at once */
#define SOFT_GROUP_LINES (SOFT_GROUP_ROWS * SOFT_SAMPLES)

/* Pixels begin <= x < end of a face on each line of samples of a group of rows: line
 * SOFT_SAMPLES * row + sample. */
typedef struct soft_ends {
    int32_t face;
    int32_t x0, x1; /* of all lines */
    bool is_alone;  /* no other face is near any of its pixels: it wins all of its samples */
    int32_t begin[SOFT_GROUP_LINES], end[SOFT_GROUP_LINES];
} soft_ends;

#define SOFT_CROWD_PX 4 /* bodies within so many columns may be before each other */

/* Depths that what may hide a body has in a tile. */
typedef struct soft_depth_range {
    float near_z, far_z;
} soft_depth_range;

/* What may hide a body in a row: the registered depth, and above and below it, or (all NULL)
 * nothing; with soft occlusion near_z, far_z and cover in the tiles that are marked. */
typedef struct soft_real_row {
    const float *near_z, *far_z;
    const uint8_t *cover, *marks;  /* of edge_matte; marks NULL = hard occlusion */
    const soft_depth_range *tiles; /* of edge_matte's tiles */
    rlf_kernel_noise noise;
    const float *row, *above, *below;
    int32_t width;
} soft_real_row;

#define SOFT_PART 16 /* pixels that are put into the picture and cleared together */

/* How faces touch a part of a row: one that is alone leaves its samples as they are. */
typedef enum soft_touch { SOFT_UNTOUCHED, SOFT_TOUCHED_ALONE, SOFT_TOUCHED } soft_touch;

/* Pixels x0 <= x < x1 of a row; none when x0 >= x1. */
typedef struct soft_span {
    int32_t x0, x1;
} soft_span;

/* A row that is being drawn: all zero between pictures. */
typedef struct soft_row {
    int32_t y;
    soft_real_row real;
    float *inverse_z;      /* [sample][x]; 0 = nothing */
    int32_t *face;         /* [sample][x]; 0 = nothing */
    float *sum[SOFT_SUMS]; /* red, green, blue (0..255, times shown), shown, and
                              with RLF_OCCLUSION_THESIS covered */
    float *layer[4];       /* RLF_OCCLUSION_THESIS: bodies so far, as the sums */
    uint8_t *touched;      /* soft_touch of every SOFT_PART pixels */
    int32_t part_count;    /* of those */
} soft_row;

/* One worker's group of rows. */
typedef struct soft_group {
    soft_row rows[SOFT_GROUP_ROWS];
    int32_t row_count, width;
    ptrdiff_t stride;        /* from one line of samples to the next */
    int32_t *list;           /* faces of a band */
    soft_depth_range *tiles; /* of a band, with soft occlusion */
    soft_ends *ends;         /* of those in the group */
    uint8_t *crowd;          /* work memory: bodies in each SOFT_CROWD_PX columns of a group */
} soft_group;

#define SOFT_SHADE_WIDTH 32 /* pixels of a tile; it is as high as a band */
#define SOFT_SHADE_SAMPLES ((SOFT_SHADE_WIDTH / CASTER_BLOCK) * (SOFT_BAND_ROWS / CASTER_BLOCK))

/* A tile of the real world while bodies take light from it. */
typedef struct soft_shade_tile {
    float x[SOFT_SHADE_SAMPLES], y[SOFT_SHADE_SAMPLES], z[SOFT_SHADE_SAMPLES]; /* caster_points */
    float light[SOFT_SHADE_SAMPLES]; /* share that is left */
    int32_t step;                    /* pixels from one sample to the next */
    int32_t columns, rows, count;    /* of samples; count: in whole lanes */
    bool has_depth, is_known, is_shaded;
} soft_shade_tile;

typedef struct soft {
    rlf_compositor_def def;
    rlf_camera camera;        /* of the picture */
    rlf_pose T_picture_depth; /* identity without a colour camera */
    rlf_image_rgba8 image;
    rlf_plane_u8 matte;
    real_depth real;
    edge_matte edges; /* RLF_OCCLUSION_SOFT only */

    shape_mesh_set meshes;
    shape_mesh_set coarse_meshes; /* for bodies below SOFT_COARSE_PX */
    uint32_t textures[BODY_TEXTURE_KINDS][BODY_TEXTURE_BYTES / 4];
    soft_scene scene;
    soft_corner *corners; /* work memory: one mesh's vertices */
    int32_t corner_capacity;
    soft_group *workers;
    soft_shade_tile **shade_tiles; /* a band's, per worker */
    int32_t worker_count;
    room_light lamp;
    light_direction direction;
    rlf_vec3 to_light; /* unit, picture camera frame */
    int32_t shade_px;  /* pixels from one sample of shadows to the next where depth is smooth */
    float ray_x0, ray_step_x; /* x / z of pixel column i, without the lens: ray_x0 + i ray_step_x */
    float ray_y0, ray_step_y;

    rlf_image_rgba8 background; /* borrowed for a picture */
    int32_t *column_left; /* bilinear resize, per x: left column, weight of the next one (0..256) */
    int32_t *column_weight;
    rlf_image_rgba8 grid_image; /* views are drawn here, then enlarged into the picture */
} soft;

/* soft.c: what the picture is seen from. */
void soft_set_viewpoint(soft *s, const rlf_camera *camera, const rlf_pose *T_picture_depth);

/* needed.c: what is looked at of the registered depth. Scene and edge_matte's bodies must be in
 * place. */
real_windows soft_needed_depth(const soft *s, const rlf_render_input *input);

/* background.c: the colour picture, or, when it has no data, registered depth in grey. */
void soft_set_background(soft *s, const rlf_image_rgba8 *color);
/* Rows [begin, end) of it; the matte there becomes 0. Real depth must be up to date if it is grey.
 */
void soft_draw_background(const soft *s, int32_t begin, int32_t end);

/* scene.c: all bodies in the picture as faces; then, with what is real read, what takes light from
 * them. */
rlf_result soft_scene_build(soft *s, const rlf_render_input *input);
void soft_scene_light(soft *s, const rlf_render_input *input);

/* obscure.c: which real surfaces the bodies of the scene are near. */
void soft_place_obscurances(soft *s, const rlf_render_input *input);

/* face.c: room for so many faces, here and with every worker. */
rlf_result soft_scene_reserve(soft *s, int32_t face_count);
/* Clips at the near plane, drops what faces away or lies outside, and adds the rest; 3 or 4 corners
 * in one plane. */
void soft_scene_add_face(soft *s, const soft_corner *corners, int32_t corner_count, int32_t body);

/* scene_model.c: the faces of a body that is drawn as a model; its colour is that of the body. */
rlf_result soft_scene_add_model(soft *s, const rlf_look *look, const rlf_pose *T_picture_body,
                                int32_t body);

/* crowd.c: which of the group's first `count` faces are alone. */
void soft_find_alone(const soft_scene *scene, int32_t count, soft_group *group);

/* raster.c: where the face begins and ends in the group's rows; false when it touches no sample. */
bool soft_find_ends(const soft_face *face, const soft_group *group, soft_ends *out);
/* Lets the face win the samples of the group's rows where it is nearest so far, unless it is alone;
 * marks the parts of rows that it touches. */
void soft_raster_face(const soft_face *face, const soft_ends *ends, soft_group *group);

/* shade.c: adds what the samples see of the faces to the sums of the group's rows. */
void soft_shade_faces(const soft *s, const soft_ends *ends, int32_t count, const soft_group *group);
/* skin.c: shares of red, green and blue that the skin's texture shows in SOFT_LANES pixels of row y
 * from x on, of which `count` count; z are their depths. */
typedef struct soft_lanes_at {
    int32_t x, y, count;
} soft_lanes_at;
void soft_skin_colors(const soft_skin *skin, const soft_face *face, soft_lanes_at at,
                      const float *z, float rgb[3][SOFT_LANES]);
/* compose.c: puts sums (red, green, blue, shown; whole lanes) over `count` pixels. */
void soft_compose_row(float *const sum[4], int32_t count, uint8_t *restrict pixels,
                      uint8_t *restrict matte);

/* The lowest byte of a pixel is red, whatever the machine's order. */
RLF_KERNEL_PART void soft_load_pixels(const uint8_t *bytes, int32_t count, uint32_t *out)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(out, bytes, 4 * (size_t)count);
#else
    for (int32_t i = 0; i < count; i++) {
        const uint8_t *p = bytes + 4 * (ptrdiff_t)i;
        out[i] = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    }
#endif
}

RLF_KERNEL_PART void soft_store_pixels(const uint32_t *pixels, int32_t count, uint8_t *out)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(out, pixels, 4 * (size_t)count);
#else
    for (int32_t i = 0; i < 4 * count; i++) {
        out[i] = (uint8_t)(pixels[i / 4] >> 8 * (i % 4));
    }
#endif
}

/* bodies.c: draws the scene over the image and writes the matte; with_background: first the
 * background, in the same go through memory. */
void soft_draw_bodies(soft *s, bool with_background);

/* shadow.c: darkens the real surfaces of rows [begin, end) that the bodies keep the light from. */
void soft_draw_shadows(const soft *s, soft_shade_tile *tiles, int32_t begin, int32_t end);

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
soft_color soft_color_near_far(double t)
    RLF_INSIDE(soft_color_near_far); /* 0 near, bright and warm .. 1 far, dark and cold */
soft_color soft_color_hue(double turn, double value); /* turn 0..1 round the wheel, value 0..1 */
soft_color soft_color_label(int32_t label);           /* neighbours differ; 0 is black */

/* draw.c: all clipped to the image. Points are pixels; rectangles x0 <= x < x1, y0 <= y < y1. */
typedef struct soft_point {
    double x, y;
} soft_point;
void soft_draw_line(const rlf_image_rgba8 *image, soft_point from, soft_point to, soft_color color);
void soft_fill_rect(const rlf_image_rgba8 *image, pixel_rect rect, soft_color color, int32_t alpha);

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
/* Lines and plot of an input; shared with the GL renderer. */
void soft_draw_overlay(const rlf_image_rgba8 *image, const rlf_render_input *input)
    RLF_INSIDE(soft_draw_overlay);
/* plot.c: at the bottom left. */
void soft_draw_plot(const rlf_image_rgba8 *image, const rlf_plot *plot);
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
void soft_draw_arrow(const rlf_image_rgba8 *image, soft_point from, soft_point to,
                     soft_color color);
/* Whether a view shows the camera's colours at the surface's pixels: s->real is read then. */
bool soft_view_has_colors(const rlf_render_input *input);
/* Colour of the camera's picture where grid point i lies at depth z; grey depth without one, and
 * where something nearer hides it from the colour camera. s->real must be read. */
soft_color soft_grid_color(const soft *s, const rlf_render_input *input, int32_t i, float z);
/* view_points.c */
rlf_result soft_draw_points(soft *s, const rlf_render_input *input);
/* view_contacts.c: over the camera's picture. */
void soft_draw_contacts(soft *s, const rlf_render_input *input);
/* view_known.c: alike. */
void soft_draw_known(soft *s, const rlf_render_input *input);
/* view_mesh.c */
void soft_draw_mesh(soft *s, const rlf_surface *surface);

#endif
