/* Stable labels: tracks of regions by overlap, and by prediction while they are hidden.
 *
 * A region keeps the label that most of its pixels had. The candidate of each region is found by
 * majority vote in one pass (Boyer and Moore 1981); of regions with the same candidate the largest
 * keeps it.
 *
 * A person behind another is seen in parts, or not at all. His track moves on as he did. When no
 * region has its label any more, the largest young region where he is expected takes the label: a
 * part that was cut off from him, or what comes out on the other side. It is younger than he. */
#include "surface/steps.h"

#include <math.h>
#include <string.h>

enum { LABEL_LIMIT = 1 << 30 };

/* So long a track is remembered that nobody sees, and so long a region is young: two people who
 * walk past each other are apart again. */
static const int64_t MEMORY_NS = 1000000000;
/* Half of a person's breadth: so far is a part of him from where he is expected. */
static const double ABOUT_M = 0.3;
/* Share of a track's points: with less it is seen in part, and its box and velocity are not its
 * own. */
static const double WHOLE = 0.75;

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

/* The region with a label; NULL = none. */
static const rlf_region *find_label(const rlf_region *regions, int32_t count, int32_t label)
{
    for (int32_t r = 0; r < count; r++) {
        if (regions[r].label == label) {
            return &regions[r];
        }
    }
    return NULL;
}

/* vote[1][k] = the largest region whose candidate is the previous region k, + 1. */
static void find_successors(rlf_reconstruct *stage, const rlf_layer_in *in,
                            const rlf_layer_out *out)
{
    const int32_t *candidate = stage->work.vote[0];
    int32_t *successor = stage->work.vote[1];
    memset(successor, 0, (size_t)in->previous_count * sizeof *successor);
    for (int32_t r = 0; r < out->region_count; r++) {
        const rlf_region *before = find_label(in->previous, in->previous_count, candidate[r]);
        if (before == NULL) {
            continue;
        }
        ptrdiff_t k = before - in->previous;
        bool larger = successor[k] == 0 ||
                      out->regions[r].point_count > out->regions[successor[k] - 1].point_count;
        successor[k] = larger ? r + 1 : successor[k];
    }
}

static rlf_track *find_track(const rlf_tracks *tracks, int32_t label)
{
    for (int32_t k = 0; k < tracks->count; k++) {
        if (tracks->item[k].label == label) {
            return &tracks->item[k];
        }
    }
    return NULL;
}

/* Brings a track from one surface ago up to now; `before`: its region there, NULL = hidden. */
static void predict(rlf_track *track, const rlf_region *before, int64_t elapsed_ns)
{
    track->points *= 1.0 - rlf_min((double)elapsed_ns / (double)MEMORY_NS, 1.0);
    if (before != NULL) {
        track->age_ns = before->age_ns;
        track->hidden_ns = 0;
    }
    if (before != NULL && before->point_count >= WHOLE * track->points) {
        track->velocity = before->linear_velocity;
        track->box = before->box;
        track->depth = before->centroid.z;
        track->points = rlf_max(track->points, before->point_count);
    }
    track->hidden_ns += elapsed_ns;
    rlf_vec3 way = rlf_scale(track->velocity, 1e-9 * (double)elapsed_ns);
    track->box = (rlf_aabb){rlf_add(track->box.min, way), rlf_add(track->box.max, way)};
    track->depth += way.z;
}

static void predict_all(rlf_tracks *tracks, const rlf_layer_in *in)
{
    int32_t kept = 0;
    for (int32_t k = 0; k < tracks->count; k++) {
        rlf_track track = tracks->item[k];
        predict(&track, find_label(in->previous, in->previous_count, track.label), in->elapsed_ns);
        if (track.hidden_ns <= MEMORY_NS) {
            tracks->item[kept++] = track;
        }
    }
    tracks->count = kept;
}

/* Not by the box's depth, which a few stray pixels make too long. */
static bool is_expected_at(const rlf_track *track, rlf_vec3 p)
{
    double x = rlf_max(track->box.min.x - p.x, p.x - track->box.max.x);
    double y = rlf_max(track->box.min.y - p.y, p.y - track->box.max.y);
    double z = rlf_max(track->depth - p.z, p.z - track->depth);
    return rlf_max(x, rlf_max(y, z)) <= ABOUT_M;
}

/* The largest young region where a track is expected; NULL = none. */
static rlf_region *find_part(const rlf_track *track, const rlf_layer_out *out)
{
    rlf_region *largest = NULL;
    for (int32_t r = 0; r < out->region_count; r++) {
        rlf_region *region = &out->regions[r];
        bool is_larger = largest == NULL || region->point_count > largest->point_count;
        bool is_young = region->age_ns <= MEMORY_NS && region->age_ns < track->age_ns;
        if (is_larger && is_young && is_expected_at(track, region->centroid)) {
            largest = region;
        }
    }
    return largest;
}

/* The track that its part was followed as has ended with that. */
static void take_over(rlf_tracks *tracks, int32_t k, rlf_region *part)
{
    rlf_track *track = &tracks->item[k], *as_part = find_track(tracks, part->label);
    part->label = track->label;
    part->age_ns = track->age_ns + track->hidden_ns;
    if (as_part != NULL) {
        *as_part = tracks->item[--tracks->count];
    }
}

/* Labels that no region has any more go to parts of what had them. */
static void find_hidden(rlf_tracks *tracks, const rlf_layer_out *out)
{
    for (int32_t k = 0; k < tracks->count; k++) {
        const rlf_track *track = &tracks->item[k];
        if (find_label(out->regions, out->region_count, track->label) == NULL) {
            rlf_region *part = find_part(track, out);
            if (part != NULL) {
                take_over(tracks, k, part);
            }
        }
    }
}

/* Begins tracks of regions that have none. */
static void add_tracks(rlf_tracks *tracks, const rlf_layer_out *out)
{
    for (int32_t r = 0; r < out->region_count && tracks->count < tracks->capacity; r++) {
        const rlf_region *region = &out->regions[r];
        if (find_track(tracks, region->label) == NULL) {
            tracks->item[tracks->count++] = (rlf_track){.label = region->label,
                                                        .box = region->box,
                                                        .depth = region->centroid.z,
                                                        .points = region->point_count};
        }
    }
}

static int32_t fresh_label(rlf_reconstruct *stage)
{
    stage->next_label = stage->next_label < LABEL_LIMIT ? stage->next_label + 1 : 1;
    return stage->next_label;
}

/* By overlap with the regions of one surface ago. */
static void track_by_overlap(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out)
{
    vote(stage, in, out->region_count);
    find_successors(stage, in, out);
    for (int32_t k = 0; k < in->previous_count; k++) {
        int32_t successor = stage->work.vote[1][k];
        if (successor > 0) {
            out->regions[successor - 1].label = in->previous[k].label;
            out->regions[successor - 1].age_ns = in->previous[k].age_ns + in->elapsed_ns;
        }
    }
}

void rlf_region_track(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out)
{
    bool is_front = in->layer == RLF_LAYER_FOREGROUND;
    for (int32_t r = 0; r < out->region_count; r++) {
        out->regions[r].label = 0;
    }
    if (in->previous_label != NULL) {
        track_by_overlap(stage, in, out);
    }
    if (is_front) {
        predict_all(&stage->tracks, in);
        find_hidden(&stage->tracks, out);
    }
    for (int32_t r = 0; r < out->region_count; r++) {
        rlf_region *region = &out->regions[r];
        region->label = region->label != 0 ? region->label : fresh_label(stage);
    }
    if (is_front) {
        add_tracks(&stage->tracks, out);
    }
}

void tracks_allocate(rlf_tracks *state, rlf_arena *arena, const rlf_reconstruct_def *def)
{
    state->capacity = 2 * def->region_capacity;
    state->item = arena_take(arena, (size_t)state->capacity, sizeof *state->item);
}
