/* Holes of registered depth, from the far side.
 *
 * Behind a near edge the colour camera sees a strip that the depth camera does not, of width
 * f b (1/z_near - 1/z_far); what is there belongs to the far surface (Fehn 2004), so the strip
 * takes the far side's depth. */
#include "camera/register.h"

#include <string.h>

/* A row or a column of the output, as bytes between neighbours. */
typedef struct fill_line {
    char *depth;
    uint8_t *state; /* NULL = not wanted */
    ptrdiff_t depth_step, state_step;
    int32_t first, count; /* pixels first <= i < count */
} fill_line;

static float *depth_at(const fill_line *line, int32_t i)
{
    return (float *)(void *)(line->depth + i * line->depth_step);
}

/* The usual case: pixels one behind the other. */
static bool is_row(const fill_line *line)
{
    return line->depth_step == (ptrdiff_t)sizeof(float);
}

/* Depth and state of pixels [begin, end). */
static void set_pixels(const fill_line *line, int32_t begin, int32_t end, float value)
{
    const uint8_t state = value > 0.0f ? RLF_REGISTERED_FILLED : RLF_REGISTERED_EMPTY;
    if (is_row(line)) {
        float *restrict depth = depth_at(line, 0);
        for (int32_t i = begin; i < end; i++) {
            depth[i] = value;
        }
        if (line->state != NULL) {
            memset(line->state + begin, state, (size_t)(end - begin));
        }
        return;
    }
    for (int32_t i = begin; i < end; i++) {
        *depth_at(line, i) = value;
        if (line->state != NULL) {
            line->state[i * line->state_step] = state;
        }
    }
}

/* The hole [begin, end): a gap between rectangles or a parallax shadow takes the far side's depth;
 * a wider one is where the depth camera saw nothing. */
static void fill_hole(const rlf_registration *r, const fill_line *line, int32_t begin, int32_t end)
{
    float value = 0.0f;
    if (begin > line->first && end < line->count) {
        float left = *depth_at(line, begin - 1);
        float right = *depth_at(line, end);
        float z_near = left < right ? left : right;
        float z_far = left < right ? right : left;
        float shadow = REGISTRATION_SHADOW * r->shadow_px_m * (1.0f / z_near - 1.0f / z_far);
        value = (float)(end - begin) <= shadow + (float)r->gap_px ? z_far : 0.0f;
    }
    set_pixels(line, begin, end, value);
}

/* First pixel from i on that has a depth, or has none. */
static int32_t find(const fill_line *line, int32_t i, bool has_depth)
{
    if (is_row(line)) {
        return rlf_kernel_find_seen(depth_at(line, 0), i, line->count, has_depth ? 1 : 0);
    }
    while (i < line->count && (*depth_at(line, i) < RLF_KERNEL_NOTHING) != has_depth) {
        i++;
    }
    return i;
}

static void fill_line_holes(const rlf_registration *r, const fill_line *line)
{
    int32_t begin = find(line, line->first, false);
    while (begin < line->count) {
        int32_t end = find(line, begin, true);
        fill_hole(r, line, begin, end);
        begin = find(line, end, false);
    }
}

static void fill_row(const rlf_registration *r, int32_t y, const pixel_rect *window,
                     const rlf_plane_f32 *depth, const rlf_plane_u8 *state)
{
    const fill_line line = {.depth = (char *)rlf_f32_row(depth, y),
                            .state = state->data != NULL ? rlf_u8_row(state, y) : NULL,
                            .depth_step = sizeof(float),
                            .state_step = 1,
                            .first = window->x0,
                            .count = window->x1};
    fill_line_holes(r, &line);
}

static void fill_column(const rlf_registration *r, int32_t x, const rlf_plane_f32 *depth,
                        const rlf_plane_u8 *state)
{
    const fill_line line = {.depth = (char *)(depth->data + x),
                            .state = state->data != NULL ? state->data + x : NULL,
                            .depth_step = depth->stride,
                            .state_step = state->stride,
                            .count = depth->height};
    fill_line_holes(r, &line);
}

void registration_fill_holes(const rlf_registration *r, const pixel_rect *window,
                             const rlf_plane_f32 *depth, const rlf_plane_u8 *state)
{
    const int32_t x0 = window->x0;
    for (int32_t y = window->y0; y < window->y1; y++) {
        if (state->data != NULL) {
            rlf_kernel_seen_row(rlf_f32_row(depth, y) + x0, window->x1 - x0,
                                rlf_u8_row(state, y) + x0);
        }
        if (!r->fills_columns) {
            fill_row(r, y, window, depth, state);
        }
    }
    for (int32_t x = 0; r->fills_columns && x < depth->width; x++) {
        fill_column(r, x, depth, state);
    }
}
