/* Square windows about a pixel, cut off at the image's border. */
#ifndef RLF_SURFACE_WINDOW_H
#define RLF_SURFACE_WINDOW_H

#include <stdbool.h>
#include <stdint.h>

/* Offsets from the pixel, both ends included. */
typedef struct rlf_window {
    int32_t x0, x1, y0, y1;
} rlf_window;

static inline int32_t rlf_least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* What of the window of `reach` pixels to each side is inside an image of that size. */
static inline rlf_window rlf_window_at(int32_t width, int32_t height, int32_t x, int32_t y,
                                       int32_t reach)
{
    return (rlf_window){-rlf_least(x, reach), rlf_least(width - 1 - x, reach), -rlf_least(y, reach),
                        rlf_least(height - 1 - y, reach)};
}

static inline bool rlf_window_is_whole(rlf_window w, int32_t reach)
{
    return w.x0 == -reach && w.x1 == reach && w.y0 == -reach && w.y1 == reach;
}

#endif
