/* One wide ceiling lamp and the light that the room itself gives back. */
#ifndef RLF_CAPTURE_SYNTHETIC_LIGHT_H
#define RLF_CAPTURE_SYNTHETIC_LIGHT_H

#include "capture/synthetic/scene.h"

/* A point to be lit, in the camera frame. */
typedef struct synth_site {
    rlf_vec3 p, normal;
} synth_site;

/* Light that falls on the site from a lamp at lamp_at: rgb, 1 = white paper looks white. `lamp` is
 * the visible share of the lamp (1 = no shadow) and `sky` that of the room's own light. */
rlf_vec3 synth_light(rlf_vec3 lamp_at, const synth_site *site, double lamp, double sky);

/* Share of the lamp that the static parts leave visible: 0, 1 or between (penumbra). */
double synth_lamp_share(const synth_scene *scene, int32_t count, const synth_site *site);

/* Share of the room's light that nearby surfaces leave (ambient occlusion), 0..1. */
double synth_sky_share(const synth_scene *scene, int32_t count, const synth_site *site);

#endif
