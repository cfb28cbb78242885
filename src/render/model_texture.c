/* A texture's levels: means over areas, in integers. */
#include "render/body_texture.h"

/* The power of two nearest to a size, by ratio. */
static int32_t nearest_power(int32_t size)
{
    int64_t power = 1;
    while (2 * power * power < (int64_t)size * size && power < RLF_MODEL_TEXTURE_MAX) {
        power *= 2;
    }
    return (int32_t)power;
}

static int32_t half(int32_t size)
{
    return size > 1 ? size / 2 : 1;
}

rlf_model_texture model_texture_fit(const rlf_image_rgba8 *image)
{
    rlf_model_texture t = {NULL, nearest_power(image->width), nearest_power(image->height), 1};
    for (int32_t w = t.width, h = t.height; w > 1 || h > 1; w = half(w), h = half(h)) {
        t.level_count++;
    }
    return t;
}

size_t rlf_model_texture_level(const rlf_model_texture *texture, int32_t level, int32_t *out_width,
                               int32_t *out_height)
{
    size_t offset = 0;
    if (!RLF_ASSERT(texture != NULL && out_width != NULL && out_height != NULL)) {
        return 0;
    }
    int32_t w = texture->width;
    int32_t h = texture->height;
    for (int32_t i = 0; i < level; i++) {
        offset += 4 * (size_t)w * (size_t)h;
        w = half(w);
        h = half(h);
    }
    *out_width = w;
    *out_height = h;
    return offset;
}

size_t model_texture_bytes(const rlf_model_texture *texture)
{
    int32_t w, h;
    return rlf_model_texture_level(texture, texture->level_count, &w, &h);
}

/* How much of source cell `from` lies in target cell `to`, when `sources` cells become `targets`:
 * in shares of 1 / (sources * targets). */
static int64_t overlap(int64_t from, int64_t sources, int64_t to, int64_t targets)
{
    int64_t low = from * targets > to * sources ? from * targets : to * sources;
    int64_t from_end = (from + 1) * targets;
    int64_t to_end = (to + 1) * sources;
    int64_t high = from_end < to_end ? from_end : to_end;
    return high > low ? high - low : 0;
}

/* Mean of the picture over one texel of level 0. */
static void mean_of(const rlf_image_rgba8 *image, const rlf_model_texture *t, int64_t x, int64_t y,
                    uint8_t *out)
{
    const int64_t w = image->width;
    const int64_t h = image->height;
    uint64_t sum[4] = {0, 0, 0, 0};
    for (int64_t j = y * h / t->height; j < h && j * t->height < (y + 1) * h; j++) {
        const uint8_t *row = rlf_rgba8_row(image, (int32_t)j);
        uint64_t down = (uint64_t)overlap(j, h, y, t->height);
        for (int64_t i = x * w / t->width; i < w && i * t->width < (x + 1) * w; i++) {
            uint64_t weight = down * (uint64_t)overlap(i, w, x, t->width);
            for (int c = 0; c < 4; c++) {
                sum[c] += weight * row[4 * i + c];
            }
        }
    }
    uint64_t all = (uint64_t)(w * h);
    for (int c = 0; c < 4; c++) {
        out[c] = (uint8_t)((sum[c] + all / 2) / all);
    }
}

/* Means of 2x2, or of 2 along a side that is 1 already. */
static void fill_next(const uint8_t *from, int32_t from_width, int32_t from_height, uint8_t *to)
{
    int32_t width = half(from_width);
    int32_t height = half(from_height);
    ptrdiff_t right = from_width > 1 ? 4 : 0;
    ptrdiff_t below = from_height > 1 ? 4 * (ptrdiff_t)from_width : 0;
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            const uint8_t *p = from + y * 2 * below + x * 2 * right;
            for (int c = 0; c < 4; c++) {
                *to++ =
                    (uint8_t)((p[c] + p[c + right] + p[c + below] + p[c + right + below] + 2) / 4);
            }
        }
    }
}

void model_texture_fill(const rlf_image_rgba8 *image, const rlf_model_texture *texture,
                        uint8_t *texels)
{
    for (int32_t y = 0; y < texture->height; y++) {
        for (int32_t x = 0; x < texture->width; x++) {
            mean_of(image, texture, x, y, texels + 4 * ((ptrdiff_t)y * texture->width + x));
        }
    }
    for (int32_t level = 1; level < texture->level_count; level++) {
        int32_t w, h, next_w, next_h;
        size_t from = rlf_model_texture_level(texture, level - 1, &w, &h);
        size_t to = rlf_model_texture_level(texture, level, &next_w, &next_h);
        fill_next(texels + from, w, h, texels + to);
    }
}
