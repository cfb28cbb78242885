/* Keyframes from frame to frame: what rested and moves, and how fast. */
#include "math/solve_six.h"
#include "surface/motion/keyframe.h"
#include "surface/steps.h"

#include <math.h>
#include <string.h>

enum {
    TAKEN_PER_FRAME = 4,
    LEAST_SIZE = 60, /* pixels of a thing */
    SAME_RECT = 2,   /* pixels that a thing's rectangle changes from one look to the next */
    IMAGE_SHARE = 5, /* what fills more than one of so many parts of the image is the room */
    REST_FRAMES = 8, /* without motion that shows: it rests */
    CAMERA_MOST = 3  /* of so many things that move at once, more than half of all: the camera */
};

/* Squared sums of 6 and 3 normal variables that chance exceeds once in 100 times. */
static const double significant_6 = 16.8, significant_3 = 11.3;
/* A mean of it: no more is at rest. */
static const double quiet_6 = 8.0;
/* Of what is seen so much agrees with a motion; and of the keyframe so much is seen. */
static const double agree_share = 0.6, seen_share = 0.4;

void keyframes_reset(velocity_planes *state)
{
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        state->keyframe[i].state = KEYFRAME_NONE;
    }
    state->next_thing = RLF_PIECES + 1;
}

static bool is_like(const rlf_keyframe *key, const rlf_rect *rect, int32_t size)
{
    const rlf_rect *a = &key->rect;
    const int32_t off[4] = {a->x0 - rect->x0, a->x1 - rect->x1, a->y0 - rect->y0,
                            a->y1 - rect->y1};
    for (int k = 0; k < 4; k++) {
        if (off[k] > SAME_RECT || off[k] < -SAME_RECT) {
            return false;
        }
    }
    return 10 * size >= 9 * key->size && 10 * key->size >= 9 * size;
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
            found = !state->is_taken[k] && is_like(key, &depart->extent[k], depart->size[k]) ? k : 0;
        }
        key->state = key->state == KEYFRAME_RESTS && found == 0 ? KEYFRAME_NONE : key->state;
        key->thing = found;
        state->is_taken[found] = true;
    }
}

static rlf_keyframe *find_free(velocity_planes *state)
{
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        if (state->keyframe[i].state == KEYFRAME_NONE) {
            return &state->keyframe[i];
        }
    }
    return NULL;
}

/* Some of the things that have none yet. */
static void take_some(rlf_reconstruct *stage)
{
    velocity_planes *state = &stage->velocity;
    const rlf_depart *depart = &stage->background.depart;
    const background_image *image = background_image_newest(stage);
    const rlf_kernel_noise noise = rlf_kernel_noise_make(&stage->def.rig.noise);
    int32_t taken = 0;
    for (; state->next_thing <= RLF_PIECES && taken < TAKEN_PER_FRAME; state->next_thing++) {
        const int32_t k = state->next_thing;
        const rlf_rect *e = &depart->extent[k];
        const int32_t size = depart->size[k];
        rlf_keyframe *key = find_free(state);
        if (key == NULL || state->is_taken[k] || size < LEAST_SIZE ||
            (e->x1 - e->x0) * (e->y1 - e->y0) > stage->grid.count / IMAGE_SHARE) {
            continue;
        }
        const keyframe_view view = {&stage->grid, depart->thing, (uint8_t)k, depart->depth,
                                    (const float *const *)image->normal};
        taken++;
        if (keyframe_take(&view, e, size, &noise, key)) {
            key->thing = k;
        }
    }
}

/* ---- a frame ---- */

static bool agrees(const rlf_keyframe *key, const keyframe_fit *fit)
{
    return fit->points >= seen_share * key->point_count && fit->rims >= seen_share * key->rim_count &&
           fit->agree >= agree_share * fit->points && fit->rims_agree >= agree_share * fit->rims;
}

static void push(rlf_keyframe *key, double time_s, const double x[6])
{
    if (key->ring_count == KEYFRAME_RING) {
        memmove(key->ring, key->ring + 1, (KEYFRAME_RING - 1) * sizeof *key->ring);
        key->ring_count--;
    }
    key->ring[key->ring_count].time_s = time_s;
    memcpy(key->ring[key->ring_count++].x, x, 6 * sizeof(double));
    memcpy(key->x, x, 6 * sizeof(double));
}

/* The line through the last n poses: slope, its variance in units of a pose's, and the squares that
 * it leaves. */
static double fit_line(const rlf_keyframe *key, int32_t n, double slope[6], double *variance)
{
    const keyframe_pose *pose = &key->ring[key->ring_count - n];
    double middle = 0.0, square = 0.0, left = 0.0;
    for (int32_t k = 0; k < n; k++) {
        middle += pose[k].time_s / n;
    }
    for (int32_t k = 0; k < n; k++) {
        square += (pose[k].time_s - middle) * (pose[k].time_s - middle);
    }
    for (int c = 0; c < 6; c++) {
        double mean = 0.0, sum = 0.0;
        for (int32_t k = 0; k < n; k++) {
            mean += pose[k].x[c] / n;
            sum += (pose[k].time_s - middle) * pose[k].x[c];
        }
        slope[c] = sum / square;
        for (int32_t k = 0; k < n; k++) {
            const double off = pose[k].x[c] - mean - slope[c] * (pose[k].time_s - middle);
            left += off * off / (key->sigma[c] * key->sigma[c]);
        }
    }
    *variance = 1.0 / square;
    return left;
}

static double significance(const double slope[6], const double sigma[6], double variance, int first)
{
    double sum = 0.0;
    for (int c = first; c < first + 3; c++) {
        sum += slope[c] * slope[c] / (sigma[c] * sigma[c] * variance);
    }
    return sum;
}

/* The slope of the ring over as many frames as it is a line. */
static void measure_velocity(rlf_keyframe *key)
{
    double slope[6] = {0}, best[6] = {0}, variance, of_best = 1.0;
    memset(key->velocity, 0, sizeof(key->velocity));
    for (int32_t n = 2; n <= key->ring_count; n++) {
        const double left = fit_line(key, n, slope, &variance);
        if (n > 3 && left > significant_6 + 6.0 * (n - 3)) {
            break;
        }
        memcpy(best, slope, sizeof(best));
        of_best = variance;
    }
    for (int first = 0; first < 6; first += 3) {
        if (significance(best, key->sigma, of_best, first) > significant_3) {
            memcpy(key->velocity + first, best + first, 3 * sizeof(double));
        }
    }
}

/* True when a thing that rested is told to move. */
static bool watch(const keyframe_frame *frame, double time_s, rlf_keyframe *key)
{
    keyframe_fit fit = {.points = 0}, rest;
    double a[6][6], step[6], sigma[6];
    keyframe_look(frame, key, 0.0, &fit);
    rest = fit;
    const bool is_seen = agrees(key, &rest);
    memcpy(a, fit.a, sizeof(a));
    math_solve_six(a, fit.b, step);
    double off = keyframe_off(frame, key, &fit, step, sigma);
    if (key->rests < KEYFRAME_REST || (is_seen && off < quiet_6)) {
        if (is_seen || key->rests < KEYFRAME_REST) {
            keyframe_learn(frame, key);
        }
        key->moved = 0;
        key->ring_count = 0;
        return false;
    }
    keyframe_register(frame, key, &fit);
    off = keyframe_off(frame, key, &fit, fit.x, sigma);
    const bool is_off = off > quiet_6 && agrees(key, &fit) &&
                        fit.agree + fit.rims_agree >= rest.agree + rest.rims_agree;
    if (!is_off) {
        key->moved = (uint8_t)(key->moved << 1);
        return false;
    }
    key->moved = (uint8_t)(key->moved << 1 | (off > significant_6 ? 1 : 0));
    memcpy(key->sigma, sigma, sizeof(sigma));
    push(key, time_s, fit.x);
    const int32_t bits = key->moved & 7;
    return (bits & 1) != 0 && (bits & 6) != 0;
}

static void follow(const keyframe_frame *frame, double time_s, rlf_keyframe *key)
{
    keyframe_fit fit = {.points = 0};
    const double dt = time_s - key->ring[key->ring_count - 1].time_s;
    for (int k = 0; k < 6; k++) {
        fit.x[k] = key->x[k] + key->velocity[k] * dt;
    }
    keyframe_register(frame, key, &fit);
    if (!agrees(key, &fit)) {
        key->state = KEYFRAME_NONE;
        return;
    }
    (void)keyframe_off(frame, key, &fit, fit.x, key->sigma);
    push(key, time_s, fit.x);
    measure_velocity(key);
}

void keyframes_follow(rlf_reconstruct *stage, const rlf_slot *slot, uint8_t *departed)
{
    velocity_planes *state = &stage->velocity;
    const keyframe_frame frame = {&stage->grid, stage->work.raw,
                                  rlf_kernel_noise_make(&stage->def.rig.noise)};
    const double time_s = 1e-9 * (double)slot->surface.time_ns;
    int32_t moving = 0, resting = 0;
    take_some(stage);
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        rlf_keyframe *key = &state->keyframe[i];
        if (key->state == KEYFRAME_MOVES) {
            follow(&frame, time_s, key);
        } else if (key->state == KEYFRAME_RESTS) {
            resting++;
            departed[key->thing] = watch(&frame, time_s, key);
            moving += departed[key->thing];
        }
    }
    const bool is_camera = moving >= CAMERA_MOST && 2 * moving > resting;
    for (int32_t i = 0; i < RLF_KEYFRAMES && moving > 0; i++) {
        rlf_keyframe *key = &state->keyframe[i];
        if (key->state != KEYFRAME_RESTS || !departed[key->thing]) {
            continue;
        }
        if (is_camera) {
            departed[key->thing] = 0;
            continue;
        }
        key->state = KEYFRAME_MOVES;
        key->thing = 0;
        for (int c = 0; c < 3; c++) {
            key->told[c] = key->x[c];
        }
        measure_velocity(key);
    }
}

/* ---- regions ---- */

/* The region that most of the keyframe's points are in. */
static int32_t label_of(const rlf_reconstruct *stage, const rlf_slot *slot, const rlf_keyframe *key)
{
    int32_t label = 0, votes = 0;
    const rlf_quat q = rlf_quat_from_rotation_vector(rlf_scale(
        rlf_vec3_make(key->x[3], key->x[4], key->x[5]), 1.0 / key->length));
    const rlf_vec3 centre = rlf_add(key->centre, rlf_vec3_make(key->x[0], key->x[1], key->x[2]));
    for (int32_t k = 0; k < key->point_count; k++) {
        const float *p = key->point[k].p;
        const rlf_vec3 at = rlf_add(centre, rlf_rotate(q, rlf_vec3_make(p[0], p[1], p[2])));
        double u, v;
        if (!(at.z > 0.05) || !rlf_camera_project(&stage->grid.camera, at, &u, &v) || !(u > -0.5) ||
            !(v > -0.5) || !(u < stage->grid.width - 0.5) || !(v < stage->grid.height - 0.5)) {
            continue;
        }
        const ptrdiff_t i =
            (ptrdiff_t)(int32_t)(v + 0.5) * stage->grid.width + (int32_t)(u + 0.5);
        const int32_t seen = slot->foreground[i] ? slot->label[i] : 0;
        label = votes == 0 ? seen : label;
        votes += seen == label ? 1 : -1;
    }
    return label;
}

const rlf_keyframe *keyframe_of_region(const rlf_reconstruct *stage, const rlf_slot *slot,
                                       int32_t label)
{
    const rlf_keyframe *best = NULL;
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        const rlf_keyframe *key = &stage->velocity.keyframe[i];
        if (key->state == KEYFRAME_MOVES && label_of(stage, slot, key) == label &&
            (best == NULL || key->size > best->size)) {
            best = key;
        }
    }
    return best;
}
