/* The compositor's values as the environment takes them. */
#include "render/render.h"

#include "render/body_look.h"

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
