/* The compositor's values as the environment takes them, and where its views are seen from. */
#include "render/render.h"

#include "render/body_look.h"

#define PITCH_MAX 1.5
#define ZOOM_MIN 0.1
#define ZOOM_MAX 10.0

rlf_camera render_camera(const rlf_compositor_def *def)
{
    const rlf_camera *camera = def->rig.has_color ? &def->rig.color : &def->rig.depth;
    int32_t width = def->width > 0 ? def->width : camera->width;
    int32_t height = def->height > 0 ? def->height : camera->height;
    return rlf_camera_resize(camera, width, height);
}

rlf_pose render_pose(const rlf_compositor_def *def)
{
    return def->rig.has_color ? def->rig.T_color_depth : rlf_pose_identity();
}

real_depth_def render_depth_def(const rlf_compositor_def *def)
{
    return (real_depth_def){.rig = &def->rig,
                            .grid = def->grid,
                            .ray_x = def->ray_x,
                            .ray_y = def->ray_y,
                            .picture = render_camera(def),
                            .T_picture_depth = render_pose(def),
                            .pool = def->pool};
}

observation render_observation(const rlf_render_input *input)
{
    return (observation){input->frame, input->surface, input->snapshot, input->T_world_camera};
}

void render_place_bodies(edge_matte *edges, const rlf_camera *camera,
                         const rlf_pose *T_picture_world, const rlf_snapshot *snapshot)
{
    edge_matte_clear_bodies(edges);
    for (int32_t i = 0; snapshot != NULL && i < snapshot->body_count; i++) {
        const rlf_body_state *body = &snapshot->bodies[i];
        edge_matte_add_body(edges, camera, rlf_transform(T_picture_world, body->T_world_body.p),
                            body_look_radius(body));
    }
    edge_matte_spread_bodies(edges);
}

static double finite_or(double value, double otherwise)
{
    return rlf_is_finite(value) ? value : otherwise;
}

rlf_pose rlf_orbit_pose(const rlf_orbit *orbit, double pivot_m)
{
    if (!RLF_ASSERT(orbit != NULL)) {
        return rlf_pose_identity();
    }
    double zoom = finite_or(orbit->zoom, 0.0);
    zoom = zoom > 0.0 ? rlf_clamp(zoom, ZOOM_MIN, ZOOM_MAX) : 1.0;
    double pitch = rlf_clamp(finite_or(orbit->pitch, 0.0), -PITCH_MAX, PITCH_MAX);
    rlf_quat yaw = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), finite_or(orbit->yaw, 0.0));
    rlf_quat up = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), pitch);
    rlf_pose T = {{0, 0, 0}, rlf_quat_mul(up, yaw)};
    rlf_vec3 pivot = rlf_rotate(T.q, rlf_vec3_make(0, 0, pivot_m));
    T.p = rlf_vec3_make(-pivot.x, -pivot.y, pivot_m * zoom - pivot.z);
    return T;
}
