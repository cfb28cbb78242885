/* Points and normals of the movers' surfaces, a run of pixels at a time: in lanes, without
 * branches.
 */
#include "sim/stamp.h"

#include "kernel/kernel.h"

enum { LANES = 16, MOST = SYNTH_RUN_MOST };

/* Points from the view's origin, and in the stamp's own coordinates. */
typedef struct points {
    float p[3][MOST], q[3][MOST], gradient[3][MOST];
} points;

/* Points at depth p[2] of pixels from (x, y) on. */
RLF_KERNEL_PART void place_points(const rlf_camera *camera, int32_t x, int32_t y, int32_t count,
                                  points *v)
{
    const double cx = camera->cx;
    const double fx = camera->fx;
    const double down = (y - camera->cy) / camera->fy;
    for (int32_t i = 0; i < count; i++) {
        const double across = (x + i - cx) / fx;
        v->p[0][i] = (float)(across * (double)v->p[2][i]);
        v->p[1][i] = (float)(down * (double)v->p[2][i]);
    }
}

/* Into the stamp's coordinates, row by row of its matrix. */
RLF_KERNEL_PART void to_stamp(const synth_stamp *stamp, int32_t count, points *v)
{
    for (int k = 0; k < 3; k++) {
        const float a = (float)stamp->A[k][0];
        const float b = (float)stamp->A[k][1];
        const float c = (float)stamp->A[k][2];
        const float offset = (float)stamp->offset[k];
        for (int32_t i = 0; i < count; i++) {
            v->q[k][i] = a * v->p[0][i] + b * v->p[1][i] + c * v->p[2][i] - offset;
            v->gradient[k][i] = v->q[k][i];
        }
    }
}

/* Away from the nearest point of the axis, along the cone's own slope. */
RLF_KERNEL_PART void lean_cone(const synth_stamp *stamp, int32_t count, points *v)
{
    const float sine = stamp->sine;
    const float cosine = sqrtf(stamp->cosine2);
    const float length = stamp->length;
    for (int32_t i = 0; i < count; i++) {
        float rho = sqrtf(v->q[0][i] * v->q[0][i] + v->q[2][i] * v->q[2][i]);
        float t = v->q[1][i] - rho * sine / cosine;
        t = t < 0.0f ? 0.0f : (t > length ? length : t);
        v->gradient[1][i] = v->q[1][i] - t;
    }
}

/* Out of the face that the point is least inside of. */
RLF_KERNEL_PART void lean_box(const float half[3], int32_t count, points *v)
{
    for (int32_t i = 0; i < count; i++) {
        float depth[3];
        RLF_KERNEL_UNROLLED(3)
        for (int k = 0; k < 3; k++) {
            depth[k] = (v->q[k][i] < 0.0f ? -v->q[k][i] : v->q[k][i]) - half[k];
        }
        int32_t face = depth[1] > depth[0] ? 1 : 0;
        float most = depth[1] > depth[0] ? depth[1] : depth[0];
        face = depth[2] > most ? 2 : face;
        RLF_KERNEL_UNROLLED(3)
        for (int k = 0; k < 3; k++) {
            float side = v->q[k][i] < 0.0f ? -1.0f : 1.0f;
            v->gradient[k][i] = k != face ? 0.0f : side;
        }
    }
}

/* Out of the face that the point is least inside of: an end or the side. */
RLF_KERNEL_PART void lean_frustum(const synth_stamp *stamp, int32_t count, points *v)
{
    const float slope = stamp->sine;
    const float slant = sqrtf(1.0f + slope * slope);
    for (int32_t i = 0; i < count; i++) {
        float rho = sqrtf(v->q[0][i] * v->q[0][i] + v->q[2][i] * v->q[2][i]);
        float side = (rho - stamp->radius_a - slope * v->q[1][i]) / slant;
        float low = -v->q[1][i];
        float high = v->q[1][i] - stamp->length;
        float end = high > low ? high : low;
        float sign = high > low ? 1.0f : -1.0f;
        int is_end = end > side;
        v->gradient[0][i] = is_end ? 0.0f : v->q[0][i];
        v->gradient[1][i] = is_end ? sign : -slope * rho;
        v->gradient[2][i] = is_end ? 0.0f : v->q[2][i];
    }
}

RLF_KERNEL_PART void turn_back(const synth_stamp *stamp, const points *v, int32_t count,
                               synth_touches *out)
{
    float A[3][3];
    for (int k = 0; k < 9; k++) {
        A[k / 3][k % 3] = (float)stamp->A[k / 3][k % 3];
    }
    for (int32_t i = 0; i < count; i++) {
        float n[3];
        RLF_KERNEL_UNROLLED(3)
        for (int k = 0; k < 3; k++) {
            n[k] = A[0][k] * v->gradient[0][i] + A[1][k] * v->gradient[1][i] +
                   A[2][k] * v->gradient[2][i];
        }
        float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        RLF_KERNEL_UNROLLED(3)
        for (int k = 0; k < 3; k++) {
            out->normal[k][i] = n[k] / length;
        }
    }
}

RLF_KERNEL_PART void put_points(const synth_stamp *stamp, const rlf_vec3 from, const points *v,
                                int32_t count, synth_touches *out)
{
    const float origin[3] = {(float)from.x, (float)from.y, (float)from.z};
    for (int k = 0; k < 3; k++) {
        const float size = stamp->type == SYNTH_ELLIPSOID ? stamp->half[k] : 1.0f;
        for (int32_t i = 0; i < count; i++) {
            out->p[k][i] = v->p[k][i] + origin[k];
            out->local[k][i] = v->q[k][i] * size;
        }
    }
}

RLF_KERNEL void synth_canvas_touch(const synth_canvas *canvas, const synth_run *run, int32_t y,
                                   synth_touches *out)
{
    const synth_stamp *stamp = &canvas->stamps[run->id];
    const size_t row = (size_t)y * (size_t)canvas->view.camera.width;
    const int32_t pixels = run->x1 - run->x0;
    const int32_t count = (pixels + LANES - 1) / LANES * LANES;
    points v;
    memcpy(v.p[2], canvas->z + row + (size_t)run->x0, (size_t)pixels * sizeof(float));
    for (int32_t i = pixels; i < count; i++) {
        v.p[2][i] = 1.0f;
    }
    place_points(&canvas->view.camera, run->x0, y, count, &v);
    to_stamp(stamp, count, &v);
    if (stamp->type == SYNTH_CONE) {
        lean_cone(stamp, count, &v);
    } else if (stamp->type == SYNTH_BOX) {
        lean_box(stamp->half, count, &v);
    } else if (stamp->type == SYNTH_FRUSTUM) {
        lean_frustum(stamp, count, &v);
    }
    turn_back(stamp, &v, count, out);
    put_points(stamp, canvas->view.origin, &v, count, out);
}
