/* What a sensor drawn at random makes of true depth: time of flight, structured light or passive
 * stereo. Errors are alike in neighbouring pixels and partly last; what the second camera or the
 * projector does not see has no depth; stereo finds nothing where nothing is to match, and spreads
 * near edges; a rim has no depth. */
#include "sim/hash.h"
#include "sim/noise.h"
#include "kernel/kernel.h"

#include <string.h>

#define WIDTH SYNTH_DEPTH_WIDTH
#define NODES (WIDTH / 2 + 2)
#define FAT_MAX 8
#define ALWAYS 0xffffffffu  /* instead of a frame's number */
#define PATTERN_STEPS 8.0f  /* of a pixel's shift: structured light */
#define PATTERN_SIGMA 0.35f /* of these steps */
#define STEREO_SIGMA 0.07f  /* pixels */
#define STEREO_STEPS 32.0f  /* of a pixel's shift */
#define FAT_SHARE 0.03f     /* of the depth: a step that spreads */

typedef float row_of[WIDTH];

/* Standard normal numbers every `pitch` pixels, interpolated; times 1.5 for what that averages. */
static void smooth_row(uint32_t key, int32_t y, int32_t pitch, row_of out)
{
    float nodes[NODES];
    const float down = (float)(y % pitch) / (float)pitch;
    const uint32_t row = (uint32_t)(y / pitch);
    const uint32_t above = synth_hash2(key, row), below = synth_hash2(key, row + 1);
    const int32_t count = (WIDTH - 1) / pitch + 1;
    for (int32_t i = 0; i <= count; i++) {
        const float a = synth_normal(synth_hash(above + (uint32_t)i * 0x9e3779b9u));
        const float b = synth_normal(synth_hash(below + (uint32_t)i * 0x9e3779b9u));
        nodes[i] = 1.5f * (a + (b - a) * down);
    }
    for (int32_t i = 0, x = 0; i < count; i++) {
        const float step = (nodes[i + 1] - nodes[i]) / (float)pitch;
        for (int32_t k = 0; k < pitch && x < WIDTH; k++, x++) {
            out[x] = nodes[i] + step * (float)k;
        }
    }
}

/* The nearer of a pixel and those 2 rows above and below. */
RLF_KERNEL static void find_nearest_row(const float *above, const float *z, const float *below,
                                        float *restrict out)
{
    for (int32_t x = 0; x < WIDTH; x++) {
        const float first = above[x] > 0.0f ? above[x] : z[x];
        const float last = below[x] > 0.0f ? below[x] : z[x];
        const float least = first < last ? first : last;
        out[x] = least < z[x] ? least : z[x];
    }
}

/* The least of 2 fat + 1 pixels about each; `near` has `fat` more at either end. */
RLF_KERNEL static void spread(const float *near, const float *z, int32_t fat, float *restrict out)
{
    for (int32_t x = 0; x < WIDTH; x++) {
        out[x] = near[x];
    }
    for (int32_t k = 1; k <= 2 * fat; k++) {
        for (int32_t x = 0; x < WIDTH; x++) {
            out[x] = near[x + k] < out[x] ? near[x + k] : out[x];
        }
    }
    for (int32_t x = 0; x < WIDTH; x++) {
        out[x] = out[x] < z[x] * (1.0f - FAT_SHARE) ? out[x] : z[x];
    }
}

/* Depth as stereo sees edges: a window that reaches something nearer matches that. */
static void spread_row(const synth_noise *noise, const float *z, int32_t y, row_of out)
{
    const int32_t fat = noise->drawn->fat;
    const int32_t rows = y >= 2 && y < SYNTH_DEPTH_HEIGHT - 2 ? 2 : 0;
    float near[WIDTH + 2 * FAT_MAX];
    find_nearest_row(z - rows * WIDTH, z, z + rows * WIDTH, near + fat);
    for (int32_t k = 0; k < fat; k++) {
        near[k] = near[fat];
        near[WIDTH + fat + k] = near[WIDTH + fat - 1];
    }
    spread(near, z, fat, out);
}

/* 0 where the second camera, on the left, does not see the surface: something nearer on the right
 * has a shift that covers it. */
static void hide_shadow(float shift_m, row_of z, const float *seen)
{
    float edge = 1e9f;
    for (int32_t x = WIDTH - 1; x >= 0; x--) {
        const float place = seen[x] > 0.0f ? (float)x - shift_m / seen[x] : 1e9f;
        if (place > edge + 0.5f) {
            z[x] = 0.0f;
        } else {
            edge = place < edge ? place : edge;
        }
    }
}

/* A standard normal number for each pixel. */
RLF_KERNEL static void draw_normals(uint32_t key, float *restrict out)
{
    for (int32_t x = 0; x < WIDTH; x++) {
        out[x] = synth_normal(synth_hash(key + (uint32_t)x * 0x9e3779b9u));
    }
}

/* out = a out + b still + c moving. */
RLF_KERNEL static void mix_rows(float a, float b, float c, const float *still, const float *moving,
                                float *restrict out)
{
    for (int32_t x = 0; x < WIDTH; x++) {
        out[x] = a * out[x] + b * still[x] + c * moving[x];
    }
}

/* Noise of one row in standard deviations. */
static void draw_errors(const synth_noise *noise, const synth_noise_row *row, uint32_t key,
                        row_of out)
{
    const synth_drawn_noise *d = noise->drawn;
    const float alike = sqrtf(d->alike), own = sqrtf(1.0f - d->alike);
    row_of still, moving;
    smooth_row(synth_hash2(noise->seed, ALWAYS), row->y, d->pitch, still);
    smooth_row(synth_hash2(noise->seed + 1u, row->frame), row->y, d->pitch, moving);
    draw_normals(key, out);
    mix_rows(own, alike * sqrtf(d->lasting), alike * sqrtf(1.0f - d->lasting), still, moving, out);
}

/* Nothing where too little light comes back, or too little is there to match. */
RLF_KERNEL static void drop_dark(const float *margin, const float *luck, float *restrict z)
{
    for (int32_t x = 0; x < WIDTH; x++) {
        z[x] = margin[x] + luck[x] >= 0.0f ? z[x] : 0.0f;
    }
}

RLF_KERNEL static void add_axial(const float *sigma_mm, const float *error, float *restrict z)
{
    for (int32_t x = 0; x < WIDTH; x++) {
        const float noisy = z[x] + 0.001f * sigma_mm[x] * error[x];
        z[x] = z[x] > 0.0f ? noisy : 0.0f;
    }
}

/* A shift that is told in whole steps and errs by `sigma` of them. */
RLF_KERNEL static void put_in_steps(float shift_m, float steps, float sigma, const float *error,
                                    float *restrict z)
{
    const float all = steps * shift_m;
    for (int32_t x = 0; x < WIDTH; x++) {
        const float real = z[x] > 0.0f ? z[x] : 1.0f;
        const int32_t whole = (int32_t)(all / real + sigma * error[x] + 0.5f);
        const float told = all / (float)(whole < 1 ? 1 : whole);
        z[x] = z[x] > 0.0f ? told : 0.0f;
    }
}

/* What the row measures, metres; 0 = nothing. */
static void measure(const synth_noise *noise, const synth_noise_row *row, uint32_t key, row_of z)
{
    const synth_drawn_noise *d = noise->drawn;
    const size_t first = (size_t)row->y * WIDTH;
    row_of error, luck;
    draw_errors(noise, row, key, error);
    if (d->kind == SYNTH_STEREO) {
        smooth_row(synth_hash2(noise->seed + 2u, row->frame), row->y, d->pitch, luck);
    } else {
        draw_normals(key ^ 0x2545f491u, luck);
    }
    drop_dark(row->margin + first, luck, z);
    if (d->kind == SYNTH_FLIGHT) {
        add_axial(row->sigma + first, error, z);
    } else if (d->kind == SYNTH_PATTERN) {
        put_in_steps(d->shift_m, PATTERN_STEPS, PATTERN_SIGMA, error, z);
    } else {
        put_in_steps(d->shift_m, STEREO_STEPS, STEREO_STEPS * STEREO_SIGMA, error, z);
    }
}

RLF_KERNEL static void to_millimetres(float least, float most, const float *z,
                                      uint16_t *restrict out)
{
    for (int32_t x = 0; x < WIDTH; x++) {
        const float mm = 1000.0f * z[x];
        const int is_inside = (mm >= least) & (mm <= most);
        out[x] = (uint16_t)(is_inside ? (int32_t)(mm + 0.5f) : 0);
    }
}

static void cut_rim(const int32_t rim[4], int32_t y, uint16_t *out)
{
    if (y < rim[2] || y >= SYNTH_DEPTH_HEIGHT - rim[3]) {
        memset(out, 0, WIDTH * sizeof(*out));
        return;
    }
    memset(out, 0, (size_t)rim[0] * sizeof(*out));
    memset(out + WIDTH - rim[1], 0, (size_t)rim[1] * sizeof(*out));
}

void synth_noise_apply_drawn(const synth_noise *noise, const synth_noise_row *row, uint16_t *out)
{
    const synth_drawn_noise *d = noise->drawn;
    const float *truth = row->z + (size_t)row->y * WIDTH;
    const uint32_t key = synth_hash2(synth_hash2(noise->seed, row->frame), (uint32_t)row->y);
    row_of seen, z;
    if (d->fat > 0) {
        spread_row(noise, truth, row->y, seen);
    } else {
        memcpy(seen, truth, sizeof(seen));
    }
    memcpy(z, seen, sizeof(z));
    if (d->shift_m > 0.0f) {
        hide_shadow(d->shift_m, z, seen);
    }
    measure(noise, row, key, z);
    to_millimetres(noise->min_mm, noise->max_mm, z, out);
    if (!d->keeps_edges) {
        synth_noise_apply_jumps(noise, row, key, out);
    }
    cut_rim(d->rim, row->y, out);
}
