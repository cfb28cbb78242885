/* Procedural textures in integer arithmetic: the same bytes everywhere. */
#include "render/body_texture.h"

body_texture_kind body_texture_kind_of(rlf_shape_type type)
{
    switch (type) {
    case RLF_SHAPE_BOX: return BODY_TEXTURE_CRATE;
    case RLF_SHAPE_HULL: return BODY_TEXTURE_PLAIN;
    case RLF_SHAPE_SPHERE:
    case RLF_SHAPE_CAPSULE:
    case RLF_SHAPE_CYLINDER: break;
    }
    return BODY_TEXTURE_STRIPE;
}

probe_material body_material_of(rlf_shape_type type)
{
    const float roughness = type == RLF_SHAPE_BOX || type == RLF_SHAPE_HULL ? 0.6f : 0.35f;
    return (probe_material){0.0f, roughness};
}

/* Noise 0..15. */
static int32_t noise_at(int32_t x, int32_t y)
{
    uint32_t h = (uint32_t)x * 0x9e3779b1u ^ (uint32_t)y * 0x85ebca77u;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 13;
    return (int32_t)(h & 15u);
}

/* Noise 0..63 that is drawn out along x like wood grain: years of growth, and fibres, each linear
 * from one value to the next. */
static int32_t wood_grain(int32_t x, int32_t y)
{
    const int32_t bent = 8 * y + 5 * noise_at(x / 32, 7) * (32 - x % 32) / 32 +
                         5 * noise_at(x / 32 + 1, 7) * (x % 32) / 32;
    const int32_t year = bent / 40;
    const int32_t rest = bent % 40;
    const int32_t years = (noise_at(year, 3) * (40 - rest) + noise_at(year + 1, 3) * rest) / 40;
    const int32_t fibre =
        (noise_at(x / 16, y) * (16 - x % 16) + noise_at(x / 16 + 1, y) * (x % 16)) / 16;
    return 3 * years + fibre;
}

/* A board's brightness: a little darker towards its edges, which are rounded. `edge`: texels to the
 * nearest one. */
static int32_t board_brightness(int32_t light, int32_t edge, int32_t grain)
{
    static const int32_t round_off[4] = {62, 26, 10, 3};
    return light - 40 + grain - (edge < 4 ? round_off[edge] : 0);
}

/* Four planks, a frame round them, and a brace from corner to corner that shows orientation. */
static int32_t crate_brightness(int32_t x, int32_t y)
{
    const int32_t n = BODY_TEXTURE_SIZE;
    const int32_t frame = 15;
    const int32_t brace = 9;
    int32_t edge_x = x < n - 1 - x ? x : n - 1 - x;
    int32_t edge_y = y < n - 1 - y ? y : n - 1 - y;
    int32_t edge = edge_x < edge_y ? edge_x : edge_y;
    if (edge < frame) {
        const bool is_upright = edge_x < edge_y;
        const int32_t inner = frame - 1 - edge;
        const int32_t grain = is_upright ? wood_grain(y + 300, x) : wood_grain(x, y + 300);
        return board_brightness(226, edge < inner ? edge : inner, grain);
    }
    const int32_t off_diagonal = x > y ? x - y : y - x;
    if (off_diagonal < brace) {
        return board_brightness(222, brace - 1 - off_diagonal, wood_grain(x + y, y - x + n));
    }
    const int32_t shade = off_diagonal < brace + 4 ? 9 * (brace + 4 - off_diagonal) : 0;
    const int32_t below = edge < frame + 4 ? 9 * (frame + 4 - edge) : 0;
    const int32_t plank = (y - frame) / 25;
    const int32_t in_plank = (y - frame) % 25;
    const int32_t side = in_plank < 24 - in_plank ? in_plank : 24 - in_plank;
    const int32_t board =
        board_brightness(192 + 7 * (plank % 2), side, wood_grain(x + 370 * plank, y));
    return board - (shade > below ? shade : below);
}

/* Eight sectors with a band round the middle. */
static int32_t stripe_brightness(int32_t x, int32_t y)
{
    const int32_t n = BODY_TEXTURE_SIZE;
    if (y >= n / 2 - 5 && y < n / 2 + 5) {
        return 238;
    }
    return x / (n / 8) % 2 == 0 ? 255 : 196;
}

static int32_t brightness_of(body_texture_kind kind, int32_t x, int32_t y)
{
    switch (kind) {
    case BODY_TEXTURE_CRATE: return crate_brightness(x, y);
    case BODY_TEXTURE_STRIPE: return stripe_brightness(x, y);
    case BODY_TEXTURE_PLAIN:
    case BODY_TEXTURE_KINDS: break;
    }
    return 255;
}

static void fill_next_level(const uint8_t *from, int32_t from_size, uint8_t *to)
{
    int32_t size = from_size / 2;
    for (int32_t y = 0; y < size; y++) {
        for (int32_t x = 0; x < size; x++) {
            const uint8_t *p = from + 4 * ((size_t)(2 * y) * (size_t)from_size + 2 * (size_t)x);
            const uint8_t *q = p + 4 * (size_t)from_size;
            for (int c = 0; c < 4; c++) {
                *to++ = (uint8_t)((p[c] + p[c + 4] + q[c] + q[c + 4] + 2) / 4);
            }
        }
    }
}

size_t body_texture_level_offset(int32_t level)
{
    size_t offset = 0;
    for (int32_t i = 0; i < level; i++) {
        size_t size = (size_t)BODY_TEXTURE_SIZE >> i;
        offset += 4 * size * size;
    }
    return offset;
}

void body_texture_fill(body_texture_kind kind, uint8_t out[BODY_TEXTURE_BYTES])
{
    const int32_t n = BODY_TEXTURE_SIZE;
    for (int32_t y = 0; y < n; y++) {
        for (int32_t x = 0; x < n; x++) {
            uint8_t *p = out + 4 * ((size_t)y * (size_t)n + (size_t)x);
            const int32_t b = brightness_of(kind, x, y);
            p[0] = p[1] = p[2] = (uint8_t)b;
            p[3] = 255;
        }
    }
    for (int32_t level = 1; level < BODY_TEXTURE_LEVELS; level++) {
        fill_next_level(out + body_texture_level_offset(level - 1), n >> (level - 1),
                        out + body_texture_level_offset(level));
    }
}

int32_t body_texture_level_of(const rlf_shape *shape, double z, double focal)
{
    double extent = 2.0 * shape->radius;
    if (shape->type == RLF_SHAPE_BOX) {
        extent = rlf_max(shape->size.x, rlf_max(shape->size.y, shape->size.z));
    } else if (shape->type == RLF_SHAPE_HULL) {
        extent = 2.0 * rlf_shape_radius(shape);
    }
    double pixels = z > 0.0 ? focal * extent / z : BODY_TEXTURE_SIZE;
    int32_t level = 0;
    /* The next level when its texels are still no larger than about 1.4 pixels. */
    while (level < BODY_TEXTURE_LEVELS - 1 && (BODY_TEXTURE_SIZE >> level) > 1.4 * pixels) {
        level++;
    }
    return level;
}
