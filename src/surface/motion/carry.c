/* The frame before as this frame's camera would have seen it, so that what is compared with it has
 * moved in the room, not in the picture. */
#include "camera/pixels.h"
#include "surface/steps.h"

#include <string.h>

static void clear_slot(const image_grid *grid, rlf_slot *slot)
{
    const size_t n = (size_t)grid->count;
    memset(slot->depth, 0, n * sizeof *slot->depth);
    memset(slot->label, 0, n * sizeof *slot->label);
    memset(slot->foreground, 0, n);
    memset(slot->reason, RLF_REASON_NO_RETURN, n);
}

static void carry_pixels(const image_grid *grid, const rlf_slot *from, const rlf_pose *T,
                         rlf_slot *to)
{
    for (int32_t i = 0; i < grid->count; i++) {
        const double z = from->foreground[i] ? (double)from->depth[i] : 0.0;
        if (!(z > 0.0)) {
            continue;
        }
        const rlf_vec3 p = {z * grid->ray_x[i], z * grid->ray_y[i], z};
        const rlf_vec3 q = rlf_transform(T, p);
        const int32_t k = camera_pixel_of(&grid->camera, q);
        if (k >= 0 && (!(to->depth[k] > 0.0f) || (float)q.z < to->depth[k])) {
            to->depth[k] = (float)q.z;
            to->label[k] = from->label[i];
            to->reason[k] = from->reason[i];
            to->foreground[k] = 1;
        }
    }
}

/* Pixels that nothing fell on, between two of one region in a row or a column. */
static void close_gaps(const image_grid *grid, rlf_slot *slot)
{
    const int32_t width = grid->width;
    const int32_t steps[2] = {1, width};
    for (int pass = 0; pass < 2; pass++) {
        const int32_t step = steps[pass];
        for (int32_t i = width + 1; i < grid->count - width - 1; i++) {
            const int32_t label = slot->label[i - step];
            if (slot->foreground[i] || label == 0 || label != slot->label[i + step]) {
                continue;
            }
            slot->depth[i] = 0.5f * (slot->depth[i - step] + slot->depth[i + step]);
            slot->label[i] = label;
            slot->reason[i] = slot->reason[i - step];
            slot->foreground[i] = 1;
        }
    }
}

static void carry_regions(const rlf_slot *from, const rlf_pose *T, rlf_slot *to)
{
    to->foreground_region_first = 0;
    to->foreground_region_count = from->foreground_region_count;
    for (int32_t k = 0; k < from->foreground_region_count; k++) {
        rlf_region *region = &to->regions[k];
        *region = from->regions[from->foreground_region_first + k];
        region->centroid = rlf_transform(T, region->centroid);
        region->linear_velocity = rlf_rotate(T->q, region->linear_velocity);
        region->angular_velocity = rlf_rotate(T->q, region->angular_velocity);
    }
}

void motion_carry(rlf_reconstruct *stage, const rlf_pose *T_now_before)
{
    const image_grid *grid = &stage->grid;
    rlf_slot *to = &stage->carried;
    clear_slot(grid, to);
    carry_pixels(grid, stage->before, T_now_before, to);
    close_gaps(grid, to);
    carry_regions(stage->before, T_now_before, to);
    to->surface.time_ns = stage->before->surface.time_ns;
    stage->previous = to;
}
