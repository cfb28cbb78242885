/* From the velocities of cells to those of pixels: the mean of the cells around a pixel, weighted
 * by nearness, of those with the same limb. */
#include "surface/velocity.h"

/* Mean of the four cells around a pixel that show the same limb and move, by nearness; the region's
 * motion where there is none. */
static void blend(const rlf_cell_grid *g, int32_t x, int32_t y, float depth, const float whole[3],
                  float out[3])
{
    float inverse = 1.0f / (float)g->size;
    float column = ((float)(x - g->region->x0) + 0.5f) * inverse - 0.5f;
    float row = ((float)(y - g->region->y0) + 0.5f) * inverse - 0.5f;
    int32_t c0 = (int32_t)(column + 1.0f) - 1, r0 = (int32_t)(row + 1.0f) - 1;
    float part_x = column - (float)c0, part_y = row - (float)r0, sum = 0.0f;
    out[0] = out[1] = out[2] = 0.0f;
    for (int k = 0; k < 4; k++) {
        int32_t c = c0 + k % 2, r = r0 + k / 2;
        if (c < 0 || r < 0 || c >= g->columns || r >= g->rows) {
            continue;
        }
        const rlf_cell *cell = &g->cells[r * g->columns + c];
        if (cell->state < RLF_CELL_WHOLE ||
            rlf_kernel_abs(cell->depth - depth) > 2.0f * rlf_flow_limb_m) {
            continue;
        }
        float weight = (k % 2 ? part_x : 1.0f - part_x) * (k / 2 ? part_y : 1.0f - part_y) + 1e-4f;
        sum += weight;
        for (int d = 0; d < 3; d++) {
            out[d] += weight * (cell->state == RLF_CELL_MOVES ? cell->velocity[d] : whole[d]);
        }
    }
    for (int d = 0; d < 3; d++) {
        out[d] = sum > 0.0f ? out[d] / sum : whole[d];
    }
}

/* Pixels x0 <= x < x1 of one cell of the region. */
static void write_part(const rlf_cell_grid *g, int32_t y, int32_t x0, int32_t x1)
{
    const rlf_grid *grid = &g->job->stage->grid;
    const float *depth = g->job->now->depth;
    rlf_vec3 spin = rlf_twist_spin(g->twist);
    for (int32_t x = x0; x < x1; x++) {
        ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
        float z = depth[i], whole[3] = {0.0f, 0.0f, 0.0f}, v[3];
        if (g->moves) {
            rlf_vec3 p = rlf_vec3_make(z * grid->ray_x[i], z * grid->ray_y[i], z);
            rlf_vec3 u = rlf_twist_at(g->twist, spin, p);
            whole[0] = (float)u.x;
            whole[1] = (float)u.y;
            whole[2] = (float)u.z;
        }
        blend(g, x, y, z, whole, v);
        rlf_flow_write(g->job, i, v);
    }
}

static void write_run(const rlf_cell_grid *g, int32_t y, const rlf_run *run)
{
    int32_t left = g->region->x0;
    const rlf_cell *row = g->cells + (y - g->region->y0) / g->size * g->columns;
    for (int32_t x = run->x0; x < run->x1;) {
        int32_t column = (x - left) / g->size, next = left + (column + 1) * g->size;
        next = next < run->x1 ? next : run->x1;
        if (row[column].state != RLF_CELL_STILL) {
            write_part(g, y, x, next);
        }
        x = next;
    }
}

static void write_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_cell_grid *g = context;
    const rlf_runs *runs = &g->job->stage->work.runs;
    for (int32_t y = g->region->y0 + begin; y < g->region->y0 + end; y++) {
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            if (runs->run[r].component == g->number) {
                write_run(g, y, &runs->run[r]);
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
