/* A model's pose from picks: closed form, then each pick by what is known of it. */
#include "known/align.h"

#include "base/checks.h"

#define ROUNDS 20
#define PICK_SIGMA_PX 1.5   /* of a hand that picks */
#define DEPTH_SIGMA_M 0.012 /* of depth at a corner, beside the sensor's noise */
#define WORLD_SIGMA_M 0.01
/* Depth at a corner may be that of what is beside or behind it: errors beyond so many deviations
 * count less (Huber 1964). */
#define DEPTH_HUBER 1.5
#define COST_MAX 25.0 /* of one residual, when a start is chosen */
/* Picks farther off than all of these, across the view, are no picks of the model: so many pixels,
 * metres, and so large a share of the points' spread. */
#define ACROSS_MAX_PX 5.0
#define ACROSS_MAX_M 0.012
#define ACROSS_MAX_SHARE 0.12
#define ALONG_MAX_M 0.04

rlf_known_def rlf_known_def_default(void)
{
    rlf_known_def def = {
        .cookie = RLF_DEF_COOKIE,
        .shape = {.type = RLF_SHAPE_BOX, .size = {0.1, 0.1, 0.1}},
        .look = {.scale = 1},
        .T_world_model = {{0, 0, 0}, {0, 0, 0, 1}},
        .has_pose = true,
        .refine = true,
        .collides = true,
        .friction = 0.5,
    };
    return def;
}

/* Adds the residual row . (p - ...), of a point at `arm` from the pose's origin. */
static void add_row(math_rigid_sums *n, rlf_vec3 row, rlf_vec3 arm, double residual, double sigma)
{
    math_rigid_add(n, row, rlf_cross(arm, row), -residual, 1.0 / (sigma * sigma));
}

static double absolute(double x)
{
    return x < 0.0 ? -x : x;
}

/* The corner may be anywhere within what is sensed around it. */
static double depth_sigma(const known_sight *sight, const known_pick *pick)
{
    return DEPTH_SIGMA_M + rlf_depth_noise_sigma(&sight->noise, pick->z) + 0.7 * pick->z_half;
}

/* Sums of all picks at a pose. */
static math_rigid_sums look(const known_pick *picks, int32_t count, const rlf_pose *T,
                            const known_sight *sight)
{
    math_rigid_sums n = {.weight = 0.0};
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
            double sigma = depth_sigma(sight, pick);
            double off = absolute(c.z - pick->z) / sigma;
            double share = off > DEPTH_HUBER ? DEPTH_HUBER / off : 1.0;
            add_row(&n, dz, arm, c.z - pick->z, sigma / sqrt(share));
        }
    }
    return n;
}

/* How far a pick is off: across the view and along it, metres. */
typedef struct pick_error {
    double across, along;
} pick_error;

static pick_error error_of(const known_pick *pick, const rlf_pose *T, const known_sight *sight)
{
    rlf_vec3 p = rlf_transform(T, pick->model);
    if (!pick->has_pixel) {
        return (pick_error){rlf_length(rlf_sub(p, pick->world)), 0.0};
    }
    rlf_vec3 c = rlf_transform(&sight->T_picture_world, p);
    if (!(c.z > 0.05)) {
        return (pick_error){1e3, 1e3};
    }
    double dx = c.x - c.z * pick->ray.x, dy = c.y - c.z * pick->ray.y;
    return (pick_error){sqrt(dx * dx + dy * dy), pick->has_depth ? absolute(c.z - pick->z) : 0.0};
}

static double cost_of(const known_pick *picks, int32_t count, const rlf_pose *T,
                      const known_sight *sight)
{
    double sum = 0.0;
    for (int32_t i = 0; i < count; i++) {
        pick_error e = error_of(&picks[i], T, sight);
        double across = e.across / DEPTH_SIGMA_M;
        sum += rlf_min(across * across, COST_MAX);
        if (picks[i].has_pixel && picks[i].has_depth) {
            double along = e.along / depth_sigma(sight, &picks[i]);
            sum += rlf_min(along * along, COST_MAX);
        }
    }
    return sum;
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
            double px =
                sight->picture.fx * error_of(&picks[i], &fit->T_world_model, sight).across / c.z;
            sum_px += px * px;
            pixels++;
        }
    }
    fit->pick_rms = fit->depth_count > 0 ? sqrt(sum / fit->depth_count) : 0.0;
    fit->pick_rms_px = pixels > 0 ? sqrt(sum_px / pixels) : 0.0;
}

/* A pick's point with the nearest (-1), middle (0) or farthest (1) depth around it. */
static rlf_vec3 candidate(const known_pick *pick, int32_t side, const known_sight *sight)
{
    if (!pick->has_pixel) {
        return pick->world;
    }
    rlf_vec3 p = rlf_scale(pick->ray, pick->z + side * pick->z_half);
    return rlf_transform_inverse(&sight->T_picture_world, p);
}

/* Gauss-Newton from *T on; out_sums: how firmly the picks hold the pose. */
static void settle(const known_pick *picks, int32_t count, const known_sight *sight, rlf_pose *T,
                   math_rigid_sums *out_sums)
{
    for (int32_t i = 0; i < ROUNDS; i++) {
        *out_sums = look(picks, count, T, sight);
        if (!known_step(out_sums, T)) {
            break;
        }
    }
}

/* Settles from the best closed form on three picks, with all their candidates; keeps the best so
 * far. Seen from afar a box and its inside out look much alike: one start is not enough. */
static void try_three(const known_pick *all, int32_t count, const int32_t three[3],
                      const known_sight *sight, double *best, rlf_pose *out)
{
    rlf_vec3 model[3], world[3];
    double best_start = 1e30;
    rlf_pose start = *out;
    for (int32_t sides = 0; sides < 27; sides++) {
        const int32_t side[3] = {sides % 3 - 1, sides / 3 % 3 - 1, sides / 9 - 1};
        for (int32_t i = 0; i < 3; i++) {
            model[i] = all[three[i]].model;
            world[i] = candidate(&all[three[i]], side[i], sight);
        }
        rlf_pose T;
        if (known_is_line(model, 3) || known_is_line(world, 3) ||
            rlf_align_points(model, world, 3, &T, NULL) != RLF_OK) {
            continue;
        }
        double cost = cost_of(all, count, &T, sight);
        start = cost < best_start ? T : start;
        best_start = rlf_min(cost, best_start);
    }
    math_rigid_sums sums;
    settle(all, count, sight, &start, &sums);
    double cost = cost_of(all, count, &start, sight);
    *out = cost < *best ? start : *out;
    *best = rlf_min(cost, *best);
}

/* The best of the closed forms on every three picks with depth, and on all of them: depth at one
 * corner may be quite wrong. */
static rlf_result start(const known_pick *picks, int32_t count, const known_sight *sight,
                        rlf_known_fit *fit)
{
    rlf_vec3 model[RLF_KNOWN_POINTS_MAX], world[RLF_KNOWN_POINTS_MAX];
    int32_t with_depth[RLF_KNOWN_POINTS_MAX], used = 0;
    for (int32_t i = 0; i < count; i++) {
        if (picks[i].has_depth) {
            with_depth[used] = i;
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
    rlf_result result = rlf_align_points(model, world, used, &fit->T_world_model, NULL);
    double best = cost_of(picks, count, &fit->T_world_model, sight);
    for (int32_t a = 0; a < used && result == RLF_OK; a++) {
        for (int32_t b = a + 1; b < used; b++) {
            for (int32_t c = b + 1; c < used; c++) {
                const int32_t three[3] = {with_depth[a], with_depth[b], with_depth[c]};
                try_three(picks, count, three, sight, &best, &fit->T_world_model);
            }
        }
    }
    return result;
}

/* Whether the picks are those of the model: all are on it across the view, three along it. */
static rlf_result check_fit(const known_pick *picks, int32_t count, const known_sight *sight,
                            const rlf_known_fit *fit)
{
    rlf_vec3 model[RLF_KNOWN_POINTS_MAX];
    double sum = 0.0, farthest = 0.0;
    int32_t near = 0;
    for (int32_t i = 0; i < count; i++) {
        pick_error e = error_of(&picks[i], &fit->T_world_model, sight);
        farthest = picks[i].has_pixel ? rlf_max(farthest, picks[i].z) : farthest;
        model[i] = picks[i].model;
        sum += e.across * e.across;
        near += picks[i].has_depth && e.along < ALONG_MAX_M + picks[i].z_half;
    }
    double rms = sqrt(sum / count);
    double limit = rlf_max(ACROSS_MAX_M, ACROSS_MAX_SHARE * known_spread(model, count));
    if (farthest > 0.0) {
        limit = rlf_max(limit, ACROSS_MAX_PX * farthest / sight->picture.fx);
    }
    if (!(rms <= limit)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "the picks do not fit the model: %.0f mm off, at most %.0f: check their "
                        "order and the model's size",
                        1000.0 * rms, 1000.0 * limit);
    }
    if (near < RLF_KNOWN_POINTS_MIN) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "the picks do not fit the model: only %d of %d have its depth: pick points "
                        "that the sensor sees",
                        (int)near, (int)count);
    }
    return RLF_OK;
}

/* out_sums: how firmly the picks hold the pose. */
static rlf_result solve_points(const rlf_known_def *def, const rlf_known_view *view,
                               rlf_known_fit *fit, math_rigid_sums *out_sums)
{
    known_pick picks[RLF_KNOWN_POINTS_MAX];
    known_sight sight;
    rlf_result result = known_look_up(def, view, picks, &sight);
    if (result == RLF_OK) {
        result = start(picks, def->point_count, &sight, fit);
    }
    if (result != RLF_OK) {
        return result;
    }
    settle(picks, def->point_count, &sight, &fit->T_world_model, out_sums);
    measure(picks, def->point_count, &sight, fit);
    return check_fit(picks, def->point_count, &sight, fit);
}

/* What does not count for its kind of shape may be anything. */
static bool is_shape_finite(const rlf_shape *shape)
{
    switch (shape->type) {
    case RLF_SHAPE_BOX: return rlf_vec3_is_finite(shape->size);
    case RLF_SHAPE_SPHERE: return rlf_is_finite(shape->radius);
    case RLF_SHAPE_CAPSULE:
    case RLF_SHAPE_CYLINDER: return rlf_is_finite(shape->radius) && rlf_is_finite(shape->height);
    case RLF_SHAPE_HULL: return true;
    }
    return false;
}

static rlf_result check_numbers(const rlf_known_def *def)
{
    const rlf_quat q = def->T_world_model.q;
    const char *field = NULL;
    if (!rlf_vec3_is_finite(def->T_world_model.p) || !rlf_is_finite(q.x + q.y + q.z + q.w)) {
        field = "T_world_model";
    } else if (!is_shape_finite(&def->shape)) {
        field = "shape (its type, size, radius or height)";
    } else if (!rlf_vec3_is_finite(def->look.offset) || !rlf_is_finite(def->look.scale)) {
        field = "look (its offset or scale)";
    } else if (!(def->restitution >= 0.0 && def->restitution <= 1.0)) {
        field = "restitution";
    } else if (!(def->friction >= 0.0 && def->friction <= 1000.0)) {
        field = "friction";
    }
    return field == NULL ? RLF_OK
                         : rlf_fail(RLF_ERROR_INVALID, "%s is not a value that can be used", field);
}

static rlf_result check(const rlf_known_def *def, const rlf_known_view *view)
{
    if (def->point_count != 0 &&
        (def->point_count < RLF_KNOWN_POINTS_MIN || def->point_count > RLF_KNOWN_POINTS_MAX)) {
        return rlf_fail(RLF_ERROR_INVALID, "point_count is %d: give %d to %d",
                        (int)def->point_count, RLF_KNOWN_POINTS_MIN, RLF_KNOWN_POINTS_MAX);
    }
    bool is_pixel = false;
    for (int32_t i = 0; i < def->point_count; i++) {
        is_pixel = is_pixel || def->points[i].has_pixel;
    }
    if (is_pixel && view == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "picked pixels need a frame of the camera");
    }
    return check_numbers(def);
}

rlf_result rlf_known_solve(const rlf_known_def *def, const rlf_known_view *view, rlf_known_fit *out)
{
    if (!RLF_ASSERT(def != NULL && def->cookie == RLF_DEF_COOKIE && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = (rlf_known_fit){.T_world_model = def->T_world_model};
    math_rigid_sums picks;
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
