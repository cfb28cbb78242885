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
    uint8_t *state;
    ptrdiff_t depth_step, state_step;
    int32_t count;
} fill_line;

static float *depth_at(const fill_line *line, int32_t i)
{
    return (float *)(void *)(line->depth + i * line->depth_step);
}

/* The hole [begin, end): a gap between rectangles or a parallax shadow takes the far side's depth;
 * a wider one is where the depth camera saw nothing. */
static void fill_hole(const rlf_registration *r, const fill_line *line, int32_t begin, int32_t end)
{
    float value = 0.0f;
    if (begin > 0 && end < line->count) {
        float left = *depth_at(line, begin - 1);
        float right = *depth_at(line, end);
        float z_near = left < right ? left : right;
        float z_far = left < right ? right : left;
        float shadow = 1.25f * r->shadow_px_m * (1.0f / z_near - 1.0f / z_far);
        value = (float)(end - begin) <= shadow + (float)r->gap_px ? z_far : 0.0f;
    }
    uint8_t state = value > 0.0f ? RLF_REGISTERED_FILLED : RLF_REGISTERED_EMPTY;
    for (int32_t i = begin; i < end; i++) {
        *depth_at(line, i) = value;
        line->state[i * line->state_step] = state;
    }
}

/* First pixel from i on whose state is `state`. */
static int32_t find(const fill_line *line, int32_t i, uint8_t state)
{
    if (line->state_step == 1) { /* rows, the usual case */
        const uint8_t *at = memchr(line->state + i, state, (size_t)(line->count - i));
        return at != NULL ? (int32_t)(at - line->state) : line->count;
    }
    while (i < line->count && line->state[i * line->state_step] != state) {
        i++;
    }
    return i;
}

static void fill_line_holes(const rlf_registration *r, const fill_line *line)
{
    int32_t begin = find(line, 0, RLF_REGISTERED_EMPTY);
    while (begin < line->count) {
        int32_t end = find(line, begin, RLF_REGISTERED_VISIBLE);
        fill_hole(r, line, begin, end);
        begin = find(line, end, RLF_REGISTERED_EMPTY);
    }
}

void registration_fill_holes(const rlf_registration *r, const rlf_plane_f32 *depth,
                             const rlf_plane_u8 *state)
{
    bool columns = r->fills_columns;
    for (int32_t y = 0; y < state->height; y++) {
        rlf_kernel_seen_row(rlf_f32_row(depth, y), state->width, rlf_u8_row(state, y));
    }
    int32_t lines = columns ? depth->width : depth->height;
    for (int32_t i = 0; i < lines; i++) {
        fill_line line = {
            (char *)depth->data + (columns ? i * (ptrdiff_t)sizeof(float) : i * depth->stride),
            state->data + (columns ? i : i * state->stride),
            columns ? depth->stride : (ptrdiff_t)sizeof(float),
            columns ? state->stride : 1,
            columns ? depth->height : depth->width,
        };
        fill_line_holes(r, &line);
    }
}
