/* Textures of models: pictures brought to powers of two, with all smaller levels. */
#ifndef RLF_RENDER_MODEL_TEXTURE_H
#define RLF_RENDER_MODEL_TEXTURE_H

#include "relief/model.h"

/* Size and levels of the texture that a picture becomes; no texels yet. */
rlf_model_texture model_texture_fit(const rlf_image_rgba8 *image);
/* Of all levels. */
size_t model_texture_bytes(const rlf_model_texture *texture);
/* Writes all levels. Integer arithmetic: the same bytes everywhere. */
void model_texture_fill(const rlf_image_rgba8 *image, const rlf_model_texture *texture,
                        uint8_t *texels);

#endif
