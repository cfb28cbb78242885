/* From the velocities of cells to those of pixels: the mean of the cells around a pixel, weighted
 * by nearness, of those with the same limb. */
#include "surface/motion/motion.h"

/* Column of the cell whose middle is at pixel x or before it; -1 = before the first. */
static int32_t column_before(const rlf_cell_grid *g, int32_t x, float inverse)
{
    float column = ((float)(x - g->region->x0) + 0.5f) * inverse - 0.5f;
    return (int32_t)(column + 1.0f) - 1;
}

/* First pixel after x, before x1, that lies beyond the middle of the cell after `column`. */
static int32_t next_middle(const rlf_cell_grid *g, int32_t x, int32_t x1, int32_t column,
                           float inverse)
{
    int32_t guess = g->region->x0 + (column + 1) * g->size + g->size / 2 - 1;
    guess = guess > x ? guess : x + 1;
    while (guess < x1 && column_before(g, guess, inverse) == column) {
        guess++;
    }
    return guess < x1 ? guess : x1;
}

static rlf_kernel_flow_cell cell_at(const rlf_cell_grid *g, int32_t row, int32_t column)
{
    if (row < 0 || column < 0 || row >= g->rows || column >= g->columns) {
        return (rlf_kernel_flow_cell){.is_known = false};
    }
    const rlf_cell *cell = &g->cells[row * g->columns + column];
    return (rlf_kernel_flow_cell){{cell->velocity[0], cell->velocity[1], cell->velocity[2]},
                                  cell->depth,
                                  cell->state >= RLF_CELL_WHOLE,
                                  cell->state != RLF_CELL_MOVES};
}

static bool is_still(const rlf_cell_grid *g, int32_t y, int32_t x)
{
    int32_t row = (y - g->region->y0) / g->size, column = (x - g->region->x0) / g->size;
    return g->cells[row * g->columns + column].state == RLF_CELL_STILL;
}

/* Pixels x0 <= x < x1, all between the middles of the flow's cells. */
static void write_part(const rlf_cell_grid *g, rlf_kernel_flow *flow, int32_t y, int32_t x0,
                       int32_t x1)
{
    const image_grid *grid = &g->job->stage->grid;
    rlf_slot *now = g->job->now;
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x0;
    float *const velocity[3] = {now->velocity[0] + i, now->velocity[1] + i, now->velocity[2] + i};
    flow->first = x0 - g->region->x0;
    rlf_kernel_flow_row(flow, now->depth + i, grid->ray_x + i, grid->ray_y + i, x1 - x0, velocity);
}

/* From middle to middle of cells, what is not of a cell that rests. */
static void write_run(const rlf_cell_grid *g, rlf_kernel_flow *flow, int32_t y, const rlf_run *run)
{
    int32_t row = (int32_t)(((float)(y - g->region->y0) + 0.5f) * flow->inverse + 0.5f) - 1;
    flow->down = ((float)(y - g->region->y0) + 0.5f) * flow->inverse - 0.5f - (float)row;
    for (int32_t x = run->x0; x < run->x1;) {
        int32_t column = column_before(g, x, flow->inverse);
        int32_t next = next_middle(g, x, run->x1, column, flow->inverse);
        int32_t edge = g->region->x0 + (column + 1) * g->size;
        int32_t first = x, last = next;
        if (is_still(g, y, x)) {
            first = edge > x && edge < next ? edge : next;
        }
        if (edge > x && edge < next && is_still(g, y, edge)) {
            last = edge;
        }
        if (first < last) {
            flow->column = (float)column;
            for (int k = 0; k < 4; k++) {
                flow->cell[k] = cell_at(g, row + k / 2, column + k % 2);
            }
            write_part(g, flow, y, first, last);
        }
        x = next;
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
                             .fastest = rlf_flow_fastest};
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

void rlf_cells_write(rlf_cell_grid *g)
{
    const rlf_region *region = g->region;
    rlf_parallel_for(g->job->stage->def.pool, region->y1 - region->y0, RLF_ROW_GRAIN, write_rows,
                     g);
}
