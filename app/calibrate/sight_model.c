/* Projection with Brown-Conrady distortion and its analytic derivatives. rlf_camera_project refuses
 * rays beyond the lens model; an optimiser on its way must not meet such walls, so it has its own.
 */
#include "calibrate/solve.h"

#define BEHIND_PX 1e4 /* error of what is behind the camera */

/* Pixel of a point in a camera's frame, by the lens's unknowns and by the point. */
static void project(const rlf_camera *camera, rlf_vec3 p, double pixel[2],
                    double by_lens[2][CALIBRATE_LENS], rlf_vec3 by_point[2])
{
    const double *k = camera->distortion;
    const double x = p.x / p.z, y = p.y / p.z, r2 = x * x + y * y;
    const double L = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    const double L_d = k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[4]);
    const double xd = x * L + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x);
    const double yd = y * L + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y;
    const double xx = L + 2.0 * x * x * L_d + 2.0 * k[2] * y + 6.0 * k[3] * x;
    const double xy = 2.0 * x * y * L_d + 2.0 * k[2] * x + 2.0 * k[3] * y;
    const double yy = L + 2.0 * y * y * L_d + 6.0 * k[2] * y + 2.0 * k[3] * x;
    const double fx = camera->fx, fy = camera->fy;
    pixel[0] = fx * xd + camera->cx;
    pixel[1] = fy * yd + camera->cy;
    const double u[CALIBRATE_LENS] = {xd,
                                      0.0,
                                      1.0,
                                      0.0,
                                      fx * x * r2,
                                      fx * x * r2 * r2,
                                      fx * 2.0 * x * y,
                                      fx * (r2 + 2.0 * x * x),
                                      fx * x * r2 * r2 * r2};
    const double v[CALIBRATE_LENS] = {0.0,
                                      yd,
                                      0.0,
                                      1.0,
                                      fy * y * r2,
                                      fy * y * r2 * r2,
                                      fy * (r2 + 2.0 * y * y),
                                      fy * 2.0 * x * y,
                                      fy * y * r2 * r2 * r2};
    for (int i = 0; i < CALIBRATE_LENS; i++) {
        by_lens[0][i] = u[i];
        by_lens[1][i] = v[i];
    }
    by_point[0] = rlf_scale(rlf_vec3_make(xx, xy, -(xx * x + xy * y)), fx / p.z);
    by_point[1] = rlf_scale(rlf_vec3_make(xy, yy, -(xy * x + yy * y)), fy / p.z);
}

/* d(g . p) by a small turn and shift of p about the frame's origin: g . (w x p + t). */
static void by_motion(rlf_vec3 g, rlf_vec3 p, double out[6])
{
    const rlf_vec3 turn = rlf_cross(p, g);
    const double values[6] = {turn.x, turn.y, turn.z, g.x, g.y, g.z};
    for (int i = 0; i < 6; i++) {
        out[i] = values[i];
    }
}

void sight_linearise(const calibrate_view *view, const calibrate_model *model, int32_t camera,
                     int32_t index, sight_term *out)
{
    const calibrate_point *point = &view->sight[camera].points[index];
    const rlf_vec3 first =
        rlf_transform(&view->T_first_board, rlf_vec3_make(point->x, point->y, 0.0));
    const rlf_pose *T = &model->T_second_first;
    const rlf_vec3 p = camera == 0 ? first : rlf_transform(T, first);
    *out = (sight_term){.error = {BEHIND_PX, BEHIND_PX}};
    if (!(p.z > 1e-6)) {
        return;
    }
    double pixel[2], by_lens[2][CALIBRATE_LENS];
    rlf_vec3 by_point[2];
    project(&model->camera[camera], p, pixel, by_lens, by_point);
    out->error[0] = pixel[0] - point->u;
    out->error[1] = pixel[1] - point->v;
    for (int a = 0; a < 2; a++) {
        for (int i = 0; i < CALIBRATE_LENS; i++) {
            out->shared[a][camera * CALIBRATE_LENS + i] = by_lens[a][i];
        }
        rlf_vec3 g = by_point[a];
        if (camera == 1) {
            by_motion(g, p, &out->shared[a][CALIBRATE_MOTION]);
            g = rlf_rotate(rlf_quat_conjugate(T->q), g);
        }
        by_motion(g, first, out->own[a]);
    }
}
