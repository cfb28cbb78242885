/* Depth seen from the colour camera: forward warp with a z-buffer, then holes from the far side.
 *
 * Each depth pixel is a small rectangle in the colour image, as wide as the ratio of the focal
 * lengths, so that a smooth surface leaves no gaps; the nearest one wins. Behind a near edge the
 * colour camera sees a strip that the depth camera does not, of width f b (1/z_near - 1/z_far);
 * what is there belongs to the far surface (Fehn 2004), so the strip takes the far side's depth. */
#include "relief/camera.h"

#include <string.h>

#define NOTHING 1e30f     /* in the z-buffer: no surface yet */
#define SHIFT 64          /* makes pixel coordinates positive before they are cut to integers */
#define EDGE 0.02f        /* pixels a rectangle is widened, against rounding gaps */
#define SPLAT_MAX 48      /* pixels: half the widest rectangle, below SHIFT */
#define LENS_CELL 16      /* pixels between knots of the lens table: error below 0.02 px */
#define BLOCK 16          /* pixels looked at together */
#define LENS_KNOT_MAX 512 /* per axis */

/* Distortion as offsets from the pinhole pixel, bilinear between knots. */
typedef struct lens_table {
    float *du, *dv; /* NULL = no distortion; NOTHING outside the lens model */
    int32_t columns, rows;
    float left, top;                /* pinhole pixel of knot (0, 0) */
    float per_pixel_x, per_pixel_y; /* knots per pixel */
} lens_table;

/* One row of rectangles in colour pixels, inclusive; empty where x1 < x0. */
typedef struct splat_row {
    float *u, *v, *half_x, *half_y, *z;
    int32_t *x0, *x1, *y0, *y1;
} splat_row;

struct rlf_registration {
    int32_t width, height; /* of the depth grid */
    rlf_camera color;
    float *a, *b, *c;     /* colour pixel of ray (x, y, 1) at depth z: */
    float ta, tb, tc;     /* u = (z a + ta) / (z c + tc), v = (z b + tb) / (z c + tc) */
    float half_x, half_y; /* half a depth pixel, in colour pixels, at z c + tc = z */
    float shadow_px_m;    /* parallax along a fill line: pixels of shift times metres of depth */
    int32_t gap_px;       /* holes up to this are gaps between rectangles */
    bool fills_columns;   /* the baseline is more vertical than horizontal */
    lens_table lens;
    splat_row row;
};

/* ---- create --------------------------------------------------------------------------------- */

static double magnitude(double x)
{
    return x < 0.0 ? -x : x;
}

/* Tables of the pinhole part: K_color [R | t] applied to each ray. */
static void fill_tables(rlf_registration *r, const float *ray_x, const float *ray_y,
                        const rlf_pose *T)
{
    const rlf_camera *k = &r->color;
    size_t count = (size_t)r->width * (size_t)r->height;
    for (size_t i = 0; i < count; i++) {
        rlf_vec3 d = rlf_rotate(T->q, rlf_vec3_make(ray_x[i], ray_y[i], 1.0));
        r->a[i] = (float)(k->fx * d.x + k->cx * d.z);
        r->b[i] = (float)(k->fy * d.y + k->cy * d.z);
        r->c[i] = (float)d.z;
    }
    r->ta = (float)(k->fx * T->p.x + k->cx * T->p.z);
    r->tb = (float)(k->fy * T->p.y + k->cy * T->p.z);
    r->tc = (float)T->p.z;
}

/* Size of the rectangles and how wide a hole may be to be filled. */
static void measure(rlf_registration *r, const rlf_camera *depth, const rlf_pose *T)
{
    rlf_mat3 R = rlf_quat_to_mat3(T->q);
    const rlf_camera *k = &r->color;
    double width = k->fx * (magnitude(R.m[0][0]) / depth->fx + magnitude(R.m[0][1]) / depth->fy);
    double height = k->fy * (magnitude(R.m[1][0]) / depth->fx + magnitude(R.m[1][1]) / depth->fy);
    r->half_x = (float)rlf_min(0.5 * width, SPLAT_MAX);
    r->half_y = (float)rlf_min(0.5 * height, SPLAT_MAX);
    double shift_x = magnitude(k->fx * T->p.x);
    double shift_y = magnitude(k->fy * T->p.y);
    r->fills_columns = shift_y > shift_x;
    r->shadow_px_m = (float)rlf_max(shift_x, shift_y);
    double along = r->fills_columns ? height : width;
    r->gap_px = along > 1.0 + 1e-6 ? 2 * (int32_t)(along + 0.999) : 0;
}

/* Pinhole pixels that the distorted image shows, from its border. */
static void lens_bounds(const rlf_camera *k, double bounds[4])
{
    double ends[4] = {0, 0, k->width - 1.0, k->height - 1.0};
    for (int i = 0; i <= 64; i++) {
        double u = ends[2] * i / 64.0;
        double v = ends[3] * i / 64.0;
        const double border[4][2] = {{u, 0}, {u, ends[3]}, {0, v}, {ends[2], v}};
        for (int side = 0; side < 4; side++) {
            rlf_vec3 ray;
            if (rlf_camera_unproject(k, border[side][0], border[side][1], &ray)) {
                bounds[0] = rlf_min(bounds[0], k->fx * ray.x + k->cx);
                bounds[1] = rlf_min(bounds[1], k->fy * ray.y + k->cy);
                bounds[2] = rlf_max(bounds[2], k->fx * ray.x + k->cx);
                bounds[3] = rlf_max(bounds[3], k->fy * ray.y + k->cy);
            }
        }
    }
}

static rlf_result make_lens_table(rlf_registration *r)
{
    const rlf_camera *k = &r->color;
    lens_table *lens = &r->lens;
    double bounds[4] = {0, 0, k->width - 1.0, k->height - 1.0};
    lens_bounds(k, bounds);
    double cell_x = rlf_max(LENS_CELL, (bounds[2] - bounds[0]) / (LENS_KNOT_MAX - 3));
    double cell_y = rlf_max(LENS_CELL, (bounds[3] - bounds[1]) / (LENS_KNOT_MAX - 3));
    lens->columns = (int32_t)((bounds[2] - bounds[0]) / cell_x) + 3;
    lens->rows = (int32_t)((bounds[3] - bounds[1]) / cell_y) + 3;
    lens->left = (float)(bounds[0] - 0.5 * cell_x);
    lens->top = (float)(bounds[1] - 0.5 * cell_y);
    lens->per_pixel_x = (float)(1.0 / cell_x);
    lens->per_pixel_y = (float)(1.0 / cell_y);
    size_t count = (size_t)lens->columns * (size_t)lens->rows;
    lens->du = rlf_alloc_array(count, sizeof(float));
    lens->dv = rlf_alloc_array(count, sizeof(float));
    if (lens->du == NULL || lens->dv == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count; i++) {
        double u0 = lens->left + (double)(i % (size_t)lens->columns) * cell_x;
        double v0 = lens->top + (double)(i / (size_t)lens->columns) * cell_y;
        rlf_vec3 ray = {(u0 - k->cx) / k->fx, (v0 - k->cy) / k->fy, 1.0};
        double u, v;
        bool is_inside = rlf_camera_project(k, ray, &u, &v);
        lens->du[i] = is_inside ? (float)(u - u0) : NOTHING;
        lens->dv[i] = is_inside ? (float)(v - v0) : NOTHING;
    }
    return RLF_OK;
}

static rlf_result allocate(rlf_registration *r)
{
    size_t count = (size_t)r->width * (size_t)r->height;
    float **grids[3] = {&r->a, &r->b, &r->c};
    float **rows[5] = {&r->row.u, &r->row.v, &r->row.half_x, &r->row.half_y, &r->row.z};
    int32_t **limits[4] = {&r->row.x0, &r->row.x1, &r->row.y0, &r->row.y1};
    for (int i = 0; i < 3; i++) {
        *grids[i] = rlf_alloc_array(count, sizeof(float));
        if (*grids[i] == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    for (int i = 0; i < 5; i++) {
        *rows[i] = rlf_alloc_array((size_t)r->width, sizeof(float));
        if (*rows[i] == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    for (int i = 0; i < 4; i++) {
        *limits[i] = rlf_alloc_array((size_t)r->width, sizeof(int32_t));
        if (*limits[i] == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    return RLF_OK;
}

rlf_result rlf_registration_create(const rlf_camera *depth, const float *ray_x, const float *ray_y,
                                   const rlf_camera *color, const rlf_pose *T_color_depth,
                                   rlf_registration **out)
{
    if (!RLF_ASSERT(depth != NULL && ray_x != NULL && ray_y != NULL && color != NULL &&
                    T_color_depth != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = rlf_camera_check(depth, "registration: depth camera");
    if (result == RLF_OK) {
        result = rlf_camera_check(color, "registration: colour camera");
    }
    if (result != RLF_OK) {
        return result;
    }
    rlf_pose T = {T_color_depth->p, rlf_quat_normalize(T_color_depth->q)};
    if (!rlf_vec3_is_finite(T.p)) {
        return rlf_fail(RLF_ERROR_INVALID, "registration: depth_to_color is not finite; calibrate");
    }
    rlf_registration *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->width = depth->width;
    r->height = depth->height;
    r->color = *color;
    result = allocate(r);
    if (result == RLF_OK && color->distortion_model != RLF_DISTORTION_NONE) {
        result = make_lens_table(r);
    }
    if (result != RLF_OK) {
        rlf_registration_destroy(&r);
        return result;
    }
    fill_tables(r, ray_x, ray_y, &T);
    measure(r, depth, &T);
    *out = r;
    return RLF_OK;
}

void rlf_registration_destroy(rlf_registration **registration)
{
    if (registration == NULL || *registration == NULL) {
        return;
    }
    rlf_registration *r = *registration;
    void *parts[14] = {r->a,          r->b,          r->c,       r->row.u,  r->row.v,
                       r->row.half_x, r->row.half_y, r->row.z,   r->row.x0, r->row.x1,
                       r->row.y0,     r->row.y1,     r->lens.du, r->lens.dv};
    for (int i = 0; i < 14; i++) {
        rlf_free(parts[i]);
    }
    rlf_free(r);
    *registration = NULL;
}

/* ---- warp ----------------------------------------------------------------------------------- */

/* Pinhole projection of one row; z becomes 0 where nothing lands. */
static void project_row(rlf_registration *r, const float *depth, size_t first)
{
    const float *restrict a = r->a + first;
    const float *restrict b = r->b + first;
    const float *restrict c = r->c + first;
    splat_row row = r->row;
    float *restrict out_u = row.u;
    float *restrict out_v = row.v;
    float *restrict out_half_x = row.half_x;
    float *restrict out_half_y = row.half_y;
    float *restrict out_z = row.z;
    for (int32_t i = 0; i < r->width; i++) {
        float z = depth[i];
        float z_color = z * c[i] + r->tc;
        bool is_seen = z > 0.0f && z_color > 0.01f && z < 1e6f;
        float inverse = 1.0f / (is_seen ? z_color : 1.0f);
        float scale = z * inverse;
        scale = is_seen ? scale : 0.0f;
        out_u[i] = (z * a[i] + r->ta) * inverse;
        out_v[i] = (z * b[i] + r->tb) * inverse;
        out_half_x[i] = scale * r->half_x;
        out_half_y[i] = scale * r->half_y;
        out_z[i] = is_seen ? z_color : 0.0f;
    }
}

/* Moves pinhole pixels to where the lens puts them; outside the model they are dropped. */
static void distort_row(rlf_registration *r)
{
    const lens_table *lens = &r->lens;
    for (int32_t i = 0; i < r->width; i++) {
        float x = (r->row.u[i] - lens->left) * lens->per_pixel_x;
        float y = (r->row.v[i] - lens->top) * lens->per_pixel_y;
        if (!(x >= 0.0f && y >= 0.0f && x < (float)(lens->columns - 1) &&
              y < (float)(lens->rows - 1))) {
            r->row.z[i] = 0.0f;
            continue;
        }
        int32_t column = (int32_t)x;
        int32_t line = (int32_t)y;
        float s = x - (float)column;
        float t = y - (float)line;
        size_t knot = (size_t)line * (size_t)lens->columns + (size_t)column;
        size_t below = knot + (size_t)lens->columns;
        float du = (lens->du[knot] * (1 - s) + lens->du[knot + 1] * s) * (1 - t) +
                   (lens->du[below] * (1 - s) + lens->du[below + 1] * s) * t;
        float dv = (lens->dv[knot] * (1 - s) + lens->dv[knot + 1] * s) * (1 - t) +
                   (lens->dv[below] * (1 - s) + lens->dv[below + 1] * s) * t;
        r->row.u[i] += du;
        r->row.v[i] += dv;
    }
}

/* First and last pixel centre inside [centre - half, centre + half], and inside the image. */
static void cut_to_pixels(const float *restrict centre, const float *restrict half,
                          const float *restrict z, int32_t count, int32_t size,
                          int32_t *restrict out_first, int32_t *restrict out_last)
{
    const float limit = (float)size + SHIFT;
    for (int32_t i = 0; i < count; i++) {
        float low = centre[i] - half[i] + ((float)SHIFT + 1.0f - EDGE); /* cut = ceil + SHIFT */
        float high = centre[i] + half[i] + ((float)SHIFT + EDGE);       /* cut = floor + SHIFT */
        bool is_inside = z[i] > 0.0f && high >= (float)SHIFT && low < limit;
        low = is_inside && low > (float)SHIFT ? low : (float)SHIFT;
        high = is_inside ? high : 0.0f;
        high = high < limit ? high : limit;
        int32_t first = (int32_t)low - SHIFT;
        int32_t last = (int32_t)high - SHIFT;
        out_first[i] = first;
        out_last[i] = last < size ? last : size - 1;
    }
}

/* Keeps the nearest surface of every pixel that a rectangle covers. */
static void splat(const rlf_registration *r, const rlf_plane_f32 *out)
{
    const splat_row *row = &r->row;
    for (int32_t i = 0; i < r->width; i++) {
        int32_t x0 = row->x0[i];
        int32_t x1 = row->x1[i];
        int32_t y0 = row->y0[i];
        int32_t y1 = row->y1[i];
        float z = row->z[i];
        if (x1 < x0 || y1 < y0) {
            continue;
        }
        if (x1 - x0 <= 1) { /* the usual size; rows of rectangles mostly share their height */
            for (int32_t y = y0; y <= y1; y++) {
                float *line = rlf_f32_row(out, y);
                float left = line[x0];
                float right = line[x1];
                line[x0] = z < left ? z : left;
                line[x1] = z < right ? z : right;
            }
            continue;
        }
        for (int32_t y = y0; y <= y1; y++) {
            float *line = rlf_f32_row(out, y);
            for (int32_t x = x0; x <= x1; x++) {
                line[x] = z < line[x] ? z : line[x];
            }
        }
    }
}

/* ---- holes ---------------------------------------------------------------------------------- */

/* A row or a column of the output, as bytes between neighbours. */
typedef struct fill_line {
    char *depth;
    uint8_t *state;
    ptrdiff_t depth_step, state_step;
    int32_t count;
} fill_line;

static float *depth_at(const fill_line *line, int32_t i)
{
    return (float *)(void *)(line->depth + i * line->depth_step);
}

/* The hole [begin, end): a gap between rectangles or a parallax shadow takes the far side's depth;
 * a wider one is where the depth camera saw nothing. */
static void fill_hole(const rlf_registration *r, const fill_line *line, int32_t begin, int32_t end)
{
    float value = 0.0f;
    if (begin > 0 && end < line->count) {
        float left = *depth_at(line, begin - 1);
        float right = *depth_at(line, end);
        float z_near = left < right ? left : right;
        float z_far = left < right ? right : left;
        float shadow = 1.25f * r->shadow_px_m * (1.0f / z_near - 1.0f / z_far);
        value = (float)(end - begin) <= shadow + (float)r->gap_px ? z_far : 0.0f;
    }
    uint8_t state = value > 0.0f ? RLF_REGISTERED_FILLED : RLF_REGISTERED_EMPTY;
    for (int32_t i = begin; i < end; i++) {
        *depth_at(line, i) = value;
        line->state[i * line->state_step] = state;
    }
}

/* End of the run of seen pixels from i on. Rows, the usual case, are looked at in blocks. */
static int32_t skip_seen(const fill_line *line, int32_t i)
{
    if (line->depth_step == (ptrdiff_t)sizeof(float)) {
        const float *z = depth_at(line, 0);
        for (; i + BLOCK <= line->count; i += BLOCK) {
            int32_t holes = 0;
            for (int32_t k = 0; k < BLOCK; k++) {
                holes |= z[i + k] < NOTHING ? 0 : 1;
            }
            if (holes != 0) {
                break;
            }
        }
    }
    while (i < line->count && *depth_at(line, i) < NOTHING) {
        i++;
    }
    return i;
}

static void fill_line_holes(const rlf_registration *r, const fill_line *line)
{
    for (int32_t i = skip_seen(line, 0); i < line->count; i = skip_seen(line, i)) {
        int32_t begin = i;
        while (i < line->count && !(*depth_at(line, i) < NOTHING)) {
            i++;
        }
        fill_hole(r, line, begin, i);
    }
}

static void fill_holes(const rlf_registration *r, const rlf_plane_f32 *depth,
                       const rlf_plane_u8 *state)
{
    bool columns = r->fills_columns;
    for (int32_t y = 0; y < state->height; y++) {
        memset(rlf_u8_row(state, y), RLF_REGISTERED_VISIBLE, (size_t)state->width);
    }
    int32_t lines = columns ? depth->width : depth->height;
    for (int32_t i = 0; i < lines; i++) {
        fill_line line = {
            (char *)depth->data + (columns ? i * (ptrdiff_t)sizeof(float) : i * depth->stride),
            state->data + (columns ? i : i * state->stride),
            columns ? depth->stride : (ptrdiff_t)sizeof(float),
            columns ? state->stride : 1,
            columns ? depth->height : depth->width,
        };
        fill_line_holes(r, &line);
    }
}

void rlf_registration_apply(rlf_registration *r, const float *depth, const rlf_plane_f32 *out_depth,
                            const rlf_plane_u8 *out_state)
{
    if (!RLF_ASSERT(r != NULL && depth != NULL && out_depth != NULL && out_state != NULL) ||
        !RLF_ASSERT(out_depth->width == r->color.width && out_depth->height == r->color.height &&
                    out_state->width == r->color.width && out_state->height == r->color.height)) {
        return;
    }
    for (int32_t y = 0; y < out_depth->height; y++) {
        float *line = rlf_f32_row(out_depth, y);
        for (int32_t x = 0; x < out_depth->width; x++) {
            line[x] = NOTHING;
        }
    }
    const splat_row *row = &r->row;
    for (int32_t y = 0; y < r->height; y++) {
        size_t first = (size_t)y * (size_t)r->width;
        project_row(r, depth + first, first);
        if (r->lens.du != NULL) {
            distort_row(r);
        }
        cut_to_pixels(row->u, row->half_x, row->z, r->width, r->color.width, row->x0, row->x1);
        cut_to_pixels(row->v, row->half_y, row->z, r->width, r->color.height, row->y0, row->y1);
        splat(r, out_depth);
    }
    fill_holes(r, out_depth, out_state);
}
