/* One frame by the live method: equal substeps of at most 1 / step_hz. */
#include "physics/broad_phase.h"
#include "physics/grid_collide.h"
#include "physics/integrate.h"
#include "physics/sleep.h"
#include "physics/solver.h"

#include <string.h>

#define SOLVE_PASSES 4
#define RELAX_PASSES 2
#define PAIR_PERIOD 2 /* substeps between searches for touching bodies */
/* Extrapolating the surface along its velocity is trusted this long, s: with 10 m/s^2 the error is
 * then 12 mm. */
#define EXTRAPOLATION_MAX 0.05
#define SHELL_PERIOD 0.25 /* s between searches for the room's shell */

static bool is_moving(const phys_body *body)
{
    return body->is_alive && !body->is_asleep && body->inverse_mass > 0.0;
}

/* The shell is a part of the room: it is looked for now and then, and anew for a moved camera. */
static void find_shell(rlf_world *world, const rlf_grid *grid)
{
    bool is_same_pose = memcmp(&world->shell_pose, &grid->T_world_grid, sizeof(rlf_pose)) == 0;
    if (!is_same_pose) {
        memset(&world->shell, 0, sizeof(world->shell));
    } else if (world->shell.turn > 0 && world->time < world->shell_time + SHELL_PERIOD) {
        return;
    }
    world->shell_pose = grid->T_world_grid;
    world->shell_time = world->time;
    grid_shell_update(&world->shell, grid);
}

/* A new grid shows the surface at the end of the advance that brings it; the same one again is
 * extrapolated. Device clock and world clock need not agree. */
static void start_surface(rlf_world *world, const rlf_grid *grid, double dt)
{
    if (grid == NULL) {
        world->has_grid = false;
        return;
    }
    bool is_new = !world->has_grid || grid->time_ns != world->grid_time_ns;
    if (is_new) {
        world->grid_tau = -dt;
    }
    grid_tiles_start(&world->foreground_tiles, grid, &grid->foreground, is_new);
    grid_tiles_start(&world->background_tiles, grid, &grid->background, is_new);
    if (is_new && phys_world_has_shell(world, grid)) {
        find_shell(world, grid);
    }
    world->has_grid = true;
    world->grid_time_ns = grid->time_ns;
}

static grid_query query_now(rlf_world *world, const rlf_grid *grid, double h)
{
    grid_query query = {.grid = grid, .time = world->time, .step = h};
    query.T_grid_world = rlf_pose_invert(&grid->T_world_grid);
    query.tau = rlf_clamp(world->grid_tau, -EXTRAPOLATION_MAX, EXTRAPOLATION_MAX);
    query.is_moving = query.tau == world->grid_tau;
    query.foreground = &world->foreground_tiles;
    query.background = &world->background_tiles;
    query.shell = phys_world_has_shell(world, grid) ? &world->shell : NULL;
    return query;
}

typedef struct surface_job {
    rlf_world *world;
    const grid_query *query;
} surface_job;

static void collide_range(void *context, int32_t begin, int32_t end, int32_t worker)
{
    surface_job *job = context;
    (void)worker;
    for (int32_t i = begin; i < end; i++) {
        phys_body *body = &job->world->bodies[i];
        if (is_moving(body) && body->surface_age >= body->surface_period) {
            grid_collide(job->query, body, i);
        }
    }
}

static void find_contacts(rlf_world *world, const grid_query *query, double h)
{
    int64_t clock = rlf_clock_ns();
    if (world->substep % PAIR_PERIOD == 0) {
        phys_find_pairs(world, (PAIR_PERIOD + 1) * h);
    }
    phys_clock(&clock, &world->times.pairs_ms);
    if (query != NULL) {
        for (int32_t i = 0; i < world->body_top; i++) {
            phys_body *body = &world->bodies[i];
            if (is_moving(body) && ++body->surface_age >= body->surface_period) {
                grid_collide_prepare(query, body);
            }
        }
        surface_job job = {world, query};
        rlf_pool *pool = world->body_top >= 16 ? world->def.pool : NULL;
        rlf_parallel_for(pool, world->body_top, 4, collide_range, &job);
        phys_clock(&clock, &world->times.surface_ms);
        return;
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        world->bodies[i].surface_count = 0;
    }
}

static void start_bodies(rlf_world *world)
{
    rlf_vec3 zero = {0, 0, 0};
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        body->impact_shift = body->impact_turn = zero;
        body->impact_time = 0.0;
        body->is_pressed = false;
        body->acceleration = body->angular_acceleration = zero;
        if (is_moving(body)) {
            rlf_vec3 gravity = rlf_scale(world->def.gravity, body->gravity_scale);
            body->acceleration = rlf_mad(gravity, body->force, body->inverse_mass);
            body->angular_acceleration =
                rlf_mat3_mul_vec(&body->inverse_inertia_world, body->torque);
        } else if (!phys_body_is_driven(body)) {
            body->v = body->w = zero;
        }
    }
}

static void limit_speed(phys_body *body, double max_speed, double h)
{
    double speed = rlf_length(body->v);
    double spin = rlf_length(body->w) * h;
    if (speed > max_speed) {
        body->v = rlf_scale(body->v, max_speed / speed);
    }
    if (spin > 1.0) { /* one radian per substep */
        body->w = rlf_scale(body->w, 1.0 / spin);
    }
}

static void damp(phys_body *body, double h)
{
    if (body->linear_damping > 0.0) {
        body->v = rlf_scale(body->v, rlf_exp(-body->linear_damping * h));
    }
    if (body->angular_damping > 0.0) {
        body->w = rlf_scale(body->w, rlf_exp(-body->angular_damping * h));
    }
}

static void accelerate(rlf_world *world, double h)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        if (is_moving(body)) {
            body->v = rlf_mad(body->v, body->acceleration, h);
            body->w = rlf_mad(body->w, body->angular_acceleration, h);
            damp(body, h);
            limit_speed(body, world->def.max_speed, h);
        }
    }
}

static void move(rlf_world *world, const grid_query *query, double h)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        if (body->is_alive && phys_body_is_driven(body)) {
            phys_integrate_position(body, h);
        }
        if (!is_moving(body)) {
            continue;
        }
        rlf_vec3 before = body->x;
        limit_speed(body, world->def.max_speed, h);
        phys_integrate_position(body, h);
        rlf_vec3 moved = rlf_sub(body->x, before);
        if (query != NULL && rlf_length(moved) > 0.1 * body->shape.inner_radius) {
            grid_guard_centre(query, body, before);
        }
    }
}

static void substep(rlf_world *world, const rlf_grid *grid, double h)
{
    grid_query query;
    const grid_query *q = NULL;
    if (grid != NULL) {
        query = query_now(world, grid, h);
        q = &query;
    }
    phys_world_release(world);
    find_contacts(world, q, h);
    int64_t clock = rlf_clock_ns();
    start_bodies(world);
    phys_solver_prepare(world);
    phys_wake_by_touch(world);
    phys_clock(&clock, &world->times.solve_ms);
    phys_solve_impacts(world, h);
    phys_clock(&clock, &world->times.impacts_ms);
    accelerate(world, h);
    phys_solver_warm_start(world);
    for (int32_t i = 0; i < SOLVE_PASSES; i++) {
        phys_solver_pass(world, true, h);
    }
    phys_solver_mark_pressed(world);
    phys_clock(&clock, &world->times.solve_ms);
    move(world, q, h);
    phys_clock(&clock, &world->times.move_ms);
    for (int32_t i = 0; i < RELAX_PASSES; i++) {
        phys_solver_pass(world, false, h);
    }
    phys_solver_log(world);
    phys_clock(&clock, &world->times.solve_ms);
    phys_fall_asleep(world, h);
    phys_clock(&clock, &world->times.sleep_ms);
    world->time += h;
    world->grid_tau += h;
    world->substep++;
}

static void forget_log(rlf_world *world)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        for (int32_t k = 0; k < world->bodies[i].surface_count; k++) {
            world->bodies[i].surface[k].log = -1;
        }
    }
    for (int32_t i = 0; i < world->pair_count; i++) {
        for (int32_t k = 0; k < world->pairs[i].contact_count; k++) {
            world->pairs[i].contacts[k].log = -1;
        }
    }
}

/* Sleepers are asked once per advance, and everyone at once when the surface is a new one. */
static void greet_surface(rlf_world *world, const rlf_grid *grid, double h)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        body->surface_age = body->surface_period;
    }
    if (grid == NULL) {
        phys_wake_by_surface(world, NULL);
        return;
    }
    grid_query query = query_now(world, grid, h);
    phys_wake_by_surface(world, &query);
}

void phys_live_advance(rlf_world *world, const rlf_grid *grid, double dt)
{
    int32_t count = (int32_t)(dt * world->def.step_hz + 1.0 - 1e-6);
    count = count < 1 ? 1 : count;
    double h = dt / count;
    double start = world->time;
    world->substep = 0;
    forget_log(world);
    start_surface(world, grid, dt);
    int64_t clock = rlf_clock_ns();
    greet_surface(world, grid, h);
    phys_clock(&clock, &world->times.wake_ms);
    for (int32_t i = 0; i < count; i++) {
        substep(world, grid, h);
    }
    world->time = start + dt;
}
