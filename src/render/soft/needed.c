/* Which part of the registered depth a picture needs. */
#include "render/soft/passes.h"

#include "render/soft/soft.h"

/* A tile beside one with bodies may have an edge, and edge_matte_settle looks less than two tiles
 * beyond that. */
#define MARGIN (3 * EDGE_MATTE_TILE)

static void add(const soft *s, const pixel_rect *rect, real_windows *out)
{
    const int32_t width = s->camera.width;
    const int32_t height = s->camera.height;
    const pixel_rect window = {rect->x0 > MARGIN ? rect->x0 - MARGIN : 0,
                               rect->y0 > MARGIN ? rect->y0 - MARGIN : 0,
                               rect->x1 + MARGIN < width ? rect->x1 + MARGIN : width,
                               rect->y1 + MARGIN < height ? rect->y1 + MARGIN : height};
    if (window.x0 < window.x1 && window.y0 < window.y1) {
        real_windows_add(out, &window);
    }
}

static bool has_bodies(const edge_matte_tile *own)
{
    return own->far_z >= own->near_z;
}

/* Tiles with bodies, run by run: all that are drawn there, and what silhouettes look at. */
static void add_tiles(const soft *s, real_windows *out)
{
    const edge_matte *l = &s->edges;
    for (int32_t row = 0; row < l->rows; row++) {
        const edge_matte_tile *own = l->own + row * l->columns;
        for (int32_t end = 0; end < l->columns; end++) {
            const int32_t first = end;
            while (end < l->columns && has_bodies(&own[end])) {
                end++;
            }
            const pixel_rect run = {first * EDGE_MATTE_TILE, row * EDGE_MATTE_TILE,
                                    end * EDGE_MATTE_TILE, (row + 1) * EDGE_MATTE_TILE};
            if (first < end) {
                add(s, &run, out);
            }
        }
    }
}

/* Where bodies are when no matte knows. */
static void add_bodies(const soft *s, real_windows *out)
{
    for (int32_t i = 0; i < s->scene.body_count; i++) {
        const soft_body *body = &s->scene.bodies[i];
        pixel_rect rect;
        if (pixel_rect_of_ball(&s->camera, body->center, body->radius, &rect)) {
            rect.y0 = body->y0;
            rect.y1 = body->y1;
            add(s, &rect, out);
        }
    }
}

real_windows soft_needed_depth(const soft *s, const rlf_render_input *input)
{
    const soft_scene *scene = &s->scene;
    real_windows windows = {.count = 0};
    if (input->frame->color.data == NULL) {
        return (real_windows){{{0, 0, s->camera.width, s->camera.height}}, 1};
    }
    add_bodies(s, &windows);
    add_tiles(s, &windows);
    for (int32_t i = 0; i < scene->caster_count; i++) {
        const pixel_rect *reach = &scene->reach[i];
        if (scene->casters[i].near_m > 0.0f && reach->x0 < reach->x1 && reach->y0 < reach->y1) {
            add(s, reach, &windows);
        }
    }
    return windows;
}
