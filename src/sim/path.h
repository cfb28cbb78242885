/* Where a camera that moves is: its path, and the scene as it stands in the camera's frame. */
#ifndef RLF_SIM_PATH_H
#define RLF_SIM_PATH_H

#include "sim/scene.h"

typedef struct synth_path {
    rlf_synthetic_path kind;
    rlf_quat q_camera_path; /* path frame: y down, z the way that the first camera faces */
    double scale;           /* of the way, 0..1, so that nothing is walked into */
} synth_path;

/* A path from where the scene's camera stands at rest. */
void synth_path_make(synth_path *path, rlf_synthetic_path kind, const synth_scene *rest);

/* Pose at time t >= 0, seconds; the identity at 0. */
rlf_pose synth_path_pose(const synth_path *path, double t);

/* *out = the scene in the frame of a camera that has moved from where it rests. */
void synth_path_see(const synth_scene *rest, const rlf_pose *T_world_camera, synth_scene *out);

/* path_room.c: walls and things to the sides and behind, where a camera at rest never looks. */
void synth_path_close_room(synth_scene *scene);

#endif
