/* Keyframes of the foreground's regions, from frame to frame. */
#include "surface/motion/keyframe.h"
#include "surface/steps.h"

#include <string.h>

/* Radians: from there on a thing looks otherwise. */
static const double most_turn = 0.436;
/* So much of what is seen agrees with one motion: it is of one piece, and nobody who holds his arms
 * still. */
static const double whole_share = 0.9;

void keyframes_reset(velocity_planes *state)
{
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        state->keyframe[i].state = KEYFRAME_NONE;
    }
    state->next_thing = RLF_PIECES + 1;
}

rlf_keyframe *keyframe_find_free(velocity_planes *state)
{
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        if (state->keyframe[i].state == KEYFRAME_NONE) {
            return &state->keyframe[i];
        }
    }
    return NULL;
}

keyframe_frame keyframe_frame_of(const rlf_reconstruct *stage)
{
    return (keyframe_frame){&stage->grid, stage->work.raw,
                            rlf_kernel_noise_make(&stage->def.rig.noise)};
}

/* The region that most of the keyframe's points are in. */
static int32_t label_of(const rlf_reconstruct *stage, const rlf_slot *slot, const rlf_keyframe *key)
{
    int32_t label = 0, votes = 0;
    const image_grid *grid = &stage->grid;
    for (int32_t k = 0; k < key->point_count; k++) {
        const ptrdiff_t i = keyframe_pixel(grid, key, key->point[k].p);
        const int32_t seen = i >= 0 && slot->foreground[i] ? slot->label[i] : 0;
        label = votes == 0 ? seen : label;
        votes += seen == label ? 1 : -1;
    }
    return label;
}

static bool is_turned(const rlf_keyframe *key, const double x[6])
{
    const double most = most_turn * key->length;
    return x[3] * x[3] + x[4] * x[4] + x[5] * x[5] > most * most;
}

static void follow(const keyframe_frame *frame, double time_s, rlf_keyframe *key)
{
    keyframe_fit fit = {.points = 0};
    const double dt = time_s - key->ring[key->ring_count - 1].time_s;
    if (dt == 0.0) {
        return; /* it has just started */
    }
    for (int k = 0; k < 6; k++) {
        fit.x[k] = key->x[k] + key->velocity[k] * dt;
    }
    keyframe_register(frame, key, &fit);
    if (!keyframe_agrees(key, &fit) || is_turned(key, fit.x)) {
        key->state = KEYFRAME_NONE;
        return;
    }
    (void)keyframe_off(frame, key, &fit, fit.x, key->spread);
    keyframe_push(key, time_s, fit.x);
    key->is_whole = key->has_stood || (fit.agree >= whole_share * fit.points &&
                                       fit.rims_agree >= whole_share * fit.rims);
    keyframe_measure_velocity(key);
}

/* The region's keyframe of the frame before, if it looks otherwise by now. */
static rlf_keyframe *find_left(velocity_planes *state, int32_t label)
{
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        rlf_keyframe *key = &state->keyframe[i];
        if (key->state == KEYFRAME_NONE && key->label == label && key->is_whole) {
            return key;
        }
    }
    return NULL;
}

/* The line through the poses of a keyframe that has ended, as those of the one that follows it. */
static void take_over(const rlf_keyframe *left, double time_s, rlf_keyframe *key)
{
    memcpy(key->spread, left->spread, sizeof(key->spread));
    for (int i = 0; i < 6; i++) {
        key->velocity[i] = left->velocity[i] * (i < 3 ? 1.0 : key->length / left->length);
    }
    for (int32_t k = 0; k < left->ring_count; k++) {
        double x[6];
        for (int i = 0; i < 6; i++) {
            x[i] = key->velocity[i] * (left->ring[k].time_s - time_s);
        }
        keyframe_push(key, left->ring[k].time_s, x);
    }
}

/* Of a region as it is now, if it has none: what it takes over goes on as it moved. */
static void take_region(rlf_reconstruct *stage, const rlf_slot *slot, const rlf_region *region)
{
    static const double none[6] = {0};
    rlf_keyframe *left = find_left(&stage->velocity, region->label);
    rlf_keyframe *key = left != NULL ? left : keyframe_find_free(&stage->velocity);
    const rlf_rect rect = {region->x0, region->y0, region->x1, region->y1};
    const double time_s = 1e-9 * (double)slot->surface.time_ns;
    const keyframe_view view = {&stage->grid,
                                NULL,
                                slot->label,
                                region->label,
                                slot->depth,
                                stage->work.raw,
                                (const float *const *)slot->normal,
                                rlf_kernel_noise_make(&stage->def.rig.noise)};
    if (key == NULL || keyframe_of_region(stage, region->label) != NULL) {
        return;
    }
    const rlf_keyframe before = *key;
    if (!keyframe_take(&view, &rect, region->point_count, key)) {
        return;
    }
    key->state = KEYFRAME_MOVES;
    key->label = region->label;
    key->is_whole = left != NULL;
    key->has_stood = left != NULL && before.has_stood;
    if (left != NULL) {
        take_over(&before, time_s, key);
    }
    keyframe_push(key, time_s, none);
}

static void turn(const rlf_quat *q, double v[3])
{
    const rlf_vec3 to = rlf_rotate(*q, rlf_vec3_make(v[0], v[1], v[2]));
    v[0] = to.x;
    v[1] = to.y;
    v[2] = to.z;
}

static void carry(const rlf_pose *T, rlf_keyframe *key)
{
    key->turn = rlf_quat_mul(T->q, key->turn);
    for (int first = 0; first < 6; first += 3) {
        for (int32_t k = 0; k < key->ring_count; k++) {
            turn(&T->q, key->ring[k].x + first);
        }
        turn(&T->q, key->x + first);
        turn(&T->q, key->velocity + first);
    }
    key->centre = rlf_transform(T, key->centre);
}

void keyframes_carry(velocity_planes *state, const rlf_pose *T_now_before)
{
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        if (state->keyframe[i].state == KEYFRAME_MOVES) {
            carry(T_now_before, &state->keyframe[i]);
        }
    }
}

void keyframes_follow(rlf_reconstruct *stage, const rlf_slot *slot, bool is_gap)
{
    const keyframe_frame frame = keyframe_frame_of(stage);
    const double time_s = 1e-9 * (double)slot->surface.time_ns;
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        rlf_keyframe *key = &stage->velocity.keyframe[i];
        if (key->state == KEYFRAME_MOVES && !is_gap) {
            follow(&frame, time_s, key);
        } else {
            key->state = key->state == KEYFRAME_RESTS ? KEYFRAME_RESTS : KEYFRAME_NONE;
            key->label = 0;
        }
        if (key->state == KEYFRAME_MOVES) {
            key->label = label_of(stage, slot, key);
            key->state = key->label > 0 ? KEYFRAME_MOVES : KEYFRAME_NONE;
        }
    }
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        take_region(stage, slot, &slot->regions[slot->foreground_region_first + r]);
    }
}

const rlf_keyframe *keyframe_of_region(const rlf_reconstruct *stage, int32_t label)
{
    const rlf_keyframe *best = NULL;
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        const rlf_keyframe *key = &stage->velocity.keyframe[i];
        if (key->state == KEYFRAME_MOVES && key->label == label &&
            (best == NULL || key->size > best->size)) {
            best = key;
        }
    }
    return best;
}
