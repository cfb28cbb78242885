/* The compositor's values as the environment takes them, and where its views are seen from. */
#include "render/render.h"

#include "render/body_texture.h"

#include <string.h>

#define PITCH_MAX 1.5
#define ZOOM_MIN 0.1
#define ZOOM_MAX 10.0
#define ROOM_SHARE 0.6 /* of a room's diagonal is half as wide as a picture of its middle, */
#define ROOM_PITCH 0.4 /* which is taken from so much further up than its base looks, radians */

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

static void place_shadows(edge_matte *edges, const rlf_camera *camera, const render_casters *from)
{
    for (int32_t i = 0; i < from->count; i++) {
        const caster *c = &from->casters[i];
        pixel_rect rect;
        if (c->near_m > 0.0f && caster_reach(c, camera, from->to_light, &rect)) {
            const double z = (double)c->center[2];
            const double end_z = z - from->to_light.z * (double)c->length_m;
            const double reach = (double)(c->radius + c->near_m);
            edge_matte_add_shadow(edges, &rect, rlf_min(z, end_z) - reach,
                                  rlf_max(z, end_z) + reach);
        }
    }
}

void render_place_bodies(edge_matte *edges, const rlf_camera *camera,
                         const rlf_pose *T_picture_world, const rlf_snapshot *snapshot,
                         const render_casters *casters)
{
    edge_matte_clear_bodies(edges);
    for (int32_t i = 0; snapshot != NULL && i < snapshot->body_count; i++) {
        const rlf_body_state *body = &snapshot->bodies[i];
        edge_matte_add_body(edges, camera, rlf_transform(T_picture_world, body->T_world_body.p),
                            body_look_radius(body));
    }
    place_shadows(edges, camera, casters);
    edge_matte_spread_bodies(edges);
}

static double finite_or(double value, double otherwise)
{
    return rlf_is_finite(value) ? value : otherwise;
}

rlf_pose render_orbit_pose(const rlf_orbit *orbit, double pivot_m)
{
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

/* The picture's camera, no larger than another. */
static rlf_camera shrink(const rlf_camera *picture, const rlf_camera *most)
{
    double scale =
        rlf_min((double)most->width / picture->width, (double)most->height / picture->height);
    scale = rlf_min(scale, 1.0);
    rlf_camera camera = *picture;
    camera.distortion_model = RLF_DISTORTION_NONE;
    memset(camera.distortion, 0, sizeof(camera.distortion));
    const int32_t width = (int32_t)(scale * picture->width + 0.5);
    const int32_t height = (int32_t)(scale * picture->height + 0.5);
    return rlf_camera_resize(&camera, width > 0 ? width : 1, height > 0 ? height : 1);
}

void rlf_room_look(const rlf_compositor_def *def, const rlf_aabb *box, const rlf_pose *T_world_base,
                   const rlf_orbit *orbit, rlf_camera *out_camera, rlf_pose *out_T_world_view)
{
    if (!RLF_ASSERT(def != NULL && box != NULL && T_world_base != NULL && orbit != NULL &&
                    out_camera != NULL && out_T_world_view != NULL)) {
        return;
    }
    const rlf_vec3 size = rlf_sub(box->max, box->min);
    const rlf_camera picture = render_camera(def);
    const double away = ROOM_SHARE * rlf_length(size) * 2.0 * picture.fx / picture.width;
    const rlf_vec3 ahead = rlf_rotate(T_world_base->q, rlf_vec3_make(0, 0, 1));
    const rlf_pose T_world_base_away = {rlf_mad(rlf_mad(box->min, size, 0.5), ahead, -away),
                                        T_world_base->q};
    rlf_orbit raised = *orbit;
    raised.pitch = finite_or(orbit->pitch, 0.0) + ROOM_PITCH;
    const rlf_pose T_view_base = render_orbit_pose(&raised, away);
    const rlf_pose T_base_view = rlf_pose_invert(&T_view_base);
    *out_camera = shrink(&picture, &def->rig.depth);
    *out_T_world_view = rlf_pose_mul(&T_world_base_away, &T_base_view);
}
