/* A layer of the live surface as the triangles that other engines take. */
#include "peer.h"

#include <stdlib.h>

#define JUMP 0.05 /* m and more from pixel to pixel, or this share of the depth: an edge */

bool peer_mesher_open(peer_mesher *out, const rlf_grid *grid)
{
    size_t pixels = (size_t)grid->width * (size_t)grid->height;
    out->vertices = malloc(3 * pixels * sizeof(*out->vertices));
    out->triangles = malloc(6 * pixels * sizeof(*out->triangles));
    return out->vertices != NULL && out->triangles != NULL;
}

void peer_mesher_close(peer_mesher *mesher)
{
    free(mesher->vertices);
    free(mesher->triangles);
    *mesher = (peer_mesher){NULL, NULL};
}

static bool is_close(const rlf_grid_sheet *sheet, const int32_t corners[3])
{
    double low = 1e9, high = 0.0;
    for (int i = 0; i < 3; i++) {
        bool is_there = sheet->mask == NULL || sheet->mask[corners[i]] != 0;
        double z = is_there ? (double)sheet->depth[corners[i]] : 0.0;
        low = rlf_min(low, z);
        high = rlf_max(high, z);
    }
    return low > 0.0 && high - low < rlf_max(JUMP, 0.5 * JUMP * high);
}

peer_mesh peer_mesh_of(peer_mesher *mesher, const rlf_grid *grid, const rlf_grid_sheet *sheet)
{
    int32_t w = grid->width, pixels = w * grid->height;
    peer_mesh mesh = {mesher->vertices, mesher->triangles, pixels, 0};
    for (int32_t i = 0; i < pixels; i++) {
        float z = sheet->depth[i];
        mesher->vertices[3 * i] = z * grid->ray_x[i];
        mesher->vertices[3 * i + 1] = z * grid->ray_y[i];
        mesher->vertices[3 * i + 2] = z;
    }
    for (int32_t i = 0; i < pixels - w; i++) {
        const int32_t halves[2][3] = {{i, i + w, i + 1}, {i + 1, i + w, i + w + 1}};
        for (int32_t k = 0; k < 2 && i % w < w - 1; k++) {
            if (is_close(sheet, halves[k])) {
                uint32_t *t = &mesher->triangles[3 * mesh.triangle_count++];
                for (int32_t corner = 0; corner < 3; corner++) {
                    t[corner] = (uint32_t)halves[k][corner];
                }
            }
        }
    }
    return mesh;
}
