/* Motion of one body over one substep: exact free fall and a geometric rotation. */
#ifndef RLF_PHYSICS_INTEGRATE_H
#define RLF_PHYSICS_INTEGRATE_H

#include "physics/body.h"

/* Turns the body by its angular velocity over h seconds; without a torque the angular momentum in
 * the world is conserved and the energy to fourth order. */
void phys_integrate_rotation(phys_body *body, double h);

/* Moves the centre and turns the body over h seconds. The velocity already holds a h. A free body
 * moves by v h + a h^2 / 2 with its old v, exact under constant acceleration; one that a contact
 * held moves with its new velocity, which the solver made fit the contact. */
void phys_integrate_position(phys_body *body, double h);

#endif
