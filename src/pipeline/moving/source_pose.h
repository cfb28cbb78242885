/* The source's own poses, as places in the map's world. */
#ifndef RELIEF_PIPELINE_SOURCE_POSE_H
#define RELIEF_PIPELINE_SOURCE_POSE_H

#include "relief/frame.h"

typedef struct source_poses {
    rlf_pose T_world_first; /* where the first frame with a pose is taken to be */
    double reach_m;         /* of the world from its origin, along each axis */
    bool has_first, has_told;
    rlf_pose T_world_source;
} source_poses;

/* For a map with such voxels. */
source_poses source_poses_begin(const rlf_pose *T_world_first, double voxel_m);
/* Where the camera was. False when the frame has no pose, one that is none, or one that is beyond
 * what a map can hold; the first such frame is named in a warning,
 * and *out stays. */
bool source_poses_take(source_poses *s, const rlf_frame *frame, rlf_pose *out);

#endif
