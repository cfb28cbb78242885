/* The regions of a layer: its support planes, and the things that are left. */
#include "surface/objects/objects.h"

#include "kernel/kernel.h"

#include <string.h>

enum { PATCHES = 80 }; /* in a row of a grid */

rlf_objects rlf_objects_layout(const image_grid *grid)
{
    rlf_objects o = {.side = 2 * ((grid->width + 2 * PATCHES - 1) / (2 * PATCHES))};
    o.side = o.side < 4 ? 4 : o.side;
    o.stride = o.side / 4;
    o.width = (grid->width + o.side - 1) / o.side;
    o.height = (grid->height + o.side - 1) / o.side;
    return o;
}

void rlf_objects_reset(rlf_objects *objects, int32_t count)
{
    if (objects != NULL) {
        memset(objects->patch, 0,
               (size_t)(objects->width * objects->height) * sizeof *objects->patch);
        memset(objects->support, 0, (size_t)count);
        objects->count = 0;
    }
}

/* ---- contacts ----
 *
 * Where one thing touches another: two points of one convex thing are both behind the other's
 * tangent plane (Stein et al. 2014). At a concave contact both are in front of it, and at a depth
 * step one is. */

static const float SIGMAS = 4.0f;       /* in front of the other's tangent plane ... */
static const float LEAST_SLOPE = 0.25f; /* ... and by this much of the way between them */
/* What was one thing, or two, in the image before needs so many times as much to become another. */
static const float STAYS = 1.4f;

/* Pixels i and j, on both sides of a third, are of two things. */
static bool is_contact(const image_grid *grid, const rlf_layer_in *in, rlf_kernel_noise noise,
                       int32_t i, int32_t j)
{
    float zi = in->depth[i], zj = in->depth[j];
    if (!(zi > 0.0f) || !(zj > 0.0f)) {
        return false;
    }
    float d[3] = {zj * grid->ray_x[j] - zi * grid->ray_x[i],
                  zj * grid->ray_y[j] - zi * grid->ray_y[i], zj - zi};
    float above_i = 0.0f, above_j = 0.0f, way = 0.0f;
    for (int k = 0; k < 3; k++) {
        above_i += d[k] * in->normal[k][i];
        above_j -= d[k] * in->normal[k][j];
        way += d[k] * d[k];
    }
    float above = above_i > above_j ? above_i : above_j;
    if (in->previous_label != NULL) {
        above *= in->previous_label[i] == in->previous_label[j] ? 1.0f / STAYS : STAYS;
    }
    return above > SIGMAS * rlf_kernel_sigma(noise, zi) &&
           above * above > LEAST_SLOPE * LEAST_SLOPE * way;
}

/* Links of pixel i to pixels that are linked still, and were not another thing's. */
static uint8_t cut_links(const rlf_reconstruct *stage, const rlf_layer_in *in, int32_t i)
{
    const uint8_t *links = stage->work.links;
    int32_t width = stage->grid.width, link = links[i];
    const int32_t bits[2] = {RLF_LINK_LEFT, RLF_LINK_UP};
    const int32_t step[2] = {-1, -width};
    for (int k = 0; k < 2; k++) {
        if (link & bits[k]) {
            int32_t j = i + step[k];
            bool was_one = in->previous_label == NULL || in->previous_label[i] == 0 ||
                           in->previous_label[j] == 0 ||
                           in->previous_label[i] == in->previous_label[j];
            link &= links[j] == 0 || !was_one ? ~bits[k] : ~0;
        }
    }
    return (uint8_t)link;
}

typedef struct contact_job {
    rlf_reconstruct *stage;
    const rlf_layer_in *in;
    rlf_kernel_noise noise;
    int32_t reach; /* pixels, from a contact to both sides */
} contact_job;

/* Two things meet at pixel i = (x, y), across or down. */
static bool is_cut(const contact_job *job, int32_t i, int32_t x, int32_t y)
{
    const image_grid *grid = &job->stage->grid;
    const uint8_t *support = job->stage->objects->support;
    int32_t across = job->reach, down = job->reach * grid->width;
    bool is_wide = x >= job->reach && x + job->reach < grid->width &&
                   support[i - across] + support[i + across] == 0;
    bool is_high = y >= job->reach && y + job->reach < grid->height &&
                   support[i - down] + support[i + down] == 0;
    return (is_wide && is_contact(grid, job->in, job->noise, i - across, i + across)) ||
           (is_high && is_contact(grid, job->in, job->noise, i - down, i + down));
}

static void cut_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const contact_job *job = context;
    int32_t width = job->stage->grid.width;
    uint8_t *links = job->stage->work.links;
    for (int32_t y = begin; y < end; y++) {
        for (int32_t x = 0; x < width; x++) {
            int32_t i = y * width + x;
            bool is_off =
                job->stage->objects->support[i] != 0 || (links[i] != 0 && is_cut(job, i, x, y));
            links[i] = is_off ? 0 : links[i];
        }
    }
}

/* Takes pixels out of work.links where things touch, and on the support planes. */
static void cut_contacts(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    contact_job job = {.stage = stage,
                       .in = in,
                       .noise = rlf_kernel_noise_make(&stage->def.rig.noise),
                       .reach = stage->objects->side / 2};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, cut_rows, &job);
    uint8_t *links = stage->work.links;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        links[i] = links[i] != 0 ? cut_links(stage, in, i) : 0;
    }
}

/* ---- things ---- */

/* Numbers of what is large enough, into work.component: support planes first. Other pixels have 0.
 * Returns the highest number. */
static int32_t number_pixels(rlf_reconstruct *stage)
{
    const rlf_work *work = &stage->work;
    const rlf_objects *o = stage->objects;
    int32_t end = work->runs.first[stage->grid.height];
    int32_t components = 0, next = o->count;
    for (int32_t r = 0; r < end; r++) {
        int32_t c = work->runs.run[r].component;
        if (c > components) {
            components = c;
            work->map[c] = work->size[c] >= stage->def.min_region_points ? ++next : 0;
        }
    }
    for (int32_t i = 0; i < stage->grid.count; i++) {
        work->component[i] = o->support[i];
    }
    for (int32_t y = 0; y < stage->grid.height; y++) {
        int32_t *row = work->component + (ptrdiff_t)y * stage->grid.width;
        for (int32_t r = work->runs.first[y]; r < work->runs.first[y + 1]; r++) {
            const rlf_run *run = &work->runs.run[r];
            for (int32_t x = run->x0; x < run->x1; x++) {
                row[x] = work->map[run->component];
            }
        }
    }
    return next;
}

/* Pixel i takes the number of pixel j when that is nearer to where it came from. */
static void spread(rlf_reconstruct *stage, int32_t i, int32_t j, int32_t link, int32_t least)
{
    uint8_t *distance = stage->objects->distance;
    int32_t *number = stage->work.component;
    if (number[j] >= least && link != 0 && distance[j] + 1 < distance[i]) {
        distance[i] = (uint8_t)(distance[j] + 1);
        number[i] = number[j];
    }
}

static void spread_to(rlf_reconstruct *stage, int32_t i, bool is_back, int32_t least)
{
    const uint8_t *links = stage->objects->links;
    const int32_t width = stage->grid.width, x = i % width, step = is_back ? 1 : -1;
    const bool is_in[2] = {is_back ? x + 1 < width : x > 0,
                           is_back ? i + width < stage->grid.count : i >= width};
    const int32_t bit[2] = {RLF_LINK_LEFT, RLF_LINK_UP}, way[2] = {step, step * width};
    for (int k = 0; k < 2; k++) {
        if (is_in[k]) {
            int32_t link = links[is_back ? i + way[k] : i] & bit[k];
            spread(stage, i, i + way[k], least > 1 ? link : 1, least);
        }
    }
}

/* Seen pixels without a number take the nearest one from `least` on, in passes of a distance
 * transform (Rosenfeld and Pfaltz 1966): over links, or over anything from 1 on. */
static void grow(rlf_reconstruct *stage, const float *depth, int32_t least)
{
    enum { PASSES = 4, FAR = 254 };
    int32_t *pixel = stage->work.parent, count = 0;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        bool is_open = stage->work.component[i] == 0 && depth[i] > 0.0f;
        stage->objects->distance[i] = stage->work.component[i] > 0 ? 0 : FAR;
        pixel[count] = i;
        count += is_open ? 1 : 0;
    }
    for (int32_t pass = 0; pass < PASSES; pass++) {
        for (int32_t k = 0; k < count; k++) {
            bool is_back = pass % 2 == 1;
            spread_to(stage, pixel[is_back ? count - 1 - k : k], is_back, least);
        }
    }
}

/* Pixels get the numbers of support planes and of parts of things. */
static void find_parts(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    const rlf_work *work = &stage->work;
    rlf_objects *o = stage->objects;
    rlf_segment_links(stage, RLF_SEGMENT_NOISE, in->depth, in->mask, in->spans);
    memcpy(o->links, work->links, (size_t)stage->grid.count);
    cut_contacts(stage, in);
    rlf_components_find(stage, in->spans);
    o->components = number_pixels(stage);
    grow(stage, in->depth, o->count + 1);
    grow(stage, in->depth, 1);
    for (int32_t i = 0; i < stage->grid.count; i++) {
        o->links[i] |= work->links[i] == 0 ? RLF_OBJECT_CUT : 0;
    }
    if (in->kept != NULL) {
        memcpy(in->kept, work->component, (size_t)stage->grid.count * sizeof *in->kept);
    }
}

void rlf_objects_step(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    if (in->steps_done == 0) {
        rlf_supports_find(stage, in);
        rlf_supports_mark(stage, in);
    } else {
        find_parts(stage, in);
    }
}

int32_t rlf_objects_find(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    rlf_work *work = &stage->work;
    rlf_layer_in step = *in;
    for (; step.steps_done < RLF_OBJECT_STEPS; step.steps_done++) {
        rlf_objects_step(stage, &step);
    }
    if (in->steps_done == RLF_OBJECT_STEPS) {
        memcpy(work->component, in->kept, (size_t)stage->grid.count * sizeof *in->kept);
    }
    int32_t components = stage->objects->components;
    rlf_objects_join(stage, in, components);
    rlf_runs_find(stage, work->component);
    memset(work->size, 0, (size_t)(components + 1) * sizeof *work->size);
    for (int32_t r = 0; r < work->runs.first[stage->grid.height]; r++) {
        work->size[work->runs.run[r].component] += work->runs.run[r].x1 - work->runs.run[r].x0;
    }
    return components;
}

rlf_objects *objects_allocate(rlf_arena *arena, const rlf_reconstruct_def *def,
                              const image_grid *grid)
{
    if (def->background_segment != RLF_SEGMENT_OBJECTS ||
        def->background_method == RLF_BACKGROUND_OFF) {
        return NULL;
    }
    rlf_objects o = rlf_objects_layout(grid);
    size_t n = (size_t)grid->count, patches = (size_t)(o.width * o.height);
    rlf_objects *objects = arena_take(arena, 1, sizeof *objects);
    o.patch = arena_take(arena, patches, sizeof *o.patch);
    o.near = arena_take(arena, patches, sizeof *o.near);
    o.scratch[0] = arena_take(arena, patches, sizeof *o.scratch[0]);
    o.scratch[1] = arena_take(arena, patches, sizeof *o.scratch[1]);
    o.queue = arena_take(arena, patches, sizeof *o.queue);
    o.sum = arena_take(arena, RLF_OBJECTS_SUMMED, sizeof *o.sum);
    o.border = arena_take(arena, RLF_BORDERS, sizeof *o.border);
    o.support = arena_take(arena, n, 1);
    o.links = arena_take(arena, n, 1);
    o.distance = arena_take(arena, n, 1);
    if (objects != NULL) {
        *objects = o;
    }
    return objects;
}
