/* Things that stand still, by their place in the room: labels end when a thing is half fused. */
#include "pipeline/moving/absorb.h"

#define STRAY_M 0.05 /* a centroid that stands: seen from elsewhere it shows another side */
#define PART 1.1     /* no part of a thing is larger than the thing by more than this */
#define GONE_NS 2000000000

/* The thing that a region is, or for one that is fused already, a part of. */
static absorb_thing *find(absorb *a, const absorb_thing *region, int64_t after_ns)
{
    for (int32_t i = 0; i < a->thing_count; i++) {
        absorb_thing *thing = &a->thing[i];
        const double way = rlf_length(rlf_sub(region->place, thing->place));
        const bool is_room = region->seen_ns - thing->since_ns >= after_ns;
        if (way < STRAY_M ||
            (is_room && way < thing->radius && region->radius < PART * thing->radius)) {
            return thing;
        }
    }
    return NULL;
}

static void forget(absorb *a, int64_t now_ns)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < a->thing_count; i++) {
        const int64_t unseen_ns = now_ns - a->thing[i].seen_ns;
        if (unseen_ns >= 0 && unseen_ns < GONE_NS) {
            a->thing[kept++] = a->thing[i];
        }
    }
    a->thing_count = kept;
}

void absorb_update(absorb *a, const rlf_surface *s, const rlf_pose *T_world_camera, double after_s)
{
    const int64_t after_ns = (int64_t)(1e9 * rlf_clamp(after_s, 0.0, 1e9));
    a->label_count = 0;
    forget(a, s->time_ns);
    for (int32_t i = 0; i < s->region_count && after_ns > 0; i++) {
        const rlf_region *r = &s->regions[i];
        if (r->layer != RLF_LAYER_FOREGROUND) {
            continue;
        }
        const absorb_thing region = {rlf_transform(T_world_camera, r->centroid),
                                     0.5 * rlf_length(rlf_sub(r->box.max, r->box.min)), s->time_ns,
                                     s->time_ns};
        absorb_thing *thing = find(a, &region, after_ns);
        if (thing == NULL && a->thing_count < ABSORB_THINGS) {
            thing = &a->thing[a->thing_count++];
            *thing = region;
        }
        if (thing == NULL) {
            continue;
        }
        thing->seen_ns = s->time_ns;
        if (s->time_ns - thing->since_ns >= after_ns && a->label_count < ABSORB_LABELS) {
            a->label[a->label_count++] = r->label;
        }
    }
}

bool absorb_is_room(const absorb *a, int32_t label)
{
    for (int32_t i = 0; i < a->label_count; i++) {
        if (a->label[i] == label) {
            return true;
        }
    }
    return false;
}
