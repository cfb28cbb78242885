/* Which neighbouring pixels belong together, by eq. 4.4 or the noise-scaled criterion, and what
 * hangs together by that: connected components, run by run, with union-find (Rosenfeld and Pfaltz
 * 1966; runs: He, Chao and Suzuki 2008). O(pixels), whatever their number and shape. */
#include "surface/depth_step.h"
#include "surface/steps.h"

static inline bool is_member(const float *depth, const uint8_t *mask, ptrdiff_t i)
{
    return depth[i] > 0.0f && (mask == NULL || mask[i] != 0);
}

static inline bool is_near(float a, float b, float tau)
{
    return rlf_kernel_abs(a - b) <= tau;
}

/* One kernel of eq. 4.4: pixel i against its neighbour; beyond the border there is nothing to
 * differ.
 */
static bool agrees(bool inside, float tau, const float *depth, const uint8_t *mask, ptrdiff_t i,
                   ptrdiff_t next)
{
    return !inside || (is_member(depth, mask, next) && is_near(depth[i], depth[next], tau));
}

void rlf_segment_thesis_bits(const image_grid *grid, double tau, const float *depth,
                             const uint8_t *mask, uint8_t *bits)
{
    float limit = (float)tau;
    int32_t width = grid->width;
    for (int32_t y = 0; y < grid->height; y++) {
        for (int32_t x = 0; x < width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * width + x;
            bool right = x + 1 < width, down = y + 1 < grid->height;
            bits[i] = is_member(depth, mask, i) && agrees(right, limit, depth, mask, i, i + 1) &&
                      agrees(down, limit, depth, mask, i, i + width);
        }
    }
}

static void thesis_links(const rlf_reconstruct *stage, const float *depth, const uint8_t *mask)
{
    const image_grid *grid = &stage->grid;
    uint8_t *bits = stage->work.bits;
    rlf_segment_thesis_bits(grid, stage->def.segment_tau_m, depth, mask, bits);
    for (int32_t y = 0; y < grid->height; y++) {
        for (int32_t x = 0; x < grid->width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            int link = RLF_LINK_MEMBER;
            link |= x > 0 && bits[i - 1] ? RLF_LINK_LEFT : 0;
            link |= y > 0 && bits[i - grid->width] ? RLF_LINK_UP : 0;
            stage->work.links[i] = (uint8_t)(bits[i] ? link : 0);
        }
    }
}

typedef struct links_job {
    const rlf_reconstruct *stage;
    const float *depth;
    const uint8_t *mask;
    const rlf_span *spans;
    rlf_kernel_links params;
} links_job;

static void noise_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const links_job *job = context;
    const image_grid *grid = &job->stage->grid;
    const rlf_work *work = &job->stage->work;
    for (int32_t y = begin; y < end; y++) {
        const rlf_span span = job->spans != NULL ? job->spans[y] : (rlf_span){0, grid->width};
        ptrdiff_t row = (ptrdiff_t)y * grid->width + span.x0;
        const rlf_kernel_links_in in = {
            .depth = job->depth + row,
            .above = y > 0 ? job->depth + row - grid->width : work->zeros,
            .mask = job->mask != NULL ? job->mask + row : work->ones,
            .mask_above = job->mask != NULL && y > 0 ? job->mask + row - grid->width : work->ones,
            .count = span.x1 - span.x0};
        rlf_kernel_link_row(&job->params, &in, work->links + row);
    }
}

void rlf_segment_links(const rlf_reconstruct *stage, rlf_segment_method method, const float *depth,
                       const uint8_t *mask, const rlf_span *spans)
{
    if (method == RLF_SEGMENT_THESIS) {
        thesis_links(stage, depth, mask);
        return;
    }
    links_job job = {.stage = stage, .depth = depth, .mask = mask, .spans = spans};
    const depth_step step = depth_step_make(&stage->def.rig.noise, stage->grid.camera.fx);
    job.params.noise = step.noise;
    job.params.sigmas = DEPTH_STEP_DIFFERENCE;
    job.params.slope = DEPTH_STEP_STEEPEST * step.footprint;
    job.params.step_m = mask != NULL ? RLF_PERSON_STEP_M : 0.0f;
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, noise_rows, &job);
}

/* Label that a lost pixel takes: of its right, lower or lower right neighbour, one within tau
 * first. 0 when none has a label. */
static int32_t grown_label(const image_grid *grid, float tau, const float *depth,
                           const int32_t *label, ptrdiff_t i)
{
    int32_t x = (int32_t)(i % grid->width), y = (int32_t)(i / grid->width);
    bool right = x + 1 < grid->width, down = y + 1 < grid->height;
    const bool inside[3] = {right, down, right && down};
    const ptrdiff_t next[3] = {i + 1, i + grid->width, i + grid->width + 1};
    int32_t any = 0;
    for (int k = 0; k < 3; k++) {
        int32_t candidate = inside[k] ? label[next[k]] : 0;
        if (candidate > 0 && is_near(depth[i], depth[next[k]], tau)) {
            return candidate;
        }
        any = any == 0 && candidate > 0 ? candidate : any;
    }
    return any;
}

/* In raster order: the neighbours that a pixel reads have not grown yet, so that labels grow by one
 * pixel only. */
void rlf_segment_dilate(const image_grid *grid, double tau, const float *depth, const uint8_t *mask,
                        int32_t *label)
{
    for (int32_t i = 0; i < grid->count; i++) {
        if (label[i] == 0 && is_member(depth, mask, i)) {
            label[i] = grown_label(grid, (float)tau, depth, label, i);
        }
    }
}

/* ---- components ---- */

int32_t rlf_component_root(int32_t *parent, int32_t a)
{
    while (parent[a] != a) {
        parent[a] = parent[parent[a]]; /* path halving */
        a = parent[a];
    }
    return a;
}

/* The smaller root wins, so that a component is known by its first run in raster order. */
static void join(int32_t *parent, int32_t a, int32_t b)
{
    a = rlf_component_root(parent, a);
    b = rlf_component_root(parent, b);
    parent[a < b ? b : a] = a < b ? a : b;
}

static int32_t find_runs(const uint8_t *links, rlf_span span, rlf_run *runs, int32_t count)
{
    int32_t x = rlf_kernel_next_mark(links, span.x0, span.x1);
    while (x < span.x1) {
        int32_t begin = x++;
        while (x < span.x1 && (links[x] & RLF_LINK_LEFT) != 0) {
            x++;
        }
        runs[count++] = (rlf_run){begin, x, 0};
        x = rlf_kernel_next_mark(links, x, span.x1);
    }
    return count;
}

/* Joins run r to the runs above that its pixels are linked to; *above is the first that can touch
 * it, and only moves on. Pixels under one and the same run say the same, but for its ends. */
static void join_run(const rlf_work *work, const uint8_t *links, int32_t r, int32_t end,
                     int32_t *above)
{
    const rlf_run *runs = work->runs.run;
    int32_t a = *above, x = runs[r].x0;
    while (x < runs[r].x1) {
        while (a < end && runs[a].x1 < x) {
            a++;
        }
        if (a == end) {
            break;
        }
        int32_t next = x + 1;
        if (links[x] & RLF_LINK_UP) {
            int32_t over = runs[a].x1 <= x ? a + 1 : a;
            join(work->parent, r, over);
            next = runs[over].x1 - 1 > next ? runs[over].x1 - 1 : next;
        }
        x = next;
    }
    *above = a;
}

int32_t rlf_components_find(const rlf_reconstruct *stage, const rlf_span *spans)
{
    const rlf_work *work = &stage->work;
    int32_t width = stage->grid.width, height = stage->grid.height;
    const rlf_span whole = {0, width};
    int32_t count = 0;
    for (int32_t y = 0; y < height; y++) {
        const uint8_t *links = work->links + (ptrdiff_t)y * width;
        int32_t above = y > 0 ? work->runs.first[y - 1] : 0, end = count;
        work->runs.first[y] = count;
        count = find_runs(links, spans != NULL ? spans[y] : whole, work->runs.run, count);
        for (int32_t r = end; r < count; r++) {
            work->parent[r] = r;
            join_run(work, links, r, end, &above);
        }
    }
    work->runs.first[height] = count;
    int32_t components = 0;
    for (int32_t r = 0; r < count; r++) {
        rlf_run *run = &work->runs.run[r];
        int32_t root = rlf_component_root(work->parent, r);
        if (root == r) {
            run->component = ++components;
            work->size[components] = 0;
        }
        run->component = work->runs.run[root].component;
        work->size[run->component] += run->x1 - run->x0;
    }
    return components;
}

void rlf_runs_find(rlf_reconstruct *stage, const int32_t *number)
{
    const rlf_runs *runs = &stage->work.runs;
    int32_t width = stage->grid.width, count = 0;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        const int32_t *row = number + (ptrdiff_t)y * width;
        runs->first[y] = count;
        for (int32_t x = 0; x < width; x++) {
            if (row[x] == 0) {
                continue;
            }
            if (x > 0 && row[x] == row[x - 1]) {
                runs->run[count - 1].x1 = x + 1;
            } else {
                runs->run[count++] = (rlf_run){x, x + 1, row[x]};
            }
        }
    }
    runs->first[stage->grid.height] = count;
}
