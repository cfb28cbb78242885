/* What a camera sees of the room: rays through the volume. Every second pixel of every second row
 * is cast; those between are, too, unless what is on both sides of them is one plane. */
#include "map/predict.h"

#include <string.h>

/* Rows of a job: pairs of rows share the blocks that they pass. */
#define GRAIN 8

/* Pixels between two of one plane are taken from it: their normals less than 18 degrees apart, and
 * each on the other's plane to a quarter of a voxel. */
static const float same_way = 0.95f, same_plane = 0.25f;

/* One ray, in voxels: at + z way, z metres along the camera's axis. */
typedef struct ray {
    const map_volume *v;
    float at[3], way[3], length; /* of way */
    int32_t block_at[3], block;  /* the block looked at last */
    float z0, d0;                /* the last place in front of a surface; d0 < 0: there is none */
} ray;

static int32_t floored(float x)
{
    int32_t i = (int32_t)x;
    return x < (float)i ? i - 1 : i;
}

/* The block with voxel (i, j, k), or -1. */
static int32_t find_block(ray *r, const int32_t voxel[3])
{
    int32_t at[3];
    for (int32_t k = 0; k < 3; k++) {
        at[k] = (voxel[k] - (voxel[k] & 7)) / MAP_SIDE;
    }
    if (at[0] != r->block_at[0] || at[1] != r->block_at[1] || at[2] != r->block_at[2]) {
        memcpy(r->block_at, at, sizeof(at));
        r->block = map_volume_find(r->v, at[0], at[1], at[2]);
    }
    return r->block;
}

/* Depth at which the ray leaves the block looked at last. */
static float leave(const ray *r)
{
    float least = 1e30f;
    for (int32_t k = 0; k < 3; k++) {
        if (r->way[k] * r->way[k] > 1e-6f) {
            const float side = r->way[k] > 0.0f ? 7.5f : -0.5f;
            const float z = ((float)(r->block_at[k] * MAP_SIDE) + side - r->at[k]) / r->way[k];
            least = z < least ? z : least;
        }
    }
    return least;
}

/* The cell about the ray's point at depth z, and where in it that is. */
static bool cell_at(ray *r, float z, map_cell *cell, float in[3])
{
    int32_t voxel[3];
    for (int32_t k = 0; k < 3; k++) {
        const float p = r->at[k] + z * r->way[k];
        voxel[k] = floored(p);
        in[k] = p - (float)voxel[k];
    }
    const int32_t block = find_block(r, voxel);
    return block >= 0 && map_cell_read(r->v, block, voxel[0] & 7, voxel[1] & 7, voxel[2] & 7, cell);
}

/* What a ray met: normal in the world. */
typedef struct hit {
    float z, normal[3];
    uint8_t grey;
} hit;

static uint8_t mean_grey(const map_cell *c, const float in[3])
{
    float sum = 0.0f, weights = 0.0f;
    for (int32_t k = 0; k < 8; k++) {
        const float x = (k & 1) != 0 ? in[0] : 1.0f - in[0];
        const float y = (k & 2) != 0 ? in[1] : 1.0f - in[1];
        const float z = (k & 4) != 0 ? in[2] : 1.0f - in[2];
        const uint8_t grey = c->block[k]->grey[c->voxel[k]];
        const float weight = grey > 0 ? x * y * z : 0.0f;
        sum += weight * (float)grey;
        weights += weight;
    }
    return weights > 0.0f ? (uint8_t)(sum / weights + 0.5f) : 0;
}

/* From a place in front (z0, d0) and one behind (z1, d1) to the zero between: twice Newton. */
static bool refine(ray *r, float z1, float d1, hit *out)
{
    const float start = r->z0 + (z1 - r->z0) * (r->d0 / (r->d0 - d1));
    float z = start, in[3], g[3] = {0, 0, 0};
    map_cell cell;
    for (int32_t i = 0; i < 2; i++) {
        if (!cell_at(r, z, &cell, in)) {
            return false;
        }
        const float d = map_cell_value(&cell, in[0], in[1], in[2], g);
        const float slope = g[0] * r->way[0] + g[1] * r->way[1] + g[2] * r->way[2];
        if (!(slope < -0.05f * r->length)) {
            return false;
        }
        z -= d / slope;
    }
    const float off = (z - start) * r->length, size2 = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
    if (!(off > -3.0f && off < 3.0f && size2 > 0.04f && z > 0.0f)) {
        return false;
    }
    const float scale = 1.0f / sqrtf(size2);
    out->z = z;
    out->grey = mean_grey(&cell, in);
    for (int32_t k = 0; k < 3; k++) {
        out->normal[k] = g[k] * scale;
    }
    return true;
}

/* Walks from z to far_z. */
static bool cast(ray *r, float z, float far_z, hit *out)
{
    const float voxel = 1.0f / r->length; /* metres of depth */
    r->d0 = -1.0f;
    while (z < far_z) {
        int32_t voxel_at[3];
        for (int32_t k = 0; k < 3; k++) {
            voxel_at[k] = floored(r->at[k] + z * r->way[k] + 0.5f);
        }
        const int32_t block = find_block(r, voxel_at);
        if (block < 0) {
            r->d0 = -1.0f;
            const float next = leave(r);
            z = (next > z ? next : z) + 0.01f * voxel;
            continue;
        }
        const int32_t i =
            ((voxel_at[2] & 7) * MAP_SIDE + (voxel_at[1] & 7)) * MAP_SIDE + (voxel_at[0] & 7);
        const map_block *b = map_block_at(r->v, block);
        const float d = (float)b->distance[i] * (1.0f / RLF_FUSE_STEPS);
        if (b->weight[i] == 0) {
            r->d0 = -1.0f;
            z += voxel;
        } else if (d > 0.0f) {
            r->z0 = z;
            r->d0 = d;
            z += (d > 1.4f ? d - 0.9f : 0.5f) * voxel;
        } else if (r->d0 > 0.0f) {
            return refine(r, z, d, out);
        } else if (d < -1.0f) {
            return false; /* the back of something */
        } else {
            z += 0.5f * voxel;
        }
    }
    return false;
}

static void ray_make(const map_caster *c, int32_t x, int32_t y, ray *out)
{
    const double scale = 1.0 / c->map->def.voxel_m;
    const rlf_vec3 straight = {(x - c->camera.cx) / c->camera.fx, (y - c->camera.cy) / c->camera.fy,
                               1.0};
    const rlf_vec3 way = rlf_scale(rlf_mat3_mul_vec(&c->R_world_camera, straight), scale);
    out->way[0] = (float)way.x;
    out->way[1] = (float)way.y;
    out->way[2] = (float)way.z;
    out->at[0] = (float)(c->eye.x * scale);
    out->at[1] = (float)(c->eye.y * scale);
    out->at[2] = (float)(c->eye.z * scale);
    out->length = (float)rlf_length(way);
}

static void put(const map_caster *c, int32_t i, const hit *h)
{
    const rlf_mat3 *R = &c->R_camera_world;
    map_view_planes *out = c->out;
    out->depth[i] = h->z;
    out->grey[i] = h->grey;
    for (int32_t k = 0; k < 3; k++) {
        out->normal[k][i] = (float)R->m[k][0] * h->normal[0] + (float)R->m[k][1] * h->normal[1] +
                            (float)R->m[k][2] * h->normal[2];
    }
}

static void cast_pixel(const map_caster *c, int32_t x, int32_t y, ray *r)
{
    const hit none = {0};
    const map_tile *tile = &c->out->tiles[(y / MAP_TILE) * c->tile_columns + x / MAP_TILE];
    hit h = none;
    if (tile->near_z < tile->far_z) {
        ray_make(c, x, y, r);
        if (!cast(r, tile->near_z, tile->far_z, &h)) {
            h = none;
        }
    }
    put(c, y * c->camera.width + x, &h);
}

/* Grey of the room at a pixel whose depth is known. */
static uint8_t grey_at(const map_caster *c, int32_t x, int32_t y, float z, ray *r)
{
    map_cell cell;
    float in[3];
    ray_make(c, x, y, r);
    return cell_at(r, z, &cell, in) ? mean_grey(&cell, in) : 0;
}

/* The pixel half way between a and b, when those are of one plane. */
static bool between(const map_caster *c, int32_t x, int32_t y, int32_t step, ray *r)
{
    map_view_planes *out = c->out;
    const int32_t i = y * c->camera.width + x, a = i - step, b = i + step;
    const float za = out->depth[a], zb = out->depth[b];
    if (!(za > 0.0f && zb > 0.0f)) {
        return false;
    }
    float n[3], along = 0.0f;
    for (int32_t k = 0; k < 3; k++) {
        n[k] = out->normal[k][a] + out->normal[k][b];
        along += out->normal[k][a] * out->normal[k][b];
    }
    if (!(along > same_way)) {
        return false;
    }
    const int32_t dx = step == 1 ? 1 : 0, dy = 1 - dx;
    const float fx = (float)c->camera.fx, fy = (float)c->camera.fy;
    const float ax = ((float)(x - dx) - (float)c->camera.cx) / fx;
    const float ay = ((float)(y - dy) - (float)c->camera.cy) / fy;
    const float bx = ax + (float)(2 * dx) / fx, by = ay + (float)(2 * dy) / fy;
    /* The distance of b's point from the mean plane through a's. */
    const float off = n[0] * (zb * bx - za * ax) + n[1] * (zb * by - za * ay) + n[2] * (zb - za);
    const float most = 2.0f * same_plane * (float)c->map->def.voxel_m;
    if (!(off < most && off > -most)) {
        return false;
    }
    const float z = 2.0f * za * zb / (za + zb);
    const float scale = 1.0f / sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    out->depth[i] = z;
    out->grey[i] = grey_at(c, x, y, z, r);
    for (int32_t k = 0; k < 3; k++) {
        out->normal[k][i] = n[k] * scale;
    }
    return true;
}

static void ray_begin(const map_caster *c, ray *r)
{
    memset(r, 0, sizeof(*r));
    r->v = &c->map->volume;
    r->block_at[0] = INT32_MAX;
    r->block = -1;
}

/* Even rows: even pixels first, then those between them. */
static void even_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const map_caster *c = context;
    const int32_t width = c->camera.width;
    ray r;
    (void)worker;
    ray_begin(c, &r);
    for (int32_t half = begin; half < end; half++) {
        const int32_t y = 2 * half;
        for (int32_t x = 0; x < width; x += 2) {
            cast_pixel(c, x, y, &r);
        }
        for (int32_t x = 1; x < width; x += 2) {
            if (x + 1 == width || !between(c, x, y, 1, &r)) {
                cast_pixel(c, x, y, &r);
            }
        }
    }
}

static void odd_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const map_caster *c = context;
    const int32_t width = c->camera.width;
    ray r;
    (void)worker;
    ray_begin(c, &r);
    for (int32_t half = begin; half < end; half++) {
        const int32_t y = 2 * half + 1;
        for (int32_t x = 0; x < width; x++) {
            if (y + 1 == c->camera.height || !between(c, x, y, width, &r)) {
                cast_pixel(c, x, y, &r);
            }
        }
    }
}

static void finish(rlf_map *map, const rlf_camera *camera, const rlf_pose *T)
{
    map_view_planes *out = &map->out;
    out->last = (rlf_prediction){
        .camera = *camera,
        .T_world_camera = *T,
        .depth = out->depth,
        .normal_x = out->normal[0],
        .normal_y = out->normal[1],
        .normal_z = out->normal[2],
        .grey = map->def.keep_color ? out->grey : NULL,
    };
}

rlf_result rlf_map_predict(rlf_map *map, const rlf_camera *camera, const rlf_pose *T_world_camera,
                           rlf_prediction *out)
{
    if (!RLF_ASSERT(map != NULL && camera != NULL && T_world_camera != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = rlf_camera_check(camera, "rlf_map_predict: camera");
    if (result != RLF_OK) {
        return result;
    }
    if (camera->width > map->pinhole.width || camera->height > map->pinhole.height) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "rlf_map_predict: camera: %d x %d is larger than the "
                        "rig's %d x %d",
                        (int)camera->width, (int)camera->height, (int)map->pinhole.width,
                        (int)map->pinhole.height);
    }
    if (!map_pose_is_sound(T_world_camera)) {
        return rlf_fail(RLF_ERROR_INVALID, "rlf_map_predict: the pose is not finite or its "
                                           "quaternion is not of unit length");
    }
    map_caster c = {.map = map, .camera = *camera, .eye = T_world_camera->p, .out = &map->out};
    c.camera.distortion_model = RLF_DISTORTION_NONE;
    memset(c.camera.distortion, 0, sizeof(c.camera.distortion));
    c.R_world_camera = rlf_quat_to_mat3(rlf_quat_normalize(T_world_camera->q));
    c.R_camera_world = rlf_mat3_transpose(&c.R_world_camera);
    map_tiles_fill(&c);
    rlf_parallel_for(map->def.pool, (camera->height + 1) / 2, GRAIN, even_rows, &c);
    rlf_parallel_for(map->def.pool, camera->height / 2, GRAIN, odd_rows, &c);
    finish(map, &c.camera, T_world_camera);
    *out = map->out.last;
    return RLF_OK;
}

const uint8_t *rlf_map_predict_color(rlf_map *map)
{
    if (!RLF_ASSERT(map != NULL) || !map->def.keep_color || map->out.last.depth == NULL) {
        return NULL;
    }
    const rlf_prediction *p = &map->out.last;
    map_caster c = {.map = map, .camera = p->camera, .eye = p->T_world_camera.p, .out = &map->out};
    c.R_world_camera = rlf_quat_to_mat3(rlf_quat_normalize(p->T_world_camera.q));
    ray r;
    ray_begin(&c, &r);
    for (int32_t y = 0; y < p->camera.height; y++) {
        for (int32_t x = 0; x < p->camera.width; x++) {
            const int32_t i = y * p->camera.width + x;
            uint8_t *rgba = &map->out.rgba[4 * (ptrdiff_t)i];
            map_cell cell;
            float in[3];
            memset(rgba, 0, 4);
            ray_make(&c, x, y, &r);
            if (p->depth[i] > 0.0f && cell_at(&r, p->depth[i], &cell, in)) {
                const int32_t nearest =
                    (in[0] > 0.5f ? 1 : 0) | (in[1] > 0.5f ? 2 : 0) | (in[2] > 0.5f ? 4 : 0);
                map_voxel_color(cell.block[nearest], cell.voxel[nearest], rgba);
            }
        }
    }
    return map->out.rgba;
}
