/* Turned pictures and their cameras. */
#include "measure/turned.h"

const turn turns[TURNS] = {
    {"as it is", false, false, false},
    {"by 90 degrees", true, true, false},
    {"by 180 degrees", false, true, true},
    {"by 270 degrees", true, false, true},
    {"mirrored", false, true, false},
    {"mirrored, by 90 degrees", true, true, true},
    {"mirrored, by 180 degrees", false, false, true},
    {"mirrored, by 270 degrees", true, false, false},
};

static void swap(double *a, double *b)
{
    double kept = *a;
    *a = *b;
    *b = kept;
}

/* Tangential distortion (p1, p2) follows its axes: p2 is that of x. */
rlf_rig turned_rig(const rlf_rig *rig, const turn *t)
{
    rlf_rig out = *rig;
    rlf_camera *c = &out.depth;
    out.has_color = false;
    if (t->swaps) {
        c->width = rig->depth.height;
        c->height = rig->depth.width;
        swap(&c->fx, &c->fy);
        swap(&c->cx, &c->cy);
        swap(&c->distortion[2], &c->distortion[3]);
    }
    if (t->mirrors_x) {
        c->cx = c->width - 1 - c->cx;
        c->distortion[3] = -c->distortion[3];
    }
    if (t->mirrors_y) {
        c->cy = c->height - 1 - c->cy;
        c->distortion[2] = -c->distortion[2];
    }
    return out;
}

static float depth_at(const rlf_frame *frame, int32_t x, int32_t y)
{
    if (frame->depth_u16 != NULL) {
        ptrdiff_t row = y * (frame->depth_stride / (ptrdiff_t)sizeof(uint16_t));
        return (float)(frame->depth_u16[row + x] / frame->depth_units_per_metre);
    }
    return frame->depth_f32[y * (frame->depth_stride / (ptrdiff_t)sizeof(float)) + x];
}

rlf_frame turned_frame(const rlf_frame *frame, const rlf_rig *rig, const turn *t, float *memory)
{
    int32_t width = rig->depth.width, height = rig->depth.height;
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            int32_t u = t->mirrors_x ? width - 1 - x : x, v = t->mirrors_y ? height - 1 - y : y;
            memory[(ptrdiff_t)y * width + x] =
                t->swaps ? depth_at(frame, v, u) : depth_at(frame, u, v);
        }
    }
    rlf_frame out = *frame;
    out.rig = rig;
    out.depth_u16 = NULL;
    out.depth_f32 = memory;
    out.depth_stride = (ptrdiff_t)sizeof(float) * width;
    out.color = (rlf_image_rgba8){0};
    return out;
}

rlf_vec3 turned_vector(rlf_vec3 v, const turn *t)
{
    rlf_vec3 s = t->swaps ? rlf_vec3_make(v.y, v.x, v.z) : v;
    return rlf_vec3_make(t->mirrors_x ? -s.x : s.x, t->mirrors_y ? -s.y : s.y, s.z);
}

rlf_vec3 unturned_vector(rlf_vec3 v, const turn *t)
{
    rlf_vec3 s = {t->mirrors_x ? -v.x : v.x, t->mirrors_y ? -v.y : v.y, v.z};
    return t->swaps ? rlf_vec3_make(s.y, s.x, s.z) : s;
}
