/* Colour of a body at a pixel: body colour * texture * light. */
#include "render/soft/soft.h"

static float clamp(float x, float low, float high)
{
    return x < low ? low : (x > high ? high : x);
}

static int32_t floor_to_int(float x)
{
    int32_t cell = (int32_t)x;
    return (float)cell > x ? cell - 1 : cell;
}

/* Bilinear, repeating; 0..1. The patterns are grey: one channel says it all. */
static float sample_texture(const soft_body *body, float s, float t)
{
    int32_t size = body->texture_size;
    int32_t mask = size - 1;
    float x = s * (float)size - 0.5f;
    float y = t * (float)size - 0.5f;
    int32_t column = floor_to_int(x);
    int32_t line = floor_to_int(y);
    float wx = x - (float)column;
    float wy = y - (float)line;
    const uint8_t *top = body->texture + 4 * (ptrdiff_t)((line & mask) * size);
    const uint8_t *bottom = body->texture + 4 * (ptrdiff_t)(((line + 1) & mask) * size);
    ptrdiff_t left = 4 * (ptrdiff_t)(column & mask);
    ptrdiff_t right = 4 * (ptrdiff_t)((column + 1) & mask);
    float a = (float)top[left] * (1.0f - wx) + (float)top[right] * wx;
    float b = (float)bottom[left] * (1.0f - wx) + (float)bottom[right] * wx;
    return (a * (1.0f - wy) + b * wy) * (1.0f / 255.0f);
}

soft_fragment soft_shade(const soft_scene *scene, const soft_triangle *t, float x, float y)
{
    float dx = x - (float)t->x[0];
    float dy = y - (float)t->y[0];
    /* A pixel that only a corner of the triangle touches has its centre outside: stay within. */
    float inverse_z = t->inverse_z.at0 + t->inverse_z.dx * dx + t->inverse_z.dy * dy;
    inverse_z = clamp(inverse_z, t->inverse_z_min, t->inverse_z_max);
    soft_fragment f = {.z = 1.0f / inverse_z};
    float a[SOFT_ATTRIBUTES];
    for (int i = 0; i < SOFT_ATTRIBUTES; i++) {
        const soft_plane *plane = &t->attribute[i];
        a[i] = (plane->at0 + plane->dx * dx + plane->dy * dy) * f.z;
    }
    float light = clamp(a[SOFT_LIGHT], 0.0f, 1.0f);
    const soft_body *body = &scene->bodies[t->body];
    light *= sample_texture(body, clamp(a[SOFT_S], 0.0f, 1.0f), clamp(a[SOFT_T], 0.0f, 1.0f));
    for (int c = 0; c < 3; c++) {
        f.color[c] = body->color[c] * light;
    }
    return f;
}
