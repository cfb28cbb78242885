/* Lines and texts that the caller wants over the picture. */
#include "render/soft/views.h"

#include "render/soft/draw.h"
#include "render/soft/soft.h"

#define TEXT_ASIDE_PX 4

static bool place(const soft *s, rlf_vec3 p, soft_point *out)
{
    const rlf_vec3 q = rlf_transform(&s->T_picture_depth, p);
    return q.z > SOFT_NEAR_Z && rlf_camera_project(&s->camera, q, &out->x, &out->y) &&
           out->x > -1e6 && out->x < 1e6 && out->y > -1e6 && out->y < 1e6;
}

/* Twice, so that it is seen in a large picture. */
static void draw_line(const soft *s, soft_point from, soft_point to, soft_color color)
{
    const soft_point a = {from.x + 0.7, from.y + 0.7}, b = {to.x + 0.7, to.y + 0.7};
    soft_draw_line(&s->image, from, to, color);
    soft_draw_line(&s->image, a, b, color);
}

void soft_draw_marks(soft *s, const rlf_render_input *input)
{
    for (int32_t i = 0; i < input->mark_count; i++) {
        const rlf_mark *mark = &input->marks[i];
        const soft_color color = soft_rgb(mark->color[0], mark->color[1], mark->color[2]);
        soft_point from, to;
        if (!place(s, mark->from, &from)) {
            continue;
        }
        if (mark->text != NULL) {
            const soft_text style = {(int32_t)from.x + TEXT_ASIDE_PX, (int32_t)from.y,
                                     soft_text_scale(s->image.height), color, true};
            soft_draw_text(&s->image, &style, mark->text);
        } else if (place(s, mark->to, &to)) {
            draw_line(s, from, to, color);
        }
    }
}
