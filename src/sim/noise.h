/* How a time-of-flight camera spoils true depth: axial noise, lost returns, mixed pixels at jumps
 * and the driver's edge filter. */
#ifndef RLF_SIM_NOISE_H
#define RLF_SIM_NOISE_H

#include "kernel/kernel.h"
#include "relief/frame.h"

#define SYNTH_DEPTH_WIDTH 512
#define SYNTH_DEPTH_HEIGHT 424
#define SYNTH_INCIDENCE_STEPS 1024

typedef struct synth_noise {
    float incidence[SYNTH_INCIDENCE_STEPS + 1]; /* theta^2 / (pi/2 - theta)^2 over cos(theta) */
    uint32_t seed;
    bool enable;
    bool enable_edge_filter;
    bool enable_steps;                     /* structured light instead of time of flight */
    float min_mm, max_mm;                  /* the sensor's range */
    const struct synth_drawn_noise *drawn; /* borrowed: of a sensor drawn at random; NULL else */
} synth_noise;

/* A sensor drawn at random, see noise_drawn.c. */
typedef struct synth_drawn_noise {
    enum { SYNTH_FLIGHT, SYNTH_PATTERN, SYNTH_STEREO } kind;
    float shift_m;    /* pixels x metres: the shift of a match is this over depth; 0 = no shadow */
    float alike;      /* share of the noise that neighbours have in common, 0..1 */
    float lasting;    /* share of that which stays from frame to frame, 0..1 */
    int32_t pitch;    /* pixels between independent errors */
    int32_t fat;      /* pixels that a near edge spreads over what is behind: stereo; <= 8 */
    int32_t rim[4];   /* columns left and right, rows at the top and the bottom without depth */
    bool keeps_edges; /* no filter of mixed pixels */
    bool has_even_light; /* the corners get as much of it as the middle */
} synth_drawn_noise;

/* What the noise of one row needs. */
typedef struct synth_noise_row {
    const float *z;      /* true depth, metres, whole picture */
    const float *sigma;  /* axial noise, millimetres */
    const float *margin; /* amplitude above the threshold, in standard deviations */
    const uint8_t *jump; /* 1 at depth jumps */
    uint32_t frame;
    int32_t y;
} synth_noise_row;

void synth_noise_init(synth_noise *noise, uint64_t seed);

/* Axial standard deviation in mm at depth z (metres) and incidence cosine (Fankhauser et al. 2015,
 * "Kinect v2 for mobile robot navigation"): 1.5 - 0.5 z + 0.3 z^2 + 0.1 z^1.5 theta^2 / (pi/2 -
 * theta)^2, theta at most 80 degrees. */
float synth_noise_sigma(const synth_noise *noise, float z, float cosine);

/* Amplitude of the returned light above the driver's threshold, in standard deviations of it. */
float synth_noise_margin(float reflectance, float z, float cosine, float vignette);

/* How far what stereo finds to match, 0..1, is above what it needs; in the same unit. */
static inline float synth_noise_match(float texture)
{
    return (texture - 0.3f) * 12.0f;
}

/* Both at once of surfaces that reflect alike: `count` pixels of a row. */
typedef struct synth_noise_seen {
    float reflectance;
    const float *z, *cosine, *vignette;
    int32_t count;
} synth_noise_seen;
void synth_noise_find(const synth_noise *noise, const synth_noise_seen *seen, float *sigma,
                      float *margin);

/* Share of light that the lens passes at pixel (u, v). */
double synth_noise_vignette(double u, double v);

/* 1 where depth jumps between the neighbours of a pixel: `count` pixels from z on, none of them on
 * the border. */
void synth_noise_find_jumps(const float *z, int32_t count, uint8_t *out);

/* noise_steps.c: depth in metres at pixel (x, y) as structured light measures it; z > 0. */
float synth_noise_steps(const synth_noise *noise, uint32_t frame, int32_t x, int32_t y, float z);

/* Millimetres in steps of one; 0 outside the range. */
RLF_KERNEL_PART uint16_t synth_noise_quantise(float least, float most, float depth_mm)
{
    int is_inside = (depth_mm >= least) & (depth_mm <= most);
    return (uint16_t)(is_inside ? (int32_t)(depth_mm + 0.5f) : 0);
}

/* noise_drawn.c: what the drawn sensor delivers instead. */
void synth_noise_apply_drawn(const synth_noise *noise, const synth_noise_row *row, uint16_t *out);
/* noise_jumps.c: mixes and drops pixels of row y at jumps. */
void synth_noise_apply_jumps(const synth_noise *noise, const synth_noise_row *row, uint32_t key,
                             uint16_t *out);

/* Depth of row y in millimetres as the driver delivers it; 0 = missing. */
void synth_noise_apply(const synth_noise *noise, const synth_noise_row *row, uint16_t *out);

#endif
