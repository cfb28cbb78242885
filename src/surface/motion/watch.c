/* Keyframes of what stands in the background: whether it moves. */
#include "surface/motion/keyframe.h"
#include "surface/steps.h"

#include <string.h>

enum {
    TAKEN_PER_FRAME = 4,
    LEAST_SIZE = 60, /* pixels of a thing */
    SAME_PX = 2,     /* that the ends of the same thing differ from one look to the next ... */
    SAME_SHARE = 10, /* ... and one of so many parts of its extent */
    IMAGE_SHARE = 5, /* what fills more than one of so many parts of the image is the room */
    CAMERA_MOST = 3  /* of so many things that move at once, more than half of all: the camera */
};

/* Squared sums of 6 and 3 normal variables that chance exceeds once in 10000 times. */
static const double significant_6 = 27.9, significant_3 = 21.1;
/* Times its mean square, a pose's square counts: what begins to move is not noise. */
static const double far_scatter = 4.0;

/* Whether two rows of pixels are the same but for the pixels at their ends. */
static bool is_near(int32_t a0, int32_t a1, int32_t b0, int32_t b1)
{
    const int32_t most = SAME_PX + (a1 - a0) / SAME_SHARE;
    return a0 - b0 <= most && b0 - a0 <= most && a1 - b1 <= most && b1 - a1 <= most;
}

static bool is_like(const rlf_keyframe *key, const rlf_rect *rect, int32_t size)
{
    const rlf_rect *a = &key->rect;
    return is_near(a->x0, a->x1, rect->x0, rect->x1) && is_near(a->y0, a->y1, rect->y0, rect->y1) &&
           4 * size >= 3 * key->size && 4 * key->size >= 3 * size;
}

void keyframes_take_things(rlf_reconstruct *stage)
{
    velocity_planes *state = &stage->velocity;
    const rlf_depart *depart = &stage->background.depart;
    memset(state->is_taken, 0, sizeof(state->is_taken));
    state->next_thing = 1;
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        rlf_keyframe *key = &state->keyframe[i];
        int32_t found = 0;
        for (int32_t k = 1; k <= RLF_PIECES && key->state == KEYFRAME_RESTS && found == 0; k++) {
            found =
                !state->is_taken[k] && is_like(key, &depart->extent[k], depart->size[k]) ? k : 0;
        }
        key->state = key->state == KEYFRAME_RESTS && found == 0 ? KEYFRAME_NONE : key->state;
        key->thing = found;
        state->is_taken[found] = true;
    }
}

/* Some of the things that have none yet. */
static void take_some(rlf_reconstruct *stage)
{
    velocity_planes *state = &stage->velocity;
    const rlf_depart *depart = &stage->background.depart;
    const background_image *image = background_image_newest(stage);
    int32_t taken = 0;
    for (; state->next_thing <= RLF_PIECES && taken < TAKEN_PER_FRAME; state->next_thing++) {
        const int32_t k = state->next_thing;
        const rlf_rect *e = &depart->extent[k];
        const int32_t size = depart->size[k];
        rlf_keyframe *key = keyframe_find_free(state);
        if (key == NULL || state->is_taken[k] || size < LEAST_SIZE ||
            (e->x1 - e->x0) * (e->y1 - e->y0) > stage->grid.count / IMAGE_SHARE) {
            continue;
        }
        const keyframe_view view = {&stage->grid,
                                    depart->thing,
                                    NULL,
                                    k,
                                    depart->depth,
                                    depart->depth,
                                    (const float *const *)image->normal,
                                    rlf_kernel_noise_make(&stage->def.rig.noise)};
        taken++;
        if (keyframe_take(&view, e, size, key)) {
            key->thing = k;
        }
    }
}

static void learn(const keyframe_frame *frame, const keyframe_fit *rest, const double x[6],
                  rlf_keyframe *key)
{
    key->rests += key->rests < 3 * KEYFRAME_REST ? 1 : 0;
    for (int k = 0; k < 6; k++) {
        const double most = key->rests > KEYFRAME_REST / 2 ? far_scatter * key->scatter[k] : 1.0;
        key->scatter[k] += (rlf_min(x[k] * x[k], most) - key->scatter[k]) / key->rests;
    }
    if (key->rests <= KEYFRAME_REST / 2 || keyframe_agrees(key, rest)) {
        keyframe_learn(frame, key);
    }
}

/* Whether most of what is not hidden of a thing is seen past: it has changed its shape or its pose
 * beyond what is rigid. Twice in three frames it has left. */
static bool is_seen_past(const rlf_keyframe *key, const keyframe_fit *rest)
{
    return 2 * rest->points > key->point_count && 2 * rest->agree < rest->points;
}

/* True when a thing that rested is told to move: twice in three frames it is elsewhere, and that
 * explains what is seen better; and the two are nearer to each other than to rest. Once is enough
 * where rest explains hardly anything. */
static bool watch(const keyframe_frame *frame, double time_s, rlf_keyframe *key)
{
    keyframe_fit fit = {.points = 0}, rest;
    double change[6], spread[6][6];
    keyframe_look(frame, key, 0.0, &fit);
    rest = fit;
    keyframe_register(frame, key, &fit);
    for (int k = 0; k < 6; k++) {
        change[k] = fit.x[k] - key->x[k];
    }
    const double same = keyframe_off(frame, key, &fit, change, spread);
    const double off = keyframe_off(frame, key, &fit, fit.x, spread);
    const double gain = rest.cost - fit.cost;
    const bool is_elsewhere = key->rests >= KEYFRAME_REST && off > significant_6 &&
                              gain > significant_6 && keyframe_agrees(key, &fit);
    const bool is_clear = 2 * (rest.agree + rest.rims_agree) < fit.agree + fit.rims_agree;
    const bool is_past = is_seen_past(key, &rest);
    const bool is_told = (is_elsewhere && (is_clear || ((key->moved & 3) != 0 && same < off))) ||
                         (is_past && (key->past & 3) != 0);
    if (!is_elsewhere && !is_past) {
        learn(frame, &rest, fit.x, key);
    }
    key->moved = (uint8_t)(key->moved << 1 | (is_elsewhere ? 1 : 0));
    key->past = (uint8_t)(key->past << 1 | (is_past ? 1 : 0));
    memcpy(key->spread, spread, sizeof(spread));
    double way = 0.0;
    for (int c = 0; c < 3; c++) {
        way += fit.x[c] * fit.x[c] / spread[c][c];
    }
    key->ring_count = way < significant_3 ? 0 : key->ring_count; /* it has not yet begun */
    keyframe_push(key, time_s, fit.x);
    return is_told;
}

static void start(rlf_keyframe *key)
{
    key->state = KEYFRAME_MOVES;
    key->thing = 0;
    key->is_whole = key->has_stood = true;
    keyframe_measure_velocity(key);
}

void keyframes_watch(rlf_reconstruct *stage, const rlf_slot *slot, uint8_t *departed)
{
    velocity_planes *state = &stage->velocity;
    const keyframe_frame frame = keyframe_frame_of(stage);
    const double time_s = 1e-9 * (double)slot->surface.time_ns;
    int32_t moving = 0, resting = 0;
    take_some(stage);
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        rlf_keyframe *key = &state->keyframe[i];
        if (key->state == KEYFRAME_RESTS) {
            resting++;
            departed[key->thing] = watch(&frame, time_s, key);
            moving += departed[key->thing];
        }
    }
    if (moving >= CAMERA_MOST && 2 * moving > resting) {
        memset(departed, 0, RLF_PIECES + 1);
    }
    for (int32_t i = 0; i < RLF_KEYFRAMES && moving > 0; i++) {
        rlf_keyframe *key = &state->keyframe[i];
        if (key->state == KEYFRAME_RESTS && departed[key->thing]) {
            start(key);
        }
    }
}
