/* What a frame has made, as the surface that is published. */
#include "surface/steps.h"
#include "surface/thickness/thickness.h"

static int32_t count_foreground(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    int32_t count = 0;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        count += slot->foreground[i];
    }
    return count;
}

void surface_publish_seen(const rlf_reconstruct *stage, rlf_slot *slot)
{
    rlf_surface *s = &slot->surface;
    s->width = stage->grid.width;
    s->height = stage->grid.height;
    s->scale_factor = stage->grid.factor;
    s->camera = stage->grid.camera;
    s->noise = stage->def.rig.noise;
    s->ray_x = stage->grid.ray_x;
    s->ray_y = stage->grid.ray_y;
    s->depth = slot->depth;
    s->normal_x = slot->normal[0];
    s->normal_y = slot->normal[1];
    s->normal_z = slot->normal[2];
    s->reason = slot->reason;
    s->is_blind = stage->sight.is_blind;
}

void surface_publish(rlf_reconstruct *stage, const rlf_frame *frame, rlf_slot *slot)
{
    const background_image *image = background_image_newest(stage);
    rlf_surface *s = &slot->surface;
    s->sequence = frame->sequence;
    surface_publish_seen(stage, slot);
    s->velocity_x = slot->velocity[0];
    s->velocity_y = slot->velocity[1];
    s->velocity_z = slot->velocity[2];
    s->thickness = slot->thickness;
    s->label = slot->label;
    s->foreground = slot->foreground;
    const float *none = stage->work.zero_plane;
    s->background_depth = image == NULL ? none : image->depth;
    s->background_normal_x = image == NULL ? none : image->normal[0];
    s->background_normal_y = image == NULL ? none : image->normal[1];
    s->background_normal_z = image == NULL ? none : image->normal[2];
    s->background_label = image == NULL ? stage->work.zero_labels : image->label;
    const float *thickness = static_newest(stage);
    int32_t publications = stage->background.thick.publications;
    s->background_thickness = thickness == NULL ? none : thickness;
    s->background_version = image == NULL ? 0 : (int64_t)image->version + publications;
    s->background_state = stage->background.state;
    s->camera_moves = stage->ego.moves;
    s->camera_may_move = stage->ego.seen_frames > 0 && !stage->ego.moves;
    s->camera_rests = stage->ego.rests;
    s->T_now_before = stage->ego.found;
    s->regions = slot->regions;
    s->region_count = slot->foreground_region_first + slot->foreground_region_count;
    s->region_points = slot->region_points;
    s->foreground_count = count_foreground(stage, slot);
    rlf_stage_add_time(stage, RLF_SURFACE_PUBLISH);
}
