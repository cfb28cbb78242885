/* The real depth that a picture's bodies are compared with, seen from the picture's camera. */
#ifndef RLF_ENVIRONMENT_REAL_DEPTH_H
#define RLF_ENVIRONMENT_REAL_DEPTH_H

#include "base/inside.h"
#include "camera/register.h"
#include "environment/background_color.h"
#include "environment/depth_tiles.h"
#include "environment/edge_matte.h"
#include "known/layer.h"

/* ---- real_windows.c: the parts of the registered depth that a picture needs. */

#define REAL_WINDOWS_MOST 4 /* what is between bodies far apart is not registered */

typedef struct real_windows {
    pixel_rect window[REAL_WINDOWS_MOST];
    int32_t count;
} real_windows;

/* Adds a window to the one that it meets, to none or, when there are enough, to the last. */
void real_windows_add(real_windows *windows, const pixel_rect *more);

/* Joins those of which one would be drawn into what another one needs, with no depth nearer than
 * `nearest` metres; 0 = not known. */
void real_windows_join(real_windows *windows, const rlf_registration *registration, double nearest);

/* ---- lost_depth.c: depths of pixels that the sensor lost, settled by what is seen around them
 * and by colours. Black cloth, hair, edges and the rim of the picture return no light. From such
 * a pixel the next seen pixels in eight directions are looked at. They are one surface, or a
 * near and a far one. What a near surface encloses belongs to it (as a closing would have it,
 * but as large as the hole is); what is between two surfaces belongs to that whose colours it
 * has; what is beyond the last seen pixel of the picture goes on as its plane does. Where the
 * room's own colour is remembered (background_color.h) that decides. Neighbours decide together,
 * so that there are no specks. */

#define LOST_DEPTH_WAYS 8
#define LOST_DEPTH_NOTHING 255 /* no seen pixel is met */

/* Columns and rows per step. */
static const int32_t lost_depth_way[LOST_DEPTH_WAYS][2] = {{-1, 0}, {0, -1}, {-1, -1}, {1, -1},
                                                           {1, 0},  {0, 1},  {1, 1},   {-1, 1}};

/* Sums over pixels at the end of a surface that nothing encloses: what speaks for its going on, and
 * one over how far it would be. */
typedef struct lost_depth_open {
    float nats, inverse, count;
} lost_depth_open;

typedef struct lost_depth {
    int32_t width, height; /* of the depth grid */
    float focal;           /* grid pixels per metre at one metre */
    rlf_pool *pool;        /* borrowed; NULL = none */
    background_color background;
    uint8_t *away[LOST_DEPTH_WAYS]; /* pixels to the next seen one; 255 = none. Work memory, as: */
    float *near_z, *far_z, *nats;   /* both sides, and what speaks for the near one; far_z 0 =
                                       nothing, < 0 = there is no choice */
    uint8_t *is_open;               /* 1 = hardly anything encloses it, and nothing is behind */
    lost_depth_open *open;          /* of a cell */
    uint8_t *cells;                 /* of 8 x 8 pixels: 1 = a picture's window needs it */
    float *body_near; /* of a cell: no body is nearer; EDGE_MATTE_FAR = none is there */
    float *nearest;   /* of a row of cells: least depth that was settled */
    int32_t columns, rows;
} lost_depth;

/* `registration` is of the surface's grid and the picture's camera; `pool` is borrowed, NULL =
 * none. RLF_ERROR_MEMORY. */
rlf_result lost_depth_create(const rlf_registration *registration, const rlf_camera *depth,
                             const rlf_pose *T_picture_depth, rlf_pool *pool, lost_depth *out);
void lost_depth_destroy(lost_depth *l);

/* Settles `depth` ([grid pixel], metres: what the surface shows, else its background) of lost
 * pixels that may be seen in the picture's windows. Colour and background may be missing. Where the
 * background is nearer than `bodies` it stays (NULL = is never). No depth
 * is nearer than `nearest`; returns the same of what was settled. */
float lost_depth_update(lost_depth *l, rlf_registration *registration, const rlf_frame *frame,
                        const rlf_surface *surface, const edge_matte *bodies,
                        const real_windows *needed, float *depth, float nearest);

/* lost_depth_ways.c: fills `away` of rows [begin, end) from a plane of reasons. */
void lost_depth_find_ways(lost_depth *l, const uint8_t *reason, int32_t begin, int32_t end);

/* ---- real_depth.c: the depth itself. */

typedef struct real_depth {
    rlf_registration *registration;
    float *input;    /* what is registered: the surface's size, or the frame's for coarse ones */
    float nearest;   /* no depth of it is nearer, metres; 0 = not known */
    rlf_plane_f32 z; /* metres along the picture camera's z; 0 = unknown */

    /* A surface that keeps every n-th pixel is too coarse to cut bodies along a silhouette; then
     * the frame's own depth is registered, as in the thesis (4.2.2). */
    bool uses_frame;
    int32_t width, height; /* of input */
    float *ray_x, *ray_y;  /* uses_frame only */
    uint8_t *is_in_lens;   /* uses_frame only */

    sight_change sight; /* of what is remembered pixel by pixel while bodies are in the picture */
    bool has_moved;     /* by that: it is forgotten */

    depth_tiles seen; /* of the surface, as it was last read */
    lost_depth lost;  /* not uses_frame only */
    rlf_pool *pool;

    known_layer known;  /* models of real things: they are put into z, */
    known_layer sensed; /* and into input where nothing is sensed */
    rlf_pose T_picture_depth;
} real_depth;

/* What there is of the real room at a time; all is borrowed. */
typedef struct observation {
    const rlf_frame *frame;
    const rlf_surface *surface;
    const rlf_snapshot *snapshot; /* for models of real things; NULL = none */
    rlf_pose T_world_camera;
} observation;

typedef struct real_depth_def {
    const rlf_rig *rig;
    rlf_camera grid;            /* of the surface */
    const float *ray_x, *ray_y; /* as rlf_surface has them */
    rlf_camera picture;
    rlf_pose T_picture_depth;
    rlf_pool *pool; /* borrowed; NULL = none */
} real_depth_def;

/* Allocates everything. RLF_ERROR_MEMORY. */
rlf_result real_depth_create(const real_depth_def *def, real_depth *out)
    RLF_INSIDE(real_depth_create);
/* As edge_matte_update's `known`. */
const known_layer *real_depth_known(const real_depth *real) RLF_INSIDE(real_depth_known);
void real_depth_destroy(real_depth *real) RLF_INSIDE(real_depth_destroy);
/* Reads the depth that is to be registered, and fills `seen`. */
void real_depth_read(real_depth *real, const observation *now) RLF_INSIDE(real_depth_read);
/* Fills windows of z with what was read last; of other pixels nothing is known. Pixels without
 * depth take the background's, when the surface knows it; with `bodies` what is around them and
 * what the picture shows decides (lost_depth.h), and has_moved says whether the matte is to forget.
 * Models of real things take their place. RLF_ERROR_MEMORY as known_layer_place. */
rlf_result real_depth_update(real_depth *real, const observation *now, const edge_matte *bodies,
                             const real_windows *needed) RLF_INSIDE(real_depth_update);

#endif
