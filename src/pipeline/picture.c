/* The picture of a pipeline: views, overlay, plot, and who draws them. */
#include "pipeline/state.h"

#include <string.h>

rlf_result rlf_pipeline_set_compositor(rlf_pipeline *p, rlf_compositor *compositor)
{
    if (!RLF_ASSERT(p != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_compositor *fresh = compositor;
    if (fresh == NULL) {
        rlf_result result = rlf_compositor_create_soft(&p->compositor_def, &fresh);
        if (result != RLF_OK) {
            return result;
        }
    }
    rlf_compositor_destroy(&p->compositor);
    p->compositor = fresh;
    p->def.enable_render = true;
    return RLF_OK;
}

rlf_compositor_def rlf_pipeline_get_compositor_def(const rlf_pipeline *p)
{
    return RLF_ASSERT(p != NULL) ? p->compositor_def : (rlf_compositor_def){.cookie = 0};
}

/* On failure the old renderer goes on. */
static rlf_result draw_by(rlf_pipeline *p, const rlf_compositor_def *def)
{
    rlf_compositor *fresh = NULL;
    const rlf_result result = rlf_compositor_create_soft(def, &fresh);
    if (result != RLF_OK) {
        return result;
    }
    p->compositor_def = *def;
    return rlf_pipeline_set_compositor(p, fresh);
}

/* What the camera's picture tells, of light and silhouettes, is not where the projector looks. */
static rlf_compositor_def seen_from(const rlf_compositor_def *from, const rlf_camera *projector,
                                    const rlf_pose *T_projector_depth)
{
    rlf_compositor_def def = *from;
    def.rig.color = *projector;
    def.rig.has_color = true;
    def.rig.T_color_depth = *T_projector_depth;
    def.width = def.height = 0;
    def.occlusion = def.occlusion == RLF_OCCLUSION_OFF ? RLF_OCCLUSION_OFF : RLF_OCCLUSION_DEPTH;
    def.estimates_light = def.estimates_light_direction = def.enable_real_ambient = false;
    return def;
}

rlf_result rlf_pipeline_set_projector(rlf_pipeline *p, const rlf_camera *projector,
                                      const rlf_pose *T_projector_depth)
{
    if (!RLF_ASSERT(p != NULL && projector != NULL && T_projector_depth != NULL)) {
        return RLF_ERROR_INVALID;
    }
    const rlf_compositor_def def = seen_from(&p->compositor_def, projector, T_projector_depth);
    return draw_by(p, &def);
}

rlf_result rlf_pipeline_set_picture_size(rlf_pipeline *p, int32_t width, int32_t height)
{
    if (!RLF_ASSERT(p != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_compositor_def def = p->compositor_def;
    def.width = width;
    def.height = height;
    return draw_by(p, &def);
}

void rlf_pipeline_set_view(rlf_pipeline *p, rlf_view view)
{
    if (RLF_ASSERT(p != NULL && view >= 0 && view < RLF_VIEW_COUNT)) {
        (void)rlf_pipeline_set_views(p, &view, 1); /* without memory for hands: without hands */
    }
}

rlf_result rlf_pipeline_set_views(rlf_pipeline *p, const rlf_view *views, int32_t count)
{
    if (!RLF_ASSERT(p != NULL && views != NULL && count >= 1 && count <= RLF_PIPELINE_VIEWS)) {
        return RLF_ERROR_INVALID;
    }
    for (int32_t i = 0; i < count; i++) {
        if (!RLF_ASSERT((int)views[i] >= 0 && views[i] < RLF_VIEW_COUNT)) {
            return RLF_ERROR_INVALID;
        }
    }
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < count; i++) {
        p->views[i] = views[i];
        if (views[i] == RLF_VIEW_HANDS && result == RLF_OK) {
            result = rlf_pipeline_set_hands(p, true);
        }
    }
    p->view_count = count;
    return result;
}

void rlf_pipeline_set_orbit(rlf_pipeline *p, const rlf_orbit *orbit)
{
    if (RLF_ASSERT(p != NULL && orbit != NULL)) {
        p->orbit = *orbit;
    }
}

void rlf_pipeline_set_plot(rlf_pipeline *p, bool is_shown)
{
    if (RLF_ASSERT(p != NULL)) {
        p->shows_plot = is_shown;
    }
}

void rlf_pipeline_set_legend(rlf_pipeline *p, bool is_shown)
{
    if (RLF_ASSERT(p != NULL)) {
        p->shows_legend = is_shown;
    }
}

void rlf_pipeline_set_overlay(rlf_pipeline *p, const char *const *lines, int32_t count)
{
    if (!RLF_ASSERT(p != NULL && count >= 0 && (lines != NULL || count == 0))) {
        return;
    }
    p->overlay_count = count < OVERLAY_LINES_MAX ? count : OVERLAY_LINES_MAX;
    for (int32_t i = 0; i < p->overlay_count; i++) {
        const char *line = lines[i] != NULL ? lines[i] : "";
        size_t length = strlen(line);
        length = length < OVERLAY_LINE_SIZE ? length : OVERLAY_LINE_SIZE - 1;
        memcpy(p->overlay[i], line, length);
        p->overlay[i][length] = '\0';
    }
}

void pipeline_note_times(rlf_pipeline *p)
{
    const rlf_stage_times *t = &p->last.times;
    if (p->plot_count == PLOT_FRAMES) {
        p->plot_count--;
        memmove(p->plot_values, p->plot_values + PLOT_STAGES,
                sizeof(p->plot_values) - PLOT_STAGES * sizeof(float));
    }
    float *values = p->plot_values + PLOT_STAGES * p->plot_count++;
    values[0] = (float)t->capture_ms;
    values[1] = (float)t->surface_ms;
    values[2] = (float)t->physics_ms;
    values[3] = (float)t->render_ms;
}

/* Room for all views; grows when the first picture shows how large they are. */
static rlf_result reserve_sheet(rlf_pipeline *p, const rlf_image_rgba8 *image)
{
    int32_t width = 2 * image->width;
    int32_t height = (p->view_count + 1) / 2 * image->height;
    if (p->sheet.data == NULL || p->sheet.width != width || p->sheet.height != height) {
        rlf_free(p->sheet.data);
        p->sheet = (rlf_image_rgba8){rlf_alloc_array((size_t)width * (size_t)height, 4), width,
                                     height, 4 * (ptrdiff_t)width};
    }
    return p->sheet.data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

/* Puts the picture of view i into its place. */
static void place_view(rlf_pipeline *p, int32_t i, const rlf_image_rgba8 *image)
{
    for (int32_t y = 0; y < image->height; y++) {
        uint8_t *row = rlf_rgba8_row(&p->sheet, i / 2 * image->height + y);
        memcpy(row + i % 2 * 4 * (ptrdiff_t)image->width, rlf_rgba8_row(image, y),
               4 * (size_t)image->width);
    }
}

/* A renderer whose device fails, e.g. an OpenGL driver that lost its context, gives way to the soft
 * one. */
static rlf_result render_one(rlf_pipeline *p, const rlf_render_input *input, rlf_render_output *out)
{
    rlf_result result = rlf_compositor_render(p->compositor, input, out);
    if (result != RLF_ERROR_DEVICE) {
        return result;
    }
    rlf_log(RLF_LOG_WARNING, "%s; going on with the soft renderer", rlf_error_text());
    result = rlf_pipeline_set_compositor(p, NULL);
    return result == RLF_OK ? rlf_compositor_render(p->compositor, input, out) : result;
}

/* The room from the orbit. */
static const rlf_room_sight *look_at_room(rlf_pipeline *p)
{
    return room_view_look(&p->room, rlf_pipeline_get_map(p), &p->compositor_def, &p->orbit);
}

/* The views one after the other; all but the first have their name as overlay. */
static rlf_result render_views(rlf_pipeline *p, rlf_render_input *input)
{
    rlf_result result = RLF_OK;
    rlf_render_output *out = &p->last.render;
    for (int32_t i = 0; result == RLF_OK && i < p->view_count; i++) {
        const char *name = rlf_view_name(p->views[i]);
        input->view = p->views[i];
        input->room = input->view == RLF_VIEW_MAP ? look_at_room(p) : NULL;
        if (i > 0) {
            input->overlay = &name;
            input->overlay_count = 1;
            input->plot = NULL;
        }
        result = render_one(p, input, out);
        if (result == RLF_OK && p->shows_legend) {
            const rlf_legend legend = rlf_view_legend(input->view, &p->compositor_def.rig);
            rlf_legend_draw(&legend, &out->image);
        }
        if (result == RLF_OK && p->view_count > 1) {
            result = reserve_sheet(p, &out->image);
        }
        if (result == RLF_OK && p->view_count > 1) {
            place_view(p, i, &out->image);
        }
    }
    if (result == RLF_OK && p->view_count > 1) {
        out->image = p->sheet;
        out->matte = (rlf_plane_u8){0};
    }
    return result;
}

rlf_result pipeline_draw(rlf_pipeline *p)
{
    static const char *const stages[PLOT_STAGES] = {"capture", "surface", "physics", "render"};
    const rlf_plot plot = {stages, p->plot_values, PLOT_STAGES, p->plot_count, PLOT_LINE_MS};
    memset(&p->last.render, 0, sizeof(p->last.render));
    if (!p->def.enable_render) {
        return RLF_OK;
    }
    if (p->last.track == NULL || p->last.track->health != RLF_TRACK_LOST) {
        room_view_pass(&p->room, &p->last.T_world_camera, p->last.surface);
    }
    hand_stage_draw(&p->hands);
    rlf_render_input input = {
        .frame = &p->last.frame,
        .surface = p->last.surface,
        .snapshot = p->last.snapshot,
        .T_world_camera = p->camera.T_world,
        .orbit = p->orbit,
        .overlay = p->overlay_lines,
        .overlay_count = p->overlay_count,
        .plot = p->shows_plot ? &plot : NULL,
        .marks = p->hands.marks,
        .mark_count = p->hands.mark_count,
    };
    return render_views(p, &input);
}
