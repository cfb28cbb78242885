/* Light that waiting pixels send: what is matt and what is mirrored, see probe.h. */
#include "render/soft/stream.h"

#include "kernel/kernel.h"
#include "render/soft/passes.h"
#include "render/soft/soft.h"

/* SOFT_LANES pixels: geometry, then what becomes of it. */
typedef struct lanes {
    float n[3][SOFT_LANES];                        /* unit */
    float r[3][SOFT_LANES];                        /* mirrored direction */
    float to_eye[SOFT_LANES], to_lamp[SOFT_LANES]; /* cosines to the normal */
    float lamp[SOFT_LANES];        /* mirrored, of its light, by a surface that mirrors all */
    float share[2][SOFT_LANES];    /* of what comes mirrored: times the colour, and plain */
    float mirrored[3][SOFT_LANES]; /* radiance */
} lanes;

/* Unit normals, and the mirrored direction of the ray. */
RLF_KERNEL_PART void place(const soft_stream *v, int32_t first, const float light[3], lanes *out)
{
    const float lx = light[0];
    const float ly = light[1];
    const float lz = light[2];
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < SOFT_LANES; k++) {
        const int32_t i = first + k;
        const float nx = v->n[0][i];
        const float ny = v->n[1][i];
        const float nz = v->n[2][i];
        const float per_n = 1.0f / sqrtf(nx * nx + ny * ny + nz * nz + 1e-20f);
        const float x = nx * per_n;
        const float y = ny * per_n;
        const float z = nz * per_n;
        const float per_e =
            1.0f / sqrtf(v->ray_x[i] * v->ray_x[i] + v->ray_y[i] * v->ray_y[i] + 1.0f);
        const float ex = -v->ray_x[i] * per_e;
        const float ey = -v->ray_y[i] * per_e;
        const float ez = -per_e;
        const float cosine = x * ex + y * ey + z * ez;
        const float to_eye = stream_clamp(cosine, 0.02f, 1.0f);
        const float to_lamp = stream_clamp(x * lx + y * ly + z * lz, 0.0f, 1.0f);
        const float hx = lx + ex;
        const float hy = ly + ey;
        const float hz = lz + ez;
        const float per_h = 1.0f / sqrtf(hx * hx + hy * hy + hz * hz + 1e-12f);
        const float nh = stream_clamp((x * hx + y * hy + z * hz) * per_h, 0.0f, 1.0f);
        const float lh = stream_clamp((lx * hx + ly * hy + lz * hz) * per_h, 0.1f, 1.0f);
        const float rough = v->roughness[i];
        const float width = rough * rough + PROBE_LAMP;
        const float width2 = width * width;
        const float spread = 0.25f / (rough + 0.5f);
        const float peak = nh * nh * (width2 - 1.0f) + 1.0f;
        out->n[0][k] = x;
        out->n[1][k] = y;
        out->n[2][k] = z;
        out->r[0][k] = 2.0f * cosine * x - ex;
        out->r[1][k] = 2.0f * cosine * y - ey;
        out->r[2][k] = 2.0f * cosine * z - ez;
        out->to_eye[k] = to_eye;
        out->to_lamp[k] = to_lamp;
        out->lamp[k] = width2 / (peak * peak) * spread / (lh * lh) * to_lamp;
    }
}

/* Karis's form of the split sum; (1 - cosine)^5 stands for his power of two. */
RLF_KERNEL_PART void split(const float *restrict roughness, lanes *v)
{
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < SOFT_LANES; k++) {
        const float rough = roughness[k];
        const float rx = 1.0f - rough;
        const float ry = 0.0425f - 0.0275f * rough;
        const float rz = 1.04f - 0.572f * rough;
        const float rw = 0.022f * rough - 0.04f;
        const float away = 1.0f - v->to_eye[k];
        const float power = away * away * away * away * away;
        const float least = rx * rx < power ? rx * rx : power;
        const float a = least * rx + ry;
        v->share[0][k] = rz - 1.04f * a;
        v->share[1][k] = stream_clamp(rw + 1.04f * a, 0.0f, 1.0f);
    }
}

RLF_KERNEL_PART void sum_terms(const float terms[PROBE_TERMS][3], int c,
                               const float d[3][SOFT_LANES], float *restrict out)
{
    const float *restrict dx = d[0];
    const float *restrict dy = d[1];
    const float *restrict dz = d[2];
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < SOFT_LANES; k++) {
        const float x = dx[k];
        const float y = dy[k];
        const float z = dz[k];
        const float sum = terms[0][c] + terms[1][c] * x + terms[2][c] * y + terms[3][c] * z +
                          terms[4][c] * x * y + terms[5][c] * y * z + terms[6][c] * z * x +
                          terms[7][c] * z * z + terms[8][c] * (x * x - y * y);
        out[k] = sum > 0.0f ? sum : 0.0f;
    }
}

RLF_KERNEL_PART float magnitude(float x)
{
    return x < 0.0f ? -x : x;
}

/* Bilinear. */
RLF_KERNEL_PART void look_up(const light_probe *probe, lanes *v)
{
    int32_t cell[SOFT_LANES];
    float across[SOFT_LANES];
    float down[SOFT_LANES];
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < SOFT_LANES; k++) {
        const float x = v->r[0][k];
        const float y = v->r[1][k];
        const float z = v->r[2][k];
        const float scale = 1.0f / (magnitude(x) + magnitude(y) + magnitude(z) + 1e-12f);
        const float a = x * scale;
        const float b = y * scale;
        const float fold_a = (1.0f - magnitude(b)) * (a < 0.0f ? -1.0f : 1.0f);
        const float fold_b = (1.0f - magnitude(a)) * (b < 0.0f ? -1.0f : 1.0f);
        const float most = (float)PROBE_SIDE + 0.499f;
        const float s = (z > 0.0f ? fold_a : a) * (0.5f * PROBE_SIDE) + (0.5f * PROBE_SIDE + 0.5f);
        const float t = (z > 0.0f ? fold_b : b) * (0.5f * PROBE_SIDE) + (0.5f * PROBE_SIDE + 0.5f);
        const float left = stream_clamp(s, 0.0f, most);
        const float top = stream_clamp(t, 0.0f, most);
        const int32_t column = (int32_t)left;
        const int32_t row = (int32_t)top;
        cell[k] = row * PROBE_ROW + column;
        across[k] = left - (float)column;
        down[k] = top - (float)row;
    }
    for (int32_t k = 0; k < SOFT_LANES; k++) {
        const float *at = probe->map[cell[k]];
        const float *below = at + 3 * PROBE_ROW;
        for (int c = 0; c < 3; c++) {
            const float upper = at[c] + (at[c + 3] - at[c]) * across[k];
            const float lower = below[c] + (below[c + 3] - below[c]) * across[k];
            v->mirrored[c][k] = upper + (lower - upper) * down[k];
        }
    }
}

/* Colour's factor and what is added to that, of one channel. */
RLF_KERNEL_PART void mix(const lanes *v, const float *restrict around,
                         const float *restrict mirrored, const float *restrict ambient,
                         const float *restrict direct, float lamp, const float *restrict metallic,
                         float *restrict times, float *restrict plus)
{
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < SOFT_LANES; k++) {
        const float metal = metallic[k];
        const float matt = 1.0f - metal;
        const float lit = lamp * direct[k];
        const float diffuse = ambient[k] * around[k] + lit * v->to_lamp[k];
        const float room = ambient[k] * mirrored[k];
        const float sheen = room * v->share[0][k] + lit * v->lamp[k];
        times[k] = matt * diffuse + metal * sheen;
        plus[k] = PROBE_SHEEN * matt * sheen + room * v->share[1][k];
    }
}

/* How many lanes are smooth. */
RLF_KERNEL_PART int32_t count_smooth(const float *restrict roughness)
{
    int32_t count = 0;
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < SOFT_LANES; k++) {
        count += roughness[k] < PROBE_SMOOTH ? 1 : 0;
    }
    return count;
}

/* What rough lanes mirror, of one channel. */
RLF_KERNEL_PART void mirror_rough(const light_probe *probe, int c, const float *restrict roughness,
                                  lanes *v)
{
    float sum[SOFT_LANES];
    sum_terms(probe->rough, c, (const float(*)[SOFT_LANES])v->r, sum);
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < SOFT_LANES; k++) {
        v->mirrored[c][k] = roughness[k] < PROBE_SMOOTH ? v->mirrored[c][k] : sum[k];
    }
}

RLF_KERNEL void soft_light_lanes(const light_probe *probe, const float light[3], soft_stream *v)
{
    float around[SOFT_LANES];
    lanes here;
    for (int32_t first = 0; first < v->count; first += SOFT_LANES) {
        const int32_t smooth = count_smooth(v->roughness + first);
        place(v, first, light, &here);
        split(v->roughness + first, &here);
        if (smooth > 0) {
            look_up(probe, &here);
        }
        for (int c = 0; c < 3; c++) {
            sum_terms(probe->around, c, (const float(*)[SOFT_LANES])here.n, around);
            if (smooth < SOFT_LANES) {
                mirror_rough(probe, c, v->roughness + first, &here);
            }
            mix(&here, around, here.mirrored[c], v->ambient + first, v->direct + first,
                probe->direct[c], v->metallic + first, v->times[c] + first, v->plus[c] + first);
        }
    }
}
