/* What a camera sees of the room: for each pixel the zero along its ray, found from the voxel
 * that is drawn there. */
#include "map/volume.h"

#include "camera/pixels.h"

#include <string.h>

#define GRAIN 8 /* rows */

/* One ray, in voxels: at + z way, z metres along the camera's axis. */
typedef struct ray {
    const map_volume *v;
    float at[3], way[3], length; /* of way */
    int32_t block_at[3], block;  /* the block looked at last */
    float z0, d0;                /* the last place in front of a surface; d0 < 0: there is none */
} ray;

/* The block with voxel (i, j, k), or -1. */
static int32_t find_block(ray *r, const int32_t voxel[3])
{
    int32_t at[3];
    for (int32_t k = 0; k < 3; k++) {
        at[k] = map_block_of(voxel[k]);
    }
    if (at[0] != r->block_at[0] || at[1] != r->block_at[1] || at[2] != r->block_at[2]) {
        memcpy(r->block_at, at, sizeof(at));
        r->block = map_volume_find(r->v, at[0], at[1], at[2]);
    }
    return r->block;
}

/* The corners of a cell, and what is read of them. */
typedef struct corners {
    float distance[8]; /* voxels */
    int32_t block;
    int32_t voxel[3]; /* the first corner, in the block */
    float in[3];      /* place in the cell, 0..1; up to 2 beyond the last of a block */
} corners;

/* False when one of them is unknown. */
static bool read_corners(const map_block *b, int32_t first, float distance[8])
{
    enum { Y = MAP_SIDE, Z = MAP_SIDE * MAP_SIDE };
    static const int32_t at[8] = {0, 1, Y, Y + 1, Z, Z + 1, Z + Y, Z + Y + 1};
    const int16_t *d = &b->distance[first];
    bool is_known = true;
    for (int32_t k = 0; k < 8; k++) {
        is_known &= d[at[k]] != RLF_FUSE_UNKNOWN;
        distance[k] = (float)d[at[k]] * (1.0f / RLF_FUSE_STEPS);
    }
    return is_known;
}

/* The cell about the ray's point at depth z. Between two blocks the last cell of the first goes on:
 * a distance is nearly flat, and one block is read in place of up to eight. */
static bool corners_at(ray *r, float z, corners *out)
{
    int32_t voxel[3];
    for (int32_t k = 0; k < 3; k++) {
        const float p = r->at[k] + z * r->way[k];
        voxel[k] = map_floor(p);
        out->in[k] = p - (float)voxel[k];
    }
    out->block = find_block(r, voxel);
    if (out->block < 0) {
        return false;
    }
    for (int32_t k = 0; k < 3; k++) {
        const int32_t i = voxel[k] & 7, beyond = i == 7 ? 1 : 0;
        out->voxel[k] = i - beyond;
        out->in[k] += (float)beyond;
    }
    const int32_t first = (out->voxel[2] * MAP_SIDE + out->voxel[1]) * MAP_SIDE + out->voxel[0];
    return read_corners(map_block_at(r->v, out->block), first, out->distance);
}

/* What a ray met: normal in the world. */
typedef struct hit {
    float z, normal[3];
    uint8_t grey;
} hit;

/* Trilinear, of the corners that have one. */
static uint8_t mean_grey(const map_block *b, const corners *c)
{
    const int32_t first = (c->voxel[2] * MAP_SIDE + c->voxel[1]) * MAP_SIDE + c->voxel[0];
    float share[3], sum = 0.0f, weights = 0.0f;
    for (int32_t k = 0; k < 3; k++) {
        share[k] = c->in[k] < 1.0f ? c->in[k] : 1.0f;
    }
    for (int32_t k = 0; k < 8; k++) {
        const int32_t dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
        const uint8_t grey = b->grey[first + (dz * MAP_SIDE + dy) * MAP_SIDE + dx];
        const float weight = (dx != 0 ? share[0] : 1.0f - share[0]) *
                             (dy != 0 ? share[1] : 1.0f - share[1]) *
                             (dz != 0 ? share[2] : 1.0f - share[2]);
        sum += grey > 0 ? weight * (float)grey : 0.0f;
        weights += grey > 0 ? weight : 0.0f;
    }
    return weights > 0.0f ? (uint8_t)(sum / weights + 0.5f) : 0;
}

/* Newton's method from `start`: where the ray meets the surface about there. Within a quarter of a
 * voxel its next step is the last: the field is nearly flat. */
static bool refine(ray *r, float start, hit *out)
{
    float z = start, g[3] = {0, 0, 0}, d = 1.0f;
    corners c = {.block = -1};
    for (int32_t i = 0; i < 4 && (d > 0.25f || d < -0.25f); i++) {
        if (!corners_at(r, z, &c)) {
            return false;
        }
        d = map_cell_value(c.distance, c.in, g);
        const float slope = g[0] * r->way[0] + g[1] * r->way[1] + g[2] * r->way[2];
        if (!(slope < -0.05f * r->length)) {
            return false;
        }
        z -= d / slope;
    }
    const float off = (z - start) * r->length, size2 = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
    if (!(d < 0.5f && d > -0.5f && off > -6.0f && off < 6.0f && size2 > 0.04f && z > 0.0f)) {
        return false;
    }
    const float scale = 1.0f / sqrtf(size2);
    out->z = z;
    out->grey = mean_grey(map_block_at(r->v, c.block), &c);
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
            voxel_at[k] = map_floor(r->at[k] + z * r->way[k] + 0.5f);
        }
        const int32_t block = find_block(r, voxel_at);
        if (block < 0) {
            r->d0 = -1.0f;
            z += 2.0f * voxel; /* less than what blocks reach beyond a surface */
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
            return refine(r, r->z0 + (z - r->z0) * (r->d0 / (r->d0 - d)), out);
        } else if (d < -1.0f) {
            return false; /* the back of something */
        } else {
            z += 0.5f * voxel;
        }
    }
    return false;
}

/* All rays: the eye, and how the way changes from pixel to pixel. */
static void prepare_rays(map_caster *c)
{
    const double scale = 1.0 / c->map->def.voxel_m;
    const double fx = c->camera.fx, fy = c->camera.fy;
    const double eye[3] = {c->eye.x, c->eye.y, c->eye.z};
    for (int32_t k = 0; k < 3; k++) {
        const double *m = c->R_world_camera.m[k];
        c->at[k] = (float)(eye[k] * scale);
        c->way[k] = (float)(scale * (m[2] - m[0] * c->camera.cx / fx - m[1] * c->camera.cy / fy));
        c->way_x[k] = (float)(scale * m[0] / fx);
        c->way_y[k] = (float)(scale * m[1] / fy);
    }
}

static void ray_make(const map_caster *c, int32_t x, int32_t y, ray *out)
{
    float length2 = 0.0f;
    for (int32_t k = 0; k < 3; k++) {
        out->at[k] = c->at[k];
        out->way[k] = c->way[k] + ((float)x * c->way_x[k] + (float)y * c->way_y[k]);
        length2 += out->way[k] * out->way[k];
    }
    out->length = sqrtf(length2);
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

#define AHEAD 6 /* pixels that memory has to answer in */

/* Brings near what a pixel of the row will read first. */
static void look_ahead(const map_caster *c, int32_t x, int32_t y, ray *r)
{
    const int32_t i = y * c->camera.width + x;
    const float inverse = x < c->camera.width ? c->out->depth[i] : 0.0f;
    if (!(inverse > 0.0f)) {
        return;
    }
    const float start = 1.0f / inverse;
    ray_make(c, x, y, r);
    const int32_t block = c->out->start[i];
    int32_t voxel[3], at[3];
    bool is_in = true;
    for (int32_t k = 0; k < 3; k++) {
        voxel[k] = map_floor(r->at[k] + start * r->way[k]);
        at[k] = map_block_of(voxel[k]);
        is_in &= at[k] == r->v->place[block][k];
    }
    if (is_in) {
        const int16_t *d = map_block_at(r->v, block)->distance;
        d += ((voxel[2] & 7) * MAP_SIDE + (voxel[1] & 7)) * MAP_SIDE;
        RLF_KERNEL_SOON(d);
        RLF_KERNEL_SOON(d + MAP_SIDE * MAP_SIDE);
    } else {
        map_volume_soon(r->v, at[0], at[1], at[2]);
    }
}

/* The plane of depth holds where the ray may meet the nearest surface: there it is looked at first.
 * At outlines it passes by that surface, and goes on. */
static void cast_pixel(const map_caster *c, int32_t x, int32_t y, ray *r)
{
    const hit none = {0};
    const int32_t i = y * c->camera.width + x;
    const float inverse = c->out->depth[i];
    hit h = none;
    if (inverse > 0.0f) {
        const float start = 1.0f / inverse;
        const float far_z = c->out->tile_far[(y / MAP_TILE) * c->tile_columns + x / MAP_TILE];
        r->block = c->out->start[i]; /* what is drawn there is likely the one to look at */
        for (int32_t k = 0; k < 3; k++) {
            r->block_at[k] = r->v->place[r->block][k];
        }
        ray_make(c, x, y, r);
        if (!refine(r, start, &h) && !cast(r, start - 1.5f / r->length, far_z, &h)) {
            h = none;
        }
    }
    put(c, i, &h);
}

static void cast_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const map_caster *c = context;
    ray r = {.v = &c->map->volume, .block_at = {INT32_MAX}, .block = -1};
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        for (int32_t x = 0; x < c->camera.width; x++) {
            look_ahead(c, x + AHEAD, y, &r);
            cast_pixel(c, x, y, &r);
        }
    }
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
    if (!math_pose_is_sound(T_world_camera)) {
        return rlf_fail(RLF_ERROR_INVALID, "rlf_map_predict: the pose is not finite or its "
                                           "quaternion is not of unit length");
    }
    map_caster c = {.map = map, .eye = T_world_camera->p, .out = &map->out};
    c.camera = camera_pinhole(camera);
    c.R_world_camera = rlf_quat_to_mat3(rlf_quat_normalize(T_world_camera->q));
    c.R_camera_world = rlf_mat3_transpose(&c.R_world_camera);
    prepare_rays(&c);
    map_splat(&c);
    rlf_parallel_for(map->def.pool, camera->height, GRAIN, cast_rows, &c);
    *out = map->out.last = (rlf_prediction){
        .camera = c.camera,
        .T_world_camera = *T_world_camera,
        .depth = map->out.depth,
        .normal_x = map->out.normal[0],
        .normal_y = map->out.normal[1],
        .normal_z = map->out.normal[2],
        .grey = map->out.grey,
    };
    return RLF_OK;
}

const uint8_t *rlf_map_predict_color(rlf_map *map)
{
    if (!RLF_ASSERT(map != NULL) || map->out.last.depth == NULL) {
        return NULL;
    }
    const rlf_prediction *p = &map->out.last;
    const rlf_mat3 R = rlf_quat_to_mat3(rlf_quat_normalize(p->T_world_camera.q));
    for (int32_t i = 0; i < p->camera.width * p->camera.height; i++) {
        const double z = (double)p->depth[i], x = i % p->camera.width, y = i / p->camera.width;
        const rlf_vec3 way = {(x - p->camera.cx) / p->camera.fx, (y - p->camera.cy) / p->camera.fy,
                              1.0};
        const rlf_vec3 at = rlf_add(rlf_mat3_mul_vec(&R, rlf_scale(way, z)), p->T_world_camera.p);
        int32_t voxel;
        const int32_t block = map_voxel_near(map, at, &voxel);
        uint8_t *rgba = &map->out.rgba[4 * (ptrdiff_t)i];
        memset(rgba, 0, 4);
        if (z > 0.0 && block >= 0) {
            map_voxel_color(map_block_at(&map->volume, block), voxel, rgba);
        }
    }
    return map->out.rgba;
}
