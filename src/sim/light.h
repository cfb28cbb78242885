/* One wide ceiling lamp and the light that the room itself gives back. */
#ifndef RLF_SIM_LIGHT_H
#define RLF_SIM_LIGHT_H

#include "sim/scene.h"
#include "kernel/kernel.h"

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
