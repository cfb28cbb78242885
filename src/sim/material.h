/* What surfaces look like: colour in visible light and reflectance at the sensor's 850 nm. */
#ifndef RLF_SIM_MATERIAL_H
#define RLF_SIM_MATERIAL_H

#include "sim/scene.h"

/* Linear RGB albedo, 0..1, at a point given in the shape's own frame. */
rlf_vec3 synth_albedo(const synth_part *part, rlf_vec3 local);

/* Share of infrared light that comes back, 0..1. */
double synth_infrared(const synth_part *part);

/* look.c: linear RGB albedo of a drawn part at a point of its own frame, and how much of a pattern
 * a stereo camera finds there: 1 = plenty, 0 = none. */
rlf_vec3 synth_look_albedo(const synth_look *look, rlf_vec3 local);
float synth_look_texture(const synth_part *part, rlf_vec3 local);

/* value_noise.c: a random number in 0..1 for each corner of a grid, and value noise between them,
 * one cell per unit. */
double synth_lattice(int32_t x, int32_t y);
double synth_value_noise(double x, double y);

/* Entry i is the sRGB code value of linear light (i + 0.5) / SYNTH_GAMMA_SIZE (IEC 61966-2-1). */
#define SYNTH_GAMMA_SIZE 4096
void synth_gamma_table(uint8_t table[SYNTH_GAMMA_SIZE]);

/* RGBA bytes of linear light, clamped to 0..1. */
static inline void synth_encode(const uint8_t gamma[SYNTH_GAMMA_SIZE], float r, float g, float b,
                                uint8_t out[4])
{
    const float light[3] = {r, g, b};
    for (int i = 0; i < 3; i++) {
        float level = light[i] * (float)SYNTH_GAMMA_SIZE;
        level = level < 0.0f ? 0.0f : level;
        level = level > (float)(SYNTH_GAMMA_SIZE - 1) ? (float)(SYNTH_GAMMA_SIZE - 1) : level;
        out[i] = gamma[(int32_t)level];
    }
    out[3] = 255;
}

#endif
