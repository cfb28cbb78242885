/* The camera's exposure and the lamps' colour from the picture's mean: on the whole a room is grey
 * (Buchsbaum 1980), and a body is lit by the same lamps and seen by the same camera. */
#include "environment/light.h"

#define GREY 118.0f        /* sRGB of 18 % reflectance */
#define DARKEST 0.25f      /* of a body's colour */
#define TINT 0.15f         /* most that a channel differs from the mean: walls have colours too */
#define STEP 16            /* pixels between samples, both ways */
#define NEWEST_SHARE 0.05f /* of a frame in the level: about a second */

static float clamp(float x, float low, float high)
{
    return x < low ? low : (x > high ? high : x);
}

/* Means of the channels over GREY. */
static void measure(const rlf_image_rgba8 *image, float out[3])
{
    int64_t sum[3] = {0, 0, 0};
    int64_t count = 0;
    for (int32_t y = STEP / 2 < image->height ? STEP / 2 : 0; y < image->height; y += STEP) {
        const uint8_t *row = rlf_rgba8_row(image, y);
        for (int32_t x = STEP / 2 < image->width ? STEP / 2 : 0; x < image->width; x += STEP) {
            for (int k = 0; k < 3; k++) {
                sum[k] += row[4 * (ptrdiff_t)x + k];
            }
            count++;
        }
    }
    for (int k = 0; k < 3; k++) {
        out[k] = (float)sum[k] / (GREY * (float)count);
    }
}

static void take_in(room_light *l, const rlf_frame *frame)
{
    float now[3];
    measure(&frame->color, now);
    for (int k = 0; k < 3; k++) {
        float step = now[k] - l->level[k];
        l->level[k] += l->is_known ? NEWEST_SHARE * step : step;
    }
    l->sequence = frame->sequence;
    l->is_known = true;
}

void room_light_update(room_light *l, const float given[3], bool is_estimated,
                       const rlf_frame *frame)
{
    if (is_estimated && frame->color.data != NULL &&
        (!l->is_known || frame->sequence != l->sequence)) {
        take_in(l, frame);
    }
    float mean = (l->level[0] + l->level[1] + l->level[2]) * (1.0f / 3.0f);
    float brightness = clamp(mean, DARKEST, 1.0f);
    for (int k = 0; k < 3; k++) {
        float tint = mean > 0.0f ? clamp(l->level[k] / mean, 1.0f - TINT, 1.0f + TINT) : 1.0f;
        float found = l->is_known ? brightness * tint : 1.0f;
        l->color[k] = given[k] * (found < 1.0f ? found : 1.0f);
    }
}
