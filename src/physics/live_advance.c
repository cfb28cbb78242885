/* One frame by the live method: equal substeps of at most 1 / step_hz, in groups of up to
 * PHYS_PERIOD_MAX between searches for pairs and islands. */
#include "physics/fetch.h"
#include "physics/grab/grab.h"
#include "physics/grid/contact/contact.h"
#include "physics/solver.h"
#include "physics/pair/collide.h"

#include <string.h>

/* The surface goes on along its velocity this long without a frame, s: two lost frames of 30 a
 * second, or one interval of a camera with 10. A foot that stood still after half of that was
 * overrun. */
#define EXTRAPOLATION_MAX 0.1
#define ROOM_PERIOD 0.25 /* s between searches for the room's shell */

/* Unit, against gravity, grid frame; 0 without gravity. */
static rlf_vec3 up_in_grid(const rlf_world *world, const rlf_grid *grid)
{
    rlf_quat q_grid_world = rlf_quat_conjugate(grid->T_world_grid.q);
    return rlf_normalize(rlf_neg(rlf_rotate(q_grid_world, world->def.gravity)));
}

/* A camera that moves through a room that is known takes the shell along; else all is new. */
static void follow_camera(rlf_world *world, const rlf_grid *grid)
{
    if (memcmp(&world->room_pose, &grid->T_world_grid, sizeof(rlf_pose)) == 0) {
        return;
    }
    if (world->map != NULL) {
        rlf_pose T_before_world = rlf_pose_invert(&world->room_pose);
        rlf_pose T_before_now = rlf_pose_mul(&T_before_world, &grid->T_world_grid);
        room_planes_carry(&world->room, &T_before_now);
        world->rest_version++;
    } else {
        memset(&world->room, 0, sizeof(world->room));
    }
    world->room_pose = grid->T_world_grid;
}

/* The shell is a part of the room: it is looked for now and then. */
static void find_room(rlf_world *world, const rlf_grid *grid)
{
    follow_camera(world, grid);
    if (world->room.turn > 0 && world->time < world->room_time + ROOM_PERIOD) {
        return;
    }
    world->room_time = world->time;
    world->rest_version++;
    room_planes_update(&world->room, grid);
}

/* Whether what stays is that of the camera's last grid. */
static bool is_same_background(phys_view *view, const rlf_grid *grid)
{
    const rlf_grid_sheet *sheet = &grid->background;
    bool is_same = view->has_grid && sheet->version != 0 &&
                   sheet->version == view->background_version &&
                   sheet->depth == view->background_depth &&
                   memcmp(&view->pose, &grid->T_world_grid, sizeof(rlf_pose)) == 0;
    view->background_version = sheet->version;
    view->background_depth = sheet->depth;
    view->pose = grid->T_world_grid;
    return is_same;
}

/* A new grid shows the surface at the end of the advance that brings it; the same one again is
 * extrapolated. Device clock and world clock need not agree. Returns whether it is new. */
static bool start_view(rlf_world *world, const rlf_grid *grid, double dt)
{
    phys_view *view = &world->views[grid->camera];
    bool is_new = !view->has_grid || grid->time_ns != view->time_ns;
    if (is_new) {
        view->gap = view->has_grid ? rlf_max(view->tau - EXTRAPOLATION_MAX, 0.0) : 0.0;
        view->tau = -dt;
    }
    bool has_changed = is_new && !is_same_background(view, grid);
    world->rest_version += has_changed;
    grid_tiles_start(&view->foreground, grid, &grid->foreground, is_new);
    grid_tiles_start(&view->background, grid, &grid->background, has_changed);
    view->has_grid = true;
    view->time_ns = grid->time_ns;
    return is_new;
}

/* Returns whether a camera shows something new, or none shows anything. */
static bool start_surface(rlf_world *world, const rlf_grid *grid, double dt)
{
    bool is_seen[RLF_WORLD_CAMERAS_MAX] = {false};
    bool is_any = grid == NULL;
    for (const rlf_grid *one = grid; one != NULL; one = one->next) {
        bool is_new = start_view(world, one, dt);
        if (is_new && one == grid && phys_world_has_room(world, grid)) {
            world->rest_version += room_planes_glide(&world->room, dt);
            find_room(world, grid);
        }
        is_any = is_any || is_new;
        is_seen[one->camera] = true;
    }
    for (int32_t k = 0; k < RLF_WORLD_CAMERAS_MAX; k++) {
        is_any = is_any || (world->views[k].has_grid && !is_seen[k]);
        world->views[k].has_grid = is_seen[k];
    }
    return is_any;
}

static grid_query query_of(rlf_world *world, const rlf_grid *grid, double h)
{
    phys_view *view = &world->views[grid->camera];
    grid_query query = {.grid = grid, .time = world->time, .step = h};
    query.T_grid_world = rlf_pose_invert(&grid->T_world_grid);
    query.tau = rlf_clamp(view->tau, -EXTRAPOLATION_MAX, EXTRAPOLATION_MAX);
    query.lag = rlf_max(query.tau - view->tau, 0.0) + view->gap;
    query.is_moving = query.tau == view->tau;
    query.rest_version = world->rest_version;
    query.foreground = &view->foreground;
    query.background = &view->background;
    query.up = up_in_grid(world, grid);
    return query;
}

/* What all cameras of the list see; the first of them alone answers for what none sees. */
typedef struct grid_queries {
    grid_query of[RLF_WORLD_CAMERAS_MAX];
} grid_queries;

static const grid_query *query_now(rlf_world *world, const rlf_grid *grid, double h,
                                   grid_queries *out)
{
    int32_t count = 0;
    for (const rlf_grid *one = grid; one != NULL; one = one->next, count++) {
        out->of[count] = query_of(world, one, h);
        out->of[count].first = &out->of[0];
        if (count > 0) {
            out->of[count - 1].next = &out->of[count];
        }
    }
    if (count == 0) {
        return NULL;
    }
    out->of[0].room = phys_world_has_room(world, grid) ? &world->room : NULL;
    out->of[0].map = world->map;
    return &out->of[0];
}

typedef struct surface_job {
    rlf_world *world;
    const grid_query *query;
} surface_job;

/* Whether the body may come to the surface in this substep, or soon after a blow in it. */
static bool is_coming(const phys_body *body, double h)
{
    double moved = rlf_length(rlf_sub(body->x, body->surface_x));
    return moved + phys_body_way(body, h) > body->surface_clear;
}

static bool is_due(const phys_body *body, double h)
{
    if (!phys_body_is_moving(body)) {
        return false;
    }
    bool is_clear = body->surface_clear > 0.0 && !is_coming(body, h);
    return body->surface_age >= (is_clear ? PHYS_PERIOD_MAX : body->surface_period) ||
           (body->is_restless && !is_clear);
}

/* What a search for contacts with the surface reads of a body. */
RLF_KERNEL_PART void fetch_due(const rlf_world *world, int32_t k)
{
    const phys_body *body = &world->bodies[world->due_bodies[k]];
    phys_fetch_body(body);
    phys_fetch(&body->surface_time, offsetof(phys_body, side) - offsetof(phys_body, surface_time));
    phys_fetch(body->surface, (size_t)body->surface_count * sizeof(phys_contact));
}

static void collide_range(void *context, int32_t begin, int32_t end, int32_t worker)
{
    surface_job *job = context;
    (void)worker;
    for (int32_t k = begin; k < end; k++) {
        int32_t i = job->world->due_bodies[k];
        fetch_due(job->world, k + 2 < end ? k + 2 : k);
        phys_body *body = &job->world->bodies[i];
        grid_collide(job->query, body, i);
        body->surface_v = body->v;
        body->surface_w = body->w;
    }
}

/* Lists the bodies that are to ask the surface in this substep; returns their number. */
static int32_t list_due(rlf_world *world, const grid_query *query)
{
    enum { AHEAD = 6 };
    int32_t due = 0;
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        const phys_body *next = &world->bodies[i + AHEAD < world->body_top ? i + AHEAD : i];
        RLF_KERNEL_SOON(&next->v);
        RLF_KERNEL_SOON(&next->x);
        RLF_KERNEL_SOON(&next->is_alive);
        if (phys_body_is_moving(body)) {
            body->surface_age++;
            if (is_due(body, query->step)) {
                world->due_bodies[due++] = i;
            }
        }
    }
    return due;
}

static void find_surface_contacts(rlf_world *world, const grid_query *query)
{
    if (query == NULL) {
        for (int32_t i = 0; i < world->body_top; i++) {
            world->bodies[i].surface_count = 0;
        }
        return;
    }
    int32_t due = list_due(world, query);
    for (int32_t k = 0; k < due; k++) {
        phys_body *body = &world->bodies[world->due_bodies[k]];
        phys_log_contacts(world, body->surface, body->surface_count);
        grid_collide_prepare(query, body);
    }
    surface_job job = {world, query};
    rlf_parallel_for(due >= 16 ? world->def.pool : NULL, due, 8, collide_range, &job);
}

static void move_driven(rlf_world *world, double h)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        if (body->is_alive && phys_body_is_driven(body)) {
            phys_integrate_position(body, h);
        }
    }
}

typedef struct island_job {
    rlf_world *world;
    const grid_query *query;
    double h;
} island_job;

static void substep_range(void *context, int32_t begin, int32_t end, int32_t worker)
{
    island_job *job = context;
    (void)worker;
    for (int32_t i = begin; i < end; i++) {
        phys_island_substep(job->world, &job->world->islands[i], job->query, job->h);
    }
}

static void substep(rlf_world *world, const grid_query *query, double h)
{
    int64_t clock = rlf_clock_ns();
    island_job job = {world, query, h};
    rlf_pool *pool = world->island_count > 1 ? world->def.pool : NULL;
    rlf_parallel_for(pool, world->island_count, 1, substep_range, &job);
    move_driven(world, h);
    phys_clock(&clock, &world->times.solve_ms);
    world->time += h;
    for (int32_t k = 0; k < RLF_WORLD_CAMERAS_MAX; k++) {
        world->views[k].tau += h;
    }
}

/* Substeps between two searches for pairs. */
static void leap(rlf_world *world, const rlf_grid *grid, int32_t count, double h)
{
    phys_world_release(world);
    for (int32_t i = 0; i < count; i++) {
        int64_t clock = rlf_clock_ns();
        grid_queries now;
        const grid_query *query = query_now(world, grid, h, &now);
        if (i == 0) {
            phys_find_pairs(world, h);
            phys_wake_by_touch(world, (count + 1) * h);
        } else {
            phys_refresh_pairs(world, h);
        }
        phys_clock(&clock, &world->times.pairs_ms);
        find_surface_contacts(world, query);
        phys_clock(&clock, &world->times.surface_ms);
        if (i == 0) {
            phys_find_islands(world);
            phys_clock(&clock, &world->times.sleep_ms);
        }
        substep(world, query, h);
    }
    int64_t clock = rlf_clock_ns();
    phys_fall_asleep(world, count * h);
    phys_clock(&clock, &world->times.sleep_ms);
}

static void fill_log(rlf_world *world)
{
    enum { AHEAD = 8 };
    for (int32_t i = 0; i < world->pair_count; i++) {
        phys_pair *pair = &world->pairs[i];
        if (i + 2 * AHEAD < world->pair_count) {
            phys_fetch_contacts(&world->pairs[i + AHEAD]);
            phys_fetch(&world->pairs[i + 2 * AHEAD], sizeof(*pair));
        }
        phys_log_contacts(world, pair->contacts, pair->contact_count);
    }
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_log_contacts(world, world->bodies[i].surface, world->bodies[i].surface_count);
    }
}

/* When the surface is a new one everyone is asked at once, sleepers too, and these for all of the
 * advance: they are not asked again in it. */
static void greet_surface(rlf_world *world, const rlf_grid *grid, double dt)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        phys_body_ask_surface(body);
    }
    grid_queries now;
    phys_wake_by_surface(world, query_now(world, grid, dt, &now), dt);
}

/* Hands take hold of bodies, carry them and let go. */
static void grab(rlf_world *world, const rlf_grid *grid, double dt)
{
    if (world->def.enable_grab) {
        grid_queries now;
        phys_grab_update(world, query_now(world, grid, dt, &now), dt);
    }
}

/* A grid that sees nothing: all of a room that is known is answered for by its map. */
static bool project_nothing(const void *context, rlf_vec3 p, double *out_u, double *out_v)
{
    (void)context, (void)p, (void)out_u, (void)out_v;
    return false;
}

static const float no_ray[1] = {0.0f};
static const rlf_grid blind_grid = {.width = 1,
                                    .height = 1,
                                    .ray_x = no_ray,
                                    .ray_y = no_ray,
                                    .project = project_nothing,
                                    .T_world_grid = {.q = {.w = 1.0}}};

void phys_live_advance(rlf_world *world, const rlf_grid *grid, double dt)
{
    grid = grid == NULL && world->map != NULL ? &blind_grid : grid;
    int32_t count = (int32_t)(dt * world->def.step_hz + 1.0 - 1e-6);
    count = count < 1 ? 1 : count;
    double h = dt / count;
    double start = world->time;
    int64_t clock = rlf_clock_ns();
    if (start_surface(world, grid, dt)) {
        greet_surface(world, grid, dt);
        if (grid != NULL) {
            grab(world, grid, dt);
        } else {
            phys_grab_release_all(world);
        }
    }
    phys_clock(&clock, &world->times.wake_ms);
    for (int32_t done = 0; done < count; done += PHYS_PERIOD_MAX) {
        int32_t rest = count - done;
        leap(world, grid, rest < PHYS_PERIOD_MAX ? rest : PHYS_PERIOD_MAX, h);
    }
    fill_log(world);
    world->time = start + dt;
}
