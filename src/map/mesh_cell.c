/* Marching cubes without its table: on each face of the cell every run of corners that are inside
 * is cut off by a line; the lines close to polygons. Two runs on a face are cut off one by one from
 * either side of it, so neighbouring cells always agree. */
#include "map/mesh_cell.h"

/* Corners one after the other, all faces the same way round as seen from outside of the cell. */
static const uint8_t faces[6][4] = {
    {0, 4, 6, 2}, {1, 3, 7, 5}, /* x = 0, 1 */
    {0, 1, 5, 4}, {2, 6, 7, 3}, /* y = 0, 1 */
    {0, 2, 3, 1}, {4, 5, 7, 6}, /* z = 0, 1 */
};

static int32_t edge_between(int32_t a, int32_t b)
{
    const int32_t difference = a ^ b, axis = difference >> 1; /* 1, 2, 4 to 0, 1, 2 */
    return axis * 8 + (a < b ? a : b);
}

/* From the edge where a run of corners ends to the edge where it began. */
static void cut_face(const uint8_t face[4], uint32_t inside, int8_t next[MAP_CELL_EDGES])
{
    for (int32_t i = 0; i < 4; i++) {
        const int32_t here = face[i], after = face[(i + 1) & 3];
        if ((inside >> here & 1) == 0 || (inside >> after & 1) != 0) {
            continue;
        }
        int32_t first = i;
        while ((inside >> face[(first + 3) & 3] & 1) != 0) {
            first = (first + 3) & 3;
        }
        const int32_t begin = edge_between(face[(first + 3) & 3], face[first]);
        next[edge_between(here, after)] = (int8_t)begin;
    }
}

int32_t map_cell_triangles(uint32_t inside, uint8_t edges[3 * MAP_CELL_TRIANGLES_MOST])
{
    int8_t next[MAP_CELL_EDGES];
    for (int32_t i = 0; i < MAP_CELL_EDGES; i++) {
        next[i] = -1;
    }
    for (int32_t i = 0; i < 6; i++) {
        cut_face(faces[i], inside, next);
    }
    int32_t count = 0;
    for (int32_t i = 0; i < MAP_CELL_EDGES; i++) {
        if (next[i] < 0) {
            continue;
        }
        /* A fan about the polygon's first corner. */
        int32_t b = next[i], c = next[b];
        next[i] = -1;
        next[b] = -1;
        while (c != i) {
            edges[3 * count] = (uint8_t)i;
            edges[3 * count + 1] = (uint8_t)c;
            edges[3 * count + 2] = (uint8_t)b;
            count++;
            b = c;
            const int32_t after = next[c];
            next[c] = -1;
            c = after;
        }
    }
    return count;
}
