/* From the velocities of cells to those of pixels: the mean of the cells around a pixel, weighted
 * by nearness, of those with the same limb. */
#include "surface/motion/motion.h"
#include "surface/window.h"

static const float fastest = 5.0f; /* m/s */

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

void rlf_cells_write(rlf_cell_grid *g)
{
    const rlf_region *region = g->region;
    rlf_parallel_for(g->job->stage->def.pool, region->y1 - region->y0, RLF_ROW_GRAIN, write_rows,
                     g);
}
