/* Light around that real surfaces near a body keep from it. */
#ifndef RLF_RENDER_SOFT_OBSCURE_H
#define RLF_RENDER_SOFT_OBSCURE_H

#include "render/soft/soft.h"

/* Which real surfaces the bodies of the scene are near. */
void soft_place_obscurances(soft *s, const rlf_render_input *input);
/* False when real surfaces take none within `radius` of a point of the face. */
bool soft_may_obscure(const soft *s, const soft_face *f, const float middle[3], float radius);
/* Multiplies `left`, of points of the face. */
void soft_obscure_nodes(const soft *s, const soft_face *f, const caster_points *points,
                        float *left);

#endif
