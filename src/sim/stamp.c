/* Movers as stamps: where they project to, and their rows. */
#include "sim/stamp.h"

#include "kernel/kernel.h"

#define NEAREST 0.05 /* metres; what is nearer is not drawn */

/* Coefficients of one row: direction d + i step_d and origin o + i step_o for pixel i. */
typedef struct row {
    float d[3], step_d[3];
    float o[3], step_o[3];
    float z0;
    int32_t count;
    int32_t id;
    float *z;
    int32_t *part;
} row;

typedef struct ray {
    float dx, dy, dz, ox, oy, oz;
} ray;

RLF_KERNEL_PART ray ray_of(const row *r, int32_t i)
{
    const float u = (float)i;
    return (ray){.dx = r->d[0] + u * r->step_d[0],
                 .dy = r->d[1] + u * r->step_d[1],
                 .dz = r->d[2] + u * r->step_d[2],
                 .ox = r->o[0] + u * r->step_o[0],
                 .oy = r->o[1] + u * r->step_o[1],
                 .oz = r->o[2] + u * r->step_o[2]};
}

/* Entry into the unit sphere: |o + s d|^2 = 1. */
RLF_KERNEL static void draw_ellipsoid(const row r)
{
    float *restrict z = r.z;
    int32_t *restrict part = r.part;
    for (int32_t i = 0; i < r.count; i++) {
        const ray m = ray_of(&r, i);
        float a = m.dx * m.dx + m.dy * m.dy + m.dz * m.dz;
        float b = m.ox * m.dx + m.oy * m.dy + m.oz * m.dz;
        float c = m.ox * m.ox + m.oy * m.oy + m.oz * m.oz - 1.0f;
        float discriminant = b * b - a * c;
        float root = sqrtf(discriminant > 0.0f ? discriminant : 0.0f);
        float t = r.z0 - (b + root) / a;
        int hit = (discriminant > 0.0f) & (t > (float)NEAREST) & (t < z[i]);
        z[i] = hit ? t : z[i];
        part[i] = hit ? r.id : part[i];
    }
}

/* Slab method. */
RLF_KERNEL static void draw_box(const row r, const float half[3])
{
    float *restrict z = r.z;
    int32_t *restrict part = r.part;
    for (int32_t i = 0; i < r.count; i++) {
        float u = (float)i;
        float near = -1e9f;
        float far = 1e9f;
        RLF_KERNEL_UNROLLED(3)
        for (int k = 0; k < 3; k++) {
            float d = r.d[k] + u * r.step_d[k];
            float o = r.o[k] + u * r.step_o[k];
            d = d == 0.0f ? 1e-12f : d;
            float t1 = (-half[k] - o) / d;
            float t2 = (half[k] - o) / d;
            float low = t1 < t2 ? t1 : t2;
            float high = t1 < t2 ? t2 : t1;
            near = low > near ? low : near;
            far = high < far ? high : far;
        }
        float t = r.z0 + near;
        int hit = (near <= far) & (t > (float)NEAREST) & (t < z[i]);
        z[i] = hit ? t : z[i];
        part[i] = hit ? r.id : part[i];
    }
}

/* Entry is the smallest of the entries into the two spheres and the crossings of the lateral
 * surface between them; see intersect_cone in shape.c. */
RLF_KERNEL static void draw_cone(const row r, const synth_stamp *stamp)
{
    const float sine = stamp->sine;
    const float cosine2 = stamp->cosine2;
    const float radius_a = stamp->radius_a;
    const float length = stamp->length;
    const float radius_a2 = radius_a * radius_a;
    const float radius_b2 = stamp->radius_b * stamp->radius_b;
    const float far = 1e9f;
    float *restrict z = r.z;
    int32_t *restrict part = r.part;
    for (int32_t i = 0; i < r.count; i++) {
        const ray m = ray_of(&r, i);
        float d_side = m.dx * m.dx + m.dz * m.dz;
        float m_side = m.ox * m.dx + m.oz * m.dz;
        float o_side = m.ox * m.ox + m.oz * m.oz;
        float dd = d_side + m.dy * m.dy;

        float b = m_side + m.oy * m.dy;
        float q = b * b - dd * (o_side + m.oy * m.oy - radius_a2);
        float entry = (-b - sqrtf(q > 0.0f ? q : 0.0f)) / dd;
        float best = q > 0.0f ? entry : far;

        float oy_b = m.oy - length;
        b = m_side + oy_b * m.dy;
        q = b * b - dd * (o_side + oy_b * oy_b - radius_b2);
        entry = (-b - sqrtf(q > 0.0f ? q : 0.0f)) / dd;
        entry = q > 0.0f ? entry : far;
        best = entry < best ? entry : best;

        float k = radius_a - sine * m.oy;
        float a = cosine2 * d_side - sine * sine * m.dy * m.dy;
        b = cosine2 * m_side + k * sine * m.dy;
        float c = cosine2 * o_side - k * k;
        q = b * b - a * c;
        float root = sqrtf(q > 0.0f ? q : 0.0f);
        float s = b > 0.0f ? -b - root : root - b; /* without cancellation */
        float t1 = s / (a == 0.0f ? 1e-12f : a);
        float t2 = c / (s == 0.0f ? 1e-12f : s);
        float y1 = m.oy + t1 * m.dy - radius_a * sine;
        float y2 = m.oy + t2 * m.dy - radius_a * sine;
        float end = length * cosine2;
        t1 = ((q > 0.0f) & (y1 >= 0.0f) & (y1 <= end)) ? t1 : far;
        t2 = ((q > 0.0f) & (y2 >= 0.0f) & (y2 <= end)) ? t2 : far;
        best = t1 < best ? t1 : best;
        best = t2 < best ? t2 : best;

        float t = r.z0 + best;
        int hit = (t > (float)NEAREST) & (t < z[i]);
        z[i] = hit ? t : z[i];
        part[i] = hit ? r.id : part[i];
    }
}

/* Entry is the smallest of the crossings of the ends and of the side; see intersect_frustum. */
RLF_KERNEL static void draw_frustum(const row r, const synth_stamp *stamp)
{
    const float slope = stamp->sine;
    const float radius_a = stamp->radius_a;
    const float length = stamp->length;
    const float radius_a2 = radius_a * radius_a;
    const float radius_b2 = stamp->radius_b * stamp->radius_b;
    const float far = 1e9f;
    float *restrict z = r.z;
    int32_t *restrict part = r.part;
    for (int32_t i = 0; i < r.count; i++) {
        const ray m = ray_of(&r, i);
        float dy = m.dy == 0.0f ? 1e-12f : m.dy;
        float t_a = -m.oy / dy;
        float t_b = (length - m.oy) / dy;
        float ax = m.ox + t_a * m.dx, az = m.oz + t_a * m.dz;
        float bx = m.ox + t_b * m.dx, bz = m.oz + t_b * m.dz;
        float best = ax * ax + az * az <= radius_a2 ? t_a : far;
        float end = bx * bx + bz * bz <= radius_b2 ? t_b : far;
        best = end < best ? end : best;

        float k = radius_a + slope * m.oy;
        float a = m.dx * m.dx + m.dz * m.dz - slope * slope * m.dy * m.dy;
        float b = m.ox * m.dx + m.oz * m.dz - slope * k * m.dy;
        float c = m.ox * m.ox + m.oz * m.oz - k * k;
        float q = b * b - a * c;
        float root = sqrtf(q > 0.0f ? q : 0.0f);
        float s = b > 0.0f ? -b - root : root - b; /* without cancellation */
        float t1 = s / (a == 0.0f ? 1e-12f : a);
        float t2 = c / (s == 0.0f ? 1e-12f : s);
        float y1 = m.oy + t1 * m.dy;
        float y2 = m.oy + t2 * m.dy;
        t1 = ((q > 0.0f) & (y1 >= 0.0f) & (y1 <= length)) ? t1 : far;
        t2 = ((q > 0.0f) & (y2 >= 0.0f) & (y2 <= length)) ? t2 : far;
        best = t1 < best ? t1 : best;
        best = t2 < best ? t2 : best;

        float t = r.z0 + best;
        int hit = (t > (float)NEAREST) & (t < z[i]);
        z[i] = hit ? t : z[i];
        part[i] = hit ? r.id : part[i];
    }
}

static void draw_stamp_row(synth_canvas *canvas, int32_t id, int32_t y)
{
    const synth_stamp *stamp = &canvas->stamps[id];
    const rlf_camera *camera = &canvas->view.camera;
    size_t first = (size_t)y * (size_t)camera->width + (size_t)stamp->rect.x0;
    row r = {.z0 = (float)stamp->z0,
             .count = stamp->rect.x1 - stamp->rect.x0,
             .id = id,
             .z = canvas->z + first,
             .part = canvas->part + first};
    rlf_vec3 m = synth_view_ray(&canvas->view, stamp->rect.x0, y).direction;
    for (int k = 0; k < 3; k++) {
        double d = stamp->A[k][0] * m.x + stamp->A[k][1] * m.y + stamp->A[k][2];
        r.d[k] = (float)d;
        r.step_d[k] = (float)(stamp->A[k][0] / camera->fx);
        r.o[k] = (float)(d * stamp->z0 - stamp->offset[k]);
        r.step_o[k] = (float)(stamp->A[k][0] / camera->fx * stamp->z0);
    }
    switch (stamp->type) {
    case SYNTH_BOX: draw_box(r, stamp->half); break;
    case SYNTH_CONE: draw_cone(r, stamp); break;
    case SYNTH_FRUSTUM: draw_frustum(r, stamp); break;
    default: draw_ellipsoid(r); break;
    }
}

void synth_canvas_draw_row(synth_canvas *canvas, const float *static_z, int32_t y)
{
    const synth_rect *drawn = &canvas->drawn;
    size_t row_start = (size_t)y * (size_t)canvas->view.camera.width;
    for (int32_t x = drawn->x0; x < drawn->x1; x++) {
        canvas->z[row_start + (size_t)x] = static_z[row_start + (size_t)x];
        canvas->part[row_start + (size_t)x] = -1;
    }
    for (int32_t i = 0; i < canvas->stamp_count; i++) {
        const synth_rect *rect = &canvas->stamps[i].rect;
        if (y >= rect->y0 && y < rect->y1 && rect->x0 < rect->x1) {
            draw_stamp_row(canvas, i, y);
        }
    }
}

bool synth_canvas_next_run(const synth_canvas *canvas, int32_t x, int32_t y, synth_run *out)
{
    const int32_t *part = canvas->part + (size_t)y * (size_t)canvas->view.camera.width;
    const int32_t last = canvas->drawn.x1;
    while (x < last && part[x] < 0) {
        x++;
    }
    *out = (synth_run){x < last ? part[x] : -1, x, x};
    while (out->x1 < last && out->x1 - x < SYNTH_RUN_MOST && part[out->x1] == out->id) {
        out->x1++;
    }
    return x < last;
}
