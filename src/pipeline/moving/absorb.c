/* Things that stand still, by their place in the room: labels end when a thing is half fused. */
#include "pipeline/moving/moving.h"

#define STRAY_M 0.05       /* a centroid that stands: seen from elsewhere it shows another side */
#define PART 1.1           /* sizes that differ by less are the same; no part is larger */
#define BLINK_NS 200000000 /* what is not seen there for longer has gone, ... */
#define GONE_NS 2000000000 /* ... and of what is fused already the last part */

static bool is_due(const absorb_thing *thing, int64_t now_ns, int64_t after_ns)
{
    return now_ns - thing->since_ns >= after_ns;
}

/* The thing that a region is, or for one that is fused already, a part of. */
static absorb_thing *find(absorb *a, const absorb_thing *region, int64_t after_ns)
{
    for (int32_t i = 0; i < a->thing_count; i++) {
        absorb_thing *thing = &a->thing[i];
        const double way = rlf_length(rlf_sub(region->place, thing->place));
        const bool is_as_large = region->radius < PART * thing->radius;
        const bool stands = way < STRAY_M && thing->radius < PART * region->radius;
        const bool is_part = is_due(thing, region->seen_ns, after_ns) && way < thing->radius;
        if (is_as_large && (stands || is_part)) {
            return thing;
        }
    }
    return NULL;
}

/* Who comes back to where he was a while ago has not stood there. */
static void forget(absorb *a, int64_t now_ns, int64_t after_ns)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < a->thing_count; i++) {
        const int64_t unseen_ns = now_ns - a->thing[i].seen_ns;
        const bool is_room = is_due(&a->thing[i], a->thing[i].seen_ns, after_ns);
        if (unseen_ns >= 0 && unseen_ns < (is_room ? GONE_NS : BLINK_NS)) {
            a->thing[kept++] = a->thing[i];
        }
    }
    a->thing_count = kept;
}

void absorb_update(absorb *a, const rlf_surface *s, const rlf_pose *T_world_camera, double after_s)
{
    const int64_t after_ns = (int64_t)(1e9 * rlf_clamp(after_s, 0.0, 1e9));
    a->label_count = 0;
    forget(a, s->time_ns, after_ns);
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
        if (is_due(thing, s->time_ns, after_ns) && a->label_count < ABSORB_LABELS) {
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
