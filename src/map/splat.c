/* The first step of a prediction: voxels drawn as points (compare Prisacariu et al. 2014,
 * InfiniTAM, who draw the blocks' boxes): each pixel's ray then begins within two voxels of its
 * surface. */
#include "map/predict.h"

#define NEAREST_M 0.05

/* What a block covers of the picture. */
typedef struct pixel_box {
    double x0, y0, x1, y1, far_z;
} pixel_box;

/* False when nothing of a box about `middle` is in the picture. `half` is half of its extent along
 * the camera's axes. */
static bool cover(const rlf_camera *c, rlf_vec3 middle, rlf_vec3 half, pixel_box *out)
{
    const double far_z = middle.z + half.z, near_z = rlf_max(middle.z - half.z, NEAREST_M);
    if (!(far_z > NEAREST_M)) {
        return false;
    }
    const double left = middle.x - half.x, right = middle.x + half.x;
    const double top = middle.y - half.y, bottom = middle.y + half.y;
    out->x0 = c->cx + c->fx * left / (left < 0.0 ? near_z : far_z);
    out->x1 = c->cx + c->fx * right / (right > 0.0 ? near_z : far_z);
    out->y0 = c->cy + c->fy * top / (top < 0.0 ? near_z : far_z);
    out->y1 = c->cy + c->fy * bottom / (bottom > 0.0 ? near_z : far_z);
    out->far_z = far_z;
    return out->x1 >= 0.0 && out->y1 >= 0.0 && out->x0 <= c->width - 1.0 &&
           out->y0 <= c->height - 1.0;
}

static void widen(map_caster *caster, const pixel_box *box)
{
    const rlf_camera *c = &caster->camera;
    const int32_t x0 = (int32_t)rlf_max(box->x0, 0.0) / MAP_TILE;
    const int32_t y0 = (int32_t)rlf_max(box->y0, 0.0) / MAP_TILE;
    const int32_t x1 = (int32_t)rlf_min(box->x1, c->width - 1.0) / MAP_TILE;
    const int32_t y1 = (int32_t)rlf_min(box->y1, c->height - 1.0) / MAP_TILE;
    for (int32_t y = y0; y <= y1; y++) {
        float *row = &caster->out->tile_far[y * caster->tile_columns];
        for (int32_t x = x0; x <= x1; x++) {
            row[x] = (float)rlf_max((double)row[x], box->far_z);
        }
    }
}

static float least_of(float a, float b)
{
    return a < b ? a : b;
}

/* A square of pixels as large as a voxel, so that near surfaces have no holes. */
static void draw_point(map_caster *caster, float u, float v, float z, float voxel_f)
{
    const int32_t width = caster->camera.width, height = caster->camera.height;
    const float size = voxel_f / z;
    float *depth = caster->out->depth;
    if (size <= 1.0f) { /* one pixel, the nearest */
        if (u > -0.5f && v > -0.5f && u < (float)width - 0.5f && v < (float)height - 0.5f) {
            float *at = &depth[(ptrdiff_t)(int32_t)(v + 0.5f) * width + (int32_t)(u + 0.5f)];
            *at = z < *at ? z : *at;
        }
        return;
    }
    const float half = 0.5f * size;
    const float right = least_of(u + half, (float)(width - 1));
    const float bottom = least_of(v + half, (float)(height - 1));
    const int32_t x0 = u - half > 0.0f ? (int32_t)(u - half) + 1 : 0;
    const int32_t y0 = v - half > 0.0f ? (int32_t)(v - half) + 1 : 0;
    for (int32_t y = y0; (float)y <= bottom; y++) {
        float *row = &depth[(ptrdiff_t)y * width];
        for (int32_t x = x0; (float)x <= right; x++) {
            row[x] = z < row[x] ? z : row[x];
        }
    }
}

static void draw_block(map_caster *caster, int32_t block, rlf_vec3 corner)
{
    const rlf_camera *c = &caster->camera;
    const double voxel = caster->map->def.voxel_m;
    const rlf_splat_camera camera = {(float)c->fx, (float)c->fy, (float)c->cx, (float)c->cy};
    const float voxel_f = (float)(voxel * rlf_max(c->fx, c->fy));
    rlf_fuse_place place = {.origin = {(float)corner.x, (float)corner.y, (float)corner.z}};
    for (int32_t k = 0; k < 3; k++) {
        for (int32_t r = 0; r < 3; r++) {
            place.step[k][r] = (float)(caster->R_camera_world.m[r][k] * voxel);
        }
    }
    rlf_splat_points points;
    const map_block *b = map_block_at(&caster->map->volume, block);
    const int32_t count = rlf_kernel_splat_block(b, &place, &camera, &points);
    for (int32_t i = 0; i < count; i++) {
        if (points.z[i] > 0.0f) {
            draw_point(caster, points.u[i], points.v[i], points.z[i], voxel_f);
        }
    }
}

/* Half of a block's extent along each of the camera's axes. */
static rlf_vec3 half_extent(const map_caster *caster)
{
    const rlf_mat3 *R = &caster->R_camera_world;
    const double half = 0.5 * caster->map->def.voxel_m * MAP_SIDE;
    double out[3];
    for (int32_t r = 0; r < 3; r++) {
        double sum = 0.0;
        for (int32_t k = 0; k < 3; k++) {
            sum += R->m[r][k] < 0.0 ? -R->m[r][k] : R->m[r][k];
        }
        out[r] = half * sum;
    }
    return rlf_vec3_make(out[0], out[1], out[2]);
}

void map_splat(map_caster *caster)
{
    const map_volume *v = &caster->map->volume;
    const rlf_mat3 *R = &caster->R_camera_world;
    const rlf_camera *c = &caster->camera;
    const double side = caster->map->def.voxel_m * MAP_SIDE;
    const int32_t rows = (c->height + MAP_TILE - 1) / MAP_TILE;
    caster->tile_columns = (c->width + MAP_TILE - 1) / MAP_TILE;
    for (int32_t i = 0; i < rows * caster->tile_columns; i++) {
        caster->out->tile_far[i] = 0.0f;
    }
    for (int32_t i = 0; i < c->width * c->height; i++) {
        caster->out->depth[i] = MAP_NOTHING;
    }
    const rlf_vec3 half = half_extent(caster), diagonal = {0.5 * side, 0.5 * side, 0.5 * side};
    const rlf_vec3 to_middle = rlf_mat3_mul_vec(R, diagonal);
    for (int32_t i = 0; i < v->high; i++) {
        if ((v->flags[i] & MAP_HAS_SURFACE) == 0) {
            continue;
        }
        const int16_t *at = v->place[i];
        const rlf_vec3 corner = rlf_mat3_mul_vec(
            R, rlf_sub(rlf_vec3_make(at[0] * side, at[1] * side, at[2] * side), caster->eye));
        pixel_box box;
        if (cover(c, rlf_add(corner, to_middle), half, &box)) {
            widen(caster, &box);
            draw_block(caster, i, corner);
        }
    }
}
