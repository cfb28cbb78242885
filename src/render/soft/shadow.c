/* Soft shadows of the bodies on the real surfaces.
 *
 * Each body is taken as a ball of radius r. A real point at distance d loses the light that the
 * ball hides: of the light around, (r / d)^2 (form factor of a ball, Quilez 2006), and of the
 * directed light, what passes close to the ball. Both are for surfaces that face the ball; those
 * the camera sees face the camera, so one with the ball behind it does not. */
#include "render/soft/soft.h"

#define REACH 3.0f /* radii from the ball within which anything is darkened */
#define AMBIENT_SHARE 0.5f
#define DIRECT_SHARE 0.35f
#define BALL_RADIUS 0.75 /* of the bounding sphere's, which no box or stick fills */
#define BLOCK 16         /* pixels looked at together */

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
    double r = BALL_RADIUS * body->radius;
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

/* True when a pixel of [begin, end) is as deep as the ball, give or take its reach. */
static bool may_darken(const float *z, int32_t begin, int32_t end, const float range[2])
{
    int32_t any = 0;
    for (int32_t x = begin; x < end; x++) {
        any |= (int32_t)(z[x] > range[0]) & (int32_t)(z[x] < range[1]);
    }
    return any != 0;
}

/* Rays (x0 + i step, y, 1) of a run of pixels. */
typedef struct ray_run {
    float x0, step, y;
} ray_run;

/* Light that is left, 0..1, at `count` pixels of depth z. Without branches, so that compilers
 * vectorise it. */
static void light_left(const ball *b, const float *restrict z, ray_run rays, int32_t count,
                       float *restrict out)
{
    float reach2 = b->radius2 * (REACH * REACH);
    for (int32_t i = 0; i < count; i++) {
        float ray_x = rays.x0 + rays.step * (float)i;
        float dx = b->x - ray_x * z[i];
        float dy = b->y - rays.y * z[i];
        float dz = b->z - z[i];
        float distance2 = dx * dx + dy * dy + dz * dz + 1e-12f;
        float fade = 1.0f - distance2 / reach2;
        float size = b->radius2 / (distance2 > b->radius2 ? distance2 : b->radius2);
        float along = dx * b->to_light[0] + dy * b->to_light[1] + dz * b->to_light[2];
        float direct = 1.0f - (distance2 - along * along) / (b->radius2 * 1.5f);
        direct = along > 0.0f ? direct : 0.0f;
        direct = direct > 0.0f ? direct : 0.0f;
        float behind = dx * ray_x + dy * rays.y + dz;
        behind = behind > 0.0f ? behind : 0.0f;
        float ray2 = ray_x * ray_x + rays.y * rays.y + 1.0f;
        float facing = 1.0f - behind * behind / (distance2 * ray2);
        float lost = fade * facing * (AMBIENT_SHARE * size + DIRECT_SHARE * direct);
        lost = fade > 0.0f ? lost : 0.0f;
        out[i] = z[i] > 0.0f ? 1.0f - lost : 1.0f;
    }
}

static void darken(uint8_t *pixels, const float *light, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        if (light[i] < 1.0f) {
            uint8_t *pixel = pixels + 4 * (ptrdiff_t)i;
            for (int c = 0; c < 3; c++) {
                pixel[c] = (uint8_t)((float)pixel[c] * light[i] + 0.5f);
            }
        }
    }
}

static void draw_ball_row(const soft *s, const ball *b, int32_t y)
{
    const rlf_camera *k = &s->camera;
    const float *z = rlf_f32_row(&s->real.z, y);
    uint8_t *pixels = rlf_rgba8_row(&s->image, y);
    float reach = REACH * (float)sqrt(b->radius2);
    const float range[2] = {b->z - reach > 0.0f ? b->z - reach : 0.0f, b->z + reach};
    for (int32_t first = b->rect.x0; first < b->rect.x1; first += BLOCK) {
        int32_t last = first + BLOCK < b->rect.x1 ? first + BLOCK : b->rect.x1;
        if (may_darken(z, first, last, range)) {
            ray_run rays = {(float)((first - k->cx) / k->fx), (float)(1.0 / k->fx),
                            (float)((y - k->cy) / k->fy)};
            float light[BLOCK];
            light_left(b, z + first, rays, last - first, light);
            darken(pixels + 4 * (ptrdiff_t)first, light, last - first);
        }
    }
}

void soft_draw_shadows(const soft *s, int32_t begin, int32_t end)
{
    if (s->def.occlusion == RLF_OCCLUSION_OFF || s->def.occlusion == RLF_OCCLUSION_THESIS) {
        return; /* the thesis has none, and plain augmented reality does not know the real world */
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
