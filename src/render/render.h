/* What both renderers ask of a def and its inputs. */
#ifndef RLF_RENDER_RENDER_H
#define RLF_RENDER_RENDER_H

#include "base/inside.h"
#include "environment/edge_matte.h"
#include "environment/real_depth.h"
#include "relief/compositor.h"
#include "render/caster.h"

/* Camera that a def's picture is drawn with, and its pose: the colour camera's or, without one, the
 * depth camera's, resized to the def's picture. */
rlf_camera render_camera(const rlf_compositor_def *def) RLF_INSIDE(render_camera);
rlf_pose render_pose(const rlf_compositor_def *def) RLF_INSIDE(render_pose); /* T_picture_depth */

real_depth_def render_depth_def(const rlf_compositor_def *def) RLF_INSIDE(render_depth_def);
observation render_observation(const rlf_render_input *input) RLF_INSIDE(render_observation);
/* T_view_base of an orbit: the base looks along z at a point `pivot_m` metres before it, and the
 * view is turned about that. Angles that are not finite are 0. */
rlf_pose render_orbit_pose(const rlf_orbit *orbit, double pivot_m);
/* Tells the matte where the bodies of a snapshot are, NULL = none, and where `count` casters'
 * shadows may fall. to_light: unit, picture camera frame. */
typedef struct render_casters {
    const caster *casters;
    int32_t count;
    rlf_vec3 to_light;
} render_casters;
void render_place_bodies(edge_matte *edges, const rlf_camera *camera,
                         const rlf_pose *T_picture_world, const rlf_snapshot *snapshot,
                         const render_casters *casters) RLF_INSIDE(render_place_bodies);

#endif
