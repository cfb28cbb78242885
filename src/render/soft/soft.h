/* Inside the CPU renderer: the values its files share. passes.h, views.h and draw.h
 * say what its files do for each other.
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

#include "kernel/kernel.h"
#include "relief/model.h"
#include "render/body_texture.h"
#include "render/caster.h"
#include "render/finish.h"
#include "render/probe.h"
#include "environment/light.h"
#include "render/real_shade.h"
#include "environment/real_depth.h"
#include "render/shape_mesh.h"
#include "environment/edge_matte.h"

#define SOFT_SAMPLES 4    /* per pixel, against jagged edges */
#define SOFT_BAND_ROWS 16 /* rows that one worker draws at a time */
#define SOFT_NEAR_Z 0.02  /* metres: nothing nearer is drawn */
#define SOFT_COARSE_PX 20 /* radius: 16 corners are off by less than 0.4 pixels */

/* ---- scene: what is in the picture, as faces of screen space -------------------------------- */

enum { SOFT_S = 0, SOFT_T = 1, SOFT_NORMAL = 2, SOFT_ATTRIBUTES = 5 };

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
    const rlf_model_texture *texture;           /* NULL = none; so are */
    const rlf_model_texture *surface, *normals; /* as rlf_model_part has them */
    float color[3];                             /* of the part and the body, linear */
    probe_material material;
    float low[2], high[2];  /* texture coordinates of the face */
    float across[3], up[3]; /* on it, picture camera frame: where red and green of normals go */
} soft_skin;

typedef struct soft_body {
    int32_t first, end; /* faces */
    int32_t y0, y1;     /* rows it may touch: y0 <= y < y1 */
    float color[3];     /* linear */
    probe_material material;
    const light_probe *probe;
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
/* Light is taken at nodes 4 or 8 pixels apart (soft.shade_px): of a row so many, or half. */
#define ROW_NODES SOFT_LANES
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

/* `count` pixels of row y from x on. */
typedef struct soft_lanes_at {
    int32_t x, y, count;
} soft_lanes_at;

/* A grid image, enlarged into the picture. */
typedef struct soft_fit {
    double scale;   /* picture pixels per grid pixel */
    int32_t x0, y0; /* of the grid image in the picture */
    int32_t width, height;
} soft_fit;

#define SOFT_SHADE_WIDTH 32 /* pixels of a tile; it is as high as a band */
#define SOFT_SHADE_SAMPLES (SOFT_SHADE_WIDTH * SOFT_BAND_ROWS)

/* A tile of the real world while bodies take light from it. */
typedef struct soft_shade_tile {
    float x[SOFT_SHADE_SAMPLES], y[SOFT_SHADE_SAMPLES], z[SOFT_SHADE_SAMPLES]; /* caster_points */
    float light[SOFT_SHADE_SAMPLES]; /* share that is left */
    /* Where the matte of an edge is, that was of what is farther, and this is what is nearer. */
    float near_z[SOFT_SHADE_SAMPLES], near_light[SOFT_SHADE_SAMPLES];
    int32_t step;                 /* pixels from one sample to the next */
    int32_t columns, rows, count; /* of samples; count: in whole lanes */
    bool has_depth, has_edge, is_known, is_shaded;
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
    probe_set *probes;
    finish *finish;
    int32_t shade_px; /* pixels from one sample of shadows to the next where depth is smooth */
    float ray_x0, ray_step_x; /* x / z of pixel column i, without the lens: ray_x0 + i ray_step_x */
    float ray_y0, ray_step_y;

    rlf_image_rgba8 background; /* borrowed for a picture */
    bool is_bare;               /* nothing is behind the bodies of this picture */
    int32_t *column_left; /* bilinear resize, per x: left column, weight of the next one (0..256) */
    int32_t *column_weight;
    rlf_image_rgba8 grid_image; /* views are drawn here, then enlarged into the picture */
} soft;

#endif
