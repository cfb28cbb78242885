/* Stable labels: a region keeps the label that most of its pixels had.
 *
 * The candidate of each region is found by majority vote in one pass (Boyer and Moore 1981); of
 * regions with the same candidate the largest keeps it. */
#include "surface/steps.h"

#include <string.h>

/* Which of the previous regions has a label: open addressing, at most half full. Entries are
 * indices + 1, 0 = free. */
typedef struct label_table {
    const rlf_region *regions;
    int32_t *entry;
    uint32_t mask;
} label_table;

static uint32_t find_entry(const label_table *table, int32_t label)
{
    uint32_t at = ((uint32_t)label * 2654435769u) & table->mask; /* Fibonacci hashing */
    while (table->entry[at] != 0 && table->regions[table->entry[at] - 1].label != label) {
        at = (at + 1) & table->mask;
    }
    return at;
}

static label_table make_table(const rlf_reconstruct *stage, const rlf_layer_in *in)
{
    uint32_t size = 2;
    while (size < 2 * (uint32_t)in->previous_count) {
        size *= 2;
    }
    label_table table = {in->previous, stage->work.heirs, size - 1};
    memset(table.entry, 0, size * sizeof *table.entry);
    for (int32_t k = 0; k < in->previous_count; k++) {
        table.entry[find_entry(&table, in->previous[k].label)] = k + 1;
    }
    return table;
}

/* `weight` votes of one kind. */
static void add_votes(int32_t *candidate, int32_t *count, int32_t label, int32_t weight)
{
    if (*candidate == label) {
        *count += weight;
    } else if (*count >= weight) {
        *count -= weight;
    } else {
        *candidate = label;
        *count = weight - *count;
    }
}

/* Label that pixel i had in this layer; 0 = none. */
static inline int32_t previous_label(const rlf_layer_in *in, ptrdiff_t i)
{
    bool counts = in->previous_mask == NULL || in->previous_mask[i] != 0;
    return counts ? in->previous_label[i] : 0;
}

static void vote_run(const rlf_layer_in *in, ptrdiff_t i, ptrdiff_t end, int32_t *candidate,
                     int32_t *count)
{
    while (i < end) {
        int32_t label = previous_label(in, i);
        ptrdiff_t begin = i++;
        while (i < end && previous_label(in, i) == label) {
            i++;
        }
        if (label != 0) {
            add_votes(candidate, count, label, (int32_t)(i - begin));
        }
    }
}

static void vote(rlf_reconstruct *stage, const rlf_layer_in *in, int32_t region_count)
{
    const rlf_runs *runs = &stage->work.runs;
    int32_t *candidate = stage->work.vote[0];
    int32_t *count = stage->work.vote[1];
    memset(candidate, 0, (size_t)region_count * sizeof *candidate);
    memset(count, 0, (size_t)region_count * sizeof *count);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        ptrdiff_t row = (ptrdiff_t)y * stage->grid.width;
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            int32_t k = run->component - 1;
            if (k >= 0) {
                vote_run(in, row + run->x0, row + run->x1, &candidate[k], &count[k]);
            }
        }
    }
}

/* vote[1][k] = the largest region whose candidate is the previous region k, + 1. */
static void find_heirs(rlf_reconstruct *stage, const rlf_layer_in *in, const label_table *table,
                       const rlf_layer_out *out)
{
    const int32_t *candidate = stage->work.vote[0];
    int32_t *heir = stage->work.vote[1];
    memset(heir, 0, (size_t)in->previous_count * sizeof *heir);
    for (int32_t r = 0; r < out->region_count; r++) {
        int32_t k = table->entry[find_entry(table, candidate[r])] - 1;
        if (k < 0) {
            continue;
        }
        bool larger =
            heir[k] == 0 || out->regions[r].point_count > out->regions[heir[k] - 1].point_count;
        heir[k] = larger ? r + 1 : heir[k];
    }
}

void rlf_region_track(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out)
{
    for (int32_t r = 0; r < out->region_count; r++) {
        out->regions[r].label = 0;
    }
    if (in->previous_label != NULL) {
        vote(stage, in, out->region_count);
        label_table table = make_table(stage, in);
        find_heirs(stage, in, &table, out);
        for (int32_t k = 0; k < in->previous_count; k++) {
            int32_t heir = stage->work.vote[1][k];
            if (heir > 0) {
                out->regions[heir - 1].label = in->previous[k].label;
                out->regions[heir - 1].age_ns = in->previous[k].age_ns + in->elapsed_ns;
            }
        }
    }
    if (in->layer == RLF_LAYER_FOREGROUND) {
        rlf_region_name(stage, in, out);
        return;
    }
    for (int32_t r = 0; r < out->region_count; r++) {
        rlf_region *region = &out->regions[r];
        region->label = region->label != 0 ? region->label : rlf_region_fresh_label(stage);
    }
}
