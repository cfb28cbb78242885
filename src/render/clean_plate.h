/* What the room looks like when nothing stands before it, and what that says of pixels whose depth
 * the sensor lost.
 *
 * Along a silhouette sensors lose a band of pixels, and with it whole slivers: a strip of a leg
 * beside a box, the gap between two limbs. The background model knows how far the room is there;
 * the plate keeps its colour beside it. A lost pixel near foreground is foreground where the
 * picture differs from the plate, and background where it shows the plate's colour and the
 * foreground's is another; else the plate
 * does not tell.
 *
 * A colour is compared with the plate's pixel and its neighbours (Elgammal et al. 2000), and what
 * is the plate's colour but darker may be a shadow on it (Horprasert et al. 1999). When most of
 * what is seen of the background differs from the plate - another exposure, another light, a moved
 * camera - it is forgotten and learnt anew. */
#ifndef RLF_RENDER_CLEAN_PLATE_H
#define RLF_RENDER_CLEAN_PLATE_H

#include "camera/register.h"
#include "relief/compositor.h"
#include "render/silhouette.h"

typedef struct clean_plate {
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
} clean_plate;

/* `registration` is of the surface's grid and the picture's camera. RLF_ERROR_MEMORY. */
rlf_result clean_plate_create(const rlf_registration *registration, const rlf_camera *depth,
                              const rlf_pose *T_picture_depth, clean_plate *out);
void clean_plate_destroy(clean_plate *plate);

/* Learns a part of the plate from a new frame. Without colour or a background nothing is done. */
void clean_plate_update(clean_plate *plate, rlf_registration *registration,
                        const rlf_render_input *input);

/* RGB of the frame where the picture has (u, v); NULL outside of it. */
const uint8_t *clean_plate_picture(const clean_plate *plate, const rlf_image_rgba8 *color, float u,
                                   float v);
/* RGB of the frame where pixel i is seen if it is z metres away; NULL outside of the picture. */
const uint8_t *clean_plate_color(const clean_plate *plate, const rlf_registration *registration,
                                 const rlf_image_rgba8 *color, int32_t i, float z);
/* Squared distance of two colours. */
float clean_plate_squared(const uint8_t *a, const uint8_t *b);

typedef struct clean_plate_sight {
    const rlf_registration *registration;
    const rlf_image_rgba8 *color;
    const rlf_surface *surface;
} clean_plate_sight;

/* What the plate says of lost pixel i that may be of a thing at near_z, like seen pixel `near`:
 * 1 = the thing, -1 = the background, 0 = nothing. */
int clean_plate_tells(const clean_plate *plate, const clean_plate_sight *sight, int32_t i,
                      int32_t near, float near_z);

#endif
