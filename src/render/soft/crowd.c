/* Faces that nothing else is before or behind need no depth of samples.
 *
 * The faces of a convex body that are turned to the eye share edges, but no samples. */
#include "render/soft/soft.h"

#include <string.h>

enum { PX = SOFT_CROWD_PX, MANY = 2 };

/* Ends [first, end) of one body, and its columns. */
typedef struct group_body {
    int32_t first, end;
    soft_span columns;
    bool is_convex;
} group_body;

static group_body next_body(const soft_scene *scene, const soft_ends *ends, int32_t first,
                            int32_t count)
{
    const int32_t body = scene->faces[ends[first].face].body;
    group_body out = {first, first, {INT32_MAX, 0}, true};
    for (; out.end < count && scene->faces[ends[out.end].face].body == body; out.end++) {
        const soft_ends *e = &ends[out.end];
        out.columns.x0 = e->x0 / PX < out.columns.x0 ? e->x0 / PX : out.columns.x0;
        out.columns.x1 = e->x1 > out.columns.x1 ? e->x1 : out.columns.x1;
        out.is_convex = out.is_convex && scene->faces[e->face].skin == 0;
    }
    out.columns.x1 = (out.columns.x1 + PX - 1) / PX;
    return out;
}

static bool is_alone(const uint8_t *crowd, soft_span columns)
{
    int32_t most = 0;
    for (int32_t x = columns.x0; x < columns.x1; x++) {
        most = crowd[x] > most ? crowd[x] : most;
    }
    return most < MANY;
}

void soft_find_alone(const soft_scene *scene, int32_t count, soft_group *group)
{
    uint8_t *crowd = group->crowd;
    memset(crowd, 0, (size_t)(group->width + PX - 1) / PX);
    for (int32_t i = 0; i < count;) {
        const group_body body = next_body(scene, group->ends, i, count);
        for (int32_t x = body.columns.x0; x < body.columns.x1; x++) {
            crowd[x] = crowd[x] < MANY ? crowd[x] + 1 : MANY;
        }
        i = body.end;
    }
    for (int32_t i = 0; i < count;) {
        const group_body body = next_body(scene, group->ends, i, count);
        const bool alone = body.is_convex && is_alone(crowd, body.columns);
        for (; i < body.end; i++) {
            group->ends[i].is_alone = alone;
        }
    }
}
