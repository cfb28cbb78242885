/* Soft shadows of the bodies on the real surfaces.
 *
 * Each body is taken as a ball of radius r. A real point with the normal n, at distance d, loses
 * the light that the ball hides: of the light around, (n.d / |d|) (r / |d|)^2 (form factor of a
 * ball above the horizon, Quilez 2006), and of the directed light, what passes close to the ball.
 */
#include "render/soft/soft.h"

#define REACH 3.0f /* radii from the ball within which anything is darkened */
#define AMBIENT_SHARE 0.5f
#define DIRECT_SHARE 0.35f
#define NORMAL_REACH 4 /* pixels to either side */
#define JUMP_MAX 0.05  /* of z: beyond it lies another surface */

/* A ball in the picture and the rectangle that its shadow can reach. */
typedef struct ball {
    float x, y, z, radius2;
    float to_light[3];
    soft_rect rect;
} ball;

static ball ball_of(const soft *s, const soft_body *body)
{
    const rlf_camera *k = &s->camera;
    rlf_vec3 l = rlf_neg(rlf_rotate(s->T_picture_depth.q, s->def.light_direction));
    /* A box or a stick fills less of its bounding sphere than a ball. */
    double r = 0.75 * body->radius;
    double z = rlf_max(body->center.z - 0.5 * REACH * r, 0.1);
    double u = k->fx * body->center.x / body->center.z + k->cx;
    double v = k->fy * body->center.y / body->center.z + k->cy;
    double reach_u = k->fx * REACH * r / z;
    double reach_v = k->fy * REACH * r / z;
    ball b = {(float)body->center.x,
              (float)body->center.y,
              (float)body->center.z,
              (float)(r * r),
              {(float)l.x, (float)l.y, (float)l.z},
              {(int32_t)rlf_clamp(u - reach_u, 0, k->width),
               (int32_t)rlf_clamp(v - reach_v, 0, k->height),
               (int32_t)rlf_clamp(u + reach_u, 0, k->width),
               (int32_t)rlf_clamp(v + reach_v, 0, k->height)}};
    return b;
}

/* Normal of the real surface at a pixel, towards the camera, from 1/z, which is linear in the
 * picture on any plane: N ~ -(fx w_u, fy w_v, w - (u - cx) w_u - (v - cy) w_v). Across an edge of
 * depth the difference is left out, which leaves the direction to the camera. */
static rlf_vec3 real_normal(const soft *s, int32_t x, int32_t y)
{
    const rlf_camera *k = &s->camera;
    int32_t x0 = x - NORMAL_REACH > 0 ? x - NORMAL_REACH : 0;
    int32_t y0 = y - NORMAL_REACH > 0 ? y - NORMAL_REACH : 0;
    int32_t x1 = x + NORMAL_REACH < k->width ? x + NORMAL_REACH : k->width - 1;
    int32_t y1 = y + NORMAL_REACH < k->height ? y + NORMAL_REACH : k->height - 1;
    const float *row = rlf_f32_row(&s->real.z, y);
    double z = row[x];
    double left = row[x0];
    double right = row[x1];
    double top = rlf_f32_row(&s->real.z, y0)[x];
    double bottom = rlf_f32_row(&s->real.z, y1)[x];
    double low = z * (1.0 - JUMP_MAX);
    double high = z * (1.0 + JUMP_MAX);
    double w_u = 0.0;
    double w_v = 0.0;
    if (left > low && left < high && right > low && right < high && x1 > x0) {
        w_u = (1.0 / right - 1.0 / left) / (x1 - x0);
    }
    if (top > low && top < high && bottom > low && bottom < high && y1 > y0) {
        w_v = (1.0 / bottom - 1.0 / top) / (y1 - y0);
    }
    return rlf_normalize(rlf_vec3_make(-k->fx * w_u, -k->fy * w_v,
                                       -(1.0 / z - (x - k->cx) * w_u - (y - k->cy) * w_v)));
}

/* Light that is left at a point with the normal n and the offset d to the ball's centre: 0..1. */
static float light_left(const ball *b, rlf_vec3 n, const float d[3])
{
    float reach2 = b->radius2 * (REACH * REACH);
    float distance2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    float fade = 1.0f - distance2 / reach2;
    float size = b->radius2 / (distance2 > b->radius2 ? distance2 : b->radius2);
    double above = (n.x * d[0] + n.y * d[1] + n.z * d[2]) / sqrt((double)distance2 + 1e-12);
    float facing = (float)rlf_clamp(above, 0.0, 1.0);
    float lit = (float)(n.x * b->to_light[0] + n.y * b->to_light[1] + n.z * b->to_light[2]);
    float along = d[0] * b->to_light[0] + d[1] * b->to_light[1] + d[2] * b->to_light[2];
    float across2 = distance2 - along * along;
    float direct = along > 0.0f && lit > 0.0f ? 1.0f - across2 / (b->radius2 * 1.5f) : 0.0f;
    direct = direct > 0.0f ? direct * lit : 0.0f;
    return 1.0f - fade * (AMBIENT_SHARE * size * facing + DIRECT_SHARE * direct);
}

static void darken(uint8_t *pixel, float light)
{
    for (int c = 0; c < 3; c++) {
        pixel[c] = (uint8_t)((float)pixel[c] * light + 0.5f);
    }
}

static void draw_ball_row(const soft *s, const ball *b, int32_t y)
{
    const rlf_camera *k = &s->camera;
    const float *z = rlf_f32_row(&s->real.z, y);
    uint8_t *pixel = rlf_rgba8_row(&s->image, y);
    float scale_x = (float)(1.0 / k->fx);
    float ray_y = (float)((y - k->cy) / k->fy);
    float cx = (float)k->cx;
    float reach2 = b->radius2 * (REACH * REACH);
    for (int32_t x = b->rect.x0; x < b->rect.x1; x++) {
        const float d[3] = {b->x - ((float)x - cx) * scale_x * z[x], b->y - ray_y * z[x],
                            b->z - z[x]};
        if (z[x] > 0.0f && d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach2) {
            darken(pixel + 4 * (ptrdiff_t)x, light_left(b, real_normal(s, x, y), d));
        }
    }
}

void soft_draw_shadows(const soft *s, int32_t begin, int32_t end)
{
    if (s->def.occlusion == RLF_OCCLUSION_OFF) {
        return; /* plain augmented reality knows nothing of the real world */
    }
    for (int32_t i = 0; i < s->scene.body_count; i++) {
        const soft_body *body = &s->scene.bodies[i];
        if (body->center.z < 0.1) {
            continue; /* around the camera: it would darken everything or nothing */
        }
        ball b = ball_of(s, body);
        int32_t first = b.rect.y0 > begin ? b.rect.y0 : begin;
        int32_t last = b.rect.y1 < end ? b.rect.y1 : end;
        for (int32_t y = first; y < last; y++) {
            draw_ball_row(s, &b, y);
        }
    }
}
