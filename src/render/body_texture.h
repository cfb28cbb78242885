/* How bodies look: procedural textures and the light, shared by both renderers.
 *
 * A body's colour is its own times the texture's; probe.h says what light it sends. */
#ifndef RLF_RENDER_BODY_TEXTURE_H
#define RLF_RENDER_BODY_TEXTURE_H

#include "base/inside.h"
#include "relief/image.h"
#include "relief/model.h"
#include "relief/snapshot.h"
#include "render/probe.h"

enum {
    BODY_TEXTURE_SIZE = 128, /* pixels, a power of two, level 0 */
    BODY_TEXTURE_LEVELS = 8, /* 128, 64, ... 1 */
    BODY_TEXTURE_BYTES = 4 * (128 * 128 + 64 * 64 + 32 * 32 + 16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1)
};

/* Shares of the light around and of the lamp's that another body can take away: see caster.h. */
#define BODY_AMBIENT_SHARE 0.6
#define BODY_DIRECT_SHARE 0.85

typedef enum body_texture_kind {
    BODY_TEXTURE_CRATE = 0,  /* planks in a frame with a brace: boxes */
    BODY_TEXTURE_STRIPE = 1, /* beach ball: spheres, capsules, cylinders */
    BODY_TEXTURE_PLAIN = 2,  /* none: hulls, which have a form of their own */
    BODY_TEXTURE_KINDS = 3
} body_texture_kind;

body_texture_kind body_texture_kind_of(rlf_shape_type type) RLF_INSIDE(body_texture_kind_of);

/* Of a body that is drawn as its shape: wood of a crate, rubber of a ball. */
probe_material body_material_of(rlf_shape_type type) RLF_INSIDE(body_material_of);

/* Writes all levels one after the other, RGBA8, row 0 is v = 0, each level the mean of 2x2 of the
 * level before. */
void body_texture_fill(body_texture_kind kind, uint8_t out[BODY_TEXTURE_BYTES])
    RLF_INSIDE(body_texture_fill);
/* Byte offset of a level. */
size_t body_texture_level_offset(int32_t level) RLF_INSIDE(body_texture_level_offset);

/* The level to sample (bilinear, repeating) for a whole body: about one texel per pixel. One level
 * per body, so that every renderer takes the same. z is the depth of the body's centre in the
 * picture's camera, focal its focal length in pixels. */
int32_t body_texture_level_of(const rlf_shape *shape, double z, double focal)
    RLF_INSIDE(body_texture_level_of);

/* ---- model_texture.c: textures of models: pictures brought to powers of two, with all smaller
 * levels. */

/* Size and levels of the texture that a picture becomes; no texels yet. */
rlf_model_texture model_texture_fit(const rlf_image_rgba8 *image);
/* Of all levels. */
size_t model_texture_bytes(const rlf_model_texture *texture);
/* Writes all levels. Integer arithmetic: the same bytes everywhere. */
void model_texture_fill(const rlf_image_rgba8 *image, const rlf_model_texture *texture,
                        uint8_t *texels);

/* ---- Where a body is that is drawn as a model, for both renderers. */

/* Body frame, metres. */
static inline rlf_vec3 body_look_point(const rlf_look *look, const rlf_model_vertex *v)
{
    rlf_vec3 p = {(double)v->position[0], (double)v->position[1], (double)v->position[2]};
    return rlf_mad(look->offset, p, look->scale);
}

/* Largest distance from the body's origin to what is drawn of it. */
static inline double body_look_radius(const rlf_body_state *body)
{
    const rlf_look *look = &body->look;
    return look->model != NULL ? look->scale * look->model->radius + rlf_length(look->offset)
                               : rlf_shape_radius(&body->shape);
}

#endif
