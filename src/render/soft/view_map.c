/* The fused room from anywhere: a prediction, enlarged into the picture; then the bodies as in the
 * main view, with its depth for the real world; then where the camera has been. */
#include "render/soft/views.h"

#include "environment/depth_edge.h"
#include "render/soft/passes.h"
#include "render/soft/draw.h"

typedef struct map_job {
    const soft *s;
    const rlf_room_sight *room;
} map_job;

/* Its colour, or grey, the lighter the more it faces the view. */
static void shade(const rlf_room_sight *room, int32_t i, float out[3])
{
    const uint8_t *color = room->rgba != NULL ? room->rgba + 4 * (ptrdiff_t)i : NULL;
    const float grey = 60.0f - 150.0f * room->prediction->normal_z[i];
    for (int k = 0; k < 3; k++) {
        out[k] = color != NULL && color[3] != 0 ? (float)color[k] : grey;
    }
}

/* The place of a picture's pixel among `size` ones, and the pixel before it. */
static float place_of(int32_t x, int32_t picture_size, int32_t size, int32_t *before)
{
    const float at = ((float)x + 0.5f) * (float)size / (float)picture_size - 0.5f;
    const float inside = at < 0.0f ? 0.0f : at;
    const int32_t low = (int32_t)inside;
    *before = low < size - 1 ? low : size - 1;
    return inside - (float)*before;
}

/* Mean of the four pixels about a place that lie on the surface of the nearest one. Its depth; 0 =
 * nothing is known there. */
static float mean_of_four(const rlf_room_sight *room, const int32_t at[4], const float weight[4],
                          float color[3])
{
    const float *depth = room->prediction->depth;
    int best = 0;
    for (int k = 1; k < 4; k++) {
        best = weight[k] > weight[best] ? k : best;
    }
    const float z = depth[at[best]];
    float sum = 0.0f;
    color[0] = color[1] = color[2] = 0.0f;
    for (int k = 0; k < 4 && z > 0.0f; k++) {
        if (depth[at[k]] > 0.0f && !depth_steps(z, depth[at[k]])) {
            float own[3];
            shade(room, at[k], own);
            sum += weight[k];
            for (int c = 0; c < 3; c++) {
                color[c] += weight[k] * own[c];
            }
        }
    }
    for (int c = 0; c < 3 && z > 0.0f; c++) {
        color[c] /= sum;
    }
    return z;
}

static void draw_room_row(const map_job *job, int32_t y)
{
    const soft *s = job->s;
    const rlf_camera *camera = &job->room->prediction->camera;
    float *z = rlf_f32_row(&s->real.z, y);
    uint8_t *pixels = rlf_rgba8_row(&s->image, y);
    int32_t row, column;
    const float down = place_of(y, s->image.height, camera->height, &row);
    const int32_t below = row < camera->height - 1 ? camera->width : 0;
    for (int32_t x = 0; x < s->image.width; x++) {
        const float across = place_of(x, s->image.width, camera->width, &column);
        const int32_t first = row * camera->width + column;
        const int32_t right = column < camera->width - 1 ? 1 : 0;
        const int32_t at[4] = {first, first + right, first + below, first + below + right};
        const float weight[4] = {(1.0f - across) * (1.0f - down), across * (1.0f - down),
                                 (1.0f - across) * down, across * down};
        float color[3];
        z[x] = mean_of_four(job->room, at, weight, color);
        if (z[x] > 0.0f) {
            soft_put(pixels + 4 * (ptrdiff_t)x,
                     soft_rgb((int32_t)color[0], (int32_t)color[1], (int32_t)color[2]));
        }
    }
}

static void draw_room_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        draw_room_row(context, y);
    }
}

static void draw_path(const soft *s, const rlf_room_sight *room)
{
    const rlf_pose T_view_world = rlf_pose_invert(&room->prediction->T_world_camera);
    const int32_t thick = soft_text_scale(s->image.height);
    soft_point last = {0, 0};
    bool has_last = false;
    for (int32_t i = 0; i < room->path_count; i++) {
        const rlf_vec3 p = rlf_transform(&T_view_world, room->path[i]);
        soft_point at;
        const bool is_seen = p.z > SOFT_NEAR_Z && rlf_camera_project(&s->camera, p, &at.x, &at.y);
        for (int32_t k = 0; is_seen && has_last && k < thick; k++) {
            const soft_point from = {last.x, last.y + k}, to = {at.x, at.y + k};
            soft_draw_line(&s->image, from, to, soft_color_path());
        }
        last = at;
        has_last = is_seen;
    }
}

/* What to do, where there is no map. */
static void draw_hint(const soft *s)
{
    static const char *const lines[2] = {"no map of the room yet: it grows as the camera moves,",
                                         "with --camera moving (or auto, once it is moved)"};
    const int32_t scale = soft_text_scale(s->image.height);
    soft_text style = {0, s->image.height / 2, scale, soft_rgb(245, 245, 235), false};
    for (int i = 0; i < 2; i++) {
        style.x = (s->image.width - soft_text_width(lines[i], scale)) / 2;
        style.x = style.x > 0 ? style.x : 0;
        soft_draw_text(&s->image, &style, lines[i]);
        style.y += 10 * scale;
    }
}

static rlf_result draw_from(soft *s, const rlf_render_input *input)
{
    const map_job job = {s, input->room};
    rlf_parallel_for(s->def.pool, s->image.height, SOFT_BAND_ROWS, draw_room_rows, (void *)&job);
    rlf_result result = soft_scene_build(s, input);
    if (result == RLF_OK && s->scene.body_count > 0) {
        soft_draw_bodies(s, false);
    }
    draw_path(s, input->room);
    soft_draw_frustum(s);
    return result;
}

rlf_result soft_draw_map(soft *s, const rlf_render_input *input)
{
    soft_clear_view(s);
    if (input->room == NULL || input->room->prediction == NULL) {
        draw_hint(s);
        return RLF_OK;
    }
    const rlf_prediction *seen = input->room->prediction;
    const rlf_camera camera = s->camera;
    const rlf_pose T_picture_depth = s->T_picture_depth;
    const rlf_occlusion occlusion = s->def.occlusion;
    const rlf_camera pinhole = rlf_camera_resize(&seen->camera, s->image.width, s->image.height);
    const rlf_pose T_view_world = rlf_pose_invert(&seen->T_world_camera);
    const rlf_pose T_view_depth = rlf_pose_mul(&T_view_world, &input->T_world_camera);
    soft_set_viewpoint(s, &pinhole, &T_view_depth);
    s->def.occlusion = RLF_OCCLUSION_DEPTH;
    rlf_result result = draw_from(s, input);
    s->def.occlusion = occlusion;
    soft_set_viewpoint(s, &camera, &T_picture_depth);
    return result;
}
