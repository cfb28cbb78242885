/* Parts of making a layer: what is beside a model's silhouette, and how much of a pixel it covers.
 */
#ifndef RLF_KNOWN_SILHOUETTE_H
#define RLF_KNOWN_SILHOUETTE_H

#include "camera/pixel_rect.h"
#include "known/form.h"
#include "known/layer.h"

/* The array with room for `more` further entries: it may move. NULL when there is no memory; the
 * old one is then still there. */
void *known_reserve(void *array, int32_t count, int32_t more, int32_t *capacity, size_t size);

/* Both of the model whose pixels are in `at`, all of them within the rectangle. False when there is
 * no memory. */
bool known_add_rims(known_layer *layer, pixel_rect r);
bool known_add_edges(known_layer *layer, const known_form *form, pixel_rect r);

#endif
