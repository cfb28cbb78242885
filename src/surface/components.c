/* Connected components in two passes with union-find (Rosenfeld and Pfaltz 1966), O(pixels). */
#include "surface/steps.h"

static int32_t root_of(int32_t *parent, int32_t a)
{
    while (parent[a] != a) {
        parent[a] = parent[parent[a]]; /* path halving */
        a = parent[a];
    }
    return a;
}

/* The smaller root wins, so that a component is known by its first pixel in raster order. */
static int32_t join(int32_t *parent, int32_t a, int32_t b)
{
    a = root_of(parent, a);
    b = root_of(parent, b);
    int32_t low = a < b ? a : b;
    parent[a < b ? b : a] = low;
    return low;
}

static int32_t provisional_row(const rlf_work *work, int32_t width, ptrdiff_t row, int32_t count)
{
    const uint8_t *links = work->links + row;
    int32_t *component = work->component + row;
    for (int32_t x = 0; x < width; x++) {
        uint8_t link = links[x];
        if (!(link & RLF_LINK_MEMBER)) {
            component[x] = 0;
            continue;
        }
        bool left = (link & RLF_LINK_LEFT) != 0;
        bool up = (link & RLF_LINK_UP) != 0;
        if (left && up) {
            int32_t a = component[x - 1], b = component[x - width];
            component[x] = a == b ? a : join(work->parent, a, b);
        } else if (left) {
            component[x] = component[x - 1];
        } else if (up) {
            component[x] = component[x - width];
        } else {
            count++;
            work->parent[count] = count;
            component[x] = count;
        }
    }
    return count;
}

int32_t rlf_components_find(const rlf_reconstruct *stage)
{
    const rlf_work *work = &stage->work;
    int32_t width = stage->grid.width;
    int32_t provisional = 0;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        provisional = provisional_row(work, width, (ptrdiff_t)y * width, provisional);
    }
    int32_t count = 0;
    for (int32_t a = 1; a <= provisional; a++) {
        int32_t root = root_of(work->parent, a);
        work->map[a] = root == a ? ++count : work->map[root];
    }
    for (int32_t a = 1; a <= count; a++) {
        work->size[a] = 0;
    }
    for (int32_t i = 0; i < stage->grid.count; i++) {
        int32_t a = work->component[i];
        if (a != 0) {
            int32_t c = work->map[a];
            work->component[i] = c;
            work->size[c]++;
        }
    }
    return count;
}
