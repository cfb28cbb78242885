/* A frame of a moving camera: pose, room, surface, map, in this order.
 *
 * The surface stage asks for the room when a frame's depth is clean (moving_give): the camera is
 * placed by that depth, and what the map shows from there is the background. When the stage is done
 * its foreground is known, and all else is fused into the map. */
#include "pipeline/moving/moving.h"

#include <string.h>

/* ---- pose ---- */

/* The source's pose; where it has none the camera stays where it was, and is lost. */
static void take_source_pose(moving *m)
{
    m->pose.last.T_world_camera = m->T_world_camera;
    m->pose.may_fuse = source_poses_take(&m->source, m->frame, &m->pose.last.T_world_camera);
    m->pose.last.health = m->pose.may_fuse ? RLF_TRACK_GOOD : RLF_TRACK_LOST;
}

/* One line when it changes. */
static void tell_health(moving *m)
{
    const rlf_track_health health = m->track.health;
    const unsigned long long number = (unsigned long long)m->frame->sequence;
    if (health == m->told || m->poses == RLF_POSES_SOURCE) {
        return;
    }
    if (health == RLF_TRACK_LOST) {
        rlf_log(RLF_LOG_WARNING,
                "camera: lost (frame %llu): bodies wait; show it what it has seen before", number);
    } else if (health == RLF_TRACK_WEAK) {
        const rlf_vec3 w = m->track.weak_way;
        rlf_log(RLF_LOG_WARNING,
                "camera: weak (frame %llu): how far it moves along %.2f, %.2f, %.2f is a guess",
                number, w.x, w.y, w.z);
    } else {
        rlf_log(RLF_LOG_INFO, "camera: tracked again (frame %llu)", number);
    }
    m->told = health;
}

static rlf_result find_pose(moving *m, const rlf_surface *seen)
{
    rlf_result result = RLF_OK;
    m->has_color = color_view_take(&m->color, m->frame, seen);
    if (m->poses == RLF_POSES_SOURCE) {
        take_source_pose(m);
        result = m->pose.last.health != RLF_TRACK_LOST
                     ? camera_pose_predict(&m->pose, m->map, &m->pose.last.T_world_camera)
                     : RLF_OK;
    } else {
        result = camera_pose_find(&m->pose, m->map, seen, m->has_color ? m->color.grey : NULL,
                                  m->frame->time_ns);
    }
    m->track = m->pose.last;
    if (result == RLF_OK) {
        tell_health(m);
    }
    return result;
}

/* ---- room ---- */

bool moving_give(void *context, const rlf_surface *seen, rlf_given_background *out)
{
    moving *m = context;
    m->has_room = false;
    if (seen->is_blind) { /* it says nothing of where the camera is */
        m->track.health = RLF_TRACK_LOST;
        return false;
    }
    m->result = find_pose(m, seen);
    if (m->result != RLF_OK || !moving_is_placed(m)) {
        return false;
    }
    m->T_world_camera = m->track.T_world_camera;
    if (!m->pose.has_prediction) { /* of the first frame: nothing is known yet */
        m->result = camera_pose_predict(&m->pose, m->map, &m->T_world_camera);
    }
    if (m->result != RLF_OK) {
        return false;
    }
    m->has_room = true;
    room_planes_take(&m->planes, &m->pose.prediction, seen, m->pool);
    const rlf_pose T_camera_world = rlf_pose_invert(&m->T_world_camera);
    *out = (rlf_given_background){
        .depth = m->planes.depth,
        .normal_x = m->planes.normal[0],
        .normal_y = m->planes.normal[1],
        .normal_z = m->planes.normal[2],
        .slack_m = rlf_map_truncation(m->map),
        .T_now_before = rlf_pose_mul(&T_camera_world, &m->T_world_before),
        .has_before = m->has_before,
    };
    return true;
}

/* ---- map ---- */

/* A weak pose adds nothing to the room: along its undetermined direction that could lie anywhere.
 */
static void leave_out_new(moving *m, const rlf_surface *s)
{
    for (int32_t i = 0; i < s->width * s->height; i++) {
        m->is_static[i] =
            m->is_static[i] && camera_pose_is_of_room(&m->pose, rlf_surface_point(s, i));
    }
}

/* Neither what stands in front, unless it has stood there for long, nor what is beside it, nor what
 * nobody saw, nor what has come lately where the room behind is not known. */
static void mark_static(moving *m, const rlf_surface *s)
{
    const int32_t width = s->width, count = s->width * s->height;
    for (int32_t i = 0; i < count; i++) {
        m->is_static[i] = s->reason[i] == RLF_REASON_OK;
    }
    if (m->pose.last.health == RLF_TRACK_WEAK) {
        leave_out_new(m, s);
    }
    settled_mark(&m->pose.settled, m->has_room ? &m->pose.prediction : NULL, s, &m->T_world_camera,
                 m->is_static);
    if (s->foreground_count == 0) {
        return;
    }
    for (int32_t i = width + 1; i < count - width - 1; i++) {
        if (s->foreground[i] != 0 && !absorb_is_room(&m->still, s->label[i])) {
            for (int32_t k = -1; k <= 1; k++) {
                memset(m->is_static + i + (ptrdiff_t)k * width - 1, 0, 3);
            }
        }
    }
}

rlf_result moving_fuse_whole(moving *m, const rlf_map_view *view, const rlf_pose *T_world_camera)
{
    rlf_map_change change;
    int64_t fused = 0;
    rlf_result result;
    do {
        result = rlf_map_integrate(m->map, view, T_world_camera, &change);
        fused += change.blocks_fused;
    } while (result == RLF_OK && change.blocks_fused > 0 && fused < change.blocks_seen);
    return result;
}

static rlf_result fuse(moving *m, const rlf_surface *s)
{
    const rlf_map_view view = {
        .depth = s->depth,
        .normal_x = s->normal_x,
        .normal_y = s->normal_y,
        .normal_z = s->normal_z,
        .is_static = m->is_static,
        .rgba = m->has_color ? m->color.rgba : NULL,
    };
    absorb_update(&m->still, s, &m->T_world_camera, m->absorb_after_s);
    mark_static(m, s);
    if (m->has_fence) {
        return rlf_map_integrate(m->map, &view, &m->T_world_camera, NULL);
    }
    rlf_result result = moving_fuse_whole(m, &view, &m->T_world_camera);
    rlf_map_fence(m->map); /* where the first frame was seen from is what the world is */
    m->has_fence = true;
    return result;
}

rlf_result moving_process(moving *m, const rlf_frame *frame, const rlf_surface **out)
{
    m->frame = frame;
    m->result = RLF_OK;
    rlf_result result = rlf_reconstruct_process(m->stage, frame, out);
    result = result == RLF_OK ? m->result : result;
    if (result != RLF_OK) {
        return result;
    }
    const bool is_placed = moving_is_placed(m);
    if (is_placed && m->pose.may_fuse) {
        result = fuse(m, *out);
    }
    m->T_world_before = m->T_world_camera;
    m->has_before = is_placed;
    return result;
}
