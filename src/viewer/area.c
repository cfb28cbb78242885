/* Where the picture is in the window, and images to lay over it. */
#include "viewer/state.h"

#include <string.h>

void viewer_get_area(const viewer *v, int32_t *out_width, int32_t *out_height)
{
    viewer_window_get_size(&v->window, out_width, out_height);
    *out_width -= v->window.panel_width < *out_width ? v->window.panel_width : 0;
}

bool viewer_is_overlay_shown(const viewer *v)
{
    return viewer_screen_is_full(&v->window) ? v->shows_overlay_in_full : v->shows_overlay;
}

bool viewer_clear_image(rlf_image_rgba8 *image, size_t *room, int32_t width, int32_t height)
{
    const size_t size = 4 * (size_t)width * (size_t)height;
    if (size > *room) {
        rlf_free(image->data);
        image->data = rlf_alloc(size);
        *room = image->data != NULL ? size : 0;
    }
    if (image->data == NULL) {
        return false;
    }
    *image = (rlf_image_rgba8){image->data, width, height, 4 * (ptrdiff_t)width};
    memset(image->data, 0, size);
    return true;
}
