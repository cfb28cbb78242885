/* Labels of what is hidden for a while: a person behind another is seen in parts, or not at all.
 *
 * A region that is new has come out of one that was near by: it was cut off from it, or it is what
 * comes out on the other side of whatever hides it. As long as both are seen each has its own
 * label. When the one whose label it was is seen no more, its largest part takes the label over. */
#include "surface/steps.h"

#include <math.h>

enum { LABEL_LIMIT = 1 << 30 };

/* Metres from what a part belongs to: aside of its rectangle, and in depth. */
static const double MOST_ASIDE = 0.25, MOST_BEHIND = 0.4;
static const double WHOLE = 0.75, FADING = 0.98; /* share of the points, per frame */
static const int64_t MEMORY_NS = 1000000000;     /* of what is hidden, and of what was cut off */

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

static rlf_kin *find_kin(const rlf_family *family, int32_t label)
{
    for (int32_t k = 0; k < family->count; k++) {
        if (family->kin[k].label == label) {
            return &family->kin[k];
        }
    }
    return NULL;
}

/* Brings what is known of the regions of one surface ago up to now; forgets what is long gone. */
static void look_back(rlf_family *family, const rlf_layer_in *in)
{
    int32_t kept = 0;
    for (int32_t k = 0; k < family->count; k++) {
        rlf_kin kin = family->kin[k];
        const rlf_region *before = find_label(in->previous, in->previous_count, kin.label);
        kin.points *= FADING;
        if (before != NULL) {
            kin.age_ns = before->age_ns;
            kin.hidden_ns = 0;
        }
        if (before != NULL && before->point_count >= WHOLE * kin.points) {
            kin.velocity = before->linear_velocity;
            kin.box = before->box;
            kin.depth = before->centroid.z;
            kin.points = rlf_max(kin.points, before->point_count);
        }
        kin.hidden_ns += in->elapsed_ns;
        rlf_vec3 way = rlf_scale(kin.velocity, 1e-9 * (double)in->elapsed_ns);
        kin.box = (rlf_aabb){rlf_add(kin.box.min, way), rlf_add(kin.box.max, way)};
        kin.depth += way.z;
        kin.origin = kin.age_ns > MEMORY_NS ? 0 : kin.origin;
        if (kin.hidden_ns <= MEMORY_NS) {
            family->kin[kept++] = kin;
        }
    }
    family->count = kept;
}

/* How far a region is from where something is expected, in depth; huge when it is aside of that.
 * Not by boxes, which a few stray pixels make too long in depth. */
static double distance_from(const rlf_kin *kin, rlf_vec3 p)
{
    double x = rlf_max(kin->box.min.x - p.x, p.x - kin->box.max.x);
    double y = rlf_max(kin->box.min.y - p.y, p.y - kin->box.max.y);
    double off = p.z < kin->depth ? kin->depth - p.z : p.z - kin->depth;
    return rlf_max(x, y) <= MOST_ASIDE ? off : HUGE_VAL;
}

/* What a new region is a part of; NULL = of nothing. Whose its pixels were does not tell: those of
 * what comes out were what has hidden it. */
static const rlf_kin *origin_of(const rlf_family *family, const rlf_region *region)
{
    const rlf_kin *origin = NULL;
    double nearest = MOST_BEHIND;
    for (int32_t k = 0; k < family->count; k++) {
        double away = distance_from(&family->kin[k], region->centroid);
        if (away < nearest) {
            nearest = away;
            origin = &family->kin[k];
        }
    }
    return origin;
}

/* The largest region that came out of the one with a label; NULL = none. */
static rlf_region *largest_part(const rlf_family *family, const rlf_layer_out *out, int32_t label)
{
    rlf_region *largest = NULL;
    for (int32_t r = 0; r < out->region_count; r++) {
        bool is_part = family->origin[r] == label;
        bool larger = largest == NULL || out->regions[r].point_count > largest->point_count;
        largest = is_part && larger ? &out->regions[r] : largest;
    }
    return largest;
}

/* Gives labels that no region has any more to the largest of their parts. */
static void take_over(rlf_family *family, const rlf_layer_out *out)
{
    for (int32_t k = 0; k < family->count; k++) {
        const rlf_kin *kin = &family->kin[k];
        if (find_label(out->regions, out->region_count, kin->label) != NULL) {
            continue;
        }
        rlf_region *heir = largest_part(family, out, kin->label);
        if (heir != NULL) {
            heir->label = kin->label;
            heir->age_ns = kin->age_ns + kin->hidden_ns;
            family->origin[heir - out->regions] = 0;
        }
    }
}

/* Takes note of the regions of now; what is hidden stays. */
static void note(rlf_family *family, const rlf_layer_out *out)
{
    for (int32_t r = 0; r < out->region_count; r++) {
        const rlf_region *region = &out->regions[r];
        rlf_kin *kin = find_kin(family, region->label);
        if (kin != NULL) {
            kin->origin = family->origin[r];
        } else if (family->count < family->capacity) {
            family->kin[family->count++] = (rlf_kin){.label = region->label,
                                                     .origin = family->origin[r],
                                                     .box = region->box,
                                                     .depth = region->centroid.z,
                                                     .points = region->point_count};
        }
    }
}

void rlf_region_name(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out)
{
    rlf_family *family = &stage->family;
    look_back(family, in);
    for (int32_t r = 0; r < out->region_count; r++) {
        const rlf_region *region = &out->regions[r];
        bool is_new = region->label == 0;
        const rlf_kin *kin = is_new ? origin_of(family, region) : find_kin(family, region->label);
        int32_t root = kin != NULL ? kin->origin : 0;
        family->origin[r] = is_new && kin != NULL && root == 0 ? kin->label : root;
    }
    take_over(family, out);
    for (int32_t r = 0; r < out->region_count; r++) {
        rlf_region *region = &out->regions[r];
        region->label = region->label != 0 ? region->label : rlf_region_fresh_label(stage);
    }
    note(family, out);
}

int32_t rlf_region_fresh_label(rlf_reconstruct *stage)
{
    stage->next_label = stage->next_label < LABEL_LIMIT ? stage->next_label + 1 : 1;
    return stage->next_label;
}

void family_allocate(rlf_family *state, rlf_arena *arena, const rlf_reconstruct_def *def)
{
    state->capacity = 2 * def->region_capacity;
    state->kin = arena_take(arena, (size_t)state->capacity, sizeof *state->kin);
    state->origin = arena_take(arena, (size_t)def->region_capacity, sizeof *state->origin);
}
