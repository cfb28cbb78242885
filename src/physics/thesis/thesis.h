/* The rigid bodies of the thesis, chapter 4.3, one idea per file. */
#ifndef RLF_PHYSICS_THESIS_THESIS_H
#define RLF_PHYSICS_THESIS_THESIS_H

#include "physics/world_state.h"

/* eq. 4.5: R += w* R dt, then the column orthogonalisation printed below it. */
void thesis_rotate(rlf_mat3 *R, rlf_vec3 w, double dt);

/* eq. 4.6 to 4.9 and the two updates of Algorithm 1 for one body. */
void thesis_integrate(phys_body *body, rlf_vec3 gravity, double dt);

/* eq. 4.10 to 4.15 with errata 6 at world point p, unit normal n from b to a. b NULL: an immovable
 * surface. Applies the impulse only when the two approach; returns j, N s, 0 when they do not. */
double thesis_impulse(phys_body *a, phys_body *b, rlf_vec3 p, rlf_vec3 n, double restitution);

/* Algorithm 2 with errata 9: the region's box, grown by the body's radius and tau, holds the body's
 * centre (grid frame). */
bool thesis_broad_phase(const rlf_aabb *box, rlf_vec3 centre, double reach);

/* Algorithm 3: the body against every point of the regions it is near. */
void thesis_collide_surface(rlf_world *world, int32_t body_index, const rlf_grid *grid);

/* Vertices of each body against the other one, both masses. */
void thesis_collide_bodies(rlf_world *world);

#endif
