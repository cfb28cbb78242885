/* Limbs that a person's own body hides.
 *
 * Of a person seen from the side one arm and one leg are behind the rest, where no ray that enters
 * the near ones can tell them. People are alike on both sides: what is in front of the middle of
 * the trunk has its like behind it. To what comes from behind, the solid ends there; the air
 * between is hidden, too. */
#ifndef RLF_PIPELINE_FAR_SIDE_H
#define RLF_PIPELINE_FAR_SIDE_H

#include "relief/surface.h"

typedef struct far_side {
    float *thickness; /* metres along z, of the grid's pixels */
    int32_t *column;  /* of a region: pixels of its trunk in each column of the grid */
} far_side;

/* RLF_ERROR_MEMORY; destroy it then as well. */
rlf_result far_side_create(int32_t width, int32_t height, far_side *out);
void far_side_destroy(far_side *far);

/* The surface's thickness, up to the mirror image of what is in front of a trunk where that is
 * deeper: before and behind a trunk, no wider than people are, and never into the background.
 * `down` is gravity's direction, camera frame, of any length; zero: y is down. The plane is
 * `far`'s or the surface's. */
const float *far_side_thicken(far_side *far, const rlf_surface *surface, rlf_vec3 down);

#endif
