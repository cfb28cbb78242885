/* Slabs from frame to frame: an extended Kalman filter at constant velocity. */
#include "surface/thin/slab.h"

#include <string.h>

/* Off constant velocity, per 1/30 s: an edge shows little of a turn, and is taken to turn steadily.
 */
static const double place_m = 0.02, turn_rad = 0.01, turn_seen_rad = 0.08;
static const double extent_m = 0.0003; /* lets extents be learnt for ever */
static const double frame_s = 1.0 / 30.0;
static const double follow_share = 0.8; /* of a change of velocity */
static const double spin_left = 0.9;    /* of a frame's, in the next */
static const double longest_lost_s = 0.6, longest_passed_s = 0.1;
static const double least_half_m = 0.038, most_half_m = 0.6;
static const double young_s = 0.25; /* it is a slab if it is not lost before */
enum { LEAST_FACES = 4, LEAST_SHARE = 4, MOST_PIXELS = 2048 };

static void predict(slab *s, double dt)
{
    double frames = dt / frame_s;
    rlf_vec3 normal = rlf_rotate(s->pose.q, rlf_vec3_make(0, 0, 1));
    double facing = rlf_dot(normal, rlf_normalize(s->pose.p));
    double turn_sigma = turn_rad + turn_seen_rad * facing * facing;
    s->pose.p = rlf_mad(s->pose.p, s->speed, dt);
    rlf_quat turn = rlf_quat_from_rotation_vector(rlf_scale(s->spin, dt));
    s->pose.q = rlf_quat_normalize(rlf_quat_mul(turn, s->pose.q));
    for (int k = 0; k < 3; k++) {
        s->doubt[k][k] += frames * place_m * place_m;
        s->doubt[3 + k][3 + k] += frames * turn_sigma * turn_sigma;
        s->doubt[6 + k][6 + k] += frames * extent_m * extent_m;
    }
}

/* Rotation vector of a small turn. */
static rlf_vec3 turn_between(rlf_quat from, rlf_quat to)
{
    rlf_quat q = rlf_quat_mul(to, rlf_quat_conjugate(from));
    double sign = q.w < 0.0 ? -2.0 : 2.0;
    return rlf_scale(rlf_vec3_make(q.x, q.y, q.z), sign);
}

/* Speed follows the frames as far as these say more than was expected: along the view a lost edge
 * says nothing. */
static void follow_motion(const rlf_pose *before, const double expected[3], double dt, slab *s)
{
    const rlf_vec3 moved = rlf_scale(rlf_sub(s->pose.p, before->p), 1.0 / dt);
    const rlf_vec3 turned = rlf_scale(turn_between(before->q, s->pose.q), 1.0 / dt);
    double share[3];
    for (int k = 0; k < 3; k++) {
        share[k] = follow_share * rlf_max(1.0 - s->doubt[k][k] / expected[k], 0.0);
    }
    s->speed.x += share[0] * (moved.x - s->speed.x);
    s->speed.y += share[1] * (moved.y - s->speed.y);
    s->speed.z += share[2] * (moved.z - s->speed.z);
    s->spin = rlf_mad(s->spin, rlf_sub(turned, s->spin), follow_share);
}

/* Whether the camera sees through most of it. */
static bool is_passed(const thin_in *in, const slab *s)
{
    const image_grid *grid = in->grid;
    const slab_view view = slab_look(s);
    const rlf_rect w = slab_window(grid, &view, 0);
    int32_t seen = 0, beyond = 0, stride = slab_stride(&w, MOST_PIXELS);
    for (int32_t y = w.y0; y < w.y1; y += stride) {
        for (int32_t x = w.x0; x < w.x1; x += stride) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            double enter, leave;
            if (in->depth[i] > 0.0f &&
                slab_cut_ray(&view, grid->ray_x[i], grid->ray_y[i], &enter, &leave)) {
                seen++;
                beyond += in->depth[i] > leave + THIN_STEP_M;
            }
        }
    }
    return w.x1 <= w.x0 || 2 * beyond > seen + 4;
}

static bool is_slab(const slab *s)
{
    return rlf_vec3_is_finite(s->pose.p) && s->half[2] < THIN_STEP_M && s->half[0] > least_half_m &&
           s->half[0] < most_half_m && s->half[1] > least_half_m && s->half[1] < most_half_m &&
           s->lost_s < (s->age_s < young_s ? 1e-6 : longest_lost_s) &&
           s->passed_s < longest_passed_s;
}

/* False when it is to be forgotten. */
static bool follow(const thin_in *in, slab *s)
{
    const rlf_pose before = s->pose;
    const double dt = in->dt;
    double expected[3];
    predict(s, dt);
    for (int k = 0; k < 3; k++) {
        expected[k] = s->doubt[k][k];
    }
    slab_fit fit = slab_improve(in, s);
    bool is_lost = fit.faces < LEAST_FACES || LEAST_SHARE * fit.outline < fit.places;
    s->age_s += dt;
    s->lost_s = is_lost ? s->lost_s + dt : 0.0;
    s->passed_s = is_passed(in, s) ? s->passed_s + dt : 0.0;
    if (!is_lost) {
        follow_motion(&before, expected, dt, s);
        s->spin = rlf_scale(s->spin, spin_left);
    }
    return is_slab(s);
}

/* Where the slab is though `depth` has nothing. */
static void expect(const thin_in *in, const slab *s, thin *state)
{
    const image_grid *grid = in->grid;
    const slab_view view = slab_look(s);
    const rlf_rect w = slab_window(grid, &view, 0);
    for (int32_t y = w.y0; y < w.y1; y++) {
        for (int32_t x = w.x0; x < w.x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            double enter, leave;
            if (!(in->depth[i] > 0.0f) &&
                slab_cut_ray(&view, grid->ray_x[i], grid->ray_y[i], &enter, &leave)) {
                if (!(state->expected[i] > 0.0f)) {
                    state->expected_pixel[state->expected_count++] = (int32_t)i;
                }
                state->expected[i] = (float)enter;
            }
        }
    }
}

void thin_track(const thin_in *in, thin *state)
{
    int32_t kept = 0;
    if (in->dt > 0.0f) {
        slab_find(in, state);
    }
    for (int32_t i = 0; i < state->count && in->dt > 0.0f; i++) {
        slab s = state->item[i];
        if (follow(in, &s)) {
            state->item[kept++] = s;
        }
    }
    state->count = kept;
    for (int32_t i = 0; i < state->expected_count; i++) {
        state->expected[state->expected_pixel[i]] = 0.0f;
    }
    state->expected_count = 0;
    for (int32_t i = 0; i < state->count; i++) {
        expect(in, &state->item[i], state);
    }
}

float thin_find_lost(const thin *state, ptrdiff_t i, float nearest)
{
    bool is_there = thin_is_expected(state, i) && state->expected[i] < nearest + (float)THIN_NEAR_M;
    return is_there ? state->expected[i] : 0.0f;
}

void thin_reset(thin *state, const image_grid *grid)
{
    state->count = state->expected_count = state->frame = state->region = 0;
    if (state->expected != NULL) {
        memset(state->expected, 0, (size_t)grid->count * sizeof *state->expected);
    }
}

void thin_allocate(thin *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                   const image_grid *grid)
{
    size_t n = (size_t)grid->count;
    arena_next_owner(arena);
    if (def->enable_coast && def->enable_thickness && def->enable_velocity) {
        state->patch = arena_take(arena, SLAB_PATCH, sizeof *state->patch);
        state->expected = arena_take(arena, n, sizeof *state->expected);
        state->expected_pixel = arena_take(arena, n, sizeof *state->expected_pixel);
        state->visited = arena_lend(arena, n, 1);
    }
}
