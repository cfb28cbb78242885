/* Levenberg-Marquardt on the normal equations, boards' poses eliminated view by view (Schur
 * complement), so that the time grows with the number of views and not with its cube. */
#include "calibrate/solve.h"

#include <math.h>
#include <string.h>

#define POSE 6
#define STEPS_MAX 100
#define DAMPING_MAX 1e12

/* Normal equations of one view: its own unknowns, and how they go with the shared ones. */
typedef struct view_block {
    double own[POSE][POSE], own_inverse[POSE][POSE];
    double mixed[CALIBRATE_SHARED][POSE];
    double right[POSE];
} view_block;

typedef struct equations {
    double shared[CALIBRATE_SHARED][CALIBRATE_SHARED];
    double right[CALIBRATE_SHARED];
    view_block *blocks; /* one per view */
    double cost;        /* sum of squares, each over its sigma */
    int32_t numbers;    /* residuals */
} equations;

double calibrate_errors(const calibrate_view *view, const calibrate_model *model, int32_t camera,
                        double *out)
{
    double sum = 0.0;
    for (int32_t i = 0; i < view->sight[camera].count; i++) {
        sight_term term;
        sight_linearise(view, model, camera, i, &term);
        if (out != NULL) {
            out[2 * i] = term.error[0];
            out[2 * i + 1] = term.error[1];
        }
        sum += term.error[0] * term.error[0] + term.error[1] * term.error[1];
    }
    return sum;
}

double calibrate_view_rms(const calibrate_view *view, const calibrate_model *model)
{
    double sum = calibrate_errors(view, model, 0, NULL) + calibrate_errors(view, model, 1, NULL);
    int32_t count = view->sight[0].count + view->sight[1].count;
    return count > 0 ? sqrt(sum / count) : 0.0;
}

/* Adds one corner's two residuals. */
static void add_term(const sight_term *t, const bool *is_fixed, double weight, equations *e,
                     view_block *block)
{
    for (int a = 0; a < 2; a++) {
        const double *shared = t->shared[a], *own = t->own[a];
        for (int i = 0; i < CALIBRATE_SHARED; i++) {
            if (is_fixed[i] || shared[i] == 0.0) {
                continue;
            }
            const double s = weight * shared[i];
            e->right[i] -= s * t->error[a];
            for (int j = 0; j <= i; j++) {
                e->shared[i][j] += is_fixed[j] ? 0.0 : s * shared[j];
            }
            for (int j = 0; j < POSE; j++) {
                block->mixed[i][j] += s * own[j];
            }
        }
        for (int i = 0; i < POSE; i++) {
            block->right[i] -= weight * own[i] * t->error[a];
            for (int j = 0; j < POSE; j++) {
                block->own[i][j] += weight * own[i] * own[j];
            }
        }
    }
}

static void build(const calibrate_views *views, const calibrate_model *model, equations *e)
{
    view_block *blocks = e->blocks;
    *e = (equations){.blocks = blocks};
    for (int32_t v = 0; v < views->count; v++) {
        const calibrate_view *view = &views->views[v];
        blocks[v] = (view_block){.right = {0}};
        for (int c = 0; c < CALIBRATE_CAMERAS && view->is_used; c++) {
            const double sigma = view->sight[c].sigma;
            for (int32_t i = 0; i < view->sight[c].count; i++) {
                sight_term term;
                sight_linearise(view, model, c, i, &term);
                const double weight = 1.0 / (sigma * sigma);
                add_term(&term, model->is_fixed, weight, e, &blocks[v]);
                e->cost += weight * (term.error[0] * term.error[0] + term.error[1] * term.error[1]);
                e->numbers += 2;
            }
        }
    }
    for (int i = 0; i < CALIBRATE_SHARED; i++) {
        for (int j = i + 1; j < CALIBRATE_SHARED; j++) {
            e->shared[i][j] = e->shared[j][i];
        }
    }
}

static bool is_in(const calibrate_view *view)
{
    return view->is_used && view->sight[0].count + view->sight[1].count > 0;
}

/* Takes one view's pose out of the shared equations. */
static void eliminate(const view_block *b, double out[CALIBRATE_SHARED][CALIBRATE_SHARED],
                      double right[CALIBRATE_SHARED])
{
    for (int i = 0; i < CALIBRATE_SHARED; i++) {
        for (int k = 0; k < POSE; k++) {
            double through = 0.0;
            for (int j = 0; j < POSE; j++) {
                through += b->mixed[i][j] * b->own_inverse[j][k];
            }
            right[i] -= through * b->right[k];
            for (int j = 0; j < CALIBRATE_SHARED; j++) {
                out[i][j] -= through * b->mixed[j][k];
            }
        }
    }
}

/* Eliminates the poses: `out` = shared - sum(mixed own^-1 mixed^T), alike the right side. False
 * when a view does not settle its pose. */
static bool reduce(const calibrate_views *views, equations *e, double damping,
                   double out[CALIBRATE_SHARED][CALIBRATE_SHARED], double right[CALIBRATE_SHARED])
{
    memcpy(out, e->shared, sizeof(e->shared));
    memcpy(right, e->right, sizeof(e->right));
    for (int i = 0; i < CALIBRATE_SHARED; i++) {
        out[i][i] *= 1.0 + damping;
    }
    for (int32_t v = 0; v < views->count; v++) {
        view_block *b = &e->blocks[v];
        double damped[POSE][POSE];
        memcpy(damped, b->own, sizeof(damped));
        for (int i = 0; i < POSE; i++) {
            damped[i][i] *= 1.0 + damping;
        }
        if (!is_in(&views->views[v])) {
            continue;
        }
        if (!linear_invert(POSE, damped[0], b->own_inverse[0])) {
            return false;
        }
        eliminate(b, out, right);
    }
    return true;
}

/* Inverse of the reduced matrix; unknowns that are fixed, or that nothing bears on (a camera that
 * is not there), have rows of zeros. False when the others are not settled. */
static bool invert_shared(const equations *e, double reduced[CALIBRATE_SHARED][CALIBRATE_SHARED],
                          double out[CALIBRATE_SHARED][CALIBRATE_SHARED])
{
    int32_t index[CALIBRATE_SHARED], n = 0;
    double packed[CALIBRATE_SHARED * CALIBRATE_SHARED] = {0};
    double inverse[CALIBRATE_SHARED * CALIBRATE_SHARED];
    for (int32_t i = 0; i < CALIBRATE_SHARED; i++) {
        if (e->shared[i][i] > 0.0) {
            index[n++] = i;
        }
    }
    for (int32_t i = 0; i < n * n; i++) {
        packed[i] = reduced[index[i / n]][index[i % n]];
    }
    memset(out, 0, sizeof(double) * CALIBRATE_SHARED * CALIBRATE_SHARED);
    if (n > 0 && !linear_invert(n, packed, inverse)) {
        return false;
    }
    for (int32_t i = 0; i < n * n; i++) {
        out[index[i / n]][index[i % n]] = inverse[i];
    }
    return true;
}

static void move_pose(rlf_pose *T, const double step[6])
{
    rlf_quat turn = rlf_quat_from_rotation_vector(rlf_vec3_make(step[0], step[1], step[2]));
    T->q = rlf_quat_normalize(rlf_quat_mul(turn, T->q));
    T->p = rlf_add(rlf_rotate(turn, T->p), rlf_vec3_make(step[3], step[4], step[5]));
}

void calibrate_move(calibrate_model *model, const double step[CALIBRATE_SHARED])
{
    for (int c = 0; c < CALIBRATE_CAMERAS; c++) {
        rlf_camera *camera = &model->camera[c];
        const double *s = &step[c * CALIBRATE_LENS];
        camera->fx += s[0];
        camera->fy += s[1];
        camera->cx += s[2];
        camera->cy += s[3];
        for (int i = 0; i < 5; i++) {
            camera->distortion[i] += s[4 + i];
        }
    }
    move_pose(&model->T_second_first, &step[CALIBRATE_MOTION]);
}

/* What is left of a view's equations once the shared step is known. */
static void move_view(const view_block *b, const double step[CALIBRATE_SHARED], rlf_pose *T)
{
    double own[POSE] = {0}, rest[POSE];
    memcpy(rest, b->right, sizeof(rest));
    for (int i = 0; i < CALIBRATE_SHARED; i++) {
        for (int j = 0; j < POSE; j++) {
            rest[j] -= b->mixed[i][j] * step[i];
        }
    }
    for (int i = 0; i < POSE; i++) {
        for (int j = 0; j < POSE; j++) {
            own[i] += b->own_inverse[i][j] * rest[j];
        }
    }
    move_pose(T, own);
}

/* Takes the step that the equations give into model and poses; false when there is none. */
static bool take_step(equations *e, double damping, calibrate_views *views, calibrate_model *model)
{
    double reduced[CALIBRATE_SHARED][CALIBRATE_SHARED], inverse[CALIBRATE_SHARED][CALIBRATE_SHARED];
    double right[CALIBRATE_SHARED], step[CALIBRATE_SHARED] = {0};
    if (!reduce(views, e, damping, reduced, right) || !invert_shared(e, reduced, inverse)) {
        return false;
    }
    for (int i = 0; i < CALIBRATE_SHARED; i++) {
        for (int j = 0; j < CALIBRATE_SHARED; j++) {
            step[i] += inverse[i][j] * right[j];
        }
    }
    for (int32_t v = 0; v < views->count; v++) {
        if (is_in(&views->views[v])) {
            move_view(&e->blocks[v], step, &views->views[v].T_first_board);
        }
    }
    calibrate_move(model, step);
    return true;
}

static void keep_poses(const calibrate_views *views, rlf_pose *poses)
{
    for (int32_t v = 0; v < views->count; v++) {
        poses[v] = views->views[v].T_first_board;
    }
}

static void restore_poses(calibrate_views *views, const rlf_pose *poses)
{
    for (int32_t v = 0; v < views->count; v++) {
        views->views[v].T_first_board = poses[v];
    }
}

/* Steps until none makes it better by more than rounding. `poses` is room for those of all views.
 */
static void descend(calibrate_views *views, calibrate_model *model, equations *e, rlf_pose *poses)
{
    double damping = 1e-4;
    build(views, model, e);
    for (int step = 0; step < STEPS_MAX && damping < DAMPING_MAX; step++) {
        const calibrate_model before = *model;
        const double cost = e->cost;
        keep_poses(views, poses);
        const bool is_taken = take_step(e, damping, views, model);
        if (is_taken) {
            build(views, model, e);
        }
        if (is_taken && e->cost <= cost) {
            damping *= 0.1;
            if (cost - e->cost <= 1e-12 * cost) {
                return;
            }
            continue;
        }
        damping *= 10.0;
        *model = before;
        restore_poses(views, poses);
        build(views, model, e);
    }
}

static void measure(const calibrate_views *views, const calibrate_model *model, calibrate_fit *out)
{
    double sum[CALIBRATE_CAMERAS] = {0};
    int32_t count[CALIBRATE_CAMERAS] = {0};
    for (int32_t v = 0; v < views->count; v++) {
        for (int c = 0; c < CALIBRATE_CAMERAS && views->views[v].is_used; c++) {
            sum[c] += calibrate_errors(&views->views[v], model, c, NULL);
            count[c] += views->views[v].sight[c].count;
        }
    }
    for (int c = 0; c < CALIBRATE_CAMERAS; c++) {
        out->rms_of[c] = count[c] > 0 ? sqrt(sum[c] / count[c]) : NAN;
    }
    out->rms = count[0] + count[1] > 0 ? sqrt((sum[0] + sum[1]) / (count[0] + count[1])) : NAN;
}

/* The covariance of the shared unknowns: sigma^2 times the inverse of the reduced equations. */
static void settle(const calibrate_views *views, equations *e, calibrate_fit *out)
{
    double reduced[CALIBRATE_SHARED][CALIBRATE_SHARED], right[CALIBRATE_SHARED];
    int32_t unknowns = POSE * calibrate_views_used(views, -1);
    for (int i = 0; i < CALIBRATE_SHARED; i++) {
        unknowns += e->shared[i][i] > 0.0;
    }
    out->is_determined = e->numbers > unknowns && reduce(views, e, 0.0, reduced, right) &&
                         invert_shared(e, reduced, out->covariance);
    out->sigma = e->numbers > unknowns ? sqrt(e->cost / (e->numbers - unknowns)) : NAN;
    for (int i = 0; i < CALIBRATE_SHARED * CALIBRATE_SHARED; i++) {
        out->covariance[i / CALIBRATE_SHARED][i % CALIBRATE_SHARED] *= out->sigma * out->sigma;
    }
}

rlf_result calibrate_solve(calibrate_views *views, calibrate_model *model, calibrate_fit *out)
{
    equations e = {.blocks = rlf_alloc_array((size_t)views->count, sizeof(view_block))};
    rlf_pose *poses = rlf_alloc_array((size_t)views->count, sizeof(*poses));
    *out = (calibrate_fit){.rms = NAN};
    if (e.blocks != NULL && poses != NULL) {
        descend(views, model, &e, poses);
        measure(views, model, out);
        settle(views, &e, out);
    }
    const bool is_done = e.blocks != NULL && poses != NULL;
    rlf_free(e.blocks);
    rlf_free(poses);
    return is_done ? RLF_OK : RLF_ERROR_MEMORY;
}

double calibrate_deviation(const calibrate_fit *fit, int32_t index)
{
    return sqrt(rlf_max(fit->covariance[index][index], 0.0));
}
