/* One frame of the colour camera: restore what was covered, darken the floor, paint the movers with
 * soft outlines. */
#include "sim/color.h"
#include "sim/material.h"

#include <string.h>

#define ROWS_PER_CHUNK 8
#define COVER_M 0.05f /* what stands so much before a mover covers it */

enum { BLOCK = 64 }; /* pixels looked at together */

static size_t index_of(const synth_color *color, int32_t x, int32_t y)
{
    return (size_t)y * (size_t)color->view.camera.width + (size_t)x;
}

static void restore_row(synth_color *color, int32_t y)
{
    size_t first = 4 * index_of(color, color->dirty.x0, y);
    size_t count = 4 * (size_t)(color->dirty.x1 - color->dirty.x0);
    memcpy(color->out + first, color->room[color->room_index].rgba + first, count);
}

/* The room's light on a mover: less of it near the floor and below. */
RLF_KERNEL_PART double sky_on_mover(double floor_y, rlf_vec3 down, const synth_site *site)
{
    double height = rlf_clamp((floor_y - rlf_dot(site->p, down)) / 0.6, 0.0, 1.0);
    double up = 0.5 - 0.5 * rlf_dot(site->normal, down);
    return (0.55 + 0.45 * height) * (0.82 + 0.28 * up);
}

/* Light on the points of a run: rgb. */
RLF_KERNEL static void light_run(const synth_scene *scene, const synth_touches *touches,
                                 int32_t count, double (*restrict light)[SYNTH_RUN_MOST])
{
    const rlf_vec3 lamp = scene->lamp;
    const rlf_vec3 down = scene->down;
    const double floor_y = scene->floor_y;
    for (int32_t i = 0; i < count; i++) {
        const synth_site site = {
            {touches->p[0][i], touches->p[1][i], touches->p[2][i]},
            {touches->normal[0][i], touches->normal[1][i], touches->normal[2][i]}};
        const rlf_vec3 here =
            synth_light(lamp, down, &site, 1.0, sky_on_mover(floor_y, down, &site));
        light[0][i] = here.x;
        light[1][i] = here.y;
        light[2][i] = here.z;
    }
}

static void paint_run(synth_color *color, const synth_run *run, int32_t y)
{
    const synth_part *part = &color->scene->movers[run->id];
    uint8_t *paint = color->paint + 4 * index_of(color, run->x0, y);
    synth_touches touches;
    double light[3][SYNTH_RUN_MOST];
    synth_canvas_touch(&color->canvas, run, y, &touches);
    light_run(color->scene, &touches, run->x1 - run->x0, light);
    for (int32_t i = 0; i < run->x1 - run->x0; i++) {
        const rlf_vec3 local = {touches.local[0][i], touches.local[1][i], touches.local[2][i]};
        const rlf_vec3 albedo = synth_albedo(part, local);
        synth_encode(color->gamma, (float)(light[0][i] * albedo.x), (float)(light[1][i] * albedo.y),
                     (float)(light[2][i] * albedo.z), paint + 4 * (size_t)i);
    }
}

static void paint_row(synth_color *color, int32_t y)
{
    const synth_canvas *canvas = &color->canvas;
    synth_run run;
    for (int32_t x = canvas->drawn.x0; synth_canvas_next_run(canvas, x, y, &run); x = run.x1) {
        paint_run(color, &run, y);
    }
}

static void draw_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    synth_color *color = context;
    const synth_color_planes *room = &color->room[color->room_index];
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        if (synth_rect_has_row(color->dirty, y)) {
            restore_row(color, y);
        }
        if (synth_rect_has_row(color->shadow.rect, y)) {
            synth_shadow_apply(&color->shadow, &color->view, color->scene->floor_y, y, room->lamp,
                               color->out);
        }
        if (synth_rect_has_row(color->canvas.drawn, y)) {
            synth_canvas_draw_row(&color->canvas, room->z, y);
            paint_row(color, y);
        }
    }
}

static bool is_painted(const synth_color *color, int32_t x, int32_t y)
{
    const synth_rect *drawn = &color->canvas.drawn;
    return x >= drawn->x0 && x < drawn->x1 && synth_rect_has_row(*drawn, y) &&
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

enum { NOT_PAINTED, PAINTED, AT_OUTLINE };

/* Whether all nine pixels around each of `count` from `row` on are painted, or none: their parts,
 * `width` to a row, are < 0 where not. */
RLF_KERNEL static void find_outline(const int32_t *row, ptrdiff_t width, int32_t count,
                                    uint8_t *restrict kind)
{
    const int32_t *above = row - width;
    const int32_t *below = row + width;
    int32_t kinds[BLOCK]; /* by themselves: bytes among integers are not vectorised */
    for (int32_t i = 0; i < count; i++) {
        const int32_t all = above[i - 1] & above[i] & above[i + 1] & row[i - 1] & row[i] &
                            row[i + 1] & below[i - 1] & below[i] & below[i + 1];
        const int32_t any = above[i - 1] | above[i] | above[i + 1] | row[i - 1] | row[i] |
                            row[i + 1] | below[i - 1] | below[i] | below[i + 1];
        const int32_t some = all < 0 ? NOT_PAINTED : AT_OUTLINE; /* sign: of all that are < 0 */
        kinds[i] = any >= 0 ? PAINTED : some;
    }
    for (int32_t i = 0; i < count; i++) {
        kind[i] = (uint8_t)kinds[i];
    }
}

static void blend_pixels(synth_color *color, int32_t x0, int32_t x1, int32_t y)
{
    for (int32_t x = x0; x < x1; x++) {
        blend_pixel(color, x, y);
    }
}

/* The same for pixels whose neighbours are all inside the canvas's rectangle. */
static void blend_inner(synth_color *color, int32_t x0, int32_t x1, int32_t y)
{
    const int32_t width = color->view.camera.width;
    uint8_t kind[BLOCK];
    for (int32_t first = x0; first < x1; first += BLOCK) {
        const int32_t count = x1 - first < BLOCK ? x1 - first : BLOCK;
        const size_t at = index_of(color, first, y);
        find_outline(color->canvas.part + at, width, count, kind);
        for (int32_t i = 0; i < count; i++) {
            if (kind[i] == AT_OUTLINE) {
                blend_pixel(color, first + i, y);
            } else if (kind[i] == PAINTED) {
                const size_t pixel = 4 * (at + (size_t)i);
                memcpy(color->out + pixel, color->paint + pixel, 4);
            }
        }
    }
}

static void blend_row(synth_color *color, synth_rect rect, int32_t y)
{
    const synth_rect *drawn = &color->canvas.drawn;
    const bool is_inner = y > drawn->y0 && y < drawn->y1 - 1 && drawn->x1 - drawn->x0 > 2;
    const int32_t x0 = is_inner ? drawn->x0 + 1 : rect.x1;
    const int32_t x1 = is_inner ? drawn->x1 - 1 : rect.x1;
    blend_pixels(color, rect.x0, x0, y);
    blend_inner(color, x0, x1, y);
    blend_pixels(color, x1, rect.x1, y);
}

static void blend_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    synth_color *color = context;
    synth_rect rect = synth_rect_grow(color->canvas.drawn, 1, &color->view.camera);
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        if (synth_rect_has_row(rect, y)) {
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
    if (!color->scene->is_moving) {
        synth_shadow_place(&color->shadow, color->scene, &color->view);
    }
    rlf_parallel_for(color->pool, camera->height, ROWS_PER_CHUNK, draw_rows, color);
    rlf_parallel_for(color->pool, camera->height, ROWS_PER_CHUNK, blend_rows, color);
    color->dirty =
        synth_rect_union(synth_rect_grow(color->canvas.drawn, 1, camera), color->shadow.rect);
}
