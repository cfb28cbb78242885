/* One frame by the thesis's method: Algorithm 1 for all bodies, then Algorithms 2 and 3. */
#include "physics/thesis/thesis.h"

void phys_thesis_advance(rlf_world *world, const rlf_grid *grid, double dt)
{
    world->time += dt;
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        if (body->is_alive && !body->is_held) {
            double speed = rlf_length(body->v);
            if (speed > world->def.max_speed) {
                body->v = rlf_scale(body->v, world->def.max_speed / speed);
            }
            thesis_integrate(body, world->def.gravity, dt);
        }
    }
    phys_world_release(world);
    thesis_collide_bodies(world);
    for (int32_t i = 0; grid != NULL && i < world->body_top; i++) {
        if (world->bodies[i].is_alive && !world->bodies[i].is_held) {
            thesis_collide_surface(world, i, grid);
        }
    }
}
