/* What a source says about its camera is checked before it is believed. */
#include "pipeline/moving/moving.h"

#include "relief/map.h"

#define UNIT_ERROR 0.01 /* of a quaternion's length, squared */
#define ROOM_BLOCKS 200 /* kept for what is seen from the farthest place */

source_poses source_poses_begin(const rlf_pose *T_world_first, double voxel_m)
{
    const double block_m = voxel_m * RLF_MAP_BLOCK;
    return (source_poses){.T_world_first = *T_world_first,
                          .reach_m = (INT16_MAX - ROOM_BLOCKS) * block_m};
}

static bool is_within(rlf_vec3 p, double reach)
{
    return p.x > -reach && p.x < reach && p.y > -reach && p.y < reach && p.z > -reach &&
           p.z < reach;
}

/* What is wrong with a pose; NULL = nothing. */
static const char *fault_of(const rlf_pose *T)
{
    const rlf_quat q = T->q;
    const double length = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    if (!rlf_vec3_is_finite(T->p) || !rlf_is_finite(length)) {
        return "is not finite";
    }
    return length > 1.0 - UNIT_ERROR && length < 1.0 + UNIT_ERROR
               ? NULL
               : "has a quaternion that is not of length 1";
}

static void tell(source_poses *s, const rlf_frame *frame, const char *fault)
{
    const unsigned long long number = (unsigned long long)frame->sequence;
    const rlf_pose *T = &frame->T_world_camera;
    if (s->has_told) {
        return;
    }
    s->has_told = true;
    if (!frame->has_pose) {
        rlf_log(RLF_LOG_WARNING,
                "poses of the source: frame %llu has none; such frames are left out", number);
        return;
    }
    rlf_log(RLF_LOG_WARNING,
            "poses of the source: frame %llu: position %g, %g, %g m, quaternion %g, %g, %g, %g %s; "
            "such frames are left out",
            number, T->p.x, T->p.y, T->p.z, T->q.x, T->q.y, T->q.z, T->q.w, fault);
}

bool source_poses_take(source_poses *s, const rlf_frame *frame, rlf_pose *out)
{
    const char *fault = frame->has_pose ? fault_of(&frame->T_world_camera) : "";
    if (fault != NULL) {
        tell(s, frame, fault);
        return false;
    }
    if (!s->has_first) {
        const rlf_pose T_source_world = rlf_pose_invert(&frame->T_world_camera);
        s->T_world_source = rlf_pose_mul(&s->T_world_first, &T_source_world);
        s->has_first = true;
    }
    const rlf_pose T_world_camera = rlf_pose_mul(&s->T_world_source, &frame->T_world_camera);
    if (!is_within(T_world_camera.p, s->reach_m)) {
        tell(s, frame, "is too far from the first one for a map");
        return false;
    }
    *out = T_world_camera;
    return true;
}
