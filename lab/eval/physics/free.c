/* Bodies in empty space against closed forms, at 30 frames a second. */
#include "eval/physics/experiments.h"
#include "eval/physics/world.h"
#include "eval/table.h"

#include <math.h>

#define FRAME_S (1.0 / 30)
#define GRAVITY 9.81

static rlf_physics_method method_of(rlf_profile profile)
{
    return profile == RLF_PROFILE_LIVE ? RLF_PHYSICS_LIVE : RLF_PHYSICS_THESIS;
}

static rlf_result run_fall(eval_table *table, rlf_profile profile)
{
    rlf_world *world = eval_world_open(method_of(profile), rlf_vec3_make(0, GRAVITY, 0), 1);
    rlf_body_def def = rlf_body_def_default();
    if (world == NULL || rlf_world_add_body(world, &def, NULL) != RLF_OK) {
        rlf_world_destroy(&world);
        return RLF_ERROR_MEMORY;
    }
    for (int k = 0; k < 30; k++) {
        rlf_world_advance(world, NULL, FRAME_S);
    }
    double fallen = eval_world_body(world, 0)->T_world_body.p.y - def.position.y;
    eval_table_add(table, "physics", "free_fall_mm", "free fall of 1 s: error, mm", profile,
                   1e3 * fabs(fallen - 0.5 * GRAVITY));
    rlf_world_destroy(&world);
    return RLF_OK;
}

/* Turns about its middle axis, where a box tumbles: 100 s without torque. */
static rlf_result run_tumble(eval_table *table, rlf_profile profile)
{
    rlf_world *world = eval_world_open(method_of(profile), rlf_vec3_make(0, 0, 0), 1);
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(0.2, 0.1, 0.04);
    def.mass = 1.0;
    def.angular_velocity = rlf_vec3_make(0.01, 10, 0.01);
    if (world == NULL || rlf_world_add_body(world, &def, NULL) != RLF_OK) {
        rlf_world_destroy(&world);
        return RLF_ERROR_MEMORY;
    }
    double start = rlf_world_energy(world), worst = 0.0;
    for (int k = 0; k < 3000; k++) {
        rlf_world_advance(world, NULL, FRAME_S);
        worst = rlf_max(worst, fabs(rlf_world_energy(world) / start - 1.0));
    }
    eval_table_add(table, "physics", "tumble_energy_drift", "tumbling box, 100 s: energy drift",
                   profile, worst);
    rlf_world_destroy(&world);
    return RLF_OK;
}

/* Five balls in a row, e = 1: the first one's 2 m/s must leave with the last. */
static rlf_result run_chain(eval_table *table, rlf_profile profile)
{
    rlf_world *world = eval_world_open(method_of(profile), rlf_vec3_make(0, 0, 0), 5);
    rlf_result result = world != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (int i = 0; i < 5 && result == RLF_OK; i++) {
        rlf_body_def def = rlf_body_def_default();
        def.shape.type = RLF_SHAPE_SPHERE;
        def.shape.radius = 0.05;
        def.restitution = 1.0;
        def.position = rlf_vec3_make(i == 0 ? -0.4 : 0.1 * i - 0.1, 0, 1);
        def.velocity = rlf_vec3_make(i == 0 ? 2 : 0, 0, 0);
        result = rlf_world_add_body(world, &def, NULL);
    }
    for (int k = 0; k < 20 && result == RLF_OK; k++) {
        rlf_world_advance(world, NULL, FRAME_S);
    }
    double worst = 0.0;
    for (int i = 0; i < 5 && result == RLF_OK; i++) {
        double expected = i == 4 ? 2.0 : 0.0;
        worst = rlf_max(worst, fabs(eval_world_body(world, i)->velocity.x - expected));
    }
    if (result == RLF_OK) {
        eval_table_add(table, "physics", "chain_error_percent",
                       "row of 5 balls, e = 1: worst speed error, %", profile, 50.0 * worst);
    }
    rlf_world_destroy(&world);
    return result;
}

rlf_result eval_free_run(eval_table *table, rlf_profile profile)
{
    rlf_result result = run_fall(table, profile);
    result = result == RLF_OK ? run_tumble(table, profile) : result;
    return result == RLF_OK ? run_chain(table, profile) : result;
}
