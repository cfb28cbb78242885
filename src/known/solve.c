/* A model's pose from picks: closed form, then each pick by what is known of it. */
#include "known/align.h"
#include "known/picks.h"

#include "base/cookie.h"

#define ROUNDS 12
#define PICK_SIGMA_PX 1.5   /* of a hand that picks */
#define DEPTH_SIGMA_M 0.012 /* of depth at a corner, beside the sensor's noise */
#define WORLD_SIGMA_M 0.01
/* Picks that are farther off than this, or this share of the model's size, are no picks of it. */
#define RESIDUAL_MAX_M 0.04
#define RESIDUAL_MAX_SHARE 0.2

rlf_known_def rlf_known_def_default(void)
{
    rlf_known_def def = {
        .cookie = RLF_DEF_COOKIE,
        .shape = {.type = RLF_SHAPE_BOX, .size = {0.1, 0.1, 0.1}},
        .T_world_model = {{0, 0, 0}, {0, 0, 0, 1}},
        .has_pose = true,
        .refine = true,
        .friction = 0.5,
    };
    return def;
}

/* d(R m + t) for a small turn about the pose's origin: turn x arm + shift. Adds the residual
 * row . (p - ...) with the row's derivative. */
static void add_row(known_normal *n, rlf_vec3 row, rlf_vec3 arm, double residual, double sigma)
{
    rlf_vec3 turn = rlf_cross(arm, row);
    const double jacobian[6] = {turn.x, turn.y, turn.z, row.x, row.y, row.z};
    known_normal_add(n, jacobian, residual, 1.0 / (sigma * sigma));
}

/* Sums of all picks at a pose. */
static known_normal look(const known_pick *picks, int32_t count, const rlf_pose *T,
                         const known_sight *sight)
{
    known_normal n = {{{0}}, {0}};
    for (int32_t i = 0; i < count; i++) {
        const known_pick *pick = &picks[i];
        rlf_vec3 p = rlf_transform(T, pick->model), arm = rlf_sub(p, T->p);
        if (!pick->has_pixel) {
            add_row(&n, rlf_vec3_make(1, 0, 0), arm, p.x - pick->world.x, WORLD_SIGMA_M);
            add_row(&n, rlf_vec3_make(0, 1, 0), arm, p.y - pick->world.y, WORLD_SIGMA_M);
            add_row(&n, rlf_vec3_make(0, 0, 1), arm, p.z - pick->world.z, WORLD_SIGMA_M);
            continue;
        }
        rlf_vec3 c = rlf_transform(&sight->T_picture_world, p);
        if (!(c.z > 0.05)) {
            continue;
        }
        rlf_quat to_world = rlf_quat_conjugate(sight->T_picture_world.q);
        double f = sight->picture.fx / c.z;
        rlf_vec3 du = rlf_rotate(to_world, rlf_vec3_make(f, 0, -f * c.x / c.z));
        rlf_vec3 dv = rlf_rotate(to_world, rlf_vec3_make(0, f, -f * c.y / c.z));
        add_row(&n, du, arm, sight->picture.fx * (c.x / c.z - pick->ray.x), PICK_SIGMA_PX);
        add_row(&n, dv, arm, sight->picture.fx * (c.y / c.z - pick->ray.y), PICK_SIGMA_PX);
        if (pick->has_depth) {
            rlf_vec3 dz = rlf_rotate(to_world, rlf_vec3_make(0, 0, 1));
            double sigma = DEPTH_SIGMA_M + rlf_depth_noise_sigma(&sight->noise, pick->z);
            add_row(&n, dz, arm, c.z - pick->z, sigma);
        }
    }
    return n;
}

static void measure(const known_pick *picks, int32_t count, const known_sight *sight,
                    rlf_known_fit *fit)
{
    double sum = 0.0, sum_px = 0.0;
    int32_t pixels = 0;
    fit->depth_count = 0;
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 p = rlf_transform(&fit->T_world_model, picks[i].model);
        if (picks[i].has_depth) {
            rlf_vec3 d = rlf_sub(p, picks[i].world);
            sum += rlf_dot(d, d);
            fit->depth_count++;
        }
        if (picks[i].has_pixel) {
            rlf_vec3 c = rlf_transform(&sight->T_picture_world, p);
            double dx = c.x / c.z - picks[i].ray.x, dy = c.y / c.z - picks[i].ray.y;
            sum_px += sight->picture.fx * sight->picture.fx * (dx * dx + dy * dy);
            pixels++;
        }
    }
    fit->pick_rms = fit->depth_count > 0 ? sqrt(sum / fit->depth_count) : 0.0;
    fit->pick_rms_px = pixels > 0 ? sqrt(sum_px / pixels) : 0.0;
}

/* The closed form on the picks with depth. */
static rlf_result start(const known_pick *picks, int32_t count, rlf_known_fit *fit)
{
    rlf_vec3 model[RLF_KNOWN_POINTS_MAX], world[RLF_KNOWN_POINTS_MAX];
    int32_t used = 0;
    for (int32_t i = 0; i < count; i++) {
        if (picks[i].has_depth) {
            model[used] = picks[i].model;
            world[used++] = picks[i].world;
        }
    }
    if (used < RLF_KNOWN_POINTS_MIN) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "only %d of %d picks have depth: pick where the sensor sees it, at least "
                        "%d, or give position and orientation",
                        (int)used, (int)count, RLF_KNOWN_POINTS_MIN);
    }
    double rms;
    rlf_result result = rlf_align_points(model, world, used, &fit->T_world_model, &rms);
    double limit = rlf_max(RESIDUAL_MAX_M, RESIDUAL_MAX_SHARE * known_spread(model, used));
    if (result == RLF_OK && !(rms <= limit)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "the picks do not fit the model: %.0f mm off, at most %.0f: check their "
                        "order and the model's size",
                        1000.0 * rms, 1000.0 * limit);
    }
    return result;
}

/* out_sums: how firmly the picks hold the pose. */
static rlf_result solve_points(const rlf_known_def *def, const rlf_known_view *view,
                               rlf_known_fit *fit, known_normal *out_sums)
{
    known_pick picks[RLF_KNOWN_POINTS_MAX];
    known_sight sight;
    rlf_result result = known_look_up(def, view, picks, &sight);
    if (result == RLF_OK) {
        result = start(picks, def->point_count, fit);
    }
    if (result != RLF_OK) {
        return result;
    }
    for (int32_t i = 0; i < ROUNDS; i++) {
        *out_sums = look(picks, def->point_count, &fit->T_world_model, &sight);
        if (!known_normal_apply(out_sums, &fit->T_world_model)) {
            break;
        }
    }
    measure(picks, def->point_count, &sight, fit);
    return RLF_OK;
}

static rlf_result check(const rlf_known_def *def, const rlf_known_view *view)
{
    bool is_pixel = false;
    for (int32_t i = 0; i < def->point_count; i++) {
        is_pixel = is_pixel || def->points[i].has_pixel;
    }
    if (def->point_count != 0 &&
        (def->point_count < RLF_KNOWN_POINTS_MIN || def->point_count > RLF_KNOWN_POINTS_MAX)) {
        return rlf_fail(RLF_ERROR_INVALID, "%d points: give %d to %d", (int)def->point_count,
                        RLF_KNOWN_POINTS_MIN, RLF_KNOWN_POINTS_MAX);
    }
    if (is_pixel && view == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "picked pixels need a frame of the camera");
    }
    const rlf_pose *T = &def->T_world_model;
    if (!rlf_vec3_is_finite(T->p) || !rlf_is_finite(T->q.x + T->q.y + T->q.z + T->q.w)) {
        return rlf_fail(RLF_ERROR_INVALID, "its pose is not finite");
    }
    return RLF_OK;
}

rlf_result rlf_known_solve(const rlf_known_def *def, const rlf_known_view *view, rlf_known_fit *out)
{
    if (!RLF_ASSERT(def != NULL && def->cookie == RLF_DEF_COOKIE && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = (rlf_known_fit){.T_world_model = def->T_world_model};
    known_normal picks;
    rlf_result result = check(def, view);
    if (result == RLF_OK && def->point_count > 0) {
        result = solve_points(def, view, out, &picks);
    }
    if (result != RLF_OK) {
        return rlf_fail(result, "known object \"%s\": %s", def->name, rlf_error_text());
    }
    if (view != NULL && def->refine && def->point_count > 0) {
        known_refine(&def->shape, view, &picks, out);
    }
    return RLF_OK;
}
