/* Relief: the render stage. Puts the bodies into the camera's picture, behind what is in front of
 * them. SPDX-License-Identifier: MIT */
#ifndef RELIEF_COMPOSITOR_H
#define RELIEF_COMPOSITOR_H

#include "relief/prediction.h"
#include "relief/snapshot.h"
#include "relief/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the picture shows. */
typedef enum rlf_view {
    RLF_VIEW_CAMERA = 0,     /* colour with the bodies composited: the main view */
    RLF_VIEW_DEPTH = 1,      /* depth, near warm to far cold */
    RLF_VIEW_NORMALS = 2,    /* rgb = (n_x, -n_y, -n_z) / 2 + 1/2 */
    RLF_VIEW_MESH = 3,       /* wireframe of the triangle mesh over the colour image (fig. 4.5) */
    RLF_VIEW_REGIONS = 4,    /* one colour per region, with boxes (fig. 4.18) */
    RLF_VIEW_FOREGROUND = 5, /* what moves or was not there at the start */
    RLF_VIEW_BACKGROUND = 6, /* the background model's depth */
    RLF_VIEW_VELOCITY = 7,   /* of the surface */
    RLF_VIEW_THICKNESS = 8,  /* of the solid behind it */
    RLF_VIEW_REASON = 9,     /* reason codes, one colour each */
    RLF_VIEW_POINTS = 10, /* the surface's points, in colour, and the bodies from anywhere: orbit */
    RLF_VIEW_CONTACTS = 11, /* camera, with an arrow along each contact's normal, longer the larger
                               its impulse */
    RLF_VIEW_KNOWN = 12,    /* camera, with the models of real things as wireframes */
    RLF_VIEW_HANDS = 13,    /* camera, with the marks of the input: palms, finger tips, gestures */
    RLF_VIEW_MAP = 14,    /* the fused room and the bodies from anywhere: orbit; the camera's way */
    RLF_VIEW_BODIES = 15, /* the bodies of the camera's view alone, over black: colours
                             premultiplied by the picture's own alpha, which is the matte; nothing
                             is opaque where there is no body */
    RLF_VIEW_COUNT = 16
} rlf_view;

/* Name as in `--view`, e.g. "normals"; NULL outside the range. */
RLF_API const char *rlf_view_name(rlf_view view);
/* View of a name as in `--view`. False, and *out as it was, when no view has that name. */
RLF_API bool rlf_view_parse(const char *name, rlf_view *out);

/* One row of a legend: a colour of the view and what it means, with its unit. Of a scale the rows
 * are single values; colours between two of them mean what is between. */
typedef struct rlf_legend_row {
    uint8_t r, g, b; /* sRGB, as in the picture */
    char text[44];   /* ASCII, e.g. "1.50 m" */
} rlf_legend_row;

/* What the colours of a view mean, to be drawn by rlf_legend_draw or in a window of one's own. A
 * value: it borrows nothing that can go away. */
#define RLF_LEGEND_ROWS 9
/* What the colours or symbols of a view mean. */
typedef struct rlf_legend {
    const char *title; /* what is shown and in which unit, e.g. "depth, m"; lives for ever */
    rlf_legend_row rows[RLF_LEGEND_ROWS]; /* from the top down */
    int32_t row_count;                    /* 0 to RLF_LEGEND_ROWS; 0: the view explains itself */
} rlf_legend;

/* Legend of a view of a rig, whose range [depth_min_m, depth_max_m] is the scale of depths; title
 * NULL for what is no view. Thread-safety: any. */
RLF_API rlf_legend rlf_view_legend(rlf_view view, const rlf_rig *rig);
/* Draws a legend into the lower left corner of a picture, in letters of 7 pixels for every 300 of
 * its height. What has no room is cut. Allocates nothing. Thread-safety: one call at a time a
 * picture. */
RLF_API void rlf_legend_draw(const rlf_legend *legend, const rlf_image_rgba8 *image);

/* Where RLF_VIEW_POINTS is seen from: the camera turned about a point in front of it, in the middle
 * of the sensor's range. All zero = from where the camera is. RLF_VIEW_MAP turns alike, about the
 * room's middle. */
typedef struct rlf_orbit {
    double yaw;   /* radians; > 0: from further right */
    double pitch; /* radians, within +-1.5; > 0: from further up */
    double zoom;  /* distance to that point over the camera's, 0.1 to 10; 0 = 1 */
} rlf_orbit;

/* The static room as RLF_VIEW_MAP shows it. All is borrowed for one call. */
typedef struct rlf_room_sight {
    /* From where the picture is seen, e.g. by rlf_map_predict. Of any size; its camera, resized,
     * is the picture's. */
    const rlf_prediction *prediction;
    /* Colours (R, G, B, A; A = 0: none) of its pixels; NULL = none. Where there is none the normal
     * gives a grey. */
    const uint8_t *rgba;
    const rlf_vec3 *path; /* where the camera has been, world, metres */
    int32_t path_count;   /* 0 = no path */
} rlf_room_sight;

/* Writes a line of text in warm white, letters of 5 x 7 dots, from (x, y), the top left corner;
 * `scale` >= 1 pixels a dot. Its dots become opaque, all else stays. What is outside the image is
 * left out, and what is not ASCII is '?'. Returns the width in pixels, also for an image without
 * data, which measures. Thread-safety: safe on different images. */
RLF_API int32_t rlf_draw_text(const rlf_image_rgba8 *image, int32_t x, int32_t y, int32_t scale,
                              const char *line);

/* A small plot under the overlay's lines: for each frame a stacked bar. */
typedef struct rlf_plot {
    const char *const *names;    /* series_count of them */
    const float *values;         /* [count][series_count], the oldest first */
    int32_t series_count, count; /* bars of a frame, and frames */
    float line;                  /* a value to mark, > 0; the plot ends at twice as much */
} rlf_plot;

/* A line over the picture, or a text. What it stands for is the caller's business: the compositor
 * knows no hands. Nothing hides a mark; what is behind the camera or far outside the picture is
 * left out. Marks are borrowed for one call, and there may be any number of them. */
typedef struct rlf_mark {
    /* Ends of the line in the depth camera's frame, metres. They must be finite. */
    rlf_vec3 from, to;
    /* Red, green, blue, 0..255. */
    uint8_t color[3];
    /* NULL = the line; else this one line of text instead of it, beside `from`. */
    const char *text;
} rlf_mark;

/* How the picture decides which pixels of a body real things hide. Sources: the thesis, section
 * 4.2.2 for the layers; docs/guide.md tells how the others do it. */
typedef enum rlf_occlusion {
    RLF_OCCLUSION_DEPTH = 0, /* hard: every pixel's depth against the registered real depth */
    RLF_OCCLUSION_THESIS =
        1,                 /* 4.2.2: one layer per body, stencil-limited, blended back to front */
    RLF_OCCLUSION_OFF = 2, /* plain augmented reality (fig. 4.9) */
    RLF_OCCLUSION_SOFT = 3 /* as DEPTH; at silhouettes of real things the share of the near side
                              comes from the colour image and is steady over time, and a body fades
                              over +-2 sigma(z) of the sensor where it meets a surface */
} rlf_occlusion;

/* What a renderer is made for. From rlf_compositor_def_default or, with rig, grid, rays and size
 * filled in, rlf_pipeline_get_compositor_def; then change what shall differ. */
typedef struct rlf_compositor_def {
    uint32_t cookie; /* set by rlf_compositor_def_default */
    rlf_rig rig;     /* the source's; must be set. Without colour the depth camera is used */
    rlf_camera grid; /* the surface's camera */
    const float *ray_x, *ray_y; /* the surface's rays; borrowed for the compositor's life */
    int32_t width, height;      /* of the picture; 0 = the colour camera's (or depth camera's) */
    rlf_occlusion occlusion;    /* default DEPTH */
    rlf_vec3 light_direction;   /* from the light into the scene, camera frame; unit. default
                                   (0.3, 0.8, 0.5) normalised */
    float light_color[3];       /* sRGB of a white body in full light, 0..1; default 1 */
    bool estimates_light;       /* bodies get darker and tinted as the camera's picture is, over
                                   about a second; default false */
    bool estimates_light_direction; /* by the shading of what is seen; where that does not tell, it
                                       is light_direction; default false */
    bool enable_real_shade;         /* with occlusion DEPTH and SOFT real things keep the light from
                                       bodies, too; default true */
    bool enable_real_ambient;       /* with the same, bodies have the light of their place: what the
                                       picture shows shines on them, and real surfaces close to a
                                       body darken it where it faces them; default true */
    bool enable_overlay;            /* text lines over the picture; default false */
    rlf_pool *pool;                 /* borrowed; NULL = one thread */
} rlf_compositor_def;

/* All fields at the defaults that they name. `rig`, `grid` and the rays are still to be set. */
RLF_API rlf_compositor_def rlf_compositor_def_default(void);

/* Where RLF_VIEW_MAP is seen from: behind and somewhat above a `box` about the room and the
 * camera's way, as `T_world_base` looks, usually the first camera; far enough to see all, and
 * turned by the orbit about the box's middle. out_camera is the picture's without its lens, no
 * larger than the depth camera, as rlf_map_predict takes it. Thread-safety: any. */
RLF_API void rlf_room_look(const rlf_compositor_def *def, const rlf_aabb *box,
                           const rlf_pose *T_world_base, const rlf_orbit *orbit,
                           rlf_camera *out_camera, rlf_pose *out_T_world_view);

/* Everything one picture is made of; all borrowed for the call. */
typedef struct rlf_render_input {
    const rlf_frame *frame;       /* required; its colour may be missing: depth is shown in grey */
    const rlf_surface *surface;   /* required */
    const rlf_snapshot *snapshot; /* NULL = no bodies */
    rlf_pose T_world_camera;      /* depth camera in the world */
    rlf_view view;                /* what the picture shows */
    rlf_orbit orbit;              /* of RLF_VIEW_POINTS */
    const rlf_room_sight *room;   /* of RLF_VIEW_MAP; NULL = there is no map, and a line says so */
    const char *const *overlay;   /* text lines, top left; used with enable_overlay */
    int32_t overlay_count;        /* 0 = none */
    const rlf_plot *plot;         /* bottom left; used with enable_overlay; NULL = none */
    const rlf_mark *marks;        /* over RLF_VIEW_HANDS, in this order */
    int32_t mark_count;           /* 0 = none */
} rlf_render_input;

/* One picture. All is the compositor's and stays valid until its next render or its end. */
typedef struct rlf_render_output {
    rlf_image_rgba8
        image;          /* the composite (or the view); the compositor's, valid until next render */
    rlf_plane_u8 matte; /* alpha of everything virtual after occlusion, 0..255; same size */
    rlf_vec3 light_direction; /* that the bodies are lit from: unit, into the scene, camera frame */
    bool is_light_estimated;  /* by the picture; else light_direction of the def */
} rlf_render_output;

/* A renderer with its buffers: what it learnt of light and silhouettes goes on from picture to
 * picture, so one compositor belongs to one sequence of frames. */
typedef struct rlf_compositor rlf_compositor;

/* Methods of a renderer; used by librelief_gl and by anyone's own. `self` is the context given at
 * creation. `render` returns RLF_OK or an error with its line set (rlf_fail), and allocates nothing
 * once it runs; RLF_ERROR_DEVICE makes a pipeline go on with the soft renderer. `destroy` frees the
 * context, NULL = nothing to free; `name` lives as long as the compositor. */
typedef struct rlf_compositor_methods {
    /* Draws one picture; *out holds until the next. RLF_ERROR_DEVICE: the pipeline goes back to the
     * soft renderer. */
    rlf_result (*render)(void *self, const rlf_render_input *input, rlf_render_output *out);
    /* Frees self. */
    void (*destroy)(void *self);
    const char *name; /* "soft", "gl" */
} rlf_compositor_methods;

/* Makes a compositor of caller's methods, which are copied. On failure `self` is not destroyed. */
RLF_API rlf_result rlf_compositor_create_custom(const rlf_compositor_methods *methods, void *self,
                                                rlf_compositor **out);
/* The CPU renderer: pure C, same bits everywhere. Allocates all it needs for the def's sizes.
 * RLF_ERROR_INVALID names the def's field that is wrong. */
RLF_API rlf_result rlf_compositor_create_soft(const rlf_compositor_def *def, rlf_compositor **out);
/* Frees it with its method and nulls the pointer. NULL and a NULL compositor are allowed. */
RLF_API void rlf_compositor_destroy(rlf_compositor **compositor);
/* Its method's name, "soft", "gl" or another one's own. */
RLF_API const char *rlf_compositor_name(const rlf_compositor *compositor);
/* Draws one picture. Allocates nothing after the first call, but for bodies that together have more
 * triangles than any picture before. Thread-safety: one call at a time. */
RLF_API rlf_result rlf_compositor_render(rlf_compositor *compositor, const rlf_render_input *input,
                                         rlf_render_output *out);

#ifdef __cplusplus
}
#endif
#endif
