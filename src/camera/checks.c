/* Checks of poses and rigs. */
#include "camera/checks.h"

#include <stdio.h>

rlf_result pose_check(const rlf_pose *T, const char *who, const char *field)
{
    const rlf_quat q = T->q;
    if (!rlf_vec3_is_finite(T->p) || !rlf_is_finite(q.x) || !rlf_is_finite(q.y) ||
        !rlf_is_finite(q.z) || !rlf_is_finite(q.w)) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %s is not finite; use metres and a unit quaternion",
                        who, field);
    }
    return RLF_OK;
}

static rlf_result check_camera(const rlf_camera *camera, const char *who, const char *field)
{
    char text[128];
    (void)snprintf(text, sizeof(text), "%s: %s", who, field);
    return rlf_camera_check(camera, text);
}

rlf_result rig_check(const rlf_rig *rig, const char *who)
{
    rlf_result result = check_camera(&rig->depth, who, "rig.depth");
    if (result == RLF_OK && rig->has_color) {
        result = check_camera(&rig->color, who, "rig.color");
    }
    if (result == RLF_OK && rig->has_color) {
        result = pose_check(&rig->T_color_depth, who, "rig.T_color_depth");
    }
    const struct {
        const char *name;
        double value;
    } numbers[] = {
        {"depth_min_m", rig->depth_min_m},
        {"depth_max_m", rig->depth_max_m},
        {"depth_offset_m", rig->depth_offset_m},
        {"noise.c0", rig->noise.c0},
        {"noise.c1", rig->noise.c1},
        {"noise.c2", rig->noise.c2},
    };
    for (size_t i = 0; result == RLF_OK && i < sizeof(numbers) / sizeof(numbers[0]); i++) {
        if (!(numbers[i].value >= -1000.0 && numbers[i].value <= 1000.0)) {
            result = rlf_fail(RLF_ERROR_INVALID, "%s: rig.%s is %g; use -1000 to 1000", who,
                              numbers[i].name, numbers[i].value);
        }
    }
    return result;
}
