/* A moving camera begins and ends. */
#include "pipeline/moving/moving.h"

#include <string.h>

#define STILL_WEIGHT 8 /* frames: so much does what a standing camera has learnt count */

/* Memory per pixel of a standing camera is left out: it would smear. */
static rlf_reconstruct_def stage_def(const rlf_pipeline_def *def)
{
    rlf_reconstruct_def stage = def->reconstruct;
    stage.background_method = RLF_BACKGROUND_GIVEN;
    stage.background_segment = RLF_SEGMENT_OFF;
    stage.enable_steadying = false;
    stage.enable_hold = false;
    stage.enable_coast = false;
    stage.enable_color_sides = false;
    return stage;
}

static rlf_result open_map(moving *m, const rlf_pipeline_def *def)
{
    m->map = def->map;
    m->owns_map = def->map == NULL;
    if (!m->owns_map) {
        return RLF_OK;
    }
    rlf_map_def map = rlf_map_def_default();
    map.rig = m->rig;
    map.pool = def->pool;
    return rlf_map_create(&map, &m->map);
}

/* The map begins, or goes on, with what was seen before the camera moved. It is a keyframe, and the
 * first guess is where the camera has come to since. */
static rlf_result fuse_still(moving *m, const moving_from *from)
{
    const rlf_map_view room = {.depth = from->still};
    const rlf_track_view view = {.depth = from->still};
    rlf_result result = RLF_OK;
    for (int32_t k = 0; k < STILL_WEIGHT && result == RLF_OK; k++) {
        result = moving_fuse_whole(m, &room, &from->T_world_camera);
    }
    rlf_track_result *last = &m->pose.last;
    *last = (rlf_track_result){
        .T_world_camera = from->T_world_camera, .health = RLF_TRACK_GOOD, .overlap = 1.0};
    rlf_tracker_accept(m->pose.tracker, &view, from->time_ns, last);
    last->T_world_camera = m->T_world_camera;
    last->health = RLF_TRACK_WEAK;
    rlf_tracker_accept(m->pose.tracker, &view, from->time_ns, last);
    m->pose.has_first = true;
    m->pose.has_prediction = false;
    m->pose.proven = 0;
    rlf_map_fence(m->map);
    m->has_fence = true;
    return result;
}

static rlf_result open_all(moving *m, const rlf_pipeline_def *def)
{
    const size_t pixels = (size_t)m->rig.depth.width * (size_t)m->rig.depth.height;
    rlf_reconstruct_def stage = stage_def(def);
    stage.give_context = m;
    stage.give_background = moving_give;
    rlf_result result = rlf_reconstruct_create(&stage, &m->stage);
    if (result == RLF_OK) {
        result = open_map(m, def);
    }
    if (result == RLF_OK) {
        result = camera_pose_open(&m->pose, &m->rig, def->pool);
    }
    if (result == RLF_OK) {
        result = color_view_open(&m->color, &m->rig, def->pool);
    }
    if (result == RLF_OK) {
        result = room_planes_open(&m->planes, &m->rig.depth, &m->pose.camera);
    }
    m->is_static = result == RLF_OK ? rlf_alloc(pixels) : NULL;
    return result == RLF_OK && m->is_static == NULL ? RLF_ERROR_MEMORY : result;
}

static rlf_result check(const rlf_pipeline_def *def)
{
    const bool is_whole = def->reconstruct.scale_factor == 1;
    return is_whole ? RLF_OK
                    : rlf_fail(RLF_ERROR_INVALID,
                               "a camera that moves needs scale factor 1, not "
                               "%d: every pixel helps to place it",
                               (int)def->reconstruct.scale_factor);
}

/* For a camera that has not moved yet. */
static rlf_result start_first(moving *m, const rlf_pipeline_def *def)
{
    memset(m, 0, sizeof(*m));
    rlf_result result = check(def);
    if (result != RLF_OK) {
        return result;
    }
    m->rig = rlf_source_get_info(def->source)->rig;
    m->pool = def->pool;
    m->poses = def->poses;
    m->absorb_after_s = def->reconstruct.absorb_after_s;
    result = open_all(m, def);
    if (result == RLF_OK) {
        rlf_tracker_reset(m->pose.tracker, &def->T_world_camera);
    }
    if (result == RLF_OK && rlf_map_get_status(m->map).block_count > 0) {
        result = camera_pose_know(&m->pose, m->map);
    }
    return result;
}

rlf_result moving_start(moving *m, const rlf_pipeline_def *def, const moving_from *from)
{
    const bool is_first = m->stage == NULL;
    rlf_result result = is_first ? start_first(m, def) : RLF_OK;
    if (result == RLF_OK) {
        const rlf_pose moved =
            from != NULL ? rlf_pose_invert(&from->T_now_before) : rlf_pose_identity();
        m->T_world_camera =
            rlf_pose_mul(from != NULL ? &from->T_world_camera : &def->T_world_camera, &moved);
        m->told = RLF_TRACK_GOOD;
        m->has_before = false;
        m->still = (absorb){.thing_count = 0};
        m->source = source_poses_begin(&m->T_world_camera, rlf_map_get_status(m->map).voxel_m);
        rlf_reconstruct_reset(m->stage);
    }
    if (result == RLF_OK && from != NULL && from->still != NULL) {
        result = fuse_still(m, from);
    }
    m->is_on = result == RLF_OK;
    if (result != RLF_OK) {
        moving_stop(m);
    }
    return result;
}

void moving_stop(moving *m)
{
    rlf_reconstruct_destroy(&m->stage);
    camera_pose_close(&m->pose);
    color_view_close(&m->color);
    room_planes_close(&m->planes);
    rlf_free(m->is_static);
    if (m->owns_map) {
        rlf_map_destroy(&m->map);
    }
    memset(m, 0, sizeof(*m));
}
