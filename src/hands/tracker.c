/* The stage: from a surface to its hands. */
#include "base/checks.h"
#include "hands/follow.h"
#include "hands/limbs.h"
#include "hands/gesture.h"

#include <string.h>

#define CONFIDENCE_LEAST 0.05  /* below it nobody asks */
#define FIT_GATE_M 0.12        /* a palm goes on with a fit that was so near */
#define FAR_FOOTPRINT_M 0.0084 /* of a pixel: two across a finger; */
#define SAME_M 0.09            /* a limb's end is that near to a fit that is the same hand */
#define UNFITTED 0.45          /* of the limb's likeness, where no fit says more */
#define FAR_LIMB 0.7           /* where two pixels cross a finger, no fit makes a limb likelier */
#define GO_ON_S 0.12           /* a fit goes on without a limb's end near it after such gaps, */
#define ALONE_LIMB 0.2         /* where it has been one, */
#define ALONE_ENERGY 45.0      /* while one frame fits it so well, */
#define ALONE_KEEP 0.98        /* less likely with each frame */
#define FIT_GAP_S 0.3          /* a fit that is older begins anew */

/* The fingers of one hand over frames. */
typedef struct hand_fitted {
    hand_search search;
    rlf_vec3 palm;
    double limb, radius; /* likeness of its limb, and of its palm, metres, when it last had one */
    int64_t last_ns;     /* 0 = free */
    bool is_taken;       /* in this frame */
} hand_fitted;

struct rlf_hand_tracker {
    rlf_hand_tracker_def def;
    rlf_vec3 down; /* unit, or 0 */
    hand_cells cells;
    hand_limbs limbs;
    hand_patch *patch;
    hand_follow follow;
    hand_seen seen[SEEN_MAX];
    hand_crop *crop;
    hand_fitted fitted[FITS_MAX];
    uint32_t turn; /* frames since the beginning */
    uint8_t *owner;
    rlf_hands out;
};

rlf_hand_tracker_def rlf_hand_tracker_def_default(int32_t width, int32_t height)
{
    rlf_hand_tracker_def def = {.cookie = RLF_DEF_COOKIE};
    def.width = width;
    def.height = height;
    def.smooth_hz = 1.0;
    def.smooth_opening = 20.0;
    return def;
}

static rlf_result check(const rlf_hand_tracker_def *def)
{
    if (def->width < 1 || def->height < 1 || def->width > 16384 || def->height > 16384) {
        return rlf_fail(RLF_ERROR_INVALID, "hand tracker def: width x height is %d x %d",
                        (int)def->width, (int)def->height);
    }
    if (!(def->smooth_hz > 0.0 && def->smooth_hz < 1e6)) {
        return rlf_fail(RLF_ERROR_INVALID, "hand tracker def: smooth_hz is %g, not > 0",
                        def->smooth_hz);
    }
    if (!(def->smooth_opening >= 0.0 && def->smooth_opening < 1e6)) {
        return rlf_fail(RLF_ERROR_INVALID, "hand tracker def: smooth_opening is %g, not >= 0",
                        def->smooth_opening);
    }
    return RLF_OK;
}

static bool allocate(rlf_hand_tracker *t)
{
    const size_t n = (size_t)t->def.width * (size_t)t->def.height;
    hand_cells *c = &t->cells;
    hand_limbs *l = &t->limbs;
    c->z = rlf_alloc_array(n, sizeof(float));
    c->noise_of = rlf_alloc_array(n, sizeof(float));
    c->reach = rlf_alloc_array(n, sizeof(float));
    c->root = rlf_alloc_array(n, 1);
    c->source = rlf_alloc_array(n, sizeof(int32_t));
    c->disc = rlf_alloc_array(n, sizeof(int32_t));
    c->queue = rlf_alloc_array(n + 1, sizeof(int32_t));
    c->queued = rlf_alloc_array(n, 1);
    c->touched = rlf_alloc_array(n, sizeof(int32_t));
    l->owner = rlf_alloc_array(n, 1);
    l->along = rlf_alloc_array(n, sizeof(float));
    l->from_tip = rlf_alloc_array(n, sizeof(float));
    t->owner = rlf_alloc_array(n, 1);
    t->patch = rlf_alloc(sizeof(*t->patch));
    t->crop = rlf_alloc(sizeof(*t->crop));
    return c->z != NULL && c->noise_of != NULL && c->reach != NULL && c->root != NULL &&
           c->source != NULL && c->disc != NULL && c->queue != NULL && c->queued != NULL &&
           c->touched != NULL && l->owner != NULL && l->along != NULL && l->from_tip != NULL &&
           t->owner != NULL && t->patch != NULL && t->crop != NULL;
}

rlf_result rlf_hand_tracker_create(const rlf_hand_tracker_def *def, rlf_hand_tracker **out)
{
    if (!RLF_ASSERT(out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    if (!RLF_ASSERT(def != NULL && def->cookie == RLF_DEF_COOKIE)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "hand tracker def: start from rlf_hand_tracker_def_default");
    }
    const rlf_result result = check(def);
    if (result != RLF_OK) {
        return result;
    }
    rlf_hand_tracker *t = rlf_alloc(sizeof(*t));
    if (t == NULL) {
        return RLF_ERROR_MEMORY;
    }
    t->def = *def;
    t->down = rlf_vec3_make(0.0, 1.0, 0.0);
    if (!allocate(t)) {
        rlf_hand_tracker_destroy(&t);
        return RLF_ERROR_MEMORY;
    }
    t->out.owner = t->owner;
    t->out.width = def->width;
    t->out.height = def->height;
    rlf_hand_tracker_reset(t);
    *out = t;
    return RLF_OK;
}

void rlf_hand_tracker_destroy(rlf_hand_tracker **tracker)
{
    if (tracker == NULL || *tracker == NULL) {
        return;
    }
    rlf_hand_tracker *t = *tracker;
    *tracker = NULL;
    void *const memory[] = {t->cells.z,       t->cells.noise_of, t->cells.reach, t->cells.root,
                            t->cells.source,  t->cells.disc,     t->cells.queue, t->cells.queued,
                            t->cells.touched, t->limbs.owner,    t->limbs.along, t->limbs.from_tip,
                            t->owner,         t->patch,          t->crop};
    for (size_t k = 0; k < sizeof(memory) / sizeof(memory[0]); k++) {
        rlf_free(memory[k]);
    }
    rlf_free(t);
}

void rlf_hand_tracker_reset(rlf_hand_tracker *t)
{
    if (!RLF_ASSERT(t != NULL)) {
        return;
    }
    memset(&t->follow, 0, sizeof(t->follow));
    memset(t->fitted, 0, sizeof(t->fitted));
    t->turn = 0;
    t->follow.smooth_hz = t->def.smooth_hz;
    t->follow.smooth_opening = t->def.smooth_opening;
    t->out.count = 0;
    t->out.event_count = 0;
}

void rlf_hand_tracker_set_down(rlf_hand_tracker *t, rlf_vec3 down)
{
    if (RLF_ASSERT(t != NULL && rlf_vec3_is_finite(down))) {
        const double length = rlf_length(down);
        t->down = length > 0.0 ? rlf_scale(down, 1.0 / length) : down;
    }
}

/* Marks the hand's pixels with 1 + the index of its limb, where they are nobody's. */
static void own(rlf_hand_tracker *t, int32_t limb)
{
    const hand_crop *c = t->crop;
    for (int32_t i = 0; i < c->pixel_count; i++) {
        const int32_t x0 = c->x0 + c->pixel[i] % c->width * c->step;
        const int32_t y0 = c->y0 + c->pixel[i] / c->width * c->step;
        for (int32_t y = y0; y < y0 + c->step && y < t->def.height; y++) {
            for (int32_t x = x0; x < x0 + c->step && x < t->def.width; x++) {
                uint8_t *owner = &t->owner[y * t->def.width + x];
                *owner = *owner == 0 ? (uint8_t)(limb + 1) : *owner;
            }
        }
    }
}

/* Ends of limbs that may be hands. */
static int32_t see_limbs(rlf_hand_tracker *t, const rlf_surface *surface)
{
    int32_t count = 0;
    for (int32_t k = 0; k < t->limbs.count; k++) {
        hand_palm palm;
        hand_seen *seen = &t->seen[count];
        if (!hand_patch_read(t->patch, surface, &t->cells, &t->limbs, k) ||
            !hand_palm_find(&palm, t->patch)) {
            continue;
        }
        hand_gesture_begin(&seen->hand, t->patch, &palm);
        seen->limb = k;
        seen->hand.confidence = hand_likeness_of_limb(&t->limbs.limb[k], &palm);
        if (seen->hand.confidence >= CONFIDENCE_LEAST) {
            seen->no_foot = 1.0 - hand_foot_likeness(&t->cells, palm.centre, t->down);
        }
        if (seen->hand.confidence >= CONFIDENCE_LEAST &&
            seen->hand.confidence * seen->no_foot >= CONFIDENCE_LEAST) {
            seen->right = hand_side_of(&t->cells, &t->limbs.limb[k], palm.arm);
            count++;
        }
    }
    return count;
}

/* The fit that goes on at that palm, or one to begin with. */
static hand_fitted *fit_at(rlf_hand_tracker *t, rlf_vec3 palm, double *out_dt)
{
    hand_fitted *best = NULL;
    double least = FIT_GATE_M;
    for (int32_t k = 0; k < FITS_MAX; k++) {
        hand_fitted *f = &t->fitted[k];
        const double dt = (double)(t->out.time_ns - f->last_ns) * 1e-9;
        const double far = rlf_length(rlf_sub(f->palm, palm));
        if (!f->is_taken && f->last_ns > 0 && dt > 0.0 && dt < FIT_GAP_S && far < least) {
            best = f;
            least = far;
            *out_dt = dt;
        }
    }
    for (int32_t k = 0; k < FITS_MAX && best == NULL; k++) {
        hand_fitted *f = &t->fitted[k];
        if (!f->is_taken && (best == NULL || f->last_ns < best->last_ns)) {
            best = f;
        }
    }
    return best;
}

static bool fit_hand(rlf_hand_tracker *t, const rlf_surface *surface, hand_seen *seen)
{
    hand_sight sight = {seen->hand.palm, seen->hand.normal, seen->hand.arm_direction, seen->right};
    double dt = 0.0;
    hand_fitted *f = fit_at(t, sight.palm, &dt);
    if (dt == 0.0) {
        hand_search_begin(&f->search);
    } else {
        hand_search_expect(&f->search, &sight, dt);
    }
    if (!hand_crop_read(t->crop, surface, sight.palm, sight.arm, t->turn)) {
        return false;
    }
    f->is_taken = true;
    f->palm = sight.palm;
    f->limb = seen->hand.confidence;
    f->radius = seen->hand.palm_radius;
    own(t, seen->limb);
    f->last_ns = t->out.time_ns;
    if (!hand_search_update(&f->search, t->crop, &sight, dt)) {
        return false;
    }
    const double energy = f->search.hope[0].energy;
    if (seen->limb >= LIMBS_MAX && f->search.hope[0].fit.energy > ALONE_ENERGY) {
        return false;
    }
    hand_gesture_read(&seen->hand, &f->search, t->crop);
    const double thing = hand_likeness_of_thing(t->crop);
    const double pixel = sight.palm.z / t->crop->fx, area = pixel * pixel * t->crop->pixel_count;
    const double fitted = hand_likeness_of_fit(seen->hand.confidence, energy, thing, area);
    const bool is_far = sight.palm.z > FAR_FOOTPRINT_M * surface->camera.fx;
    seen->hand.confidence = is_far ? rlf_min(fitted, FAR_LIMB * seen->hand.confidence) : fitted;
    return true;
}

/* The likeliest hands' fingers. */
static void fit_all(rlf_hand_tracker *t, const rlf_surface *surface, int32_t count)
{
    bool is_done[SEEN_MAX] = {false};
    double limb[SEEN_MAX];
    for (int32_t k = 0; k < FITS_MAX; k++) {
        t->fitted[k].is_taken = false;
    }
    for (int32_t i = 0; i < count; i++) {
        limb[i] = t->seen[i].hand.confidence;
        t->seen[i].hand.confidence *= UNFITTED;
    }
    for (int32_t n = 0; n < FITS_MAX && n < count; n++) {
        int32_t best = -1;
        for (int32_t i = 0; i < count; i++) {
            best = !is_done[i] && (best < 0 || limb[i] > limb[best]) ? i : best;
        }
        is_done[best] = true;
        t->seen[best].hand.confidence = limb[best];
        if (!fit_hand(t, surface, &t->seen[best])) {
            t->seen[best].hand.confidence *= UNFITTED;
        }
    }
    for (int32_t i = 0; i < count; i++) {
        t->seen[i].hand.confidence *= t->seen[i].no_foot;
    }
    t->turn++;
}

/* Whether the end of a limb is that hand, or lies on its forearm. */
static bool is_of_limb(const hand_model *m, rlf_vec3 palm, rlf_vec3 seen)
{
    const rlf_vec3 arm = rlf_sub(m->b[MODEL_CONES - 1], palm);
    const double along = rlf_dot(rlf_sub(seen, palm), arm) / rlf_dot(arm, arm);
    const rlf_vec3 near = rlf_mad(palm, arm, rlf_clamp(along, 0.0, 1.0));
    return rlf_length(rlf_sub(near, seen)) < SAME_M;
}

/* A hand that lies on a thing, or is closed before its arm, ends no limb: where its fit was good it
 * goes on by its own pixels. */
static int32_t see_fits(rlf_hand_tracker *t, int32_t count)
{
    const int32_t limbs = count;
    for (int32_t k = 0; k < FITS_MAX; k++) {
        const hand_fitted *f = &t->fitted[k];
        const hand_hope *hope = &f->search.hope[0];
        const double dt = (double)(t->out.time_ns - f->last_ns) * 1e-9;
        if (f->last_ns == 0 || !(dt > 0.0 && dt < GO_ON_S) || f->search.count == 0 ||
            hope->energy > SEARCH_SURE || f->limb < ALONE_LIMB) {
            continue;
        }
        hand_model m;
        hand_model_build(&m, &hope->fit.pose);
        const rlf_vec3 palm = rlf_mad(m.palm, hope->velocity, dt);
        bool has_limb = false;
        for (int32_t i = 0; i < limbs; i++) {
            has_limb = has_limb || is_of_limb(&m, palm, t->seen[i].hand.palm);
        }
        if (!has_limb) {
            hand_seen *seen = &t->seen[count++];
            *seen = (hand_seen){.limb = LIMBS_MAX + k, .no_foot = 1.0};
            hand_gesture_go_on(&seen->hand, &m, palm, f->radius);
            seen->hand.confidence = ALONE_KEEP * f->limb;
        }
    }
    return count;
}

static int32_t see_all(rlf_hand_tracker *t, const rlf_surface *surface)
{
    const int32_t count = see_fits(t, see_limbs(t, surface));
    fit_all(t, surface, count);
    return count;
}

/* From indices of limbs to those of hands. */
static void rename_owners(rlf_hand_tracker *t)
{
    uint8_t name[SEEN_MAX + 1] = {0};
    for (int32_t k = 0; k < RLF_HANDS_MAX; k++) {
        const hand_track *track = &t->follow.track[k];
        for (int32_t i = 0; i < t->out.count; i++) {
            if (track->hand.id > 0 && track->is_seen && t->out.hand[i].id == track->hand.id) {
                name[track->limb + 1] = (uint8_t)(i + 1);
            }
        }
    }
    const int32_t count = t->def.width * t->def.height;
    for (int32_t i = 0; i < count; i++) {
        uint64_t eight = 1;
        if (i + 8 <= count) {
            memcpy(&eight, t->owner + i, sizeof(eight));
        }
        if (eight == 0) { /* most of a picture is nobody's */
            i += 7;
        } else {
            t->owner[i] = name[t->owner[i]];
        }
    }
}

const rlf_hands *rlf_hand_tracker_update(rlf_hand_tracker *t, const rlf_surface *surface)
{
    if (!RLF_ASSERT(t != NULL && surface != NULL && surface->width == t->def.width &&
                    surface->height == t->def.height)) {
        return NULL;
    }
    int32_t count = 0;
    t->out.sequence = surface->sequence;
    t->out.time_ns = surface->time_ns;
    memset(t->owner, 0, (size_t)t->def.width * (size_t)t->def.height);
    if (hand_cells_read(&t->cells, surface)) {
        hand_limbs_find(&t->limbs, &t->cells);
        count = see_all(t, surface);
    }
    hand_follow_update(&t->follow, t->seen, count, &t->out);
    rename_owners(t);
    return &t->out;
}
