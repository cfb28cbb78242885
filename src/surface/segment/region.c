/* From components to regions: which are kept, and their order. */
#include "surface/objects/objects.h"

#include <string.h>

/* Everything is one component. */
static int32_t find_single(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    rlf_segment_links(stage, RLF_SEGMENT_NOISE, in->depth, in->mask, in->spans);
    int32_t components = rlf_components_find(stage, in->spans);
    int32_t size = 0;
    for (int32_t c = 1; c <= components; c++) {
        size += stage->work.size[c];
    }
    int32_t end = stage->work.runs.first[stage->grid.height];
    for (int32_t r = 0; r < end; r++) {
        stage->work.runs.run[r].component = 1;
    }
    stage->work.size[1] = size;
    return components > 0 ? 1 : 0;
}

static int32_t find_components(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    if (in->has_components) {
        return in->component_count;
    }
    if (in->method == RLF_SEGMENT_OFF) {
        return find_single(stage, in);
    }
    if (in->method == RLF_SEGMENT_OBJECTS) {
        return rlf_objects_find(stage, in);
    }
    rlf_segment_links(stage, in->method, in->depth, in->mask, in->spans);
    return rlf_components_find(stage, in->spans);
}

/* Smallest size that leaves at most region_capacity components. */
static int32_t least_size(const rlf_reconstruct *stage, int32_t component_count)
{
    int32_t least = stage->def.min_region_points > 1 ? stage->def.min_region_points : 1;
    for (;;) {
        int32_t kept = 0, smallest = INT32_MAX - 1;
        for (int32_t c = 1; c <= component_count; c++) {
            int32_t size = stage->work.size[c];
            kept += size >= least ? 1 : 0;
            smallest = size >= least ? rlf_least(size, smallest) : smallest;
        }
        if (kept <= stage->def.region_capacity) {
            return least;
        }
        least = smallest + 1;
    }
}

/* map[c] = region number, 0 = dropped. */
static int32_t number_regions(rlf_reconstruct *stage, int32_t component_count)
{
    rlf_work *work = &stage->work;
    int32_t least = least_size(stage, component_count);
    int32_t count = 0;
    for (int32_t c = 1; c <= component_count; c++) {
        work->map[c] = work->size[c] >= least ? ++count : 0;
    }
    return count;
}

static void number_runs(rlf_reconstruct *stage)
{
    const rlf_work *work = &stage->work;
    int32_t end = work->runs.first[stage->grid.height];
    for (int32_t r = 0; r < end; r++) {
        int32_t c = work->runs.run[r].component;
        work->runs.run[r].component = c > 0 && work->map[c] > 0 ? work->map[c] : -c;
    }
}

static void fill_run(const rlf_run *run, int32_t value, int32_t *row)
{
    for (int32_t x = run->x0; x < run->x1; x++) {
        row[x] = value;
    }
}

/* Fig. 4.12, over a plane of region numbers. */
static void dilate(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    const rlf_work *work = &stage->work;
    int32_t *number = work->component;
    memset(number, 0, (size_t)stage->grid.count * sizeof *number);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t r = work->runs.first[y]; r < work->runs.first[y + 1]; r++) {
            const rlf_run *run = &work->runs.run[r];
            fill_run(run, run->component > 0 ? run->component : 0,
                     number + (ptrdiff_t)y * stage->grid.width);
        }
    }
    rlf_segment_dilate(&stage->grid, stage->def.segment_tau_m, in->depth, in->mask, number);
    rlf_runs_find(stage, number);
}

void rlf_layer_segment(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out)
{
    int32_t components = find_components(stage, in);
    out->region_count = number_regions(stage, components);
    number_runs(stage);
    if (in->method == RLF_SEGMENT_THESIS && stage->def.enable_dilation) {
        dilate(stage, in);
    }
    rlf_region_measure(stage, in, out);
    rlf_region_track(stage, in, out);
}

void rlf_region_write_labels(const rlf_reconstruct *stage, const rlf_layer_out *out, int32_t *label)
{
    const rlf_runs *runs = &stage->work.runs;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        int32_t *row = label + (ptrdiff_t)y * stage->grid.width;
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            if (run->component > 0) {
                fill_run(run, out->regions[run->component - 1].label, row);
            }
        }
    }
}

/* The region in whose box (and a hand's breadth around it) a point lies; 0 = none. */
static int32_t region_around(const rlf_layer_out *out, rlf_vec3 p)
{
    for (int32_t r = 0; r < out->region_count; r++) {
        const rlf_aabb *box = &out->regions[r].box;
        rlf_vec3 low = rlf_sub(p, box->min), high = rlf_sub(box->max, p);
        double outside = rlf_min(rlf_min(low.x, rlf_min(low.y, low.z)),
                                 rlf_min(high.x, rlf_min(high.y, high.z)));
        if (outside > -(double)RLF_PERSON_STEP_M) {
            return r + 1;
        }
    }
    return 0;
}

/* map[c] of the pieces: the region that an end of one of their runs is close to, 0 = none. */
static void find_homes(const rlf_reconstruct *stage, const float *depth, const rlf_layer_out *out)
{
    const rlf_work *work = &stage->work;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        int32_t row = y * stage->grid.width;
        for (int32_t r = work->runs.first[y]; r < work->runs.first[y + 1]; r++) {
            const rlf_run *run = &work->runs.run[r];
            if (run->component >= 0 || work->map[-run->component] > 0) {
                continue;
            }
            int32_t home = region_around(out, image_grid_point(&stage->grid, depth, row + run->x0));
            if (home == 0) {
                home = region_around(out, image_grid_point(&stage->grid, depth, row + run->x1 - 1));
            }
            work->map[-run->component] = home;
        }
    }
}

void rlf_region_adopt(rlf_reconstruct *stage, const float *depth, rlf_layer_out *out)
{
    const rlf_work *work = &stage->work;
    find_homes(stage, depth, out);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t r = work->runs.first[y]; r < work->runs.first[y + 1]; r++) {
            rlf_run *run = &work->runs.run[r];
            int32_t home = run->component < 0 ? work->map[-run->component] : 0;
            if (home > 0) {
                run->component = home;
                rlf_region_grow(&out->regions[home - 1], run, y);
            }
        }
    }
}
