/* From pixels to the planes in which chords are cut, the lines of pixels that a block is cut along,
 * and from knots back to pixels. */
#include "surface/thickness/thickness.h"

#include "surface/steps.h"

#include <math.h>
#include <string.h>

/* Limbs are wide beside a pixel as narrow as this: at 2 m, 8 mm. */
static const double fine_pixel_rad = 0.004;

enum { LINE = 16 /* of the cache, in floats */ };

int32_t rlf_knot_step(const image_grid *grid)
{
    return grid->camera.fx * fine_pixel_rad >= 1.0 ? 2 : 1;
}

static void prepare_run(const rlf_chord_job *job, const rlf_run *run, int32_t y)
{
    const rlf_slot *slot = job->slot;
    const rlf_region *region = &slot->regions[slot->foreground_region_first + run->component - 1];
    ptrdiff_t width = job->stage->grid.width, from = y * width, to = y * job->pitch;
    for (int32_t x = run->x0; x < run->x1 && y + 1 < job->stage->grid.height; x += LINE) {
        RLF_KERNEL_SOON(&job->raw[from + width + x]); /* of the row below */
        RLF_KERNEL_SOON(&slot->depth[from + width + x]);
    }
    from += run->x0;
    to += run->x0;
    rlf_kernel_chord_front(job->raw + from, slot->depth + from, region->label, run->x1 - run->x0,
                           job->front + to, job->inverse + to, job->label + to);
}

/* The row's knots, those beside the image unknown. */
static void prepare_knots(const rlf_chord_job *job, int32_t y)
{
    const float *depth = job->slot->depth + (ptrdiff_t)y * job->stage->grid.width;
    ptrdiff_t from = y * job->pitch, to = y / job->step * job->knot_pitch;
    int32_t x0 = job->x0 / job->step, x1 = (job->x0 + job->width + job->step - 1) / job->step;
    ptrdiff_t first = (ptrdiff_t)job->step * x0;
    rlf_kernel_knot_row(job->front + from + first, depth + first, job->step, x1 - x0,
                        job->knot + to + x0);
    for (int k = 0; k < 6; k++) {
        memset(job->stage->chords.solid[k] + to + x0, 0, (size_t)(x1 - x0) * sizeof(float));
    }
    job->knot[to - 1] = job->knot[to + job->columns] = 0.0f;
    job->thickness[to - 1] = job->thickness[to + job->columns] = 0.0f;
}

/* Marks the squares that row y of the block, from its first pixel x0 to x1, is in. */
static void mark_squares(const rlf_chord_job *job, int32_t y, int32_t x0, int32_t x1)
{
    uint8_t *row = job->squares + (ptrdiff_t)(y / RLF_CHORD_SQUARE) * job->square_pitch;
    int32_t first = x0 / RLF_CHORD_SQUARE, last = (x1 - 1) / RLF_CHORD_SQUARE;
    memset(row + first, 1, (size_t)(last - first + 1));
}

static void prepare_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_chord_job *job = context;
    const rlf_reconstruct *stage = job->stage;
    const rlf_runs *runs = &stage->work.runs;
    for (int32_t y = begin; y < end; y += RLF_CHORD_SQUARE) {
        memset(job->squares + (ptrdiff_t)(y / RLF_CHORD_SQUARE) * job->square_pitch, 0,
               (size_t)job->square_pitch);
    }
    for (int32_t y = job->y0 + begin; y < job->y0 + end; y++) {
        memset(job->front + y * job->pitch + job->x0, 0, (size_t)job->width * sizeof(float));
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            bool is_inside = run->x0 >= job->x0 && run->x0 < job->x0 + job->width;
            if (is_inside && run->component > 0 && !job->is_plate[run->component]) {
                prepare_run(job, run, y);
                mark_squares(job, y - job->y0, run->x0 - job->x0, run->x1 - job->x0);
            }
        }
        if (y % job->step == 0) {
            prepare_knots(job, y);
        }
    }
}

void rlf_chords_prepare(rlf_chord_job *job)
{
    rlf_parallel_for(job->stage->def.pool, job->height, RLF_ROW_GRAIN, prepare_rows, job);
}

/* The rows of knots around row y, from column x on. */
static rlf_kernel_knots knots_around(const rlf_chord_job *job, int32_t x, int32_t y)
{
    const float at_knot[3] = {1.0f, 4.0f, 1.0f}, between[3] = {0.0f, 3.0f, 3.0f};
    rlf_kernel_knots out;
    for (int32_t k = 0; k < 3; k++) {
        int32_t row = y / 2 + k - 1;
        bool is_in = row >= 0 && row < job->rows;
        float weight = y % 2 == 0 ? at_knot[k] : between[k];
        ptrdiff_t i = (is_in && weight > 0.0f ? row : y / 2) * job->knot_pitch + x;
        out.weight[k] = is_in ? weight : 0.0f;
        out.depth[k] = job->knot + i;
        out.value[k] = job->thickness + i;
    }
    return out;
}

/* The pixels of the run between knot x and the count-th from there. */
static void spread_part(const rlf_chord_job *job, const rlf_run *run, int32_t y, int32_t x,
                        int32_t count)
{
    const rlf_slot *slot = job->slot;
    ptrdiff_t row = (ptrdiff_t)y * job->stage->grid.width;
    float side[2][RLF_PART], out[2][RLF_PART];
    int32_t x0 = 2 * x > run->x0 ? 2 * x : run->x0;
    int32_t x1 = 2 * (x + count) < run->x1 ? 2 * (x + count) : run->x1;
    const rlf_kernel_knots knots = knots_around(job, x, y);
    side[0][0] = side[1][count - 1] = 0.0f; /* perhaps not of the run */
    for (int32_t k = x0; k < x1; k++) {
        side[k % 2][k / 2 - x] = slot->depth[row + k];
    }
    rlf_kernel_spread_row(&knots, count, RLF_BODY_STEP_M, side[0], side[1], out[0], out[1]);
    for (int32_t k = x0; k < x1; k++) {
        slot->thickness[row + k] = out[k % 2][k / 2 - x];
    }
}

void rlf_knots_spread(const rlf_chord_job *job, const rlf_run *run, int32_t y)
{
    if (job->step == 1) {
        const float *at_knots = job->thickness + y * job->knot_pitch + run->x0;
        memcpy(job->slot->thickness + (ptrdiff_t)y * job->stage->grid.width + run->x0, at_knots,
               (size_t)(run->x1 - run->x0) * sizeof *at_knots);
        return;
    }
    int32_t end = (run->x1 + 1) / 2;
    for (int32_t x = run->x0 / 2; x < end; x += RLF_PART) {
        spread_part(job, run, y, x, end - x < RLF_PART ? end - x : RLF_PART);
    }
}

int32_t rlf_line_count(const rlf_chord_job *job)
{
    int32_t pixels = job->dx == 0 ? job->width : job->height;
    pixels = job->dx != 0 && job->dy != 0 ? job->width + job->height - 1 : pixels;
    return (pixels + job->step - 1) / job->step;
}

/* First pixel of line `index`, from the block's corner. Lines of consecutive indices lie side by
 * side. */
static void first_pixel(const rlf_chord_job *job, int32_t index, int32_t *x, int32_t *y)
{
    int32_t last = job->height - 1, at = job->step * index;
    *x = job->dx == 0 ? at : 0;
    *y = job->dx == 0 ? 0 : at;
    if (job->dx != 0 && job->dy != 0) {
        int32_t off = at + (job->dy > 0 ? last % job->step : 0) - last;
        *x = off > 0 ? off : 0;
        *y = off < 0 ? -off : 0;
        *y = job->dy < 0 ? last - *y : *y;
    }
}

float rlf_line_origin(const rlf_chord_job *job, int32_t index)
{
    int32_t x, y;
    first_pixel(job, index, &x, &y);
    return (float)(x * job->dx + y * job->dy) / (float)(job->dx * job->dx + job->dy * job->dy);
}

rlf_line rlf_line_at(const rlf_chord_job *job, int32_t index)
{
    const image_grid *grid = &job->stage->grid;
    int32_t x, y;
    first_pixel(job, index, &x, &y);
    int32_t down = job->dy < 0 ? y + 1 : job->height - y;
    int32_t count = job->dx == 0 ? job->height : job->width - x;
    if (job->dx != 0 && job->dy != 0) {
        count = count < down ? count : down;
    }
    float ax = (float)job->dx / (float)grid->camera.fx,
          ay = (float)job->dy / (float)grid->camera.fy;
    rlf_line line = {.x = job->x0 + x, .y = job->y0 + y, .dx = job->dx, .dy = job->dy};
    line.base = line.y * job->pitch + line.x;
    line.stride = job->dy * job->pitch + job->dx;
    line.count = count;
    line.phase = line.x % job->step;
    line.knot_stride = job->dy * job->knot_pitch + job->dx;
    line.knot = (line.y + line.phase * job->dy) / job->step * job->knot_pitch +
                (line.x + line.phase * job->dx) / job->step;
    line.angle = sqrtf(ax * ax + ay * ay);
    return line;
}
