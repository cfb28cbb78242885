/* Point to plane residuals (Chen and Medioni 1991), sixteen points at a time. */
#include "track/tracker.h"

#include "kernel/kernel.h"

#include <stddef.h>

/* Metres per square metre of depth: errors that neighbours share, so that no mean takes them out. A
 * sensor that measures disparity has them grow with the square. */
#define SHARED_SIGMA 0.002f
#define LEAST_COSINE 0.1f /* at lower angles depth says little about the distance to the plane */
#define LEAST_DEPTH 0.05f /* metres */
#define GREY_SIGMA 5.0f   /* levels: of a picture against the prediction */
#define GREY_CUT 6.0f     /* Tukey's limit, in those */

enum { LANES = 16 };

/* Terms of the sums, in track_sums' order. */
enum {
    EQUATIONS = 27, /* a, then b */
    GREY = EQUATIONS,
    INFORMATION = 2 * EQUATIONS,
    SQUARED,
    WEIGHT,
    GREY_RESIDUAL,
    GREY_WEIGHT,
    TERMS
};

/* A rotation and a translation, the prediction's camera and the gate, in single precision. */
typedef struct view {
    float m[3][3], t[3];
    float fx, fy, cx, cy;
    float metres, cut, grey;
    bool asks_grey;
} view;

/* Sixteen points. */
typedef struct lanes {
    float x[LANES], y[LANES], z[LANES]; /* moved */
    float sigma[LANES];                 /* of the depth */
    int32_t at[LANES];                  /* pixel of the prediction; 0 where there is none */
    float u[LANES], v[LANES];
    int32_t is_in[LANES]; /* 1: in the prediction's picture */
    float qz[LANES], n[3][LANES];
    float residual[LANES], deviation[LANES], plane_error[LANES];
    int32_t is_matched[LANES];
    int32_t bin[LANES];
} lanes;

typedef struct lane_sums {
    float of[TERMS][LANES];
} lane_sums;

static view view_of(const rlf_prediction *prediction, const rlf_pose *T, const track_gate *gate)
{
    const rlf_camera *c = &prediction->camera;
    const rlf_mat3 r = rlf_quat_to_mat3(T->q);
    view out = {.t = {(float)T->p.x, (float)T->p.y, (float)T->p.z},
                .fx = (float)c->fx,
                .fy = (float)c->fy,
                .cx = (float)c->cx,
                .cy = (float)c->cy,
                .metres = (float)gate->metres,
                .cut = (float)gate->cut,
                .grey = (float)gate->grey,
                .asks_grey =
                    gate->asks_grey && prediction->grey != NULL && c->width >= 3 && c->height >= 3};
    for (int i = 0; i < 9; i++) {
        out.m[i / 3][i % 3] = (float)r.m[i / 3][i % 3];
    }
    return out;
}

/* Points from `first` on, `stride` apart, moved into the prediction's picture. */
RLF_KERNEL_PART void project(const view *c, const track_points *points, size_t first,
                             int32_t stride, int32_t count, const rlf_camera *camera,
                             lanes *restrict l)
{
    const float width = (float)camera->width, height = (float)camera->height;
    float px[LANES] = {0}, py[LANES] = {0}, pz[LANES] = {0};
    for (int32_t i = 0; i < count; i++) {
        const size_t from = first + (size_t)(i * stride);
        px[i] = points->x[from];
        py[i] = points->y[from];
        pz[i] = points->z[from];
        l->sigma[i] = points->sigma[from];
    }
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        const float x = c->m[0][0] * px[i] + c->m[0][1] * py[i] + c->m[0][2] * pz[i] + c->t[0];
        const float y = c->m[1][0] * px[i] + c->m[1][1] * py[i] + c->m[1][2] * pz[i] + c->t[1];
        const float z = c->m[2][0] * px[i] + c->m[2][1] * py[i] + c->m[2][2] * pz[i] + c->t[2];
        const float deep = z > LEAST_DEPTH ? z : LEAST_DEPTH;
        const float u = c->fx * x / deep + c->cx + 0.5f, v = c->fy * y / deep + c->cy + 0.5f;
        const int32_t is_in = (pz[i] > 0.0f ? 1 : 0) & (z > LEAST_DEPTH ? 1 : 0) &
                              (u >= 0.0f ? 1 : 0) & (v >= 0.0f ? 1 : 0) & (u < width ? 1 : 0) &
                              (v < height ? 1 : 0);
        const float column = is_in != 0 ? u : 0.0f, row = is_in != 0 ? v : 0.0f;
        l->x[i] = x;
        l->y[i] = y;
        l->z[i] = deep;
        l->u[i] = column;
        l->v[i] = row;
        l->is_in[i] = is_in;
        l->at[i] = (int32_t)row * camera->width + (int32_t)column;
    }
}

/* How far the points are off the predicted planes, and whether that is within the gate. */
RLF_KERNEL_PART void match(const view *c, const rlf_prediction *prediction,
                           const float *plane_error, lanes *restrict l)
{
    for (int32_t i = 0; i < LANES; i++) {
        const int32_t at = l->at[i];
        l->qz[i] = prediction->depth[at];
        l->n[0][i] = prediction->normal_x[at];
        l->n[1][i] = prediction->normal_y[at];
        l->n[2][i] = prediction->normal_z[at];
        l->plane_error[i] = plane_error[at];
    }
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        const float x = l->x[i], y = l->y[i], z = l->z[i], qz = l->qz[i];
        const float qx = ((float)(int32_t)l->u[i] - c->cx) / c->fx * qz;
        const float qy = ((float)(int32_t)l->v[i] - c->cy) / c->fy * qz;
        const float nx = l->n[0][i], ny = l->n[1][i], nz = l->n[2][i];
        const float facing = nx * x + ny * y + nz * z;
        const float residual = nx * (x - qx) + ny * (y - qy) + nz * (z - qz);
        /* Depth moves a point along its ray: so much of that is across the plane. */
        const float across = l->sigma[i] * facing / z, shared = SHARED_SIGMA * z * z;
        const float bent = l->plane_error[i];
        const float deviation = sqrtf(across * across + shared * shared + bent * bent);
        const float size = rlf_kernel_abs(residual);
        const float bin = size / deviation * TRACK_BINS_PER_SIGMA;
        l->residual[i] = residual;
        l->deviation[i] = deviation;
        l->is_matched[i] = l->is_in[i] & (qz > 0.0f ? 1 : 0) & (size < c->metres ? 1 : 0) &
                           (facing <= -LEAST_COSINE * sqrtf(x * x + y * y + z * z) ? 1 : 0);
        l->bin[i] = (int32_t)(bin < TRACK_BINS - 1 ? bin : TRACK_BINS - 1);
    }
}

/* Adds the squares of residuals r with their derivatives, times w; n: how r changes as the point
 * moves. */
RLF_KERNEL_PART void add_equations(const lanes *restrict l, const float n[3][LANES],
                                   const float *restrict residual, const float *restrict w,
                                   float (*restrict sums)[LANES])
{
    float j[6][LANES];
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        j[0][i] = l->y[i] * n[2][i] - l->z[i] * n[1][i];
        j[1][i] = l->z[i] * n[0][i] - l->x[i] * n[2][i];
        j[2][i] = l->x[i] * n[1][i] - l->y[i] * n[0][i];
        j[3][i] = n[0][i];
        j[4][i] = n[1][i];
        j[5][i] = n[2][i];
    }
    int32_t k = 0;
    for (int32_t r = 0; r < 6; r++) {
        float wj[LANES];
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LANES; i++) {
            wj[i] = w[i] * j[r][i];
            sums[21 + r][i] -= wj[i] * residual[i];
        }
        for (int32_t c = 0; c <= r; c++, k++) {
            RLF_KERNEL_WHOLE
            for (int32_t i = 0; i < LANES; i++) {
                sums[k][i] += wj[i] * j[c][i];
            }
        }
    }
}

/* Tukey's weights. */
RLF_KERNEL_PART void add_depth(const view *c, const lanes *restrict l, lane_sums *restrict sums)
{
    float w[LANES];
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        const float inverse = 1.0f / l->deviation[i], u = l->residual[i] * inverse;
        const float rest = 1.0f - u * u / (c->cut * c->cut);
        const float robust = l->is_matched[i] != 0 && rest > 0.0f ? rest * rest : 0.0f;
        w[i] = robust * inverse * inverse;
        sums->of[INFORMATION][i] += w[i];
        sums->of[SQUARED][i] += robust * u * u;
        sums->of[WEIGHT][i] += robust;
    }
    add_equations(l, (const float(*)[LANES])l->n, l->residual, w, sums->of);
}

/* Brightness: the prediction at the moved point, against the frame's (Kerl et al. 2013). It tells
 * what planes cannot: how far the camera slid along them. */
RLF_KERNEL_PART void add_grey(const view *c, const rlf_prediction *prediction,
                              const float *restrict seen, const lanes *restrict l,
                              lane_sums *restrict sums)
{
    const int32_t width = prediction->camera.width, height = prediction->camera.height;
    float n[3][LANES], residual[LANES], w[LANES];
    for (int32_t i = 0; i < LANES; i++) {
        const int32_t x = (int32_t)l->u[i], y = (int32_t)l->v[i];
        const bool is_inside = l->is_matched[i] != 0 && seen[i] > 0.0f && x > 0 && y > 0 &&
                               x + 1 < width && y + 1 < height;
        const uint8_t *g = &prediction->grey[is_inside ? l->at[i] : width + 1];
        const bool is_whole = is_inside && g[0] != 0 && *(g - 1) != 0 && g[1] != 0 &&
                              *(g - width) != 0 && g[width] != 0;
        const float gu = 0.5f * (float)(g[1] - *(g - 1));
        const float gv = 0.5f * (float)(g[width] - *(g - width));
        const float du = l->u[i] - (float)x - 0.5f, dv = l->v[i] - (float)y - 0.5f;
        residual[i] = (float)g[0] + gu * du + gv * dv - seen[i] - c->grey;
        const float u = residual[i] / (GREY_SIGMA * GREY_CUT), rest = 1.0f - u * u;
        const float robust = is_whole && rest > 0.0f ? rest * rest : 0.0f;
        n[0][i] = gu * c->fx / l->z[i];
        n[1][i] = gv * c->fy / l->z[i];
        n[2][i] = -(n[0][i] * l->x[i] + n[1][i] * l->y[i]) / l->z[i];
        w[i] = robust / (GREY_SIGMA * GREY_SIGMA);
        sums->of[GREY_RESIDUAL][i] += robust * (residual[i] + c->grey);
        sums->of[GREY_WEIGHT][i] += robust;
    }
    add_equations(l, (const float(*)[LANES])n, residual, w, sums->of + GREY);
}

/* How far the pixel (dx, dy) farther is off the plane of pixel (x, y); what is unknown, much. */
static float off_plane(const rlf_prediction *p, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    const rlf_camera *c = &p->camera;
    const int32_t i = y * c->width + x;
    if (x + dx < 0 || y + dy < 0 || x + dx >= c->width || y + dy >= c->height ||
        !(p->depth[i + dy * c->width + dx] > 0.0f)) {
        return 1e9f;
    }
    const float z = p->depth[i], to = p->depth[i + dy * c->width + dx];
    const float u = (float)x - (float)c->cx, v = (float)y - (float)c->cy;
    const float off_x = ((u + (float)dx) * to - u * z) / (float)c->fx;
    const float off_y = ((v + (float)dy) * to - v * z) / (float)c->fy;
    return rlf_kernel_abs(p->normal_x[i] * off_x + p->normal_y[i] * off_y +
                          p->normal_z[i] * (to - z));
}

void track_find_plane_error(const rlf_prediction *prediction, float *error)
{
    const rlf_camera *c = &prediction->camera;
    for (int32_t y = 0; y < c->height; y++) {
        for (int32_t x = 0; x < c->width; x++) {
            const float left = off_plane(prediction, x, y, -1, 0);
            const float right = off_plane(prediction, x, y, 1, 0);
            const float above = off_plane(prediction, x, y, 0, -1);
            const float below = off_plane(prediction, x, y, 0, 1);
            const float row = left < right ? left : right, column = above < below ? above : below;
            const float most = prediction->depth[y * c->width + x] / (float)c->fx;
            const float off = row > column ? row : column;
            error[y * c->width + x] = 0.5f * (off < most ? off : most); /* half a pixel away */
        }
    }
}

/* One row, into single precision: it is short. */
RLF_KERNEL static void add_row(const view *c, const track_points *points, int32_t row,
                               int32_t stride, const rlf_prediction *prediction,
                               const float *plane_error, lane_sums *restrict out,
                               track_sums *restrict counts)
{
    const int32_t columns = (points->width + stride - 1) / stride;
    lanes l = {.sigma = {0}};
    for (int32_t column = 0; column < columns; column += LANES) {
        const int32_t count = columns - column < LANES ? columns - column : LANES;
        const size_t first = (size_t)row * (size_t)points->width + (size_t)(column * stride);
        project(c, points, first, stride, count, &prediction->camera, &l);
        match(c, prediction, plane_error, &l);
        add_depth(c, &l, out);
        for (int32_t i = 0; i < LANES; i++) {
            counts->tried += l.is_in[i];
            counts->matched += l.is_matched[i];
            counts->bins[l.bin[i]] += l.is_matched[i];
        }
        if (c->asks_grey) {
            float seen[LANES] = {0};
            for (int32_t i = 0; i < count; i++) {
                seen[i] = (float)points->grey[first + (size_t)(i * stride)];
            }
            add_grey(c, prediction, seen, &l, out);
        }
    }
}

track_sums track_sums_of(const track_points *points, int32_t stride,
                         const rlf_prediction *prediction, const float *plane_error,
                         const rlf_pose *T, const track_gate *gate)
{
    const view c = view_of(prediction, T, gate);
    track_sums out = {.tried = 0};
    double sum[TERMS][LANES] = {{0}}, total[TERMS] = {0};
    for (int32_t row = 0; row < points->height; row += stride) {
        lane_sums part = {.of = {{0}}};
        add_row(&c, points, row, stride, prediction, plane_error, &part, &out);
        for (int32_t k = 0; k < TERMS * LANES; k++) {
            sum[k / LANES][k % LANES] += (double)part.of[k / LANES][k % LANES];
        }
    }
    for (int32_t k = 0; k < TERMS * LANES; k++) {
        total[k / LANES] += sum[k / LANES][k % LANES];
    }
    _Static_assert(offsetof(track_sums, tried) == sizeof(total), "the sums are in TERMS' order");
    memcpy(&out, total, sizeof(total));
    return out;
}
