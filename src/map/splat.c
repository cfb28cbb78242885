/* The first step of a prediction: voxels drawn as points (compare Prisacariu et al. 2014,
 * InfiniTAM, who draw the blocks' boxes): each pixel's ray then begins within two voxels of its
 * surface. */
#include "map/volume.h"

#include <string.h>

/* A cube's width from any side, in its edges: neighbours that touch leave no hole. */
#define DIAGONAL 1.7321f

/* A square of `size` pixels. One over the depth is linear in the picture on a plane, and is cut at
 * what the square's surface can have. */
typedef struct splat {
    float u, v, size;
    float inverse, by_x, by_y, least, most;
    int32_t block;
} splat;

static float least_of(float a, float b)
{
    return a < b ? a : b;
}

/* The tiles of these pixels have a surface as far as z. */
static void widen(map_caster *caster, int32_t x0, int32_t y0, int32_t x1, int32_t y1, float z)
{
    for (int32_t y = y0 / MAP_TILE; y <= y1 / MAP_TILE; y++) {
        float *row = &caster->out->tile_far[y * caster->tile_columns];
        for (int32_t x = x0 / MAP_TILE; x <= x1 / MAP_TILE; x++) {
            row[x] = row[x] > z ? row[x] : z;
        }
    }
}

/* At least one pixel, the nearest. */
static void draw_point(map_caster *caster, const splat *p)
{
    const int32_t width = caster->camera.width, height = caster->camera.height;
    const float half = 0.5f * (p->size > 1.0f ? p->size : 1.0f);
    const float right = least_of(p->u + half, (float)width - 0.5f);
    const float bottom = least_of(p->v + half, (float)height - 0.5f);
    const int32_t x0 = p->u - half > -1.0f ? (int32_t)(p->u - half + 1.0f) : 0;
    const int32_t y0 = p->v - half > -1.0f ? (int32_t)(p->v - half + 1.0f) : 0;
    if (!((float)x0 <= right && (float)y0 <= bottom)) {
        return;
    }
    const int32_t x1 = (int32_t)right, y1 = (int32_t)bottom;
    widen(caster, x0, y0, x1, y1, 1.0f / p->least + caster->slack);
    for (int32_t y = y0; y <= y1; y++) {
        const ptrdiff_t row = (ptrdiff_t)y * width;
        for (int32_t x = x0; x <= x1; x++) {
            float inverse = p->inverse + ((float)x - p->u) * p->by_x + ((float)y - p->v) * p->by_y;
            inverse = inverse > p->least ? least_of(inverse, p->most) : p->least;
            if (inverse > caster->out->depth[row + x]) {
                caster->out->depth[row + x] = inverse;
                caster->out->start[row + x] = p->block;
            }
        }
    }
}

/* All voxels in front of the surface, as large as they are: near surfaces have no holes then. */
static void draw_voxels(map_caster *caster, int32_t block, const float corner[3], float voxel_f)
{
    const rlf_camera *c = &caster->camera;
    const rlf_splat_camera camera = {(float)c->fx, (float)c->fy, (float)c->cx, (float)c->cy};
    rlf_fuse_place place = {.origin = {corner[0], corner[1], corner[2]}};
    memcpy(place.step, caster->step, sizeof(place.step));
    rlf_splat_points points;
    const map_block *b = map_block_at(&caster->map->volume, block);
    const int32_t count = rlf_kernel_splat_block(b, &place, &camera, &points);
    for (int32_t i = 0; i < count; i++) {
        const float z = points.z[i];
        if (z > 0.0f) {
            const float inverse = 1.0f / z;
            const splat p = {.u = points.u[i],
                             .v = points.v[i],
                             .size = DIAGONAL * voxel_f * inverse,
                             .inverse = inverse,
                             .least = inverse,
                             .most = inverse,
                             .block = block};
            draw_point(caster, &p);
        }
    }
}

/* The plane of a patch whose voxel is at q: one over depth at the square's middle, and its slopes.
 * False on faces that look away. */
static bool lay_plane(const map_caster *caster, const rlf_fuse_patch *patch, const float q[3],
                      splat *p)
{
    const float scale = caster->per_metre / 127.0f; /* steps are a voxel long */
    float n[3], offset = 0.0f, way2 = 0.0f;
    for (int32_t r = 0; r < 3; r++) {
        n[r] = scale * (caster->step[0][r] * (float)patch->normal[0] +
                        caster->step[1][r] * (float)patch->normal[1] +
                        caster->step[2][r] * (float)patch->normal[2]);
        offset += n[r] * q[r];
        way2 += q[r] * q[r];
    }
    if (offset > 0.0f && offset * offset > 0.1f * way2) {
        return false;
    }
    offset -= (float)patch->ahead / (256.0f * caster->per_metre);
    if (offset * offset > 0.01f * way2 && offset < 0.0f) {
        const float inverse = 1.0f / offset;
        p->by_x = n[0] * inverse / (float)caster->camera.fx;
        p->by_y = n[1] * inverse / (float)caster->camera.fy;
        p->inverse = n[2] * inverse + (p->u - (float)caster->camera.cx) * p->by_x +
                     (p->v - (float)caster->camera.cy) * p->by_y;
    }
    return true;
}

/* One square for each eighth of the block, about its middle, wide enough from any side, on the
 * plane of its surface. */
static void draw_eighths(map_caster *caster, int32_t block, const float corner[3], float voxel_f)
{
    const rlf_camera *c = &caster->camera;
    const rlf_fuse_patch *front = caster->map->volume.front[block];
    const float reach = 2.0f * DIAGONAL / caster->per_metre; /* half of the eighth's diagonal */
    for (int32_t k = 0; k < 8; k++) {
        const int32_t voxel = front[k].voxel;
        const float *to = caster->to_eighth[k], z = corner[2] + to[2];
        if (voxel == RLF_FUSE_NO_VOXEL || !(z > RLF_FUSE_NEAREST_M + reach)) {
            continue;
        }
        const float inverse = 1.0f / z;
        float q[3];
        for (int32_t r = 0; r < 3; r++) {
            q[r] = corner[r] + caster->step[0][r] * (float)(voxel & 7) +
                   caster->step[1][r] * (float)(voxel >> 3 & 7) +
                   caster->step[2][r] * (float)(voxel >> 6);
        }
        splat p = {.u = (float)c->fx * (corner[0] + to[0]) * inverse + (float)c->cx,
                   .v = (float)c->fy * (corner[1] + to[1]) * inverse + (float)c->cy,
                   .size = 4.0f * DIAGONAL * voxel_f * inverse,
                   .inverse = 1.0f / q[2],
                   .least = 1.0f / (z + reach),
                   .most = 1.0f / (z - reach),
                   .block = block};
        if (lay_plane(caster, &front[k], q, &p)) {
            draw_point(caster, &p);
        }
    }
}

/* Where a voxel is less than half a pixel, four of them are less than two. */
static void draw_block(map_caster *caster, int32_t block, const float corner[3])
{
    const rlf_camera *c = &caster->camera;
    const float voxel_f = (float)(caster->map->def.voxel_m * rlf_max(c->fx, c->fy));
    if (voxel_f < 0.5f * corner[2]) {
        draw_eighths(caster, block, corner, voxel_f);
    } else {
        draw_voxels(caster, block, corner, voxel_f);
    }
}

/* Whether a ball about p may be seen; margin: its radius in pixels at a metre, in the corners. */
static bool is_in_view(const rlf_camera *c, const float p[3], float radius, float margin)
{
    const float z = p[2], u = (float)c->fx * p[0] + (float)(c->cx + 1.0) * z;
    const float v = (float)c->fy * p[1] + (float)(c->cy + 1.0) * z;
    return (z > RLF_FUSE_NEAREST_M - radius) & (u > -margin) & (v > -margin) &
           (u < (float)(c->width + 1) * z + margin) & (v < (float)(c->height + 1) * z + margin);
}

static void begin(map_caster *caster)
{
    const rlf_mat3 *R = &caster->R_camera_world;
    const rlf_camera *c = &caster->camera;
    const double voxel = caster->map->def.voxel_m;
    const size_t rows = (size_t)(c->height + MAP_TILE - 1) / MAP_TILE;
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    caster->tile_columns = (c->width + MAP_TILE - 1) / MAP_TILE;
    caster->slack = (float)(4.0 * voxel);
    caster->per_metre = (float)(1.0 / voxel);
    memset(caster->out->tile_far, 0, rows * (size_t)caster->tile_columns * sizeof(float));
    memset(caster->out->depth, 0, pixels * sizeof(float));
    for (int32_t k = 0; k < 9; k++) {
        caster->step[k / 3][k % 3] = (float)(R->m[k % 3][k / 3] * voxel);
    }
    for (int32_t k = 0; k < 24; k++) { /* two or six voxels along each side */
        const int32_t eighth = k / 3, r = k % 3;
        const float x = (eighth & 1) != 0 ? 6.0f : 2.0f, y = (eighth & 2) != 0 ? 6.0f : 2.0f;
        const float z = (eighth & 4) != 0 ? 6.0f : 2.0f;
        caster->to_eighth[eighth][r] =
            x * caster->step[0][r] + y * caster->step[1][r] + z * caster->step[2][r];
    }
}

void map_splat(map_caster *caster)
{
    const map_volume *v = &caster->map->volume;
    const rlf_mat3 *R = &caster->R_camera_world;
    const double side = caster->map->def.voxel_m * MAP_SIDE, radius = 0.5 * DIAGONAL * side;
    const rlf_camera *camera = &caster->camera;
    const double across = rlf_max(camera->cx, camera->width - camera->cx) / camera->fx;
    const double down = rlf_max(camera->cy, camera->height - camera->cy) / camera->fy;
    const float margin = (float)(radius * rlf_max(camera->fx, camera->fy) *
                                 rlf_length(rlf_vec3_make(across, down, 1.0)));
    /* From the eye to the world's origin, and along a block's edges. */
    const rlf_vec3 origin = rlf_mat3_mul_vec(R, rlf_scale(caster->eye, -1.0));
    const float first[3] = {(float)origin.x, (float)origin.y, (float)origin.z};
    float edge[3][3];
    for (int32_t k = 0; k < 9; k++) {
        edge[k / 3][k % 3] = (float)(R->m[k / 3][k % 3] * side);
    }
    begin(caster);
    for (int32_t i = 0; i < v->high; i++) {
        if ((v->flags[i] & MAP_HAS_SURFACE) == 0) {
            continue;
        }
        const float a = (float)v->place[i][0], b = (float)v->place[i][1], c = (float)v->place[i][2];
        float corner[3], p[3];
        for (int32_t r = 0; r < 3; r++) {
            corner[r] = first[r] + (edge[r][0] * a + edge[r][1] * b + edge[r][2] * c);
            p[r] = corner[r] + 0.5f * (edge[r][0] + edge[r][1] + edge[r][2]);
        }
        if (is_in_view(camera, p, (float)radius, margin)) {
            draw_block(caster, i, corner);
        }
    }
}
