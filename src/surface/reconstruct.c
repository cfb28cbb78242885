/* The surface stage: one frame through all steps into the next slot of the ring. */
#include "surface/motion/keyframe.h"
#include "surface/objects/objects.h"
#include "surface/steps.h"
#include "surface/thickness/thickness.h"

#include "base/checks.h"
#include "camera/checks.h"

#include <string.h>

/* Pixels: the steps of a smaller frame, some 10 microseconds each, are done before another thread
 * has woken. */
enum { LEAST_SHARED = 8192 };

static void set_grid(rlf_reconstruct *stage)
{
    image_grid *grid = &stage->grid;
    grid->factor = stage->def.scale_factor;
    grid->camera = rlf_camera_decimate(&stage->def.rig.depth, grid->factor);
    grid->width = grid->camera.width;
    grid->height = grid->camera.height;
    grid->count = grid->width * grid->height;
}

rlf_result rlf_reconstruct_create(const rlf_reconstruct_def *def, rlf_reconstruct **out)
{
    if (!RLF_ASSERT(def != NULL && out != NULL && def->cookie == RLF_DEF_COOKIE)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "reconstruct: the def is not from rlf_reconstruct_def_default");
    }
    *out = NULL;
    rlf_result result = rlf_reconstruct_def_check(def);
    if (result != RLF_OK) {
        return result;
    }
    rlf_reconstruct *stage = rlf_alloc(sizeof *stage);
    if (stage == NULL) {
        return RLF_ERROR_MEMORY;
    }
    stage->def = *def;
    set_grid(stage);
    if (stage->grid.count < LEAST_SHARED) {
        stage->def.pool = NULL;
    }
    if (!rlf_stage_allocate(stage)) {
        rlf_reconstruct_destroy(&stage);
        return RLF_ERROR_MEMORY;
    }
    rlf_reconstruct_reset(stage);
    *out = stage;
    return RLF_OK;
}

void rlf_reconstruct_destroy(rlf_reconstruct **stage)
{
    if (stage == NULL || *stage == NULL) {
        return;
    }
    rlf_stage_release(*stage);
    rlf_free(*stage);
    *stage = NULL;
}

void rlf_reconstruct_reset(rlf_reconstruct *stage)
{
    if (!RLF_ASSERT(stage != NULL)) {
        return;
    }
    rlf_sight_reset(&stage->sight);
    rlf_background_reset(&stage->background, &stage->grid);
    static_reset(&stage->background.thick);
    keyframes_reset(&stage->velocity);
    temporal_reset(&stage->temporal, &stage->grid);
    normals_reset(&stage->normals, &stage->grid);
    rlf_objects_reset(stage->objects, stage->grid.count);
    stage->tracks.count = 0;
    thin_reset(&stage->thin, &stage->grid);
    rlf_color_guide_reset(stage);
    rlf_ego_motion_reset(&stage->ego);
    rlf_shadow_reset(&stage->shadow);
    stage->previous = stage->before = NULL;
}

static rlf_result check_frame(const rlf_reconstruct *stage, const rlf_frame *frame)
{
    const rlf_camera *camera = &stage->def.rig.depth;
    if (frame->rig != NULL &&
        (frame->rig->depth.width != camera->width || frame->rig->depth.height != camera->height)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "reconstruct: frame %llu is %d x %d, the stage was made for %d x %d",
                        (unsigned long long)frame->sequence, (int)frame->rig->depth.width,
                        (int)frame->rig->depth.height, (int)camera->width, (int)camera->height);
    }
    return rlf_frame_check(&stage->def.rig, frame, "reconstruct");
}

/* What the background is, and with it the foreground. */
static void find_background(rlf_reconstruct *stage, const float *kept, rlf_slot *slot)
{
    rlf_sight_take(stage, slot);
    rlf_background_update(stage, kept, slot);
    rlf_stage_add_time(stage, RLF_SURFACE_BACKGROUND);
}

static void find_motion(rlf_reconstruct *stage, rlf_slot *slot)
{
    if (stage->def.enable_velocity) {
        rlf_velocity_estimate(stage, slot);
        rlf_stage_add_time(stage, RLF_SURFACE_VELOCITY);
    }
}

static void find_thickness(rlf_reconstruct *stage, const float *kept, rlf_slot *slot)
{
    if (stage->def.enable_thickness) {
        rlf_thickness_estimate(stage, slot, kept);
        thin_write(&stage->thin, &stage->grid, stage->background.mean, slot);
        static_advance(stage);
        rlf_stage_add_time(stage, RLF_SURFACE_THICKNESS);
    }
}

/* The surface in ten sentences. Each step reads what those before it have finished. */
static void make_surface(rlf_reconstruct *stage, const rlf_frame *frame, rlf_slot *slot)
{
    rlf_work *work = &stage->work;
    /* Depth is read, and mixed pixels are taken off. */
    depth_read_frame(stage, frame, work->raw, work->kept, slot->reason);
    /* Thin things are followed to where they must be. */
    depth_track_thin(stage, work->kept, slot);
    /* What was dropped is recalled, and noise is averaged over time. */
    depth_average(stage, work->raw, work->kept, slot->reason);
    /* Noise is averaged within planes, which have normals. */
    normals_smooth(stage, work->kept, slot);
    /* Small holes are filled; they, creases and contours get normals from beside them. */
    depth_fill(stage, frame, work->kept, slot, work->was_seen);
    normals_complete(stage, slot, work->was_seen);
    /* What is not the background is the foreground; normals that differ by layer are known now. */
    find_background(stage, work->kept, slot);
    normals_finish(stage, work->kept, slot);
    /* Both layers fall into regions with labels that last. */
    segment_frame(stage, slot);
    /* Regions of the foreground move. */
    find_motion(stage, slot);
    /* They have a back, and so have things that stand. */
    find_thickness(stage, work->kept, slot);
    /* All of it is published. */
    rlf_ego_motion_remember(stage, slot);
    surface_publish(stage, frame, slot);
}

rlf_result rlf_reconstruct_process(rlf_reconstruct *stage, const rlf_frame *frame,
                                   const rlf_surface **out_surface)
{
    if (!RLF_ASSERT(stage != NULL && frame != NULL && out_surface != NULL)) {
        return rlf_fail(RLF_ERROR_INVALID, "reconstruct: NULL argument");
    }
    *out_surface = NULL;
    rlf_result result = check_frame(stage, frame);
    if (result != RLF_OK) {
        return result;
    }
    stage->current = (stage->current + 1) % RLF_RECONSTRUCT_SURFACES;
    rlf_slot *slot = &stage->ring[stage->current];
    slot->surface.time_ns = frame->time_ns;
    rlf_stage_start_times(stage);
    const bool is_given = stage->def.background_method == RLF_BACKGROUND_GIVEN;
    stage->before = stage->previous;
    stage->previous = is_given ? NULL : stage->previous;
    make_surface(stage, frame, slot);
    stage->previous = slot;
    *out_surface = &slot->surface;
    return RLF_OK;
}
