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

/* A square of pixels as large as a voxel, so that near surfaces have no holes. */
static void draw_point(map_caster *caster, const rlf_splat_point *p, float voxel_f)
{
    const int32_t width = caster->camera.width, height = caster->camera.height;
    const float half = 0.5f * voxel_f / p->z + 0.5f; /* rounding out by half a pixel */
    const float left = p->u - half, right = p->u + half;
    const float top = p->v - half, bottom = p->v + half;
    if (!(right >= 0.0f && bottom >= 0.0f && left <= (float)(width - 1) &&
          top <= (float)(height - 1))) {
        return;
    }
    const int32_t x0 = left > 0.0f ? (int32_t)left + 1 : 0;
    const int32_t y0 = top > 0.0f ? (int32_t)top + 1 : 0;
    const int32_t x1 = right < (float)(width - 1) ? (int32_t)right : width - 1;
    const int32_t y1 = bottom < (float)(height - 1) ? (int32_t)bottom : height - 1;
    for (int32_t y = y0; y <= y1; y++) {
        float *row = &caster->out->depth[(ptrdiff_t)y * width];
        for (int32_t x = x0; x <= x1; x++) {
            row[x] = (row[x] == 0.0f || p->z < row[x]) ? p->z : row[x];
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
    rlf_splat_point points[MAP_VOXELS];
    const map_block *b = map_block_at(&caster->map->volume, block);
    const int32_t count = rlf_kernel_splat_block(b, &place, &camera, points);
    for (int32_t i = 0; i < count; i++) {
        if (points[i].z > 0.0f) {
            draw_point(caster, &points[i], voxel_f);
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
        caster->out->depth[i] = 0.0f;
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
