/* Velocity of what is not rigid, limb by limb: a person.
 *
 * The region is cut into square cells of a limb's width. Each has one velocity: several guesses
 * (the region's motion, the frame before's, the neighbour's, none) are tried against the frame
 * before, and the best is improved by Gauss and Newton. A guess matters because a limb that crosses
 * the picture moves by as much as its own width from frame to frame. */
#include "surface/motion/keyframe.h"
#include "surface/motion/motion.h"

#include <math.h>

enum {
    SIDE_SAMPLES = 8,              /* in a cell, and its least side in pixels */
    MOST_SAMPLES = RLF_FLOW_BATCH, /* SIDE_SAMPLES squared */
    LEAST_SAMPLES = 6,             /* that must agree */
    PASSES = 3,
    SEARCH = 4 /* steps to each side */
};

static const float fastest = 5.0f;  /* m/s */
static const float reach_m = 0.01f; /* beyond the noise: from here on a residual is all wrong */
/* Squared sum of 3 normal variables that chance exceeds once in 400 times. */
static const float significant_3 = 14.2f;

/* A square of the image in one region. */
typedef struct rlf_cell {
    rlf_velocity velocity;
    float depth; /* of the limb that it holds, metres; 0 = none of the region */
    int32_t state;
} rlf_cell;

/* What is known of a cell: nothing of the region, nothing that fits, it rests, it moves with the
 * region, it moves by itself. */
enum { RLF_CELL_EMPTY = 0, RLF_CELL_UNKNOWN, RLF_CELL_STILL, RLF_CELL_WHOLE, RLF_CELL_MOVES };

/* The cells of one region. */
typedef struct rlf_cell_grid {
    const rlf_flow *job;
    const rlf_region *region;
    const rlf_twist *twist;
    bool moves; /* the twist is not 0 */
    rlf_cell *cells;
    int32_t size, columns, rows;
    int32_t number; /* of the region, in the runs */
} rlf_cell_grid;

/* The pixels of a cell that show its limb. */
typedef struct samples {
    rlf_kernel_flow_samples s;
    int32_t pixel[MOST_SAMPLES];
    int32_t count;
    float limit;    /* of the squared residual, m^2 */
    float variance; /* of a residual by noise, m^2 */
} samples;

/* What a velocity leaves of the samples. */
typedef struct residuals {
    float e[MOST_SAMPLES];
    int32_t is_seen[MOST_SAMPLES];
} residuals;

typedef struct velocity_guess {
    rlf_velocity of;
    float cost; /* < 0: not yet known */
} velocity_guess;

static float depth_of(const rlf_cell_grid *g, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * g->job->stage->grid.width + x;
    bool own = g->job->now->label[i] == g->region->label;
    return own && g->job->now->reason[i] == RLF_REASON_OK ? g->job->now->depth[i] : 0.0f;
}

/* Median of what a few pixels of the cell show: the limb that fills most of it. */
static float limb_depth(const rlf_cell_grid *g, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    enum { SIDE = 4 };
    float found[SIDE * SIDE];
    int32_t count = 0;
    for (int32_t k = 0; k < SIDE * SIDE; k++) {
        int32_t x = x0 + (2 * (k % SIDE) + 1) * (x1 - x0) / (2 * SIDE);
        int32_t y = y0 + (2 * (k / SIDE) + 1) * (y1 - y0) / (2 * SIDE);
        float z = depth_of(g, x, y);
        if (!(z > 0.0f)) {
            continue;
        }
        int32_t at = count++;
        for (; at > 0 && found[at - 1] > z; at--) {
            found[at] = found[at - 1];
        }
        found[at] = z;
    }
    return count > 0 ? found[count / 2] : 0.0f;
}

static void add_sample(const rlf_cell_grid *g, int32_t x, int32_t y, samples *out)
{
    const image_grid *grid = &g->job->stage->grid;
    const rlf_slot *now = g->job->now;
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    float z = now->depth[i], x_ray = grid->ray_x[i], y_ray = grid->ray_y[i];
    float n[3] = {now->normal[0][i], now->normal[1][i], now->normal[2][i]};
    float facing = -(n[0] * x_ray + n[1] * y_ray + n[2]);
    if (!(facing > 0.0f)) {
        return;
    }
    float sigma = rlf_kernel_sigma(g->job->noise, z) * facing;
    out->variance += 2.0f * sigma * sigma;
    int32_t k = out->count++;
    out->pixel[k] = (int32_t)i;
    out->s.column[k] = (float)x;
    out->s.row[k] = (float)y;
    out->s.ray_x[k] = x_ray;
    out->s.ray_y[k] = y_ray;
    out->s.x[k] = z * x_ray;
    out->s.y[k] = z * y_ray;
    out->s.z[k] = z;
    out->s.nx[k] = n[0];
    out->s.ny[k] = n[1];
    out->s.nz[k] = n[2];
}

static void take_samples(const rlf_cell_grid *g, int32_t x0, int32_t y0, float depth, samples *out)
{
    const rlf_region *region = g->region;
    int32_t step = (g->size + SIDE_SAMPLES - 1) / SIDE_SAMPLES;
    out->count = 0;
    out->variance = 0.0f;
    for (int32_t y = y0; y < y0 + g->size && y < region->y1; y += step) {
        for (int32_t x = x0; x < x0 + g->size && x < region->x1; x += step) {
            float z = depth_of(g, x, y);
            if (z > 0.0f && rlf_kernel_abs(z - depth) < rlf_flow_limb_m) {
                add_sample(g, x, y, out);
            }
        }
    }
    out->variance /= (float)(out->count > 0 ? out->count : 1);
    float reach = reach_m + 3.0f * sqrtf(out->variance);
    out->limit = reach * reach;
}

/* Distance along the normal between the samples first <= k < end taken back by v dt and what was
 * seen there. */
static void find_residuals(const rlf_cell_grid *g, const samples *all, rlf_velocity v,
                           int32_t first, int32_t end, residuals *out)
{
    const rlf_flow *job = g->job;
    const float step[3] = {v.v[0] * job->dt, v.v[1] * job->dt, v.v[2] * job->dt};
    rlf_kernel_flow_residuals(&job->view, &all->s, step, first, end - first, out->e, out->is_seen);
}

/* Sum of squared residuals, each limited: what does not fit at all counts like what fits badly. But
 * the sensor drops a pixel now and then: a few that were not seen count like noise. Stops where it
 * is more than `most`: sums only grow. */
static float cost_of(const rlf_cell_grid *g, const samples *all, rlf_velocity v, float most)
{
    float cost = 0.0f;
    int32_t lost = 0;
    residuals r;
    for (int32_t k = 0; k < all->count && cost <= most; k++) {
        if (k % RLF_FLOW_LANES == 0) {
            int32_t end = k + RLF_FLOW_LANES < all->count ? k + RLF_FLOW_LANES : all->count;
            find_residuals(g, all, v, k, end, &r);
        }
        float e = r.e[k % RLF_FLOW_LANES];
        if (r.is_seen[k % RLF_FLOW_LANES]) {
            cost += e * e < all->limit ? e * e : all->limit;
        } else {
            cost += 5 * ++lost > all->count ? all->limit : all->variance;
        }
    }
    return cost;
}

/* One step of Gauss and Newton; returns how many samples agree. */
static int32_t improve(const rlf_cell_grid *g, const samples *all, float limit, rlf_velocity *v)
{
    rlf_mat3 a = {{{0.0}}}, inverse;
    rlf_vec3 b = {0.0, 0.0, 0.0};
    int32_t count = 0;
    residuals r;
    find_residuals(g, all, *v, 0, all->count, &r);
    for (int32_t k = 0; k < all->count; k++) {
        const double e = r.e[k], n[3] = {all->s.nx[k], all->s.ny[k], all->s.nz[k]};
        if (!r.is_seen[k] || r.e[k] * r.e[k] > limit) {
            continue;
        }
        for (int i = 0; i < 9; i++) {
            a.m[i / 3][i % 3] += n[i / 3] * n[i % 3];
        }
        b = rlf_mad(b, rlf_vec3_make(n[0], n[1], n[2]), e / (double)g->job->dt);
        count++;
    }
    for (int i = 0; i < 3; i++) {
        a.m[i][i] += (double)rlf_flow_ridge * count;
    }
    if (count >= LEAST_SAMPLES && rlf_mat3_invert(&a, &inverse)) {
        const rlf_vec3 more = rlf_mat3_mul_vec(&inverse, b);
        *v = rlf_velocity_make(more.x + (double)v->v[0], more.y + (double)v->v[1],
                               more.z + (double)v->v[2]);
    }
    return count;
}

/* Velocity and cost of the best of some guesses, improved. */
static velocity_guess fit_guesses(const rlf_cell_grid *g, const samples *all,
                                  const velocity_guess *guess, int32_t count)
{
    velocity_guess best = {guess[0].of, all->limit * (float)(all->count + 1)};
    for (int32_t k = 0; k < count; k++) {
        const float known = guess[k].cost;
        const float cost = known < 0.0f ? cost_of(g, all, guess[k].of, best.cost) : known;
        best = cost < best.cost ? (velocity_guess){guess[k].of, cost} : best;
    }
    velocity_guess better = best;
    int32_t agree = 0;
    for (int pass = 0; pass < PASSES; pass++) {
        agree = improve(g, all, pass == 0 ? 9.0f * all->limit : all->limit, &better.of);
    }
    better.cost = cost_of(g, all, better.of, best.cost);
    return agree >= LEAST_SAMPLES && better.cost < best.cost ? better : best;
}

static bool fits(const samples *all, float cost)
{
    return 4.0f * cost <= 3.0f * all->limit * (float)all->count;
}

/* What noise makes of the difference between two costs. */
static float tolerance_of(const samples *all)
{
    return significant_3 * rlf_flow_correlated * all->variance;
}

/* A limb that begins to swing, or comes from behind another, moves as nothing about it did a frame
 * ago: looks for where it was, to the sides. (Up and down, too, legs are found where they were not:
 * they are long.) */
static velocity_guess search(const rlf_cell_grid *g, const samples *all)
{
    velocity_guess guess[2 * SEARCH];
    int32_t count = 0;
    for (int32_t k = -SEARCH; k <= SEARCH; k++) {
        if (k != 0) {
            const rlf_velocity of = {{(float)k * rlf_flow_limb_m / g->job->dt, 0.0f, 0.0f}};
            guess[count++] = (velocity_guess){of, -1.0f};
        }
    }
    return fit_guesses(g, all, guess, count);
}

/* Rest and the region's motion are true until the noise cannot explain what they leave. Where both
 * are, a piece that is flat cannot tell, and moves with the region. */
static void fit_cell(const rlf_cell_grid *g, const samples *all, const rlf_cell *left,
                     rlf_cell *cell)
{
    const int32_t middle = all->count / 2, as_whole = g->moves ? RLF_CELL_WHOLE : RLF_CELL_STILL;
    const rlf_vec3 p = rlf_vec3_make(all->s.x[middle], all->s.y[middle], all->s.z[middle]);
    const rlf_vec3 v = rlf_twist_velocity(g->twist, p);
    const bool is_sure = rlf_length(rlf_sub(p, g->twist->centre)) < g->twist->reach;
    float *const *was = g->job->before->velocity;
    const int32_t i = all->pixel[middle];
    const rlf_velocity before = {{was[0][i], was[1][i], was[2][i]}};
    velocity_guess guess[4], still = {{{0.0f}}, 0.0f};
    velocity_guess whole = {rlf_velocity_make(v.x, v.y, v.z), 0.0f};
    still.cost = cost_of(g, all, still.of, INFINITY);
    whole.cost = g->moves ? cost_of(g, all, whole.of, INFINITY) : still.cost;
    cell->velocity = whole.of;
    cell->state = as_whole;
    /* no more than the noise; or what a keyframe tells, where nothing speaks against it */
    const float least = is_sure ? 0.75f * all->limit : all->variance;
    if (whole.cost <= least * (float)all->count) {
        return;
    }
    int32_t count = 2;
    guess[0] = whole;
    guess[1] = still;
    if (before.v[0] != 0.0f || before.v[1] != 0.0f || before.v[2] != 0.0f) {
        guess[count++] = (velocity_guess){before, -1.0f};
    }
    if (left != NULL && left->state == RLF_CELL_MOVES) {
        guess[count++] = (velocity_guess){left->velocity, -1.0f};
    }
    velocity_guess best = fit_guesses(g, all, guess, count);
    if (2.0f * best.cost > all->limit * (float)all->count) {
        const velocity_guess other = search(g, all);
        best = other.cost < best.cost ? other : best;
    }
    const float most = best.cost + tolerance_of(all);
    if (!fits(all, best.cost) || whole.cost > most) {
        cell->state = !fits(all, best.cost) ? RLF_CELL_UNKNOWN
                      : still.cost <= most  ? RLF_CELL_STILL
                                            : RLF_CELL_MOVES;
        cell->velocity = best.of;
    }
}

/* Mean velocity of the moving neighbours with the same limb; false when there are fewer than two.
 */
static bool neighbour_mean(const rlf_cell_grid *g, int32_t row, int32_t column, rlf_velocity *out)
{
    const rlf_cell *cell = &g->cells[row * g->columns + column];
    float count = 0.0f;
    *out = (rlf_velocity){{0.0f}};
    for (int k = 0; k < 9; k++) {
        int32_t r = row + k / 3 - 1, c = column + k % 3 - 1;
        if (k == 4 || r < 0 || c < 0 || r >= g->rows || c >= g->columns) {
            continue;
        }
        const rlf_cell *next = &g->cells[r * g->columns + c];
        if (next->state < RLF_CELL_WHOLE ||
            rlf_kernel_abs(next->depth - cell->depth) > 2.0f * rlf_flow_limb_m) {
            continue;
        }
        count += 1.0f;
        for (int d = 0; d < 3; d++) {
            out->v[d] += next->velocity.v[d];
        }
    }
    for (int d = 0; d < 3 && count > 1.0f; d++) {
        out->v[d] /= count;
    }
    return count > 1.0f;
}

/* What a piece cannot tell, its neighbours can: a cell that moves by itself starts again from their
 * mean, and keeps what comes of it if it fits as well. */
static void relax_cell(const rlf_cell_grid *g, int32_t row, int32_t column, samples *all)
{
    rlf_cell *cell = &g->cells[row * g->columns + column];
    velocity_guess guess = {.cost = -1.0f};
    if ((cell->state != RLF_CELL_MOVES && cell->state != RLF_CELL_UNKNOWN) ||
        !neighbour_mean(g, row, column, &guess.of)) {
        return;
    }
    take_samples(g, g->region->x0 + column * g->size, g->region->y0 + row * g->size, cell->depth,
                 all);
    const velocity_guess found = fit_guesses(g, all, &guess, 1);
    const float own = cost_of(g, all, cell->velocity, INFINITY);
    if (all->count >= LEAST_SAMPLES && fits(all, found.cost) &&
        found.cost <= own + tolerance_of(all)) {
        cell->velocity = found.of;
        cell->state = RLF_CELL_MOVES;
    }
}

static void relax(const rlf_cell_grid *g)
{
    samples all;
    for (int32_t row = g->rows - 1; row >= 0; row--) {
        for (int32_t column = g->columns - 1; column >= 0; column--) {
            relax_cell(g, row, column, &all);
        }
    }
}

static void fit_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_cell_grid *g = context;
    const rlf_region *region = g->region;
    samples all;
    for (int32_t row = begin; row < end; row++) {
        int32_t y0 = region->y0 + row * g->size;
        int32_t y1 = y0 + g->size < region->y1 ? y0 + g->size : region->y1;
        for (int32_t column = 0; column < g->columns; column++) {
            int32_t x0 = region->x0 + column * g->size;
            int32_t x1 = x0 + g->size < region->x1 ? x0 + g->size : region->x1;
            rlf_cell *cell = &g->cells[row * g->columns + column];
            *cell = (rlf_cell){{{0.0f}}, limb_depth(g, x0, y0, x1, y1), RLF_CELL_EMPTY};
            if (!(cell->depth > 0.0f)) {
                continue;
            }
            cell->state = RLF_CELL_UNKNOWN;
            take_samples(g, x0, y0, cell->depth, &all);
            if (all.count >= LEAST_SAMPLES) {
                fit_cell(g, &all, column > 0 ? cell - 1 : NULL, cell);
            }
        }
    }
}

/* ---- pixels: the mean of the cells around, weighted by nearness, of those with the same limb ----
 */

static rlf_kernel_flow_cell cell_at(const rlf_cell_grid *g, int32_t row, int32_t column)
{
    if (row < 0 || column < 0 || row >= g->rows || column >= g->columns) {
        return (rlf_kernel_flow_cell){.is_known = false};
    }
    const rlf_cell *cell = &g->cells[row * g->columns + column];
    return (rlf_kernel_flow_cell){{cell->velocity.v[0], cell->velocity.v[1], cell->velocity.v[2]},
                                  cell->depth,
                                  cell->state >= RLF_CELL_WHOLE,
                                  cell->state != RLF_CELL_MOVES};
}

/* Half a cell at a time, what is not of a cell that rests. */
static void write_run(const rlf_cell_grid *g, rlf_kernel_flow *flow, int32_t y, const rlf_run *run)
{
    const image_grid *grid = &g->job->stage->grid;
    rlf_slot *now = g->job->now;
    const int32_t size = g->size, half = size / 2, down = y - g->region->y0;
    const int32_t row = down / size, above = row - (down % size < half ? 1 : 0);
    flow->down = ((float)down + 0.5f) * flow->inverse - 0.5f - (float)above;
    for (int32_t x = run->x0, next; x < run->x1; x = next) {
        const int32_t right = x - g->region->x0, column = right / size;
        const bool is_first = right % size < half;
        next = rlf_least(run->x1, g->region->x0 + column * size + (is_first ? half : size));
        if (g->cells[row * g->columns + column].state == RLF_CELL_STILL) {
            continue;
        }
        const int32_t before = column - (is_first ? 1 : 0);
        flow->column = (float)before;
        for (int k = 0; k < 4; k++) {
            flow->cell[k] = cell_at(g, above + k / 2, before + k % 2);
        }
        const ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
        float *const out[3] = {now->velocity[0] + i, now->velocity[1] + i, now->velocity[2] + i};
        flow->first = right;
        rlf_kernel_flow_row(flow, now->depth + i, grid->ray_x + i, grid->ray_y + i, next - x, out);
    }
}

static rlf_kernel_flow flow_of(const rlf_cell_grid *g)
{
    rlf_vec3 c = g->twist->centre, s = rlf_twist_spin(g->twist);
    const double *x = g->twist->x;
    return (rlf_kernel_flow){.twist = {{c.x, c.y, c.z}, {x[0], x[1], x[2]}, {s.x, s.y, s.z}},
                             .moves = g->moves,
                             .inverse = 1.0f / (float)g->size,
                             .limb = 2.0f * rlf_flow_limb_m,
                             .fastest = fastest};
}

static void write_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_cell_grid *g = context;
    const rlf_runs *runs = &g->job->stage->work.runs;
    rlf_kernel_flow flow = flow_of(g);
    for (int32_t y = g->region->y0 + begin; y < g->region->y0 + end; y++) {
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            if (runs->run[r].component == g->number) {
                write_run(g, &flow, y, &runs->run[r]);
            }
        }
    }
}

static void write_cells(rlf_cell_grid *g)
{
    const rlf_region *region = g->region;
    rlf_parallel_for(g->job->stage->def.pool, region->y1 - region->y0, RLF_ROW_GRAIN, write_rows,
                     g);
}

void rlf_velocity_cells(const rlf_flow *job, const rlf_region *region, const rlf_twist *twist,
                        bool moves)
{
    const image_grid *grid = &job->stage->grid;
    double size =
        2.0 * (double)rlf_flow_limb_m * grid->camera.fx / rlf_max(region->centroid.z, 0.1);
    rlf_cell_grid g = {.job = job,
                       .region = region,
                       .twist = twist,
                       .moves = moves,
                       .cells = job->stage->velocity.cells};
    g.number = (int32_t)(region - &job->now->regions[job->now->foreground_region_first]) + 1;
    g.size = (int32_t)rlf_clamp(size, SIDE_SAMPLES, RLF_IMAGE_SIZE_MAX);
    g.columns = (region->x1 - region->x0 + g.size - 1) / g.size;
    g.rows = (region->y1 - region->y0 + g.size - 1) / g.size;
    rlf_parallel_for(job->stage->def.pool, g.rows, 1, fit_rows, &g);
    relax(&g);
    write_cells(&g);
}

void velocity_allocate(velocity_planes *state, rlf_arena *arena, const image_grid *grid)
{
    const size_t n = (size_t)grid->count;
    const size_t cells =
        ((size_t)grid->width / SIDE_SAMPLES + 1) * ((size_t)grid->height / SIDE_SAMPLES + 1);
    state->seen = arena_take(arena, n, sizeof(float));
    state->cells = arena_take(arena, cells, sizeof *state->cells);
    state->keyframe = arena_take(arena, RLF_KEYFRAMES, sizeof(rlf_keyframe));
    arena_next_owner(arena);
    state->is_steady = arena_lend(arena, n, 1);
}
