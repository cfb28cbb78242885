/* Point to plane residuals of one row of points (Chen and Medioni 1991). */
#include "track/normal_equations.h"

#include "kernel/kernel.h"

/* Metres per square metre of depth: errors that neighbours share, so that no mean takes them out. A
 * sensor that measures disparity has them grow with the square. */
#define SHARED_SIGMA 0.002
#define LEAST_COSINE 0.1 /* at lower angles depth says little about the distance to the plane */
#define GREY_SIGMA 5.0   /* levels: of a picture against the prediction */
#define GREY_CUT 6.0     /* Tukey's limit, in those */

/* A rotation and a translation in single precision. */
typedef struct motion {
    float m[3][3], t[3];
} motion;

static motion motion_of(const rlf_pose *T)
{
    const rlf_mat3 r = rlf_quat_to_mat3(T->q);
    motion out;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out.m[i][j] = (float)r.m[i][j];
        }
    }
    out.t[0] = (float)T->p.x;
    out.t[1] = (float)T->p.y;
    out.t[2] = (float)T->p.z;
    return out;
}

/* A point on the prediction. */
typedef struct match {
    double p[3], n[3]; /* the moved point and the surface's normal */
    double residual;   /* metres */
    double deviation;  /* that is expected of it */
} match;

/* Adds the square of `residual` with its derivative, times w. */
static void add_equation(track_sums *sums, const double j[6], double residual, double w)
{
    int32_t k = 0;
    for (int r = 0; r < 6; r++) {
        const double wj = w * j[r];
        for (int c = 0; c <= r; c++) {
            sums->a[k++] += wj * j[c];
        }
        sums->b[r] -= wj * residual;
    }
}

static void add_match(track_sums *sums, const match *m, double cut)
{
    const double u = m->residual / m->deviation;
    const double size = u < 0.0 ? -u : u;
    const int32_t bin = (int32_t)rlf_min(size * TRACK_BINS_PER_SIGMA, TRACK_BINS - 1);
    sums->bins[bin]++;
    sums->matched++;
    if (size >= cut) {
        return;
    }
    const double rest = 1.0 - u * u / (cut * cut);
    const double robust = rest * rest;
    const double w = robust / (m->deviation * m->deviation);
    const double *p = m->p, *n = m->n;
    const double j[6] = {p[1] * n[2] - p[2] * n[1],
                         p[2] * n[0] - p[0] * n[2],
                         p[0] * n[1] - p[1] * n[0],
                         n[0],
                         n[1],
                         n[2]};
    add_equation(sums, j, m->residual, w);
    sums->information += w;
    sums->squared += robust * u * u;
    sums->weight += robust;
}

/* Brightness: the prediction at the moved point, against the frame's (Kerl et al. 2013). It tells
 * what planes cannot: how far the camera slid along them. du, dv: from the pixel's middle. */
static void add_grey(track_sums *sums, const rlf_prediction *prediction, size_t at, float du,
                     float dv, const double p[3], double frame_grey, const track_gate *gate)
{
    const size_t width = (size_t)prediction->camera.width;
    const uint8_t *g = &prediction->grey[at];
    if (g[0] == 0 || *(g - 1) == 0 || g[1] == 0 || *(g - width) == 0 || g[width] == 0) {
        return;
    }
    const double gu = 0.5 * (g[1] - *(g - 1)), gv = 0.5 * (g[width] - *(g - width));
    const double r = g[0] + gu * (double)du + gv * (double)dv - frame_grey - gate->grey;
    const double u = r / (GREY_SIGMA * GREY_CUT);
    if (!(u > -1.0 && u < 1.0)) {
        return;
    }
    const double robust = (1.0 - u * u) * (1.0 - u * u);
    const double a = gu * prediction->camera.fx / p[2], b = gv * prediction->camera.fy / p[2];
    const double n[3] = {a, b, -(a * p[0] + b * p[1]) / p[2]};
    const double j[6] = {p[1] * n[2] - p[2] * n[1],
                         p[2] * n[0] - p[0] * n[2],
                         p[0] * n[1] - p[1] * n[0],
                         n[0],
                         n[1],
                         n[2]};
    add_equation(sums, j, r, gate->grey_weight * robust / (GREY_SIGMA * GREY_SIGMA));
    sums->grey_residual += robust * (r + gate->grey);
    sums->grey_weight += robust;
}

void track_sums_add_row(track_sums *sums, const track_points *points, int32_t row, int32_t stride,
                        const rlf_prediction *prediction, const rlf_pose *T, track_gate gate)
{
    const motion g = motion_of(T);
    const rlf_camera *c = &prediction->camera;
    const float fx = (float)c->fx, fy = (float)c->fy;
    const float cx = (float)(c->cx + 0.5), cy = (float)(c->cy + 0.5);
    for (int32_t column = 0; column < points->width; column += stride) {
        const size_t i = (size_t)row * (size_t)points->width + (size_t)column;
        const float pz = points->z[i];
        if (pz == 0.0f) {
            continue;
        }
        const float px = points->x[i], py = points->y[i];
        const float x = g.m[0][0] * px + g.m[0][1] * py + g.m[0][2] * pz + g.t[0];
        const float y = g.m[1][0] * px + g.m[1][1] * py + g.m[1][2] * pz + g.t[1];
        const float z = g.m[2][0] * px + g.m[2][1] * py + g.m[2][2] * pz + g.t[2];
        if (!(z > 0.05f)) {
            continue;
        }
        const float u = fx * x / z + cx, v = fy * y / z + cy;
        if (!(u >= 0.0f && v >= 0.0f && u < (float)c->width && v < (float)c->height)) {
            continue;
        }
        const size_t at = (size_t)(int32_t)v * (size_t)c->width + (size_t)(int32_t)u;
        const float qz = prediction->depth[at];
        sums->tried++;
        if (!(qz > 0.0f)) {
            continue;
        }
        const float qx = ((float)(int32_t)u - (float)c->cx) / fx * qz;
        const float qy = ((float)(int32_t)v - (float)c->cy) / fy * qz;
        const float nx = prediction->normal_x[at], ny = prediction->normal_y[at],
                    nz = prediction->normal_z[at];
        const float along = (nx * x + ny * y + nz * z) / sqrtf(x * x + y * y + z * z);
        const float dx = x - qx, dy = y - qy, dz = z - qz;
        const float residual = nx * dx + ny * dy + nz * dz;
        if (along > (float)-LEAST_COSINE ||
            !(residual < (float)gate.metres && residual > (float)-gate.metres)) {
            continue;
        }
        /* Depth moves a point along its ray: so much of that is across the plane. */
        const double shared = SHARED_SIGMA * (double)z * (double)z;
        const double across =
            (double)points->sigma[i] * (double)(nx * x + ny * y + nz * z) / (double)z;
        const match m = {{(double)x, (double)y, (double)z},
                         {(double)nx, (double)ny, (double)nz},
                         (double)residual,
                         sqrt(across * across + shared * shared)};
        add_match(sums, &m, gate.cut);
        const int32_t ui = (int32_t)u, vi = (int32_t)v;
        if (gate.grey_weight > 0.0 && points->grey[i] != 0 && ui > 0 && vi > 0 &&
            ui + 1 < c->width && vi + 1 < c->height) {
            add_grey(sums, prediction, at, u - (float)ui - 0.5f, v - (float)vi - 0.5f, m.p,
                     points->grey[i], &gate);
        }
    }
}

void track_sums_add(track_sums *sums, const track_sums *part)
{
    for (int i = 0; i < 21; i++) {
        sums->a[i] += part->a[i];
    }
    for (int i = 0; i < 6; i++) {
        sums->b[i] += part->b[i];
    }
    sums->information += part->information;
    sums->squared += part->squared;
    sums->weight += part->weight;
    sums->grey_residual += part->grey_residual;
    sums->grey_weight += part->grey_weight;
    sums->tried += part->tried;
    sums->matched += part->matched;
    for (int i = 0; i < TRACK_BINS; i++) {
        sums->bins[i] += part->bins[i];
    }
}
