/* How far a camera's motion shifts its picture. */
#include "environment/background_color.h"

#define MOST_PX 1.0

/* Pixels that a point far away, in the middle, shifts by turning, and one at `nearest_m` by moving:
 * at most so many, up to a small factor at wide corners. */
static double shift_px(const rlf_pose *T, double focal_px, double nearest_m)
{
    const rlf_vec3 axis = rlf_vec3_make(T->q.x, T->q.y, T->q.z);
    const double turn = 2.0 * rlf_length(axis); /* 2 sin(angle / 2) */
    return focal_px * (turn + rlf_length(T->p) / nearest_m);
}

bool sight_change_update(sight_change *c, const rlf_pose *T_world_camera, const rlf_camera *camera,
                         double nearest_m)
{
    if (c->has_pose) {
        const rlf_pose T_before_world = rlf_pose_invert(&c->T_world_camera);
        const rlf_pose T_before_now = rlf_pose_mul(&T_before_world, T_world_camera);
        if (shift_px(&T_before_now, rlf_max(camera->fx, camera->fy), nearest_m) < MOST_PX) {
            return false;
        }
    }
    const bool has_changed = c->has_pose;
    c->T_world_camera = *T_world_camera;
    c->has_pose = true;
    return has_changed;
}
