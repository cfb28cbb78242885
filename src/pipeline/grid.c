/* Views of a surface for physics. */
#include "relief/pipeline.h"

static bool project_to_grid(const void *context, rlf_vec3 p, double *out_u, double *out_v)
{
    const rlf_camera *camera = context;
    return rlf_camera_project(camera, p, out_u, out_v) && *out_u >= -0.5 && *out_v >= -0.5 &&
           *out_u < camera->width - 0.5 && *out_v < camera->height - 0.5;
}

static rlf_grid_sheet front_sheet(const rlf_surface *s)
{
    rlf_grid_sheet sheet = {
        .depth = s->depth,
        .normal_x = s->normal_x,
        .normal_y = s->normal_y,
        .normal_z = s->normal_z,
        .velocity_x = s->velocity_x,
        .velocity_y = s->velocity_y,
        .velocity_z = s->velocity_z,
        .label = s->label,
    };
    return sheet;
}

static rlf_grid_sheet background_sheet(const rlf_surface *s)
{
    rlf_grid_sheet sheet = {
        .depth = s->background_depth,
        .normal_x = s->background_normal_x,
        .normal_y = s->background_normal_y,
        .normal_z = s->background_normal_z,
        .label = s->background_label,
        .thickness = s->background_thickness,
        .version = s->background_version,
    };
    return sheet;
}

static int32_t list_regions(const rlf_surface *s, rlf_grid_region *regions, int32_t capacity)
{
    int32_t count = s->region_count < capacity ? s->region_count : capacity;
    for (int32_t i = 0; i < count; i++) {
        const rlf_region *region = &s->regions[i];
        bool has_points = s->region_points != NULL && region->first_point >= 0;
        regions[i] = (rlf_grid_region){
            .label = region->label,
            .is_foreground = region->layer == RLF_LAYER_FOREGROUND,
            .box = region->box,
            .points = has_points ? s->region_points + region->first_point : NULL,
            .point_count = has_points ? region->point_count : 0,
        };
    }
    return count;
}

void rlf_grid_from_surface(const rlf_surface *surface, const rlf_pose *T_world_camera,
                           rlf_grid_region *regions, int32_t region_capacity, rlf_grid *out)
{
    if (!RLF_ASSERT(surface != NULL && T_world_camera != NULL && out != NULL) ||
        !RLF_ASSERT(regions != NULL || region_capacity == 0)) {
        return;
    }
    *out = (rlf_grid){
        .width = surface->width,
        .height = surface->height,
        .ray_x = surface->ray_x,
        .ray_y = surface->ray_y,
        .regions = regions,
        .region_count = list_regions(surface, regions, region_capacity),
        .project = project_to_grid,
        .project_context = &surface->camera,
        .pixel_angle = 1.0 / surface->camera.fx,
        .T_world_grid = *T_world_camera,
        .time_ns = surface->time_ns,
    };
    if (surface->background_state == RLF_BACKGROUND_READY) {
        out->background = background_sheet(surface);
        out->background.default_thickness = RLF_BACKGROUND_GUESS_M;
        out->foreground = front_sheet(surface);
        out->foreground.thickness = surface->thickness;
        out->foreground.mask = surface->foreground;
    } else {
        /* Until the background is known, all that is seen is one endlessly thick sheet. */
        out->background = front_sheet(surface);
    }
}
