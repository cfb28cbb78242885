/* Windows that grow together. */
#include "environment/real_depth.h"

static bool meet(const pixel_rect *a, const pixel_rect *b)
{
    return a->x0 < b->x1 && b->x0 < a->x1 && a->y0 < b->y1 && b->y0 < a->y1;
}

static void widen(pixel_rect *window, const pixel_rect *by)
{
    window->x0 = by->x0 < window->x0 ? by->x0 : window->x0;
    window->y0 = by->y0 < window->y0 ? by->y0 : window->y0;
    window->x1 = by->x1 > window->x1 ? by->x1 : window->x1;
    window->y1 = by->y1 > window->y1 ? by->y1 : window->y1;
}

void real_windows_add(real_windows *windows, const pixel_rect *more)
{
    int32_t i = 0;
    while (i < windows->count && !meet(&windows->window[i], more)) {
        i++;
    }
    if (i == REAL_WINDOWS_MOST) {
        i--;
    }
    if (i == windows->count) {
        windows->window[windows->count++] = *more;
    }
    widen(&windows->window[i], more);
}

/* The first two windows that meet when they are drawn; false when none do. */
static bool find_pair(const real_windows *windows, const rlf_registration *registration,
                      double nearest, int32_t pair[2])
{
    pixel_rect drawn[REAL_WINDOWS_MOST];
    for (int32_t i = 0; i < windows->count; i++) {
        drawn[i] = registration_widen(registration, &windows->window[i], nearest);
        for (int32_t k = 0; k < i; k++) {
            if (meet(&drawn[k], &drawn[i])) {
                pair[0] = k;
                pair[1] = i;
                return true;
            }
        }
    }
    return false;
}

void real_windows_join(real_windows *windows, const rlf_registration *registration, double nearest)
{
    int32_t pair[2];
    while (find_pair(windows, registration, nearest, pair)) {
        widen(&windows->window[pair[0]], &windows->window[pair[1]]);
        windows->window[pair[1]] = windows->window[--windows->count];
    }
}
