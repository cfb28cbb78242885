/* The lines of pixels that a block is cut along. */
#include "surface/thickness/thickness.h"

#include <math.h>

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
    const rlf_grid *grid = &job->stage->grid;
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
