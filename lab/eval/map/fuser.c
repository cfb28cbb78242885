/* One frame after the other into the map. */
#include "eval/map/fuser.h"

#include <string.h>

/* What the map needs of a frame is what the sensor saw now: no filling, no memory of earlier frames
 * (the map is that), no regions. */
static rlf_reconstruct_def stage_def(const rlf_rig *rig, rlf_pool *pool)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, rig);
    def.background_method = RLF_BACKGROUND_OFF;
    def.background_segment = RLF_SEGMENT_OFF;
    def.foreground_segment = RLF_SEGMENT_OFF;
    def.enable_fill = false;
    def.enable_steadying = false;
    def.enable_hold = false;
    def.enable_edge_normals = false;
    def.enable_velocity = false;
    def.enable_thickness = false;
    def.enable_coast = false;
    def.enable_color_sides = false;
    def.pool = pool;
    return def;
}

rlf_result fuser_open(fuser *f, const rlf_rig *rig, const fuser_options *options, rlf_pool *pool)
{
    memset(f, 0, sizeof(*f));
    f->rig = rig;
    rlf_map_def def = rlf_map_def_default();
    def.rig = *rig;
    def.pool = pool;
    def.voxel_m = options->voxel_m > 0.0 ? options->voxel_m : def.voxel_m;
    def.memory_mb = options->memory_mb > 0 ? options->memory_mb : def.memory_mb;
    def.blocks_per_frame = options->has_time ? 0 : def.blocks_per_frame;
    rlf_result result = rlf_map_create(&def, &f->map);
    if (result == RLF_OK) {
        const rlf_reconstruct_def stage = stage_def(rig, pool);
        result = rlf_reconstruct_create(&stage, &f->stage);
    }
    if (result == RLF_OK) {
        result = color_view_open(&f->color, rig, pool);
    }
    f->is_tracked = options->is_tracked;
    if (result == RLF_OK && f->is_tracked) {
        f->is_static = rlf_alloc((size_t)rig->depth.width * (size_t)rig->depth.height);
        result = f->is_static != NULL ? camera_pose_open(&f->pose, rig, pool) : RLF_ERROR_MEMORY;
    }
    return result;
}

static double ms_since(int64_t start_ns)
{
    return (double)(rlf_clock_ns() - start_ns) * 1e-6;
}

rlf_result fuser_add(fuser *f, const rlf_frame *frame, const rlf_pose *T_world_camera,
                     rlf_map_change *out_change)
{
    const rlf_surface *s = NULL;
    int64_t start = rlf_clock_ns();
    f->integrate_ms = 0.0;
    rlf_result result = rlf_reconstruct_process(f->stage, frame, &s);
    if (result != RLF_OK) {
        return result;
    }
    f->surface = s;
    f->surface_ms = ms_since(start);
    start = rlf_clock_ns();
    const bool has_color = color_view_take(&f->color, frame, s);
    f->color_ms = ms_since(start);
    if (f->is_tracked && T_world_camera != NULL) {
        f->pose.predict_ms = 0.0;
        result = camera_pose_predict(&f->pose, f->map, T_world_camera);
    } else if (f->is_tracked) {
        result =
            camera_pose_find(&f->pose, f->map, s, has_color ? f->color.grey : NULL, frame->time_ns);
        if (result != RLF_OK || !f->pose.may_fuse) {
            return result;
        }
        T_world_camera = &f->pose.last.T_world_camera;
    }
    if (result == RLF_OK && f->is_tracked) {
        camera_pose_mark_static(&f->pose, s, f->is_static);
    }
    start = rlf_clock_ns();
    const rlf_map_view view = {
        .depth = s->depth,
        .normal_x = s->normal_x,
        .normal_y = s->normal_y,
        .normal_z = s->normal_z,
        .is_static = f->is_tracked ? f->is_static : NULL,
        .rgba = has_color ? f->color.rgba : NULL,
    };
    result = rlf_map_integrate(f->map, &view, T_world_camera, out_change);
    if (!f->has_fence) { /* what the first frame shows is the world, and stays */
        rlf_map_fence(f->map);
        f->has_fence = true;
    }
    f->integrate_ms = ms_since(start);
    return result;
}

void fuser_close(fuser *f)
{
    rlf_map_destroy(&f->map);
    rlf_reconstruct_destroy(&f->stage);
    camera_pose_close(&f->pose);
    color_view_close(&f->color);
    rlf_free(f->is_static);
    f->is_static = NULL;
}
