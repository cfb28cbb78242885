/* The live surface and the showers of bench_physics. */
#define _POSIX_C_SOURCE 200809L
#include "bench_physics.h"

#include "pipeline/grid.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define EMPTY_FRAMES 8   /* the background needs five */
#define LAYER_COLUMNS 14 /* cubes of a layer side by side */

bool room_open(room *r, uint64_t seed, int32_t scale_factor)
{
    memset(r, 0, sizeof(*r));
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.seed = seed;
    def.frame_count = -1;
    def.enable_color = false;
    def.enable_truth = false;
    if (rlf_synthetic_create(&def, &r->source) != RLF_OK) {
        return false;
    }
    rlf_reconstruct_def reconstruct =
        rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rlf_source_get_info(r->source)->rig);
    reconstruct.scale_factor = scale_factor;
    bool is_good = rlf_reconstruct_create(&reconstruct, &r->reconstruct) == RLF_OK;
    for (int32_t k = 0; k < EMPTY_FRAMES && is_good; k++) {
        is_good = room_next(r);
    }
    return is_good;
}

bool room_next(room *r)
{
    const rlf_pose camera = rlf_pose_identity();
    const rlf_surface *surface = NULL;
    rlf_frame frame;
    if (rlf_source_next(r->source, &frame) != RLF_OK ||
        rlf_reconstruct_process(r->reconstruct, &frame, &surface) != RLF_OK) {
        return false;
    }
    grid_from_surface(surface, &camera, r->regions, ROOM_REGIONS_MAX, &r->grid);
    return true;
}

void room_close(room *r)
{
    rlf_reconstruct_destroy(&r->reconstruct);
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
    s->step_capacity = 2 * (int32_t)(seconds * ROOM_HZ);
    s->step_ms = malloc((size_t)s->step_capacity * sizeof(*s->step_ms));
    s->inside = calloc((size_t)count, sizeof(*s->inside));
    return s->step_ms != NULL && s->inside != NULL && rlf_world_create(&def, &s->world) == RLF_OK;
}

void shower_close(shower *s)
{
    rlf_world_destroy(&s->world);
    free(s->step_ms);
    free(s->inside);
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
        if (rlf_world_add_body(s->world, &def, NULL) != RLF_OK) {
            return false;
        }
    }
    return true;
}

/* Of one worker its own time, whoever else uses the machine; of several that on the wall. */
static double now_ms(bool is_alone)
{
    struct timespec t;
    clock_gettime(is_alone ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void advance(shower *s, const rlf_grid *grid)
{
    uint64_t allocs = rlf_alloc_count();
    double start = now_ms(s->is_alone);
    rlf_world_advance(s->world, grid, 0.5 / ROOM_HZ);
    s->step_ms[s->step_count++] = now_ms(s->is_alone) - start;
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

bool shower_step(shower *s, room *r)
{
    int32_t frame = s->step_count / 2;
    if (frame % SHOWER_LAYER_FRAMES == 0 && !drop_layer(s)) {
        return false;
    }
    advance(s, &r->grid);
    advance(s, &r->grid);
    count_losses(s, r);
    return true;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double shower_percentile(const shower *s, double percent)
{
    double *sorted = malloc((size_t)s->step_count * sizeof(*sorted));
    if (sorted == NULL || s->step_count == 0) {
        free(sorted);
        return 0.0;
    }
    memcpy(sorted, s->step_ms, (size_t)s->step_count * sizeof(*sorted));
    qsort(sorted, (size_t)s->step_count, sizeof(*sorted), compare);
    double value = sorted[(int32_t)(percent / 100.0 * (s->step_count - 1))];
    free(sorted);
    return value;
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
