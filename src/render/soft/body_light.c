/* What other bodies and real things leave of the light on a body, at nodes a few pixels apart. */
#include "render/soft/stream.h"

#include "kernel/kernel.h"
#include "render/soft/passes.h"
#include "render/soft/soft.h"

/* A ball about four corners. */
RLF_KERNEL_PART float ball_of(const caster_points *points, const int32_t corner[4], float out[3])
{
    float p[4][3];
    out[0] = out[1] = out[2] = 0.0f;
    for (int i = 0; i < 4; i++) {
        const float z = points->z[corner[i]];
        p[i][0] = points->x[corner[i]] * z;
        p[i][1] = points->y[corner[i]] * z;
        p[i][2] = z;
        for (int k = 0; k < 3; k++) {
            out[k] += 0.25f * p[i][k];
        }
    }
    float most = 0.0f;
    for (int i = 0; i < 4; i++) {
        float step[3] = {p[i][0] - out[0], p[i][1] - out[1], p[i][2] - out[2]};
        float square = step[0] * step[0] + step[1] * step[1] + step[2] * step[2];
        most = square > most ? square : most;
    }
    return sqrtf(most);
}

/* Depths of the nodes of a row from pixel (x, y) on, and their rays. */
RLF_KERNEL_PART void place_nodes(const soft *s, const soft_face *f, int32_t x, int32_t y,
                                 float *restrict ray_x, float *restrict ray_y, float *restrict z)
{
    const ramp r = ramp_at(&f->inverse_z, (float)x - f->origin_x, (float)y - f->origin_y);
    const float first = s->ray_x0 + s->ray_step_x * (float)x;
    const float step = s->ray_step_x * (float)s->shade_px;
    const float down = s->ray_y0 + s->ray_step_y * (float)y;
    const float low = f->inverse_z_min;
    const float high = f->inverse_z_max;
    const int32_t px = s->shade_px;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        const float inverse_z = r.at0 + r.step * (float)(px * i);
        z[i] = 1.0f / stream_clamp(inverse_z, low, high);
        ray_x[i] = first + step * (float)i;
        ray_y[i] = down;
    }
}

RLF_KERNEL_PART void clear_nodes(light_nodes *out)
{
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < 2 * ROW_NODES; k++) {
        out->ambient[k] = out->direct[k] = 1.0f;
    }
}

/* Other bodies' contact darkening takes the light around, their shadows the directed light: at
 * nodes of rows y0 and y1 from x on, of which `count` pixels will be drawn. So do real things.
 * False when nothing takes any. */
RLF_KERNEL bool soft_fill_nodes(const soft *s, const soft_face *f, const int32_t y[2], int32_t x,
                                int32_t count, light_nodes *out)
{
    const soft_body *body = &s->scene.bodies[f->body];
    float ray_x[2 * ROW_NODES];
    float ray_y[2 * ROW_NODES];
    float z[2 * ROW_NODES];
    const int32_t last = (count + s->shade_px - 1) / s->shade_px;
    const int32_t per_row = last < ROW_NODES / 2 ? ROW_NODES / 2 : ROW_NODES;
    for (int32_t i = 0; i < 2; i++) {
        const int32_t first = i * per_row;
        place_nodes(s, f, x, y[i], ray_x + first, ray_y + first, z + first);
    }
    const caster_points points = {ray_x, ray_y, z, 2 * per_row};
    const int32_t corner[4] = {0, last, per_row, per_row + last};
    out->per_row = per_row;
    float middle[3];
    float radius = ball_of(&points, corner, middle);
    bool is_shaded = f->is_lit && body->real_shade != NULL;
    if (is_shaded) {
        clear_nodes(out);
        real_shade_take(body->real_shade, &points, (float)BODY_DIRECT_SHARE, out->direct);
    }
    if (soft_may_obscure(s, f, middle, radius)) {
        if (!is_shaded) {
            clear_nodes(out);
        }
        is_shaded = true;
        soft_obscure_nodes(s, f, &points, out->ambient);
    }
    for (int32_t i = 0; i < body->shader_count; i++) {
        const caster *c = &s->scene.casters[body->shaders[i]];
        int32_t takes = caster_may_take(c, middle, radius);
        takes &= f->is_lit ? ~0 : ~CASTER_TAKES_DIRECT;
        if (takes != CASTER_TAKES_NOTHING && !is_shaded) {
            clear_nodes(out);
        }
        is_shaded = is_shaded || takes != CASTER_TAKES_NOTHING;
        if ((takes & CASTER_TAKES_AMBIENT) != 0) {
            caster_take_ambient(c, &points, (float)BODY_AMBIENT_SHARE, out->ambient);
        }
        if ((takes & CASTER_TAKES_DIRECT) != 0) {
            caster_take_direct(c, &points, (float)BODY_DIRECT_SHARE, out->direct);
        }
    }
    return is_shaded;
}
