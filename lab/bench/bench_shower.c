/* The live surface and the showers of bench_physics. */
#define _POSIX_C_SOURCE 200809L
#include "bench_physics.h"

#include "relief/pipeline.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define EMPTY_FRAMES 8   /* the background needs five */
#define LAYER_COLUMNS 14 /* cubes of a layer side by side */

/* Of one worker its own time, whoever else uses the machine; of several that on the wall. */
static double now_ms(bool is_alone)
{
    struct timespec t;
    clock_gettime(is_alone ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static rlf_synthetic_def source_def(rlf_synthetic_scene scene, uint64_t seed)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.scene = scene;
    def.seed = seed;
    def.frame_count = -1;
    def.enable_color = false;
    def.enable_truth = false;
    return def;
}

bool room_open(room *r, uint64_t seed, int32_t scale_factor)
{
    memset(r, 0, sizeof(*r));
    r->seed = seed;
    r->first_time_ns = -1;
    rlf_synthetic_def def = source_def(RLF_SYNTHETIC_ROOM, seed);
    if (rlf_synthetic_create(&def, &r->source) != RLF_OK) {
        return false;
    }
    rlf_reconstruct_def reconstruct =
        rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rlf_source_get_info(r->source)->rig);
    reconstruct.scale_factor = scale_factor;
    bool is_good = rlf_reconstruct_create(&reconstruct, &r->reconstruct) == RLF_OK &&
                   far_side_create(reconstruct.rig.depth.width, reconstruct.rig.depth.height,
                                   &r->far) == RLF_OK;
    for (int32_t k = 0; k < EMPTY_FRAMES && is_good; k++) {
        is_good = room_next(r);
    }
    return is_good;
}

bool room_next(room *r)
{
    const rlf_pose camera = rlf_pose_identity();
    const rlf_vec3 down = {0, 1, 0};
    const rlf_surface *surface = NULL;
    rlf_frame frame;
    if (rlf_source_next(r->source, &frame) != RLF_OK ||
        rlf_reconstruct_process(r->reconstruct, &frame, &surface) != RLF_OK) {
        return false;
    }
    r->first_time_ns = r->first_time_ns < 0 ? frame.time_ns : r->first_time_ns;
    r->time_s = 1e-9 * (double)(frame.time_ns - r->first_time_ns);
    double start = now_ms(true);
    rlf_grid_from_surface(surface, &camera, r->regions, ROOM_REGIONS_MAX, &r->grid);
    r->grid.foreground.thickness = far_side_thicken(&r->far, surface, down);
    r->grid_ms = now_ms(true) - start;
    return true;
}

bool room_empty(room *r)
{
    rlf_synthetic_def def = source_def(RLF_SYNTHETIC_EMPTY, r->seed);
    rlf_source_destroy(&r->source);
    r->first_time_ns = -1;
    return rlf_synthetic_create(&def, &r->source) == RLF_OK;
}

void room_close(room *r)
{
    rlf_reconstruct_destroy(&r->reconstruct);
    far_side_destroy(&r->far);
    rlf_source_destroy(&r->source);
}

bool shower_open(shower *s, int32_t count, double seconds, rlf_pool *pool)
{
    rlf_world_def def = rlf_world_def_default();
    def.body_capacity = count;
    def.contact_capacity = 32 * count + 256;
    def.border = RLF_BORDER_EXTEND;
    def.pool = pool;
    memset(s, 0, sizeof(*s));
    s->count = count;
    s->is_alone = rlf_pool_worker_count(pool) == 1;
    s->empty_time = seconds;
    s->step_capacity = 2 * (int32_t)((seconds + SHOWER_SETTLE) * ROOM_HZ);
    s->step_ms = malloc((size_t)s->step_capacity * sizeof(*s->step_ms));
    s->grid_ms = malloc((size_t)s->step_capacity * sizeof(*s->grid_ms));
    s->inside = calloc((size_t)count, sizeof(*s->inside));
    s->passages = calloc((size_t)count, sizeof(*s->passages));
    for (int i = 0; i < 2; i++) {
        s->places[i] = calloc((size_t)count, sizeof(*s->places[i]));
    }
    return s->step_ms != NULL && s->grid_ms != NULL && s->inside != NULL && s->passages != NULL &&
           s->places[0] != NULL && s->places[1] != NULL &&
           rlf_world_create(&def, &s->world) == RLF_OK;
}

void shower_close(shower *s)
{
    rlf_world_destroy(&s->world);
    free(s->step_ms);
    free(s->grid_ms);
    free(s->inside);
    free(s->passages);
    free(s->places[0]);
    free(s->places[1]);
}

rlf_body_def shower_cube(int32_t index)
{
    rlf_body_def def = rlf_body_def_default();
    int32_t place = index % SHOWER_LAYER;
    int32_t column = place % LAYER_COLUMNS, row = place / LAYER_COLUMNS;
    def.position =
        rlf_vec3_make(0.18 * (column - 0.5 * (LAYER_COLUMNS - 1)), -0.4, 1.5 + 0.18 * row);
    def.orientation =
        rlf_quat_from_rotation_vector(rlf_vec3_make(0.1 * index, 0.2 * index, 0.3 * index));
    def.velocity = rlf_vec3_make(0, 1, 0);
    return def;
}

static bool drop_layer(shower *s)
{
    for (int32_t k = 0; k < SHOWER_LAYER && s->added < s->count; k++, s->added++) {
        rlf_body_def def = shower_cube(s->added);
        s->places[0][s->added] = def.position;
        if (rlf_world_add_body(s->world, &def, NULL) != RLF_OK) {
            return false;
        }
    }
    return true;
}

/* A surface serves two steps, which share what its grid took. */
static void advance(shower *s, const room *r)
{
    uint64_t allocs = rlf_alloc_count();
    double start = now_ms(s->is_alone);
    rlf_world_advance(s->world, &r->grid, 0.5 / ROOM_HZ);
    s->step_ms[s->step_count++] = now_ms(s->is_alone) - start + 0.5 * r->grid_ms;
    s->alloc_count += (int32_t)(rlf_alloc_count() - allocs);
    rlf_world_times t = rlf_world_get_times(s->world);
    s->times.wake_ms += t.wake_ms;
    s->times.surface_ms += t.surface_ms;
    s->times.pairs_ms += t.pairs_ms;
    s->times.impacts_ms += t.impacts_ms;
    s->times.solve_ms += t.solve_ms;
    s->times.move_ms += t.move_ms;
    s->times.sleep_ms += t.sleep_ms;
    s->times.publish_ms += t.publish_ms;
}

/* Whether the picture shows p to be in the solid of what stays: from its front to the depth that is
 * taken for its back. What else is solid there in truth, something hides. */
static bool is_seen_solid(const rlf_grid *grid, rlf_vec3 p)
{
    const rlf_grid_sheet *sheet = &grid->background;
    double u, v;
    if (!grid->project(grid->project_context, p, &u, &v)) {
        return false;
    }
    int32_t x = (int32_t)(u + 0.5), y = (int32_t)(v + 0.5);
    if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
        return false;
    }
    int32_t i = y * grid->width + x;
    double back = sheet->thickness != NULL ? (double)sheet->thickness[i] : sheet->default_thickness;
    double front = (double)sheet->depth[i];
    return front > 0.0 && p.z > front && p.z < front + back;
}

static void report_loss(const shower *s, const rlf_body_state *body, int32_t label, double distance)
{
    rlf_vec3 p = body->T_world_body.p;
    fprintf(stderr,
            "lost at %.2f s: cube %d of %d, %.3f m inside label %d, at (%.2f, %.2f, %.2f)\n",
            0.5 * s->step_count / ROOM_HZ, (int)body->id.index1, (int)s->count, -distance,
            (int)label, p.x, p.y, p.z);
}

/* A cube whose centre is inside what stays (floor, wall, furniture) for 0.3 s is lost, and so is
 * one that left the world. */
static void count_losses(shower *s, room *r)
{
    const rlf_snapshot *snapshot = rlf_world_get_snapshot(s->world);
    s->lost_count = s->added - snapshot->body_count;
    s->asleep_count = 0;
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        const rlf_body_state *body = &snapshot->bodies[i];
        int32_t *inside = &s->inside[body->id.index1 - 1];
        double distance = 1.0;
        rlf_vec3 normal;
        int32_t label = 0;
        rlf_synthetic_distance(r->source, body->T_world_body.p, &distance, &normal, &label);
        bool is_inside = distance < 0.0 && label < RLF_SYNTHETIC_LABEL_PERSON;
        *inside = is_inside || *inside >= SHOWER_LOST ? *inside + 1 : 0;
        s->lost_count += *inside >= SHOWER_LOST;
        if (*inside == SHOWER_LOST) {
            s->hidden_count += !is_seen_solid(&r->grid, body->T_world_body.p);
            report_loss(s, body, label, distance);
        }
        s->asleep_count += body->is_asleep;
    }
}

/* Contacts of a pair are listed side by side. */
static void count_deep(shower *s)
{
    const rlf_snapshot *snapshot = rlf_world_get_snapshot(s->world);
    uint64_t last = 0;
    for (int32_t i = 0; i < snapshot->contact_count; i++) {
        const rlf_contact *c = &snapshot->contacts[i];
        uint64_t pair = (uint64_t)c->body.index1 << 32 | c->other_body.index1;
        if (c->other == RLF_CONTACT_BODY && c->separation < -SHOWER_DEEP && pair != last) {
            s->deep_sum++;
            last = pair;
        }
    }
}

bool shower_step(shower *s, room *r)
{
    int32_t frame = s->step_count / 2;
    if (frame % SHOWER_LAYER_FRAMES == 0 && !drop_layer(s)) {
        return false;
    }
    s->grid_ms[frame] = r->grid_ms;
    advance(s, r);
    shower_note_places(s);
    advance(s, r);
    shower_look_for_passages(s, r);
    count_losses(s, r);
    count_deep(s);
    return true;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* When the last layer has come down, s. */
static double poured_time(const shower *s)
{
    int32_t layers = (s->count + SHOWER_LAYER - 1) / SHOWER_LAYER;
    return (double)(layers - 1) * SHOWER_LAYER_FRAMES / ROOM_HZ + SHOWER_FALL;
}

static int32_t step_at(const shower *s, double time)
{
    return (int32_t)rlf_clamp(time * 2.0 * ROOM_HZ + 0.5, 0.0, s->step_count);
}

shower_cost shower_cost_of(const shower *s, shower_phase phase)
{
    shower_cost cost = {0};
    double end = s->empty_time + SHOWER_SETTLE;
    const double times[SHOWER_PHASES][2] = {
        {0.0, rlf_min(poured_time(s), s->empty_time)},
        {rlf_min(poured_time(s), s->empty_time), s->empty_time},
        {end - SHOWER_REST, end},
    };
    int32_t begin = step_at(s, times[phase][0]), count = step_at(s, times[phase][1]) - begin;
    double *sorted = malloc((size_t)(count + 1) * sizeof(*sorted));
    if (sorted != NULL && count > 0) {
        memcpy(sorted, s->step_ms + begin, (size_t)count * sizeof(*sorted));
        qsort(sorted, (size_t)count, sizeof(*sorted), compare);
        for (int32_t i = 0; i < count; i++) {
            cost.mean_ms += sorted[i] / count;
        }
        cost.step_count = count;
        cost.median_ms = sorted[(count - 1) / 2];
        cost.p95_ms = sorted[(int32_t)(0.95 * (count - 1))];
    }
    free(sorted);
    return cost;
}

shower_cost shower_worst_cost(const shower *s)
{
    shower_cost worst = {0};
    for (shower_phase phase = 0; phase < SHOWER_PHASES; phase++) {
        shower_cost cost = shower_cost_of(s, phase);
        worst = cost.median_ms > worst.median_ms ? cost : worst;
    }
    return worst;
}

double shower_worst_step(const shower *s)
{
    double worst = 0.0;
    for (int32_t i = 0; i < s->step_count; i++) {
        worst = rlf_max(worst, s->step_ms[i]);
    }
    return worst;
}

double shower_busiest_second(const shower *s)
{
    double worst = 0.0, sum = 0.0;
    for (int32_t i = 0; i < s->step_count; i++) {
        sum += s->step_ms[i] - (i >= 2 * ROOM_HZ ? s->step_ms[i - 2 * ROOM_HZ] : 0.0);
        worst = i >= 2 * ROOM_HZ - 1 && sum > worst ? sum : worst;
    }
    return worst / (2.0 * ROOM_HZ);
}

double shower_grid_mean(const shower *s)
{
    double sum = 0.0;
    for (int32_t i = 0; i < s->step_count / 2; i++) {
        sum += s->grid_ms[i];
    }
    return s->step_count > 0 ? sum / s->step_count : 0.0;
}
