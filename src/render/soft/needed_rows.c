/* Which rows of the registered depth a picture needs. */
#include "render/soft/soft.h"

/* Two tiles and what silhouette_settle looks at beyond them. */
#define MARGIN_ROWS (6 * SILHOUETTE_TILE)

static void widen(soft_rows *rows, int32_t begin, int32_t end)
{
    rows->begin = begin < rows->begin ? begin : rows->begin;
    rows->end = end > rows->end ? end : rows->end;
}

/* Rows of the picture in which the real world is looked at: where bodies are and as far as they
 * take light, and so much around them as edges of real things reach. */
soft_rows soft_needed_rows(const soft *s, const rlf_render_input *input)
{
    const soft_scene *scene = &s->scene;
    soft_rows rows = {s->camera.height, 0};
    if (input->frame->color.data == NULL) {
        return (soft_rows){0, s->camera.height};
    }
    for (int32_t i = 0; i < scene->body_count; i++) {
        widen(&rows, scene->bodies[i].y0, scene->bodies[i].y1);
    }
    for (int32_t i = 0; i < scene->caster_count; i++) {
        if (scene->casters[i].near_m > 0.0f && scene->reach[i].y0 < scene->reach[i].y1) {
            widen(&rows, scene->reach[i].y0, scene->reach[i].y1);
        }
    }
    for (int32_t i = 0; i < s->silhouette.columns * s->silhouette.rows; i++) {
        if (s->silhouette.own[i].far_z >= s->silhouette.own[i].near_z) {
            const int32_t y = i / s->silhouette.columns * SILHOUETTE_TILE;
            widen(&rows, y, y + SILHOUETTE_TILE);
        }
    }
    rows.begin = rows.begin > MARGIN_ROWS ? rows.begin - MARGIN_ROWS : 0;
    rows.end =
        rows.end + MARGIN_ROWS < s->camera.height ? rows.end + MARGIN_ROWS : s->camera.height;
    return rows;
}
