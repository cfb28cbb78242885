/* Stable labels: a region keeps the label that most of its pixels had.
 *
 * The candidate of each region is found by majority vote in one pass (Boyer and Moore 1981); of two
 * regions with the same candidate the larger keeps it. */
#include "surface/steps.h"

enum { LABEL_LIMIT = 1 << 30 };

static void vote(rlf_reconstruct *stage, const rlf_layer_in *in, const int32_t *number,
                 int32_t region_count)
{
    int32_t *candidate = stage->work.vote[0];
    int32_t *count = stage->work.vote[1];
    for (int32_t r = 0; r <= region_count; r++) {
        candidate[r] = count[r] = 0;
    }
    for (int32_t i = 0; i < stage->grid.count; i++) {
        int32_t r = number[i];
        int32_t label = in->previous_label[i];
        bool counts = in->previous_mask == NULL || in->previous_mask[i] != 0;
        if (r == 0 || label == 0 || !counts) {
            continue;
        }
        if (count[r] == 0) {
            candidate[r] = label;
        }
        count[r] += candidate[r] == label ? 1 : -1;
    }
}

static const rlf_region *find_previous(const rlf_layer_in *in, int32_t label)
{
    for (int32_t k = 0; k < in->previous_count; k++) {
        if (in->previous[k].label == label) {
            return &in->previous[k];
        }
    }
    return NULL;
}

static bool is_largest_heir(const rlf_layer_out *out, const int32_t *candidate, int32_t r)
{
    for (int32_t k = 0; k < out->region_count; k++) {
        if (k == r || candidate[k + 1] != candidate[r + 1]) {
            continue;
        }
        int32_t other = out->regions[k].point_count, own = out->regions[r].point_count;
        if (other > own || (other == own && k < r)) {
            return false;
        }
    }
    return true;
}

static int32_t fresh_label(rlf_reconstruct *stage)
{
    stage->next_label = stage->next_label < LABEL_LIMIT ? stage->next_label + 1 : 1;
    return stage->next_label;
}

void rlf_region_track(rlf_reconstruct *stage, const rlf_layer_in *in, const int32_t *number,
                      rlf_layer_out *out)
{
    const int32_t *candidate = stage->work.vote[0];
    bool has_history = in->previous_label != NULL;
    if (has_history) {
        vote(stage, in, number, out->region_count);
    }
    for (int32_t r = 0; r < out->region_count; r++) {
        rlf_region *region = &out->regions[r];
        const rlf_region *before = NULL;
        if (has_history && candidate[r + 1] != 0 && is_largest_heir(out, candidate, r)) {
            before = find_previous(in, candidate[r + 1]);
        }
        region->label = before != NULL ? before->label : fresh_label(stage);
        region->age_ns = before != NULL ? before->age_ns + in->elapsed_ns : 0;
    }
}
