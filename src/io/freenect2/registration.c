/* Kinect v2: undistortion, depth to colour and the filter of hidden pixels.
 *
 * The order of every float operation is that of libfreenect2, so the results are the same bits.
 * What is different is the order of the work: the two passes over the 8 MB of big depth go along
 * with the rows of the depth picture, while those rows are still in the cache. */
#include "io/freenect2/freenect2.h"

#include <math.h>
#include <string.h>

#define WIDTH KINECT2_DEPTH_WIDTH
#define HEIGHT KINECT2_DEPTH_HEIGHT
#define BIG_WIDTH KINECT2_COLOR_WIDTH
#define BIG_SIZE (BIG_WIDTH * KINECT2_BIG_HEIGHT)

/* Half the window that a depth pixel covers in the colour picture. */
#define HALF_WIDE 2
#define HALF_HIGH 1
/* Share of its depth by which a pixel may lie behind what covers it. */
#define HIDDEN_TOLERANCE 0.01F

/* Scales of the factory's polynomial: depth pixels and colour pixels to its units. */
static const float depth_scale = 0.01F;
static const float color_scale = 0.002199F;

/* Colour rows that a depth row's windows reach, in rows of big depth. */
typedef struct reach {
    int32_t first, last;
} reach;

struct kinect2_registration {
    float fx, cx, shift_m;                /* of colour; cx with the half for rounding */
    int32_t source[KINECT2_DEPTH_PIXELS]; /* of each undistorted pixel; -1 = outside */
    float map_x[KINECT2_DEPTH_PIXELS];
    int32_t map_y[KINECT2_DEPTH_PIXELS];
    reach rows[HEIGHT];
    int32_t ready[HEIGHT]; /* the depth row after which this one's windows are complete */
    int32_t offset[KINECT2_DEPTH_PIXELS];
    float *memory, *big; /* big has HALF_WIDE floats before and behind it */
};

/* Where the lens puts an undistorted pixel. */
static void distort(const kinect2_ir *ir, float u, float v, float out[2])
{
    const float x = (u - ir->cx) / ir->fx;
    const float y = (v - ir->cy) / ir->fy;
    const float x2 = x * x;
    const float y2 = y * y;
    const float r2 = x2 + y2;
    const float xy = 2 * x * y;
    const float k = 1 + ((ir->k3 * r2 + ir->k2) * r2 + ir->k1) * r2;
    out[0] = ir->fx * (x * k + ir->p2 * (r2 + 2 * x2) + ir->p1 * xy) + ir->cx;
    out[1] = ir->fy * (y * k + ir->p1 * (r2 + 2 * y2) + ir->p2 * xy) + ir->cy;
}

/* The factory's cubics: x of the colour picture in units of its focal length without parallax, and
 * y in pixels. */
static void map_pixel(const kinect2_ir *ir, const kinect2_color *color, float u, float v,
                      float out[2])
{
    const float a = (u - ir->cx) * depth_scale;
    const float b = (v - ir->cy) * depth_scale;
    const float terms[10] = {a * a * a, b * b * b, a * a * b, b * b * a, a * a,
                             b * b,     a * b,     a,         b,         1.0F};
    float sum_x = terms[0] * color->mx[0];
    float sum_y = terms[0] * color->my[0];
    for (int i = 1; i < 10; i++) {
        sum_x = sum_x + terms[i] * color->mx[i];
        sum_y = sum_y + terms[i] * color->my[i];
    }
    out[0] = sum_x / (color->fx * color_scale) - color->shift_m / color->shift_d;
    out[1] = sum_y / color_scale + color->cy;
}

void kinect2_project(const kinect2_ir *ir, const kinect2_color *color, float u, float v, float z,
                     float out[2])
{
    float mapped[2];
    map_pixel(ir, color, u, v, mapped);
    out[0] = (mapped[0] + color->shift_m / z) * color->fx + color->cx;
    out[1] = mapped[1];
}

void kinect2_point(const kinect2_ir *ir, int u, int v, float depth_mm, float out[3])
{
    const float z = depth_mm / 1000.0F;
    if (isnan(z) || (double)z <= 0.001) {
        out[0] = out[1] = out[2] = NAN;
        return;
    }
    const float inverse_fx = 1 / ir->fx;
    const float inverse_fy = 1 / ir->fy;
    out[0] = (float)((u + 0.5 - (double)ir->cx) * (double)inverse_fx * (double)z);
    out[1] = (float)((v + 0.5 - (double)ir->cy) * (double)inverse_fy * (double)z);
    out[2] = z;
}

static int32_t clamp_row(int64_t row)
{
    return (int32_t)(row < 0 ? 0 : row > KINECT2_BIG_HEIGHT ? KINECT2_BIG_HEIGHT : row);
}

/* A depth row's colour rows: those of its pixels, one more each way for the window, and one more
 * since a window at the side of a row wraps to the next. */
static void find_reach(kinect2_registration *r, int32_t v)
{
    int32_t least = KINECT2_BIG_HEIGHT;
    int32_t most = -KINECT2_BIG_HEIGHT;
    for (int32_t i = v * WIDTH; i < (v + 1) * WIDTH; i++) {
        least = r->map_y[i] < least ? r->map_y[i] : least;
        most = r->map_y[i] > most ? r->map_y[i] : most;
    }
    /* Row y of colour is row y + 1 of big depth. */
    r->rows[v] = (reach){clamp_row((int64_t)least + 1 - HALF_HIGH - 1),
                         clamp_row((int64_t)most + 1 + HALF_HIGH + 1)};
}

/* The last depth row whose windows reach into the rows of row v. */
static void find_ready(kinect2_registration *r)
{
    for (int32_t v = 0; v < HEIGHT; v++) {
        r->ready[v] = v;
        for (int32_t w = v + 1; w < HEIGHT; w++) {
            if (r->rows[w].first <= r->rows[v].last) {
                r->ready[v] = w;
            }
        }
    }
    /* In order: a row is not read before those above it. */
    for (int32_t v = 1; v < HEIGHT; v++) {
        r->ready[v] = r->ready[v] > r->ready[v - 1] ? r->ready[v] : r->ready[v - 1];
    }
}

static int32_t to_row(float y)
{
    const float rounded = y + 0.5F;
    return rounded > -1e6F && rounded < 1e6F ? (int32_t)rounded : -KINECT2_BIG_HEIGHT;
}

static void fill_tables(kinect2_registration *r, const kinect2_ir *ir, const kinect2_color *color)
{
    for (int32_t i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
        const float u = (float)(i % WIDTH);
        const float v = (float)(i / WIDTH);
        float at[2];
        distort(ir, u, v, at);
        const bool is_near = fabsf(at[0]) < 1e6F && fabsf(at[1]) < 1e6F;
        const int32_t x = is_near ? (int32_t)(at[0] + 0.5F) : -1;
        const int32_t y = is_near ? (int32_t)(at[1] + 0.5F) : -1;
        const bool is_inside = x >= 0 && x < WIDTH && y >= 0 && y < HEIGHT;
        r->source[i] = is_inside ? y * WIDTH + x : -1;
        map_pixel(ir, color, u, v, at);
        r->map_x[i] = at[0];
        r->map_y[i] = to_row(at[1]);
    }
    for (int32_t v = 0; v < HEIGHT; v++) {
        find_reach(r, v);
    }
    find_ready(r);
}

rlf_result kinect2_registration_create(const kinect2_ir *ir, const kinect2_color *color,
                                       kinect2_registration **out)
{
    *out = NULL;
    kinect2_registration *r = rlf_alloc(sizeof(*r));
    float *memory = rlf_alloc_array(BIG_SIZE + 2 * HALF_WIDE, sizeof(float));
    if (r == NULL || memory == NULL) {
        rlf_free(r);
        rlf_free(memory);
        return RLF_ERROR_MEMORY;
    }
    r->memory = memory;
    r->big = memory + HALF_WIDE;
    r->fx = color->fx;
    r->cx = color->cx + 0.5F;
    r->shift_m = color->shift_m;
    fill_tables(r, ir, color);
    *out = r;
    return RLF_OK;
}

void kinect2_registration_destroy(kinect2_registration **registration)
{
    if (registration != NULL && *registration != NULL) {
        rlf_free((*registration)->memory);
        rlf_free(*registration);
        *registration = NULL;
    }
}

const float *kinect2_registration_big_depth(const kinect2_registration *registration)
{
    return registration->big;
}

/* Undistorted depth of row v and the colour pixel of each of its pixels. */
static void find_offsets(const kinect2_registration *r, const float *depth, int32_t v,
                         float *restrict undistorted, int32_t *restrict offset)
{
    const int32_t *source = r->source + v * WIDTH;
    const float *map_x = r->map_x + v * WIDTH;
    const int32_t *map_y = r->map_y + v * WIDTH;
    for (int32_t u = 0; u < WIDTH; u++) {
        undistorted[u] = source[u] < 0 ? 0.0F : depth[source[u]];
    }
    for (int32_t u = 0; u < WIDTH; u++) {
        const float z = undistorted[u];
        const float x = (map_x[u] + r->shift_m / z) * r->fx + r->cx;
        const bool is_valid = z > 0.0F && x > -1e6F && x < 1e6F;
        const int32_t at = (int32_t)(is_valid ? x : -1e7F) + map_y[u] * BIG_WIDTH;
        offset[u] = at < 0 || at >= KINECT2_COLOR_PIXELS ? -1 : at;
    }
}

static void clear_row(float *row)
{
    for (int32_t i = 0; i < BIG_WIDTH; i++) {
        row[i] = INFINITY;
    }
}

typedef float float4 __attribute__((vector_size(16)));
typedef int32_t int4 __attribute__((vector_size(16)));

/* One row of a window: each of five becomes the smaller of itself and z. */
static void lower(float window[2 * HALF_WIDE + 1], float z)
{
    const float4 lane_z = {z, z, z, z};
    float4 row;
    memcpy(&row, window, sizeof(row));
    const int4 is_less = (int4)(lane_z < row);
    const int4 least = ((int4)lane_z & is_less) | ((int4)row & ~is_less);
    window[4] = z < window[4] ? z : window[4];
    memcpy(window, &least, sizeof(least));
}

/* Each pixel lowers the 5 x 3 window round its colour pixel to its own depth. */
static void splat_row(float *big, const uint32_t *color, const float *undistorted,
                      const int32_t *offset)
{
    for (int32_t u = 0; u < WIDTH; u++) {
        if (offset[u] < 0) {
            continue;
        }
        __builtin_prefetch(color + offset[u]); /* wanted some rows later */
        const float z = undistorted[u];
        float *window = big + offset[u] - HALF_WIDE;
        for (int32_t row = 0; row <= 2 * HALF_HIGH; row++, window += BIG_WIDTH) {
            lower(window, z);
        }
    }
}

static void color_row(const float *big, const uint32_t *color, const float *undistorted,
                      const int32_t *offset, uint32_t *out)
{
    for (int32_t u = 0; u < WIDTH; u++) {
        out[u] = 0;
        if (offset[u] >= 0) {
            const float nearest = big[BIG_WIDTH + offset[u]];
            const float z = undistorted[u];
            const bool is_hidden = (z - nearest) / z > HIDDEN_TOLERANCE;
            out[u] = is_hidden ? 0 : color[offset[u]];
        }
    }
}

void kinect2_registration_apply(kinect2_registration *registration, const float *depth,
                                const uint32_t *color, const kinect2_registered *out)
{
    kinect2_registration *r = registration;
    int32_t filled = 0;  /* rows of big depth that are set to infinity */
    int32_t colored = 0; /* rows of out->color that are done */
    for (int32_t v = 0; v < HEIGHT; v++) {
        const int32_t begin = v * WIDTH;
        const int32_t end = v + 1 < HEIGHT ? r->rows[v].last + 1 : KINECT2_BIG_HEIGHT;
        for (; filled < end && filled < KINECT2_BIG_HEIGHT; filled++) {
            clear_row(r->big + filled * BIG_WIDTH);
        }
        find_offsets(r, depth, v, out->undistorted + begin, out->offset + begin);
        splat_row(r->big, color, out->undistorted + begin, out->offset + begin);
        for (; colored < HEIGHT && r->ready[colored] <= v; colored++) {
            const int32_t at = colored * WIDTH;
            color_row(r->big, color, out->undistorted + at, out->offset + at, out->color + at);
        }
    }
}
