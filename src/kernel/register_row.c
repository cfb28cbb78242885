/* Depth pixels as rectangles of a colour image, in short loops that compilers vectorise. */
#include "kernel/kernel.h"

#define SHIFT 64   /* makes coordinates positive before they are cut to integers */
#define EDGE 0.02f /* pixels a rectangle is widened, against rounding gaps */

/* Compilers trust `restrict` on parameters alone; one plane at a time keeps them few. */
RLF_KERNEL_PART void depth_to_inverse(const float *restrict depth, const float *restrict c,
                                      float tc, int32_t count, float *restrict out_inverse,
                                      float *restrict out_z)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i];
        z = z > 0.0f ? z : 0.0f;
        z = z < 1e6f ? z : 0.0f;
        float z_color = z * c[i] + tc;
        z_color = z > 0.0f ? z_color : 0.0f;
        out_inverse[i] = 1.0f / (z_color > 0.01f ? z_color : 1.0f);
        out_z[i] = z_color > 0.01f ? z_color : RLF_KERNEL_NOTHING;
    }
}

RLF_KERNEL_PART void project(const float *restrict depth, const float *restrict table, float t,
                             const float *restrict inverse, int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = (depth[i] * table[i] + t) * inverse[i];
    }
}

RLF_KERNEL_PART void scale_row(const float *restrict depth, const float *restrict z, int32_t count,
                               float *restrict scale)
{
    for (int32_t i = 0; i < count; i++) {
        scale[i] = z[i] < RLF_KERNEL_NOTHING ? depth[i] * scale[i] : 0.0f;
    }
}

RLF_KERNEL void rlf_kernel_project_row(const rlf_kernel_pinhole *params,
                                       const rlf_kernel_rays *rays, const float *restrict depth,
                                       int32_t count, const rlf_kernel_points *out)
{
    float *inverse = out->scale;
    depth_to_inverse(depth, rays->c, params->tc, count, inverse, out->z);
    project(depth, rays->a, params->ta, inverse, count, out->u);
    project(depth, rays->b, params->tb, inverse, count, out->v);
    scale_row(depth, out->z, count, out->scale);
}

/* Bilinear between knots. */
RLF_KERNEL_PART void add_offsets(const float *restrict table, const int32_t *restrict knots,
                                 const float *restrict across, const float *restrict down,
                                 int32_t columns, int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        int32_t knot = knots[i];
        float s = across[i];
        float t = down[i];
        float top = table[knot] * (1.0f - s) + table[knot + 1] * s;
        float bottom = table[knot + columns] * (1.0f - s) + table[knot + columns + 1] * s;
        out[i] += top * (1.0f - t) + bottom * t;
    }
}

/* Knot and weights of each pixel; z becomes nothing outside the table. */
RLF_KERNEL_PART void find_knots(const rlf_kernel_lens *lens, const float *restrict u,
                                const float *restrict v, int32_t count, int32_t *restrict knots,
                                float *restrict across, float *restrict down, float *restrict z)
{
    const int32_t columns = lens->columns;
    const float last_x = (float)(lens->columns - 1);
    const float last_y = (float)(lens->rows - 1);
    const float left = lens->left;
    const float top = lens->top;
    const float per_pixel_x = lens->per_pixel_x;
    const float per_pixel_y = lens->per_pixel_y;
    for (int32_t i = 0; i < count; i++) {
        float x = (u[i] - left) * per_pixel_x;
        float y = (v[i] - top) * per_pixel_y;
        x = x >= 0.0f ? x : -1.0f; /* -1: outside */
        x = x < last_x ? x : -1.0f;
        y = y >= 0.0f ? y : -1.0f;
        y = y < last_y ? y : -1.0f;
        float here = x < 0.0f ? RLF_KERNEL_NOTHING : z[i];
        z[i] = y < 0.0f ? RLF_KERNEL_NOTHING : here;
        x = x > 0.0f ? x : 0.0f;
        y = y > 0.0f ? y : 0.0f;
        int32_t column = (int32_t)x;
        int32_t line = (int32_t)y;
        knots[i] = line * columns + column;
        across[i] = x - (float)column;
        down[i] = y - (float)line;
    }
}

RLF_KERNEL void rlf_kernel_distort_row(const rlf_kernel_lens *lens, int32_t count,
                                       const rlf_kernel_points *points)
{
    enum { BLOCK = 64 };
    int32_t knots[BLOCK];
    float across[BLOCK];
    float down[BLOCK];
    for (int32_t i = 0; i < count; i += BLOCK) {
        int32_t size = count - i < BLOCK ? count - i : BLOCK;
        find_knots(lens, points->u + i, points->v + i, size, knots, across, down, points->z + i);
        add_offsets(lens->du, knots, across, down, lens->columns, size, points->u + i);
        add_offsets(lens->dv, knots, across, down, lens->columns, size, points->v + i);
    }
}

RLF_KERNEL void rlf_kernel_stretch_row(const float *restrict size, int32_t count,
                                       float *restrict scale)
{
    for (int32_t i = 0; i < count; i++) {
        scale[i] *= size[i];
    }
}

/* First and last pixel centre inside [centre - half, centre + half] and inside 0..size-1; last <
 * first when there is none. */
RLF_KERNEL_PART void cut_to_pixels(const float *restrict centre, const float *restrict scale,
                                   const float limits[2], int32_t count,
                                   int32_t *restrict out_first, int32_t *restrict out_last)
{
    const float half = limits[0];
    const float end = limits[1] + (float)SHIFT;
    for (int32_t i = 0; i < count; i++) {
        float reach = scale[i] * half;
        float low = centre[i] - reach + ((float)SHIFT + 1.0f - EDGE); /* cut = ceil + SHIFT */
        float high = centre[i] + reach + ((float)SHIFT + EDGE);       /* cut = floor + SHIFT */
        low = low > (float)SHIFT ? low : (float)SHIFT;
        low = low < end ? low : end;
        high = high < end - 1.0f ? high : end - 1.0f;
        high = high > (float)SHIFT - 1.0f ? high : (float)SHIFT - 1.0f;
        out_first[i] = (int32_t)low - SHIFT;
        out_last[i] = (int32_t)high - SHIFT;
    }
}

RLF_KERNEL_PART void join(const int32_t *restrict y0, int32_t count, float *restrict z,
                          int32_t *restrict x0, int32_t *restrict x1, int32_t *restrict y)
{
    for (int32_t i = 0; i < count; i++) {
        bool is_seen = z[i] < RLF_KERNEL_NOTHING && x0[i] <= x1[i] && y0[i] <= y[i];
        z[i] = is_seen ? z[i] : RLF_KERNEL_NOTHING;
        x0[i] = is_seen ? x0[i] : 0;
        x1[i] = is_seen ? x1[i] : 0;
        y[i] = is_seen ? y0[i] * RLF_KERNEL_ROWS + y[i] : -1;
    }
}

RLF_KERNEL void rlf_kernel_splat_row(const rlf_kernel_pinhole *params,
                                     const rlf_kernel_points *points, int32_t count,
                                     const rlf_kernel_splat *out)
{
    const float across[2] = {params->half_x, params->width};
    const float down[2] = {params->half_y, params->height};
    cut_to_pixels(points->u, points->scale, across, count, out->x0, out->x1);
    cut_to_pixels(points->v, points->scale, down, count, out->y0, out->y);
    join(out->y0, count, points->z, out->x0, out->x1, out->y);
}

RLF_KERNEL void rlf_kernel_nearer_row(const float *restrict line, int32_t count,
                                      float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = line[i] < out[i] ? line[i] : out[i];
    }
}

/* Of `count` rectangles in other rows than y, without those that have no pixels: how many. */
RLF_KERNEL_PART int32_t count_others(const int32_t *restrict rows, int32_t y, int32_t count)
{
    int32_t sum = 0;
    for (int32_t i = 0; i < count; i++) {
        sum += (rows[i] != y ? 1 : 0) & (rows[i] >= 0 ? 1 : 0);
    }
    return sum;
}

RLF_KERNEL int32_t rlf_kernel_splat_run(const rlf_kernel_splat *splat, int32_t begin, int32_t count,
                                        int32_t out[3])
{
    enum { BLOCK = 64 };
    const int32_t *restrict x0 = splat->x0;
    const int32_t *restrict x1 = splat->x1;
    const int32_t *restrict y = splat->y;
    const int32_t here = y[begin];
    int32_t end = begin;
    while (end + BLOCK <= count && count_others(y + end, here, BLOCK) == 0) {
        end += BLOCK;
    }
    while (end < count && (y[end] == here || y[end] < 0)) {
        end++;
    }
    int32_t least = INT32_MAX;
    int32_t most = 0;
    int32_t widest = 0;
    for (int32_t i = begin; i < end; i++) {
        int32_t blank = y[i] < 0 ? INT32_MAX : 0;
        int32_t first = x0[i] | blank;
        int32_t width = x1[i] - x0[i] + 1;
        least = first < least ? first : least;
        most = x1[i] > most ? x1[i] : most;
        widest = width > widest ? width : widest;
    }
    out[0] = least;
    out[1] = most;
    out[2] = widest;
    return end;
}

RLF_KERNEL void rlf_kernel_clear_row(int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = RLF_KERNEL_NOTHING;
    }
}

RLF_KERNEL void rlf_kernel_seen_row(const float *restrict z, int32_t count, uint8_t *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = z[i] < RLF_KERNEL_NOTHING;
    }
}

RLF_KERNEL_PART int32_t count_seen(const float *restrict z, int32_t count)
{
    int32_t sum = 0;
    for (int32_t i = 0; i < count; i++) {
        sum += z[i] < RLF_KERNEL_NOTHING ? 1 : 0;
    }
    return sum;
}

RLF_KERNEL int32_t rlf_kernel_find_seen(const float *z, int32_t begin, int32_t count,
                                        int32_t is_seen)
{
    enum { BLOCK = 64, PART = 16 };
    const int32_t wanted = is_seen != 0 ? 1 : 0;
    int32_t i = begin;
    while (i + BLOCK <= count && count_seen(z + i, BLOCK) == (1 - wanted) * BLOCK) {
        i += BLOCK;
    }
    while (i + PART <= count && count_seen(z + i, PART) == (1 - wanted) * PART) {
        i += PART;
    }
    while (i < count && (z[i] < RLF_KERNEL_NOTHING ? 1 : 0) != wanted) {
        i++;
    }
    return i;
}
