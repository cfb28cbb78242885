/* Keyframes from frame to frame: what rested and moves, and how fast. */
#include "math/eigen.h"
#include "surface/motion/keyframe.h"
#include "surface/steps.h"

#include <math.h>
#include <string.h>

enum {
    TAKEN_PER_FRAME = 4,
    LEAST_SIZE = 60, /* pixels of a thing */
    SAME_PX = 2,     /* that the ends of the same thing differ from one look to the next ... */
    SAME_SHARE = 10, /* ... and one of so many parts of its extent */
    IMAGE_SHARE = 5, /* what fills more than one of so many parts of the image is the room */
    LEAST_LINE = 4,  /* frames: fewer always lie on a line */
    CAMERA_MOST = 3  /* of so many things that move at once, more than half of all: the camera */
};

/* Squared sums of 6 and 3 normal variables that chance exceeds once in 10000 times; the square of
 * one that it exceeds once in 100. */
static const double significant_6 = 27.9, significant_3 = 21.1, likely_1 = 6.63;

void keyframes_reset(velocity_planes *state)
{
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        state->keyframe[i].state = KEYFRAME_NONE;
    }
    state->next_thing = RLF_PIECES + 1;
}
/* Square of a slope in units of its variance in the worst direction: it is right to 5 %. */
static const double precise = 400.0;
/* Radians: from there on a thing looks otherwise. */
static const double most_turn = 0.436;
/* So much of what is seen agrees with one motion: it is of one piece, and nobody who holds his arms
 * still. */
static const double whole_share = 0.9;
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

/* ---- a frame ---- */

static double square_of(double x)
{
    return x * x;
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

/* The line through the last n poses of the shift (first = 0) or the turn (3): its slope, the
 * variance of that in units of a pose's, and the squares that it leaves. */
static double fit_line(const rlf_keyframe *key, int first, int32_t n, double slope[3],
                       double *variance)
{
    const keyframe_pose *pose = &key->ring[key->ring_count - n];
    double middle = 0.0, square = 0.0, left = 0.0;
    for (int32_t k = 0; k < n; k++) {
        middle += pose[k].time_s / n;
    }
    for (int32_t k = 0; k < n; k++) {
        square += (pose[k].time_s - middle) * (pose[k].time_s - middle);
    }
    for (int c = 0; c < 3; c++) {
        double mean = 0.0, sum = 0.0;
        for (int32_t k = 0; k < n; k++) {
            mean += pose[k].x[first + c] / n;
            sum += (pose[k].time_s - middle) * pose[k].x[first + c];
        }
        slope[c] = sum / square;
        for (int32_t k = 0; k < n; k++) {
            const double on = mean + slope[c] * (pose[k].time_s - middle);
            left += square_of(pose[k].x[first + c] - on) / key->spread[first + c][first + c];
        }
    }
    *variance = 1.0 / square;
    return left;
}

/* Of a slope with a covariance so many times that of poses, the directions in which it is not
 * chance; nothing, unless all of it is not. */
static void keep_significant(const rlf_keyframe *key, int first, const double slope[3],
                             double variance, double out[3])
{
    double c[4][4] = {{0.0}}, value[4], axis[4][4], sum = 0.0;
    for (int i = 0; i < 3; i++) {
        memcpy(c[i], key->spread[first + i] + first, 3 * sizeof(double));
        out[i] = 0.0;
    }
    math_eigen(c, 3, value, axis);
    for (int e = 0; e < 3; e++) {
        const double v = slope[0] * axis[0][e] + slope[1] * axis[1][e] + slope[2] * axis[2][e];
        const double squares = v * v / (value[e] * variance);
        sum += squares;
        for (int i = 0; i < 3 && squares > likely_1; i++) {
            out[i] += v * axis[i][e];
        }
    }
    if (sum < significant_3) {
        memset(out, 0, 3 * sizeof(double));
    }
}

/* The slope over as few frames as tell it well, or as many as it is a line. */
static void measure_velocity(rlf_keyframe *key, int first)
{
    double slope[3] = {0}, best[3] = {0}, variance, of_best = 1.0;
    bool is_precise = false;
    for (int32_t n = 2; n <= key->ring_count && !is_precise; n++) {
        double length = 0.0, worst = 0.0;
        const double left = fit_line(key, first, n, slope, &variance);
        if (n >= LEAST_LINE && left > significant_3 + 3.0 * (n - 2)) {
            break;
        }
        for (int c = 0; c < 3; c++) {
            length += square_of(slope[c]);
            worst = rlf_max(worst, key->spread[first + c][first + c]);
        }
        is_precise = length > precise * worst * variance;
        memcpy(best, slope, sizeof(best));
        of_best = variance;
    }
    keep_significant(key, first, best, of_best, key->velocity + first);
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
    const bool is_told = is_elsewhere && (is_clear || ((key->moved & 3) != 0 && same < off));
    if (!is_elsewhere) {
        learn(frame, &rest, fit.x, key);
    }
    key->moved = (uint8_t)(key->moved << 1 | (is_elsewhere ? 1 : 0));
    memcpy(key->spread, spread, sizeof(spread));
    double way = 0.0;
    for (int c = 0; c < 3; c++) {
        way += square_of(fit.x[c]) / spread[c][c];
    }
    key->ring_count = way < significant_3 ? 0 : key->ring_count; /* it has not yet begun */
    push(key, time_s, fit.x);
    return is_told;
}

static keyframe_frame frame_of(const rlf_reconstruct *stage)
{
    return (keyframe_frame){&stage->grid, stage->work.raw,
                            rlf_kernel_noise_make(&stage->def.rig.noise)};
}

static void start(rlf_keyframe *key)
{
    key->state = KEYFRAME_MOVES;
    key->thing = 0;
    key->is_whole = key->has_stood = true;
    for (int c = 0; c < 3; c++) {
        key->told[c] = key->x[c];
    }
    measure_velocity(key, 0);
    measure_velocity(key, 3);
}

void keyframes_watch(rlf_reconstruct *stage, const rlf_slot *slot, uint8_t *departed)
{
    velocity_planes *state = &stage->velocity;
    const keyframe_frame frame = frame_of(stage);
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

/* ---- regions ---- */

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
    const double turn = square_of(x[3]) + square_of(x[4]) + square_of(x[5]);
    return turn > square_of(most_turn * key->length);
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
    push(key, time_s, fit.x);
    key->is_whole = key->has_stood || (fit.agree >= whole_share * fit.points &&
                                       fit.rims_agree >= whole_share * fit.rims);
    measure_velocity(key, 0);
    measure_velocity(key, 3);
}

/* The region's keyframe of the frame before, if it looks otherwise by now. */
static const rlf_keyframe *find_left(const velocity_planes *state, int32_t label)
{
    for (int32_t i = 0; i < RLF_KEYFRAMES; i++) {
        const rlf_keyframe *key = &state->keyframe[i];
        if (key->state == KEYFRAME_NONE && key->label == label && key->is_whole) {
            return key;
        }
    }
    return NULL;
}

/* Of a region as it is now, if it has none: what it takes over goes on as it moved. */
static void take_region(rlf_reconstruct *stage, const rlf_slot *slot, const rlf_region *region)
{
    static const double none[6] = {0};
    const rlf_keyframe *left = find_left(&stage->velocity, region->label);
    rlf_keyframe *key = left != NULL ? &stage->velocity.keyframe[left - stage->velocity.keyframe]
                                     : find_free(&stage->velocity);
    const rlf_rect rect = {region->x0, region->y0, region->x1, region->y1};
    const keyframe_view view = {&stage->grid,
                                NULL,
                                slot->label,
                                region->label,
                                slot->depth,
                                stage->work.raw,
                                (const float *const *)slot->normal,
                                rlf_kernel_noise_make(&stage->def.rig.noise)};
    rlf_keyframe before = {.state = KEYFRAME_NONE};
    if (left != NULL) {
        before = *left;
    }
    if (key == NULL || keyframe_of_region(stage, region->label) != NULL ||
        !keyframe_take(&view, &rect, region->point_count, key)) {
        return;
    }
    key->state = KEYFRAME_MOVES;
    key->label = region->label;
    key->is_whole = before.is_whole;
    key->has_stood = before.has_stood;
    memcpy(key->velocity, before.velocity, sizeof(key->velocity));
    push(key, 1e-9 * (double)slot->surface.time_ns, none);
}

static void turn(const rlf_quat *q, double v[3])
{
    const rlf_vec3 to = rlf_rotate(*q, rlf_vec3_make(v[0], v[1], v[2]));
    v[0] = to.x;
    v[1] = to.y;
    v[2] = to.z;
}

static void turn_float(const rlf_quat *q, float v[3])
{
    double to[3] = {v[0], v[1], v[2]};
    turn(q, to);
    for (int c = 0; c < 3; c++) {
        v[c] = (float)to[c];
    }
}

static void carry(const rlf_pose *T, rlf_keyframe *key)
{
    for (int32_t k = 0; k < key->point_count; k++) {
        turn_float(&T->q, key->point[k].p);
        turn_float(&T->q, key->point[k].n);
    }
    for (int32_t k = 0; k < key->rim_count; k++) {
        turn_float(&T->q, key->rim[k].p);
        turn_float(&T->q, key->rim[k].n);
        turn_float(&T->q, key->rim[k].out);
    }
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
    const keyframe_frame frame = frame_of(stage);
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
