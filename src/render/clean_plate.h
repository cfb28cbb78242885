/* What the room looks like when nothing stands before it, and what that says of pixels whose depth
 * the sensor lost.
 *
 * Along a silhouette sensors lose a band of pixels, and with it whole slivers: a strip of a leg
 * beside a box, the gap between two limbs. The background model knows how far the room is there;
 * the plate keeps its colour beside it. A lost pixel near foreground is foreground where the
 * picture differs from the plate, and background where it shows the plate's colour and the
 * foreground's is another; else it stays as it was filled.
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

/* Learns a part of the plate from a new frame, and settles `depth` ([grid pixel], metres: what the
 * surface shows, else its background) of lost pixels where that may hide one of `bodies`. Without
 * colour or a background nothing is done. */
void clean_plate_update(clean_plate *plate, rlf_registration *registration,
                        const rlf_render_input *input, const silhouette *bodies, float *depth);

#endif
