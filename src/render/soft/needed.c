/* Which part of the registered depth a picture needs. */
#include "render/soft/soft.h"

/* A tile beside one with bodies may have an edge, and silhouette_settle looks less than two tiles
 * beyond that. */
#define MARGIN (3 * SILHOUETTE_TILE)

static void widen(registration_window *window, const caster_rect *by)
{
    window->x0 = by->x0 < window->x0 ? by->x0 : window->x0;
    window->y0 = by->y0 < window->y0 ? by->y0 : window->y0;
    window->x1 = by->x1 > window->x1 ? by->x1 : window->x1;
    window->y1 = by->y1 > window->y1 ? by->y1 : window->y1;
}

/* Tiles with bodies: all that are drawn there, and what silhouettes look at. */
static void widen_by_tiles(registration_window *window, const silhouette *s)
{
    for (int32_t i = 0; i < s->columns * s->rows; i++) {
        if (s->own[i].far_z >= s->own[i].near_z) {
            const int32_t x = i % s->columns * SILHOUETTE_TILE;
            const int32_t y = i / s->columns * SILHOUETTE_TILE;
            const caster_rect tile = {x, y, x + SILHOUETTE_TILE, y + SILHOUETTE_TILE};
            widen(window, &tile);
        }
    }
}

/* Where bodies are when no silhouette knows. */
static void widen_by_bodies(registration_window *window, const soft *s)
{
    for (int32_t i = 0; i < s->scene.body_count; i++) {
        const soft_body *body = &s->scene.bodies[i];
        caster_rect rect;
        if (caster_rect_of_ball(&s->camera, body->center, body->radius, &rect)) {
            rect.y0 = body->y0;
            rect.y1 = body->y1;
            widen(window, &rect);
        }
    }
}

registration_window soft_needed_depth(const soft *s, const rlf_render_input *input)
{
    const soft_scene *scene = &s->scene;
    const int32_t width = s->camera.width;
    const int32_t height = s->camera.height;
    registration_window window = {width, height, 0, 0};
    if (input->frame->color.data == NULL) {
        return (registration_window){0, 0, width, height};
    }
    widen_by_bodies(&window, s);
    widen_by_tiles(&window, &s->silhouette);
    for (int32_t i = 0; i < scene->caster_count; i++) {
        const caster_rect *reach = &scene->reach[i];
        if (scene->casters[i].near_m > 0.0f && reach->x0 < reach->x1 && reach->y0 < reach->y1) {
            widen(&window, reach);
        }
    }
    window.x0 = window.x0 > MARGIN ? window.x0 - MARGIN : 0;
    window.y0 = window.y0 > MARGIN ? window.y0 - MARGIN : 0;
    window.x1 = window.x1 + MARGIN < width ? window.x1 + MARGIN : width;
    window.y1 = window.y1 + MARGIN < height ? window.y1 + MARGIN : height;
    return window;
}
