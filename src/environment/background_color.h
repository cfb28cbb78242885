/* The colour of the room when nothing stands before it, and what that says of pixels whose depth
 * the sensor lost.
 *
 * Along a contour sensors lose a band of pixels, and with it whole slivers: a strip of a leg beside
 * a box, the gap between two limbs. The background model knows how far the room is there; here its
 * colour is learnt. A lost pixel near foreground is foreground where the picture differs from that
 * colour. It is background where the picture shows that colour and the foreground's is another.
 * Else colour says nothing.
 *
 * A colour is compared with that of the pixel and its neighbours (Elgammal et al. 2000). What is of
 * the same colour but darker may be in a shadow (Horprasert et al. 1999). When most of what is seen
 * of the background has another colour, the exposure, the light or the camera has changed: all is
 * learnt anew. */
#ifndef RLF_ENVIRONMENT_BACKGROUND_COLOR_H
#define RLF_ENVIRONMENT_BACKGROUND_COLOR_H

#include "camera/register.h"
#include "relief/camera.h"
#include "relief/surface.h"

typedef struct background_color {
    int32_t width, height; /* of the depth grid */
    uint8_t *colors; /* [pixel][4]: RGB of the background, times it was seen so; 0 = unknown */
    uint8_t *cells;  /* [row][column] of 8 x 8 pixels: work memory */
    int32_t columns, rows;
    float to_grid[4]; /* grid pixels per picture pixel, [x][u, v], [y][u, v] */
    float scale[2];   /* colour pixels per picture pixel */
    int32_t next_row; /* that is learnt */
    bool is_whole;    /* every row has been learnt once */
    uint64_t last_sequence;
    bool has_sequence;
} background_color;

/* `registration` is of the surface's grid and the picture's camera. RLF_ERROR_MEMORY. */
rlf_result background_color_create(const rlf_registration *registration, const rlf_camera *depth,
                                   const rlf_pose *T_picture_depth, background_color *out);
void background_color_destroy(background_color *background);

/* As at the start. */
void background_color_forget(background_color *background);

/* Learns some rows from a new frame. Without colour or a background nothing is done. */
void background_color_update(background_color *background, rlf_registration *registration,
                             const rlf_frame *frame, const rlf_surface *surface);

/* RGB of the frame where the picture has (u, v); NULL outside of it. */
const uint8_t *background_color_seen_at(const background_color *background,
                                        const rlf_image_rgba8 *color, float u, float v);
/* RGB of the frame where pixel i is seen if it is z metres away; NULL outside of the picture. */
const uint8_t *background_color_seen(const background_color *background,
                                     const rlf_registration *registration,
                                     const rlf_image_rgba8 *color, int32_t i, float z);
/* Squared distance of two colours. */
float background_color_squared(const uint8_t *a, const uint8_t *b);

typedef struct background_color_sight {
    const rlf_registration *registration;
    const rlf_image_rgba8 *color;
    const rlf_surface *surface;
} background_color_sight;

/* What colour says of lost pixel i that may be of a thing at near_z, like seen pixel `near`:
 * 1 = the thing, -1 = the background, 0 = nothing. */
int background_color_tells(const background_color *background, const background_color_sight *sight,
                           int32_t i, int32_t near, float near_z);

/* ---- sight_change.c: whether the camera has moved so far that what is remembered pixel by
 * pixel is no longer there. */

/* A zeroed one remembers nothing. */
typedef struct sight_change {
    rlf_pose T_world_camera; /* where the memory began */
    bool has_pose;
} sight_change;

/* True when something between `nearest_m` and far away is now a pixel of `camera`, or more, from
 * where it was when the memory began; it then begins anew here. The first pose is no change, and a
 * standing camera's never is. */
bool sight_change_update(sight_change *c, const rlf_pose *T_world_camera, const rlf_camera *camera,
                         double nearest_m);

#endif
