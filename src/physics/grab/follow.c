/* The rigid motion of a hand that was seen before: point-to-plane inside (Chen and Medioni 1991),
 * along the normals of its outline at the edge (Harris 1990, "RAPID"), robust least squares. It is
 * told from how the hand looked when it grabbed, so that no error adds up; the flow of the surface
 * decides only what neither shows. */
#include "math/rigid.h"
#include "physics/grab/grab.h"

#define PASSES 4
/* Residuals count in full up to here and hardly beyond: noise, metres. The first pass is as many
 * times more tolerant as there are passes, since the hand may have stopped or started. */
#define SOFT_M (0.4 * GRID_NOISE_M)
/* What is farther from where it should be is something else, metres. */
#define FAR_M (3.0 * GRID_NOISE_M)
/* The flow counts like this share of what is seen. */
#define FLOW_SHARE 0.05
/* Of the hand so much must be seen again: a share of its points. */
#define SEEN_SHARE 0.25

typedef struct follow_fit {
    math_rigid_sums sums; /* about `pivot`, grid frame */
    rlf_vec3 pivot;
    double soft;   /* of residuals, metres */
    rlf_vec3 flow; /* sum of velocities, weighted */
    double flow_weight;
    double seen; /* points found again */
} follow_fit;

static void add_row(follow_fit *fit, rlf_vec3 point, rlf_vec3 n, double residual)
{
    const double soft = 1.0 + residual * residual / (fit->soft * fit->soft);
    const rlf_vec3 turn = rlf_cross(rlf_sub(point, fit->pivot), n);
    math_rigid_add(&fit->sums, n, turn, residual, 1.0 / (soft * soft));
}

static void add_point(follow_fit *fit, const rlf_grid *grid, const rlf_pose *T_grid_hand,
                      rlf_vec3 place)
{
    rlf_vec3 p = rlf_transform(T_grid_hand, place);
    int32_t x, y;
    field_cell cell;
    if (!grid_pixel_of(grid, p, &x, &y) || !grid_cell_read(grid, &grid->foreground, x, y, &cell)) {
        return;
    }
    double residual = rlf_dot(cell.normal, rlf_sub(cell.point, p));
    if (residual < FAR_M && residual > -FAR_M) {
        add_row(fit, p, cell.normal, residual);
        fit->flow = rlf_add(fit->flow, cell.velocity);
        fit->flow_weight += 1.0;
        fit->seen += 1.0;
    }
}

/* Pixels from (x, y) to the outline along its row or column; false when there is none. */
static bool find_rim(const rlf_grid *grid, const grab_rim *rim, int32_t x, int32_t y, int32_t far,
                     int32_t *out)
{
    int32_t dx = rim->is_of_column ? 0 : rim->step, dy = rim->is_of_column ? rim->step : 0;
    for (int32_t k = 0; k <= far; k++) {
        for (int32_t sign = 1; sign >= -1; sign -= 2) {
            int32_t off = sign * k;
            if (grab_is_rim(grid, x + off * dx, y + off * dy, dx, dy)) {
                *out = off * rim->step;
                return true;
            }
        }
    }
    return false;
}

static void add_rim(follow_fit *fit, const rlf_grid *grid, const rlf_pose *T_grid_hand,
                    const grab_rim *rim)
{
    rlf_vec3 p = rlf_transform(T_grid_hand, rim->point);
    double u, v;
    int32_t x, y, off;
    if (!grid_pixel_of(grid, p, &x, &y) || !grid->project(grid->project_context, p, &u, &v)) {
        return;
    }
    double footprint = p.z * grid->pixel_angle;
    int32_t far = 1 + (int32_t)(FAR_M / footprint);
    if (!find_rim(grid, rim, x, y, far, &off)) {
        return;
    }
    int32_t crossing = (rim->is_of_column ? y : x) + off;
    double shift = crossing - (rim->is_of_column ? v : u);
    int32_t i = rim->is_of_column ? crossing * grid->width + x : y * grid->width + crossing;
    double step = (double)grid->foreground.depth[i] - p.z;
    if (step > FAR_M || step < -FAR_M) {
        return;
    }
    double nu = rim->along[0], nv = rim->along[1];
    rlf_vec3 n = rlf_vec3_make(nu, nv, -(nu * p.x + nv * p.y) / p.z);
    add_row(fit, p, n, shift * rim->along[rim->is_of_column] * footprint);
}

static void collect(follow_fit *fit, const rlf_grid *grid, const phys_grab *grab,
                    const rlf_pose *T_grid_hand, double soft)
{
    *fit = (follow_fit){.pivot = T_grid_hand->p, .soft = soft};
    for (int32_t i = 0; i < grab->point_count; i++) {
        add_point(fit, grid, T_grid_hand, grab->points[i]);
    }
    for (int32_t i = 0; i < grab->rim_count; i++) {
        add_rim(fit, grid, T_grid_hand, &grab->rims[i]);
    }
}

/* The turn from a to b over dt, rad/s. */
static rlf_vec3 turn_between(rlf_quat a, rlf_quat b, double dt)
{
    return rlf_scale(math_rotation_vector(rlf_quat_mul(b, rlf_quat_conjugate(a))), 1.0 / dt);
}

/* Weighs in that the hand moved as predicted. */
static void add_prediction(follow_fit *fit, const rlf_pose *T, const rlf_pose *predicted,
                           double radius)
{
    const double weight = FLOW_SHARE * fit->sums.weight + 1e-3;
    const rlf_vec3 turn = turn_between(T->q, predicted->q, 1.0);
    const rlf_vec3 shift = rlf_sub(predicted->p, T->p);
    const double back[6] = {shift.x, shift.y, shift.z, turn.x, turn.y, turn.z};
    for (int32_t i = 0; i < 6; i++) {
        const double w = i < 3 ? weight : weight * radius * radius;
        fit->sums.a[i][i] += w;
        fit->sums.b[i] += w * back[i];
    }
}

static void move(rlf_pose *T, const double step[6])
{
    rlf_vec3 turn = rlf_vec3_make(step[3], step[4], step[5]);
    T->q = rlf_quat_normalize(rlf_quat_mul(rlf_quat_from_rotation_vector(turn), T->q));
    T->p = rlf_add(T->p, rlf_vec3_make(step[0], step[1], step[2]));
}

bool grab_follow_hand(const grid_query *query, phys_grab *grab, double dt)
{
    const rlf_grid *grid = query->grid;
    rlf_pose before = rlf_pose_mul(&query->T_grid_world, &grab->T_world_hand), T = before;
    rlf_vec3 v = rlf_rotate(query->T_grid_world.q, grab->v);
    rlf_vec3 w = rlf_rotate(query->T_grid_world.q, grab->w);
    const double on[6] = {v.x * dt, v.y * dt, v.z * dt, w.x * dt, w.y * dt, w.z * dt};
    move(&T, on);
    rlf_pose predicted = T;
    double radius = 0.5 * GRID_THIN_M;
    follow_fit fit;
    for (int32_t pass = 0; pass < PASSES; pass++) {
        double step[6];
        collect(&fit, grid, grab, &T, SOFT_M * (PASSES - pass));
        if (fit.seen < SEEN_SHARE * grab->point_count) {
            return false;
        }
        if (pass == 0) {
            predicted.p = rlf_mad(before.p, fit.flow, dt / rlf_max(fit.flow_weight, 1.0));
        }
        add_prediction(&fit, &T, &predicted, radius);
        (void)math_rigid_solve(&fit.sums, 0.0, step);
        move(&T, step);
    }
    grab->alike = fit.sums.weight / (grab->point_count + grab->rim_count);
    rlf_pose T_world_hand = rlf_pose_mul(&grid->T_world_grid, &T);
    grab->v = rlf_scale(rlf_sub(T_world_hand.p, grab->T_world_hand.p), 1.0 / dt);
    grab->w = turn_between(grab->T_world_hand.q, T_world_hand.q, dt);
    grab->T_world_hand = T_world_hand;
    return true;
}
