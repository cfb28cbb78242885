/* Thickness, velocity and phantoms against truth. */
#include "eval/measures/solid.h"

#include <math.h>
#include <string.h>

#define CLOSE_M 0.05
#define FAST_M_PER_S 0.2
#define SWIFT_M_PER_S 1.5
#define STILL_M_PER_S 1e-4
#define AGE_SOON 3
#define AGE_LATE 30

void eval_solid_finish(eval_solid *e)
{
    rlf_free(e->phantoms.background);
    rlf_free(e->phantoms.age);
    e->phantoms.background = NULL;
    e->phantoms.age = NULL;
    e->phantoms.capacity = 0;
}

rlf_result eval_solid_restart(eval_solid *e, const rlf_rig *rig)
{
    eval_phantoms *p = &e->phantoms;
    int64_t count = (int64_t)rig->depth.width * rig->depth.height;
    if (p->capacity < count) {
        eval_solid_finish(e);
        p->background = rlf_alloc_array((size_t)count, sizeof *p->background);
        p->age = rlf_alloc_array((size_t)count, sizeof *p->age);
        if (p->background == NULL || p->age == NULL) {
            return RLF_ERROR_MEMORY;
        }
        p->capacity = count;
    }
    p->has_background = false;
    return RLF_OK;
}

static void add_exit(eval_exit *e, double error)
{
    error = error < 0.0 ? -error : error;
    e->count++;
    e->close += error <= CLOSE_M;
    e->sum_m += error;
}

static void add_speed(eval_speed *e, double error, double speed)
{
    double share = error / speed;
    int bin = (int)rlf_min(share * 1000.0, EVAL_SHARE_BINS - 1);
    e->bins[bin]++;
    e->sum += share;
    e->count++;
}

static void add_velocity(eval_solid *e, const rlf_surface *s, int32_t i, const rlf_truth *truth,
                         int32_t t)
{
    rlf_vec3 found = {s->velocity_x[i], s->velocity_y[i], s->velocity_z[i]};
    rlf_vec3 real = {truth->velocity_x[t], truth->velocity_y[t], truth->velocity_z[t]};
    rlf_vec3 normal = {truth->normal_x[t], truth->normal_y[t], truth->normal_z[t]};
    if (rlf_length(real) < STILL_M_PER_S) {
        e->still++;
        e->still_zero += found.x == 0.0 && found.y == 0.0 && found.z == 0.0;
    }
    if (!truth->foreground[t] || !s->foreground[i]) {
        return;
    }
    rlf_vec3 error = rlf_sub(found, real);
    double along = rlf_dot(real, normal), off = rlf_dot(error, normal);
    if (along * along > FAST_M_PER_S * FAST_M_PER_S) {
        add_speed(&e->normal, off < 0.0 ? -off : off, along < 0.0 ? -along : along);
    }
    if (rlf_length(real) > FAST_M_PER_S) {
        add_speed(&e->full, rlf_length(error), rlf_length(real));
    }
    if (rlf_length(real) > SWIFT_M_PER_S) {
        add_speed(&e->swift, rlf_length(error), rlf_length(real));
    }
}

static void add_phantom(eval_phantoms *p, const rlf_surface *s, int32_t i, const rlf_truth *truth,
                        int32_t t)
{
    float now = truth->background_depth[t];
    bool gone = p->has_background && now > p->background[t] + (float)CLOSE_M;
    bool hidden = truth->foreground[t] != 0; /* what a person hides cannot be known */
    p->age[t] = gone ? 1 : (p->age[t] > 0 ? p->age[t] + 1 : 0);
    p->age[t] = hidden || !p->has_background ? 0 : p->age[t];
    p->background[t] = now;
    bool left = s->background_depth[i] > 0.0f && s->background_depth[i] < now - (float)CLOSE_M;
    if (p->age[t] == AGE_SOON + 1) {
        p->seen_soon++;
        p->left_soon += left;
    }
    if (p->age[t] == AGE_LATE + 1) {
        p->seen_late++;
        p->left_late += left;
    }
}

static bool is_furniture(int32_t label)
{
    return (label > RLF_SYNTHETIC_LABEL_COLUMN && label < RLF_SYNTHETIC_LABEL_PERSON) ||
           label >= RLF_SYNTHETIC_LABEL_THING;
}

/* Where the background shows a thing: what bodies take for its back. */
static void add_standing(eval_solid *e, const rlf_surface *s, int32_t i, const rlf_truth *truth,
                         int32_t t)
{
    double front = s->background_depth[i], thickness = s->background_thickness[i];
    double off = front - truth->depth[t];
    if (s->background_state != RLF_BACKGROUND_READY || truth->foreground[t] ||
        !is_furniture(truth->label[t]) || off > CLOSE_M || off < -CLOSE_M) {
        return;
    }
    double guess = thickness > 0.0 ? thickness : RLF_BACKGROUND_GUESS_M;
    add_exit(&e->standing, front + guess - (truth->depth[t] + truth->thickness[t]));
    e->standing_known += thickness > 0.0;
}

/* Whether it is a part of a person by which he is no adult in plain clothes. */
static bool is_unlike(const char *part)
{
    static const char *const parts[] = {"child's head", "coat", "skirt", "backpack"};
    for (size_t k = 0; k < sizeof(parts) / sizeof(parts[0]); k++) {
        if (strcmp(part, parts[k]) == 0) {
            return true;
        }
    }
    return false;
}

/* Labels of the people who are no adults in plain clothes, as bits. */
static uint32_t find_unlike(const rlf_truth *truth)
{
    uint32_t labels = 0;
    for (int32_t i = 0; i < truth->pose_count; i++) {
        const rlf_truth_pose *pose = &truth->poses[i];
        if (pose->label < RLF_SYNTHETIC_LABEL_THING && is_unlike(pose->name)) {
            labels |= 1u << pose->label;
        }
    }
    return labels;
}

/* Of what moves. */
static void add_moving(eval_solid *e, const rlf_surface *s, int32_t i, const rlf_truth *truth,
                       int32_t t, uint32_t unlike)
{
    int32_t label = truth->label[t];
    if (!truth->foreground[t] || !s->foreground[i] || !(s->depth[i] > 0.0f)) {
        return;
    }
    double error = s->depth[i] + s->thickness[i] - (truth->depth[t] + truth->thickness[t]);
    add_exit(label == RLF_SYNTHETIC_LABEL_BOOK ? &e->book : &e->body, error);
    if (label < RLF_SYNTHETIC_LABEL_THING && (unlike >> label & 1) != 0) {
        add_exit(&e->unlike, error);
    }
}

void eval_solid_add(eval_solid *e, const rlf_surface *s, const rlf_truth *truth, const rlf_rig *rig)
{
    const uint32_t unlike = find_unlike(truth);
    for (int32_t y = 0; y < s->height; y++) {
        for (int32_t x = 0; x < s->width; x++) {
            int32_t i = y * s->width + x;
            int32_t t = y * s->scale_factor * rig->depth.width + x * s->scale_factor;
            add_phantom(&e->phantoms, s, i, truth, t);
            add_velocity(e, s, i, truth, t);
            add_standing(e, s, i, truth, t);
            add_moving(e, s, i, truth, t, unlike);
        }
    }
    e->phantoms.has_background = true;
}

double eval_exit_mean_cm(const eval_exit *e)
{
    return e->count > 0 ? 100.0 * e->sum_m / (double)e->count : NAN;
}

double eval_standing_known_percent(const eval_solid *e)
{
    return e->standing.count > 0 ? 100.0 * (double)e->standing_known / (double)e->standing.count
                                 : NAN;
}

double eval_exit_close_percent(const eval_exit *e)
{
    return e->count > 0 ? 100.0 * (double)e->close / (double)e->count : NAN;
}

double eval_speed_median_percent(const eval_speed *e)
{
    int64_t seen = 0;
    for (int i = 0; i < EVAL_SHARE_BINS && e->count > 0; i++) {
        seen += e->bins[i];
        if (2 * seen >= e->count) {
            return (i + 0.5) * 0.1;
        }
    }
    return NAN;
}

double eval_speed_mean_percent(const eval_speed *e)
{
    return e->count > 0 ? 100.0 * e->sum / (double)e->count : NAN;
}
