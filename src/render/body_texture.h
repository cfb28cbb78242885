/* How bodies look: procedural textures and the light, shared by both renderers.
 *
 * A body's pixel is  sRGB = body colour * texture * light,  light = ambient + diffuse max(0, -n.l),
 * each as far as other bodies leave it, with the normal n and the light's direction l in the depth
 * camera's frame. */
#ifndef RLF_RENDER_BODY_TEXTURE_H
#define RLF_RENDER_BODY_TEXTURE_H

#include "base/inside.h"
#include "relief/image.h"
#include "relief/snapshot.h"

enum {
    BODY_TEXTURE_SIZE = 128, /* pixels, a power of two, level 0 */
    BODY_TEXTURE_LEVELS = 8, /* 128, 64, ... 1 */
    BODY_TEXTURE_BYTES = 4 * (128 * 128 + 64 * 64 + 32 * 32 + 16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1)
};

#define BODY_LIGHT_AMBIENT 0.45
#define BODY_LIGHT_DIFFUSE 0.55
/* Shares of the two that another body can take away: see caster.h. */
#define BODY_AMBIENT_SHARE 0.6
#define BODY_DIRECT_SHARE 0.85

typedef enum body_texture_kind {
    BODY_TEXTURE_CRATE = 0,  /* planks in a frame with a brace: boxes */
    BODY_TEXTURE_STRIPE = 1, /* beach ball: spheres, capsules, cylinders */
    BODY_TEXTURE_PLAIN = 2,  /* none: hulls, which have a form of their own */
    BODY_TEXTURE_KINDS = 3
} body_texture_kind;

body_texture_kind body_texture_kind_of(rlf_shape_type type) RLF_INSIDE(body_texture_kind_of);

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

#endif
