/* Depths of pixels that the sensor lost, settled by what is seen around them and by colours.
 *
 * Black cloth, hair, edges and the rim of the picture return no light. From such a pixel the next
 * seen pixels in eight directions are looked at. They are one surface, or a near and a far one.
 * What a near surface encloses belongs to it (as a closing would have it, but as large as the hole
 * is); what is between two surfaces belongs to that whose colours it has; what is beyond the last
 * seen pixel of the picture goes on as its plane does. Where the room's own colour is remembered
 * (background_color.h) that decides. Neighbours decide together, so that there are no specks. */
#ifndef RLF_ENVIRONMENT_LOST_DEPTH_H
#define RLF_ENVIRONMENT_LOST_DEPTH_H

#include "camera/register.h"
#include "environment/background_color.h"
#include "environment/edge_matte.h"
#include "environment/real_windows.h"

#define LOST_DEPTH_WAYS 8
#define LOST_DEPTH_NOTHING 255 /* no seen pixel is met */

/* Columns and rows per step. */
static const int32_t lost_depth_way[LOST_DEPTH_WAYS][2] = {{-1, 0}, {0, -1}, {-1, -1}, {1, -1},
                                                           {1, 0},  {0, 1},  {1, 1},   {-1, 1}};

typedef struct lost_depth {
    int32_t width, height; /* of the depth grid */
    float focal;           /* grid pixels per metre at one metre */
    rlf_pool *pool;        /* borrowed; NULL = none */
    background_color background;
    uint8_t *away[LOST_DEPTH_WAYS]; /* pixels to the next seen one; 255 = none. Work memory, as: */
    float *near_z, *far_z, *nats;   /* both sides, and what speaks for the near one; far_z 0 =
                                       nothing, < 0 = there is no choice */
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

#endif
