/* Contacts over the camera's picture: where, in which direction, and how hard. */
#include "render/soft/views.h"

#include "render/soft/draw.h"
#include "render/soft/soft.h"

#define LENGTH_LEAST_M 0.03  /* of an arrow without impulse */
#define LENGTH_MORE_M 0.30   /* that a large impulse adds */
#define IMPULSE_HALF_N_S 0.2 /* adds half of that */
#define DOT_PX 2

static bool place(const soft *s, rlf_vec3 p, soft_point *out)
{
    return p.z > SOFT_NEAR_Z && rlf_camera_project(&s->camera, p, &out->x, &out->y);
}

/* Three lines beside each other, so that it is seen in a large picture. */
static void draw_thick_arrow(const soft *s, soft_point from, soft_point to, soft_color color)
{
    for (int i = -1; i <= 1; i++) {
        const double shift = 0.7 * i;
        soft_point a = {from.x + shift, from.y + shift};
        soft_point b = {to.x + shift, to.y + shift};
        soft_draw_arrow(&s->image, a, b, color);
    }
}

static void draw_contact(const soft *s, const rlf_pose *T_picture_world, const rlf_contact *c)
{
    double share = c->impulse / (c->impulse + IMPULSE_HALF_N_S);
    double length = LENGTH_LEAST_M + LENGTH_MORE_M * rlf_clamp(share, 0.0, 1.0);
    rlf_vec3 p = rlf_transform(T_picture_world, c->point);
    rlf_vec3 n = rlf_rotate(T_picture_world->q, c->normal);
    soft_point from, to;
    if (!place(s, p, &from) || !rlf_is_finite(from.x + from.y) ||
        !(from.x > -1e6 && from.x < 1e6 && from.y > -1e6 && from.y < 1e6)) {
        return;
    }
    int32_t x = (int32_t)from.x;
    int32_t y = (int32_t)from.y;
    pixel_rect dot = {x - DOT_PX, y - DOT_PX, x + DOT_PX + 1, y + DOT_PX + 1};
    soft_fill_rect(&s->image, dot, soft_color_contact(c->other), 256);
    if (place(s, rlf_mad(p, n, length), &to)) {
        draw_thick_arrow(s, from, to, soft_color_contact(c->other));
    }
}

void soft_draw_contacts(soft *s, const rlf_render_input *input)
{
    rlf_pose T_camera_world = rlf_pose_invert(&input->T_world_camera);
    rlf_pose T_picture_world = rlf_pose_mul(&s->T_picture_depth, &T_camera_world);
    for (int32_t i = 0; input->snapshot != NULL && i < input->snapshot->contact_count; i++) {
        draw_contact(s, &T_picture_world, &input->snapshot->contacts[i]);
    }
}
