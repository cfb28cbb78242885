/* From components to regions: which are kept, which small ones join a neighbour, and their order.
 */
#include "surface/steps.h"

#include <string.h>

static int32_t single_component(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    int32_t size = 0;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        bool member = in->depth[i] > 0.0f && (in->mask == NULL || in->mask[i] != 0);
        stage->work.component[i] = member ? 1 : 0;
        size += member;
    }
    stage->work.size[1] = size;
    return size > 0 ? 1 : 0;
}

/* Smallest size that leaves at most region_capacity components, found by bisection. */
static int32_t least_size(const rlf_reconstruct *stage, int32_t component_count)
{
    int32_t low = stage->def.min_region_points > 1 ? stage->def.min_region_points : 1;
    int32_t high = stage->grid.count + 1;
    high = high > low ? high : low;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        int32_t kept = 0;
        for (int32_t c = 1; c <= component_count; c++) {
            kept += stage->work.size[c] >= middle ? 1 : 0;
        }
        if (kept <= stage->def.region_capacity) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

/* vote[0][c]: the largest component that touches c in the image. */
static void find_neighbours(const rlf_reconstruct *stage, int32_t component_count)
{
    const rlf_work *work = &stage->work;
    int32_t *best = work->vote[0];
    memset(best, 0, (size_t)(component_count + 1) * sizeof *best);
    int32_t width = stage->grid.width;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t x = 0; x < width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * width + x;
            int32_t a = work->component[i];
            if (a == 0) {
                continue;
            }
            const int32_t near[2] = {x > 0 ? work->component[i - 1] : 0,
                                     y > 0 ? work->component[i - width] : 0};
            for (int k = 0; k < 2; k++) {
                int32_t b = near[k];
                if (b == 0 || b == a) {
                    continue;
                }
                best[a] = best[a] == 0 || work->size[b] > work->size[best[a]] ? b : best[a];
                best[b] = best[b] == 0 || work->size[a] > work->size[best[b]] ? a : best[b];
            }
        }
    }
}

/* map[c] = region number, 0 = dropped. Small pieces join the largest component they touch. */
static int32_t number_regions(rlf_reconstruct *stage, int32_t component_count, bool merge)
{
    rlf_work *work = &stage->work;
    int32_t least = least_size(stage, component_count);
    int32_t count = 0;
    for (int32_t c = 1; c <= component_count; c++) {
        work->map[c] = work->size[c] >= least ? ++count : 0;
    }
    if (merge && count < component_count) {
        find_neighbours(stage, component_count);
        for (int32_t c = 1; c <= component_count; c++) {
            int32_t b = work->vote[0][c];
            if (work->size[c] < least && b != 0 && work->size[b] >= least) {
                work->map[c] = work->map[b];
            }
        }
    }
    return count;
}

void rlf_layer_segment(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out)
{
    int32_t components = 0;
    if (in->method == RLF_SEGMENT_OFF) {
        components = single_component(stage, in);
    } else {
        rlf_segment_links(stage, in->method, in->depth, in->mask);
        components = rlf_components_find(stage);
    }
    bool merge = in->method == RLF_SEGMENT_NOISE;
    out->region_count = number_regions(stage, components, merge);
    for (int32_t i = 0; i < stage->grid.count; i++) {
        int32_t c = stage->work.component[i];
        out->label[i] = c == 0 ? 0 : stage->work.map[c];
    }
    if (in->method == RLF_SEGMENT_THESIS && stage->def.enable_dilation) {
        rlf_segment_dilate(&stage->grid, stage->def.segment_tau_m, in->depth, in->mask, out->label);
    }
    rlf_region_measure(stage, in, out->label, out);
    rlf_region_track(stage, in, out->label, out);
    for (int32_t i = 0; i < stage->grid.count; i++) {
        int32_t number = out->label[i];
        out->label[i] = number == 0 ? 0 : out->regions[number - 1].label;
    }
}

/* The region in whose box (and a hand's breadth around it) a point lies; NULL = none. */
static rlf_region *region_around(rlf_region *regions, int32_t count, rlf_vec3 p)
{
    const double around_m = 0.1;
    for (int32_t r = 0; r < count; r++) {
        rlf_vec3 low = rlf_sub(p, regions[r].box.min), high = rlf_sub(regions[r].box.max, p);
        double out = rlf_min(rlf_min(low.x, rlf_min(low.y, low.z)),
                             rlf_min(high.x, rlf_min(high.y, high.z)));
        if (out > -around_m) {
            return &regions[r];
        }
    }
    return NULL;
}

void rlf_region_adopt(const rlf_grid *grid, const float *depth, ptrdiff_t i, int32_t *label,
                      rlf_region *regions, int32_t count)
{
    double z = depth[i];
    rlf_vec3 p = {z * grid->ray_x[i], z * grid->ray_y[i], z};
    rlf_region *region = region_around(regions, count, p);
    if (region == NULL) {
        return;
    }
    int32_t x = (int32_t)(i % grid->width), y = (int32_t)(i / grid->width);
    label[i] = region->label;
    region->point_count++;
    region->x0 = x < region->x0 ? x : region->x0;
    region->y0 = y < region->y0 ? y : region->y0;
    region->x1 = x + 1 > region->x1 ? x + 1 : region->x1;
    region->y1 = y + 1 > region->y1 ? y + 1 : region->y1;
}
