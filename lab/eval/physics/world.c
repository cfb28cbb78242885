/* The worlds of the experiments on bodies. */
#include "eval/physics/world.h"

rlf_world *eval_world_open(rlf_physics_method method, rlf_vec3 gravity, int32_t bodies)
{
    rlf_world_def def = rlf_world_def_default();
    def.method = method;
    def.gravity = gravity;
    def.body_capacity = bodies;
    def.contact_capacity = 4096;
    rlf_world *world = NULL;
    return rlf_world_create(&def, &world) == RLF_OK ? world : NULL;
}

const rlf_body_state *eval_world_body(const rlf_world *world, int32_t i)
{
    return &rlf_world_get_snapshot(world)->bodies[i];
}
