/* What surfaces look like: colour in visible light and reflectance at the sensor's 850 nm. */
#ifndef RLF_SIM_MATERIAL_H
#define RLF_SIM_MATERIAL_H

#include "kernel/kernel.h"
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

/* ---- light.c: one wide ceiling lamp and the light that the room itself gives back. */

/* A point to be lit, in the camera frame. */
typedef struct synth_site {
    rlf_vec3 p, normal;
} synth_site;

/* Light that falls on the site from a lamp at lamp_at: rgb, 1 = white paper looks white. `lamp` is
 * the visible share of the lamp (1 = no shadow), `sky` that of the room's own light, `down` a unit
 * vector towards the floor. */
RLF_KERNEL_PART rlf_vec3 synth_light(rlf_vec3 lamp_at, rlf_vec3 down, const synth_site *site,
                                     double lamp, double sky)
{
    rlf_vec3 to_lamp = rlf_sub(lamp_at, site->p);
    double distance2 = rlf_dot(to_lamp, to_lamp);
    double cosine = rlf_dot(site->normal, to_lamp) / sqrt(distance2);
    double direct = lamp * rlf_max(0.0, cosine) * 10.5 / (4.5 + distance2);
    double up =
        0.5 - 0.5 * rlf_dot(site->normal, down); /* 1 facing the ceiling, 0 facing the floor */
    double ambient = sky * (0.38 + 0.06 * up);
    /* warm lamp, bluish daylight, a little warm light back from the floor */
    return rlf_vec3_make(0.98 * direct + ambient * (1.02 - 0.06 * up), 0.92 * direct + ambient,
                         0.82 * direct + ambient * (0.94 + 0.14 * up));
}

/* Share of the lamp that the static parts leave visible: 0, 1 or between (penumbra). */
double synth_lamp_share(const synth_scene *scene, int32_t count, const synth_site *site);

/* Share of the room's light that nearby surfaces leave (ambient occlusion), 0..1. */
double synth_sky_share(const synth_scene *scene, int32_t count, const synth_site *site);

#endif
