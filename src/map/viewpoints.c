/* Where a map was seen from: a camera that comes into a known room is looked for there. */
#include "map/volume.h"

/* A pose this near to a viewpoint in both is no new one. */
#define APART_M 0.25
#define APART_COSINE 0.9914 /* of half the angle, 15 degrees */

static bool is_alike(const rlf_pose *a, const rlf_pose *b)
{
    const double cosine = a->q.x * b->q.x + a->q.y * b->q.y + a->q.z * b->q.z + a->q.w * b->q.w;
    return rlf_length(rlf_sub(a->p, b->p)) < APART_M &&
           (cosine > APART_COSINE || cosine < -APART_COSINE);
}

void map_viewpoints_add(rlf_map *map, const rlf_pose *T_world_camera)
{
    for (int32_t i = 0; i < map->viewpoint_count; i++) {
        if (is_alike(&map->viewpoint[i], T_world_camera)) {
            return;
        }
    }
    if (map->viewpoint_count < MAP_VIEWPOINTS) {
        map->viewpoint[map->viewpoint_count++] = *T_world_camera;
    }
}

const rlf_pose *rlf_map_get_viewpoints(const rlf_map *map, int32_t *out_count)
{
    if (!RLF_ASSERT(map != NULL && out_count != NULL)) {
        return NULL;
    }
    *out_count = map->viewpoint_count;
    return map->viewpoint;
}
