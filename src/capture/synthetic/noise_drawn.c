/* What a sensor drawn at random makes of true depth: time of flight, structured light or passive
 * stereo. Errors are alike in neighbouring pixels and partly last; what the second camera or the
 * projector does not see has no depth; stereo finds nothing where nothing is to match, and spreads
 * near edges; a rim has no depth. */
#include "capture/synthetic/hash.h"
#include "capture/synthetic/noise.h"

#include <string.h>

#define WIDTH SYNTH_DEPTH_WIDTH
#define NODES (WIDTH / 2 + 2)
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
    for (int32_t i = 0; i <= (WIDTH - 1) / pitch + 1; i++) {
        const float a = synth_normal(synth_hash(above + (uint32_t)i * 0x9e3779b9u));
        const float b = synth_normal(synth_hash(below + (uint32_t)i * 0x9e3779b9u));
        nodes[i] = 1.5f * (a + (b - a) * down);
    }
    for (int32_t x = 0; x < WIDTH; x++) {
        const float share = (float)(x % pitch) / (float)pitch;
        out[x] = nodes[x / pitch] + (nodes[x / pitch + 1] - nodes[x / pitch]) * share;
    }
}

/* Depth as stereo sees edges: a window that reaches something nearer matches that. */
static void spread_row(const synth_noise *noise, const float *z, int32_t y, row_of out)
{
    const int32_t fat = noise->drawn->fat;
    const int32_t rows = y >= 2 && y < SYNTH_DEPTH_HEIGHT - 2 ? 1 : 0;
    row_of near;
    for (int32_t x = 0; x < WIDTH; x++) {
        const float above = z[x - rows * 2 * WIDTH], below = z[x + rows * 2 * WIDTH];
        const float least = above < below ? above : below;
        near[x] = least > 0.0f && least < z[x] ? least : z[x];
    }
    for (int32_t x = 0; x < WIDTH; x++) {
        float least = near[x];
        for (int32_t k = -fat; k <= fat; k++) {
            const int32_t at = x + k < 0 ? 0 : (x + k >= WIDTH ? WIDTH - 1 : x + k);
            least = near[at] > 0.0f && near[at] < least ? near[at] : least;
        }
        out[x] = least < z[x] * (1.0f - FAT_SHARE) ? least : z[x];
    }
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

/* Noise of one row in standard deviations. */
static void draw_errors(const synth_noise *noise, const synth_noise_row *row, uint32_t key,
                        row_of out)
{
    const synth_drawn_noise *d = noise->drawn;
    const float lasting = sqrtf(d->lasting), passing = sqrtf(1.0f - d->lasting);
    const float alike = sqrtf(d->alike), own = sqrtf(1.0f - d->alike);
    row_of still, moving;
    smooth_row(synth_hash2(noise->seed, ALWAYS), row->y, d->pitch, still);
    smooth_row(synth_hash2(noise->seed + 1u, row->frame), row->y, d->pitch, moving);
    for (int32_t x = 0; x < WIDTH; x++) {
        const float single = synth_normal(synth_hash(key + (uint32_t)x * 0x9e3779b9u));
        out[x] = own * single + alike * (lasting * still[x] + passing * moving[x]);
    }
}

static float in_steps(float shift_m, float steps, float z, float error)
{
    const float shift = steps * shift_m / z + error;
    const int32_t whole = (int32_t)(shift + 0.5f);
    return steps * shift_m / (float)(whole < 1 ? 1 : whole);
}

/* What the row measures, metres; 0 = nothing. */
static void measure(const synth_noise *noise, const synth_noise_row *row, uint32_t key, row_of z)
{
    const synth_drawn_noise *d = noise->drawn;
    const float *sigma = row->sigma + (size_t)row->y * WIDTH;
    const float *margin = row->margin + (size_t)row->y * WIDTH;
    row_of error, blot;
    draw_errors(noise, row, key, error);
    smooth_row(synth_hash2(noise->seed + 2u, row->frame), row->y, d->pitch, blot);
    for (int32_t x = 0; x < WIDTH; x++) {
        const uint32_t h = synth_hash(key + (uint32_t)x * 0x85ebca6bu + 1u);
        const float luck = d->kind == SYNTH_STEREO ? blot[x] : synth_normal(h);
        if (!(z[x] > 0.0f) || margin[x] + luck < 0.0f) {
            z[x] = 0.0f;
        } else if (d->kind == SYNTH_FLIGHT) {
            z[x] += 0.001f * sigma[x] * error[x];
        } else if (d->kind == SYNTH_PATTERN) {
            z[x] = in_steps(d->shift_m, PATTERN_STEPS, z[x], PATTERN_SIGMA * error[x]);
        } else {
            z[x] = in_steps(d->shift_m, STEREO_STEPS, z[x],
                            STEREO_STEPS * STEREO_SIGMA * error[x]);
        }
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
    for (int32_t x = 0; x < WIDTH; x++) {
        const float mm = 1000.0f * z[x];
        out[x] = mm >= noise->min_mm && mm <= noise->max_mm ? (uint16_t)(mm + 0.5f) : 0;
    }
    if (!d->keeps_edges) {
        synth_noise_apply_jumps(noise, row, key, out);
    }
    cut_rim(d->rim, row->y, out);
}
