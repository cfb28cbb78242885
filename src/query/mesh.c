/* The organised triangle mesh (thesis fig. 4.3). */
#include "relief/surface.h"

size_t rlf_mesh_index_count(int32_t width, int32_t height)
{
    if (width < 2 || height < 2) {
        return 0;
    }
    return (size_t)(width - 1) * (size_t)(height - 1) * 6;
}

typedef struct square {
    uint32_t t1[3], t2[3];
} square;

static square square_at(uint32_t n, uint32_t w)
{
    square s = {{n, n + 1, n + w}, {n + 1, n + w + 1, n + w}};
    return s;
}

void rlf_mesh_indices(int32_t width, int32_t height, uint32_t *out)
{
    if (!RLF_ASSERT(out != NULL)) {
        return;
    }
    for (int32_t y = 0; y + 1 < height; y++) {
        for (int32_t x = 0; x + 1 < width; x++) {
            square s = square_at((uint32_t)y * (uint32_t)width + (uint32_t)x, (uint32_t)width);
            for (int k = 0; k < 3; k++) {
                out[k] = s.t1[k];
                out[3 + k] = s.t2[k];
            }
            out += 6;
        }
    }
}

static bool is_surface(const float *depth, const uint32_t corner[3], double max_jump)
{
    double low = depth[corner[0]];
    double high = low;
    for (int k = 1; k < 3; k++) {
        low = rlf_min(low, depth[corner[k]]);
        high = rlf_max(high, depth[corner[k]]);
    }
    return low > 0.0 && high - low <= max_jump * low;
}

/* Triangles of one square: those of the surface and, unless label is 0, of that region. */
static size_t add_square(const rlf_surface *surface, uint32_t n, double max_jump, int32_t label,
                         uint32_t *out)
{
    square s = square_at(n, (uint32_t)surface->width);
    const uint32_t *const triangles[2] = {s.t1, s.t2};
    size_t count = 0;
    for (int t = 0; t < 2; t++) {
        const uint32_t *corner = triangles[t];
        bool own = label == 0 ||
                   (surface->label[corner[0]] == label && surface->label[corner[1]] == label &&
                    surface->label[corner[2]] == label);
        for (int k = 0; own && is_surface(surface->depth, corner, max_jump) && k < 3; k++) {
            out[count++] = corner[k];
        }
    }
    return count;
}

size_t rlf_mesh_indices_valid(const rlf_surface *surface, double max_jump, uint32_t *out)
{
    size_t count = 0;
    if (!RLF_ASSERT(surface != NULL && surface->depth != NULL && out != NULL)) {
        return 0;
    }
    for (int32_t y = 0; y + 1 < surface->height; y++) {
        for (int32_t x = 0; x + 1 < surface->width; x++) {
            uint32_t n = (uint32_t)y * (uint32_t)surface->width + (uint32_t)x;
            count += add_square(surface, n, max_jump, 0, out + count);
        }
    }
    return count;
}

size_t rlf_mesh_indices_region(const rlf_surface *surface, const rlf_region *region,
                               double max_jump, uint32_t *out)
{
    size_t count = 0;
    if (!RLF_ASSERT(surface != NULL && surface->depth != NULL && surface->label != NULL &&
                    region != NULL && out != NULL)) {
        return 0;
    }
    for (int32_t y = region->y0; y + 1 < region->y1; y++) {
        for (int32_t x = region->x0; x + 1 < region->x1; x++) {
            uint32_t n = (uint32_t)y * (uint32_t)surface->width + (uint32_t)x;
            count += add_square(surface, n, max_jump, region->label, out + count);
        }
    }
    return count;
}
