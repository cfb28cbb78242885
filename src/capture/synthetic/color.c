/* One frame of the colour camera: restore what was covered, darken the floor, paint the movers with
 * soft outlines. */
#include "capture/synthetic/color.h"
#include "capture/synthetic/light.h"

#include <string.h>

#define ROWS_PER_CHUNK 8

static size_t index_of(const synth_color *color, int32_t x, int32_t y)
{
    return (size_t)y * (size_t)color->view.camera.width + (size_t)x;
}

static bool has_row(synth_rect rect, int32_t y)
{
    return y >= rect.y0 && y < rect.y1 && rect.x0 < rect.x1;
}

static void restore_row(synth_color *color, int32_t y)
{
    size_t first = 4 * index_of(color, color->dirty.x0, y);
    size_t count = 4 * (size_t)(color->dirty.x1 - color->dirty.x0);
    memcpy(color->out + first, color->room[color->room_index].rgba + first, count);
}

/* The room's light on a mover: less of it near the floor and below. */
static double sky_on_mover(const synth_color *color, const synth_site *site)
{
    double height = rlf_clamp((color->scene->floor_y - site->p.y) / 0.6, 0.0, 1.0);
    double up = 0.5 - 0.5 * site->normal.y;
    return (0.55 + 0.45 * height) * (0.82 + 0.28 * up);
}

static void paint_row(synth_color *color, int32_t y)
{
    const synth_canvas *canvas = &color->canvas;
    for (int32_t x = canvas->drawn.x0; x < canvas->drawn.x1; x++) {
        size_t i = index_of(color, x, y);
        int32_t id = canvas->part[i];
        if (id < 0) {
            continue;
        }
        const synth_part *part = &color->scene->movers[id];
        synth_touch touch =
            synth_stamp_touch(&canvas->stamps[id], &color->view, x, y, canvas->z[i]);
        synth_site site = {{touch.p[0], touch.p[1], touch.p[2]},
                           {touch.normal[0], touch.normal[1], touch.normal[2]}};
        rlf_vec3 light = synth_light(color->scene->lamp, &site, 1.0, sky_on_mover(color, &site));
        rlf_vec3 albedo =
            synth_albedo(part, rlf_vec3_make(touch.local[0], touch.local[1], touch.local[2]));
        synth_encode(color->gamma, (float)(light.x * albedo.x), (float)(light.y * albedo.y),
                     (float)(light.z * albedo.z), &color->paint[4 * i]);
    }
}

static void draw_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    synth_color *color = context;
    const synth_color_planes *room = &color->room[color->room_index];
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        if (has_row(color->dirty, y)) {
            restore_row(color, y);
        }
        if (has_row(color->shadow.rect, y)) {
            synth_shadow_apply(&color->shadow, &color->view, color->scene->floor_y, y, room->lamp,
                               color->out);
        }
        if (has_row(color->canvas.drawn, y)) {
            synth_canvas_draw_row(&color->canvas, room->z, y);
            paint_row(color, y);
        }
    }
}

static bool is_painted(const synth_color *color, int32_t x, int32_t y)
{
    const synth_rect *drawn = &color->canvas.drawn;
    return x >= drawn->x0 && x < drawn->x1 && has_row(*drawn, y) &&
           color->canvas.part[index_of(color, x, y)] >= 0;
}

/* Near an outline the share of movers in the 3x3 neighbourhood is the paint's opacity, and a pixel
 * beside the mover takes the mean paint of its neighbours: a lens blurs outlines alike. */
static void blend_pixel(synth_color *color, int32_t x, int32_t y)
{
    uint32_t sum[3] = {0, 0, 0};
    uint32_t count = 0;
    for (int32_t dy = -1; dy <= 1; dy++) {
        for (int32_t dx = -1; dx <= 1; dx++) {
            if (is_painted(color, x + dx, y + dy)) {
                const uint8_t *paint = &color->paint[4 * index_of(color, x + dx, y + dy)];
                for (int c = 0; c < 3; c++) {
                    sum[c] += paint[c];
                }
                count++;
            }
        }
    }
    size_t i = 4 * index_of(color, x, y);
    bool is_own = is_painted(color, x, y);
    for (int c = 0; c < 3 && count > 0; c++) {
        uint32_t paint = is_own ? color->paint[i + (size_t)c] : sum[c] / count;
        uint32_t room = color->out[i + (size_t)c];
        color->out[i + (size_t)c] = (uint8_t)((paint * count + room * (9 - count) + 4) / 9);
    }
}

/* True when all nine pixels around column x agree on being painted or not. */
static bool is_uniform(const int32_t *above, const int32_t *row, const int32_t *below, int32_t x)
{
    int32_t any = 0;
    int32_t all = -1;
    for (int32_t k = x - 1; k <= x + 1; k++) {
        any |= ~above[k] | ~row[k] | ~below[k]; /* sign bit: some part is >= 0 */
        all &= ~above[k] & ~row[k] & ~below[k]; /* sign bit: all parts are >= 0 */
    }
    return any >= 0 || all < 0;
}

static void blend_row(synth_color *color, synth_rect rect, int32_t y)
{
    const synth_rect *drawn = &color->canvas.drawn;
    int32_t width = color->view.camera.width;
    const int32_t *row = color->canvas.part + index_of(color, 0, y);
    bool is_inner_row = y > drawn->y0 && y < drawn->y1 - 1;
    for (int32_t x = rect.x0; x < rect.x1; x++) {
        bool is_inner = is_inner_row && x > drawn->x0 && x < drawn->x1 - 1;
        if (!is_inner || !is_uniform(row - width, row, row + width, x)) {
            blend_pixel(color, x, y);
        } else if (row[x] >= 0) {
            size_t i = 4 * index_of(color, x, y);
            memcpy(color->out + i, color->paint + i, 4);
        }
    }
}

static void blend_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    synth_color *color = context;
    synth_rect rect = synth_rect_grow(color->canvas.drawn, 1, &color->view.camera);
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        if (has_row(rect, y)) {
            blend_row(color, rect, y);
        }
    }
}

void synth_color_render(synth_color *color, int32_t room_index)
{
    const rlf_camera *camera = &color->view.camera;
    if (room_index != color->room_index) {
        color->room_index = room_index;
        color->dirty = (synth_rect){0, 0, camera->width, camera->height};
    }
    synth_canvas_place(&color->canvas, color->scene);
    synth_shadow_place(&color->shadow, color->scene, &color->view);
    rlf_parallel_for(color->pool, camera->height, ROWS_PER_CHUNK, draw_rows, color);
    rlf_parallel_for(color->pool, camera->height, ROWS_PER_CHUNK, blend_rows, color);
    color->dirty =
        synth_rect_union(synth_rect_grow(color->canvas.drawn, 1, camera), color->shadow.rect);
}
