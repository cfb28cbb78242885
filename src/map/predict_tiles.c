/* Where along its rays a tile of the picture may meet a surface (Prisacariu et al. 2014, InfiniTAM:
 * blocks drawn as boxes). */
#include "map/predict.h"

#define NEAREST_M 0.05
#define FARTHEST_M 1000.0f

typedef struct pixel_box {
    double x0, y0, x1, y1, near_z, far_z;
} pixel_box;

/* What a box about `middle` covers of the picture; false when that is nothing. `half` is half of
 * its extent along the camera's axes. */
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
    out->near_z = near_z;
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
        map_tile *row = &caster->out->tiles[y * caster->tile_columns];
        for (int32_t x = x0; x <= x1; x++) {
            row[x].near_z = (float)rlf_min((double)row[x].near_z, box->near_z);
            row[x].far_z = (float)rlf_max((double)row[x].far_z, box->far_z);
        }
    }
}

void map_tiles_fill(map_caster *caster)
{
    const map_volume *v = &caster->map->volume;
    const rlf_mat3 *R = &caster->R_camera_world;
    const double side = caster->map->def.voxel_m * MAP_SIDE;
    const int32_t rows = (caster->camera.height + MAP_TILE - 1) / MAP_TILE;
    caster->tile_columns = (caster->camera.width + MAP_TILE - 1) / MAP_TILE;
    for (int32_t i = 0; i < rows * caster->tile_columns; i++) {
        caster->out->tiles[i] = (map_tile){.near_z = FARTHEST_M, .far_z = 0.0f};
    }
    double half[3];
    for (int32_t r = 0; r < 3; r++) {
        double sum = 0.0;
        for (int32_t k = 0; k < 3; k++) {
            sum += R->m[r][k] < 0.0 ? -R->m[r][k] : R->m[r][k];
        }
        half[r] = 0.5 * side * sum;
    }
    for (int32_t i = 0; i < v->high; i++) {
        if ((v->flags[i] & MAP_HAS_SURFACE) == 0) {
            continue;
        }
        const int16_t *at = v->place[i];
        const rlf_vec3 middle = {(at[0] + 0.5) * side, (at[1] + 0.5) * side, (at[2] + 0.5) * side};
        pixel_box box;
        if (cover(&caster->camera, rlf_mat3_mul_vec(R, rlf_sub(middle, caster->eye)),
                  rlf_vec3_make(half[0], half[1], half[2]), &box)) {
            widen(caster, &box);
        }
    }
}
