/* One frame of the colour camera: restore what was covered, darken the floor, paint the movers with
 * soft outlines. */
#include "capture/synthetic/color.h"
#include "capture/synthetic/light.h"

#include <string.h>

#define ROWS_PER_CHUNK 8
#define COVER_M 0.05f /* what stands so much before a mover covers it */

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

/* Nearest mover painted in the 3x3 neighbourhood, metres, and how many pixels are; the sum of their
 * paint. */
typedef struct outline {
    float nearest;
    uint32_t count, paint[3];
} outline;

static outline outline_at(const synth_color *color, int32_t x, int32_t y)
{
    outline o = {.nearest = 1e9f};
    for (int32_t k = 0; k < 9; k++) {
        int32_t at_x = x + k % 3 - 1;
        int32_t at_y = y + k / 3 - 1;
        if (is_painted(color, at_x, at_y)) {
            size_t i = index_of(color, at_x, at_y);
            o.nearest = color->canvas.z[i] < o.nearest ? color->canvas.z[i] : o.nearest;
            o.count++;
            for (int c = 0; c < 3; c++) {
                o.paint[c] += color->paint[4 * i + (size_t)c];
            }
        }
    }
    return o;
}

/* Colour of the room at a pixel without paint, where a mover's outline is blended with it: what
 * stands before the mover is there by itself, without what is behind both. NULL = the room does not
 * stand before a mover at that depth. */
static const uint8_t *cover_at(const synth_color *color, int32_t x, int32_t y, float z)
{
    const synth_color_planes *room = &color->room[color->room_index];
    const rlf_camera *camera = &color->view.camera;
    if (x < 0 || y < 0 || x >= camera->width || y >= camera->height || is_painted(color, x, y)) {
        return NULL;
    }
    size_t i = index_of(color, x, y);
    return room->z[i] > 0.0f && room->z[i] + COVER_M < z ? room->front + 4 * i : NULL;
}

/* Sum of the colours of the 3x3 neighbourhood that are not the mover's, at a pixel of the mover:
 * of what covers it, and of what its own pixel would show without it. */
static void add_room(const synth_color *color, int32_t x, int32_t y, uint32_t sum[3])
{
    size_t i = index_of(color, x, y);
    for (int32_t k = 0; k < 9; k++) {
        int32_t at_x = x + k % 3 - 1;
        int32_t at_y = y + k / 3 - 1;
        if (is_painted(color, at_x, at_y)) {
            continue;
        }
        const uint8_t *cover = cover_at(color, at_x, at_y, color->canvas.z[i]);
        const uint8_t *here = cover != NULL ? cover : color->out + 4 * i;
        for (int c = 0; c < 3; c++) {
            sum[c] += here[c];
        }
    }
}

/* Near an outline the share of movers in the 3x3 neighbourhood is the paint's opacity, and a pixel
 * beside the mover takes the mean paint of its neighbours: a lens blurs outlines alike. */
static void blend_pixel(synth_color *color, int32_t x, int32_t y)
{
    const outline o = outline_at(color, x, y);
    if (o.count == 0) {
        return;
    }
    const size_t i = 4 * index_of(color, x, y);
    uint32_t room[3] = {0, 0, 0};
    uint32_t paint[3];
    if (is_painted(color, x, y)) {
        add_room(color, x, y, room);
        for (int c = 0; c < 3; c++) {
            paint[c] = color->paint[i + (size_t)c] * o.count;
        }
    } else {
        const uint8_t *cover = cover_at(color, x, y, o.nearest);
        const uint8_t *here = cover != NULL ? cover : color->out + i;
        for (int c = 0; c < 3; c++) {
            room[c] = here[c] * (9 - o.count);
            paint[c] = o.paint[c] / o.count * o.count;
        }
    }
    for (int c = 0; c < 3; c++) {
        color->out[i + (size_t)c] = (uint8_t)((paint[c] + room[c] + 4) / 9);
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
