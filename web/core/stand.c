/* What a device knows to stand in the room beside its depth: planes and meshes that it detects.
 * They are models of real things, which collide and are not drawn. */
#include "page.h"

#include <string.h>

enum { STATICS = 256, STATIC_VERTICES = 256, STATIC_TRIANGLES = 512 };

/* A hull is borrowed by its body, so it stays here. */
typedef struct static_thing {
    rlf_body_id body;
    rlf_hull hull;
} static_thing;

static struct {
    rlf_vec3 vertices[STATIC_VERTICES];
    double corners[3 * STATIC_VERTICES];
    int32_t triangles[3 * STATIC_TRIANGLES];
    static_thing statics[STATICS];
} stand;

/* Corners (doubles, three each, at most 256) and triangles (int32, three each, at most 512) of
 * relief_touch_hull. */
double *EXPORT(relief_touch_corners)(void)
{
    return stand.corners;
}

int32_t *EXPORT(relief_touch_triangles)(void)
{
    return stand.triangles;
}

static void free_static(static_thing *s)
{
    if (page_world() != NULL) {
        rlf_world_remove_body(page_world(), s->body);
    }
    rlf_free((void *)(uintptr_t)s->hull.vertices);
    rlf_free((void *)(uintptr_t)s->hull.triangles);
    *s = (static_thing){0};
}

void EXPORT(relief_touch_remove_static)(int32_t handle)
{
    if (handle >= 0 && handle < STATICS) {
        free_static(&stand.statics[handle]);
    }
}

void page_stand_forget(void)
{
    for (int i = 0; i < STATICS; i++) {
        free_static(&stand.statics[i]);
    }
}

static int32_t add_static(rlf_body_def *def, const rlf_hull *hull)
{
    rlf_pose pose;
    if (page_world() == NULL || !page_pose_read(&pose)) {
        return -1;
    }
    def->is_real = true;
    def->position = pose.p;
    def->orientation = pose.q;
    for (int32_t i = 0; i < STATICS; i++) {
        static_thing *s = &stand.statics[i];
        if (s->body.index1 == 0) {
            s->hull = hull != NULL ? *hull : (rlf_hull){0};
            def->shape.hull = &s->hull;
            if (rlf_world_add_body(page_world(), def, &s->body) != RLF_OK) {
                *s = (static_thing){0}; /* the hull is the caller's again */
                return -1;
            }
            return i;
        }
    }
    (void)rlf_fail(RLF_ERROR_CAPACITY, "more than %d things that stand", (int)STATICS);
    return -1;
}

/* A box of these edges, metres, that stands where relief_touch_numbers says. Returns its handle; -1
 * = it was refused. */
int32_t EXPORT(relief_touch_box)(double x, double y, double z)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = RLF_SHAPE_BOX;
    def.shape.size = rlf_vec3_make(x, y, z);
    return add_static(&def, NULL);
}

static void *copy(const void *from, size_t bytes)
{
    void *to = rlf_alloc(bytes);
    return to != NULL ? memcpy(to, from, bytes) : NULL;
}

/* A convex solid of what is in relief_touch_corners and relief_touch_triangles, counter-clockwise
 * from outside, about its own origin. Returns as relief_touch_box. */
int32_t EXPORT(relief_touch_hull)(int32_t corners, int32_t triangles)
{
    if (corners < 4 || corners > STATIC_VERTICES || triangles < 4 || triangles > STATIC_TRIANGLES) {
        (void)rlf_fail(RLF_ERROR_CAPACITY, "a solid of %d corners and %d triangles", (int)corners,
                       (int)triangles);
        return -1;
    }
    for (int32_t i = 0; i < corners; i++) {
        const double *c = &stand.corners[(ptrdiff_t)3 * i];
        stand.vertices[i] = rlf_vec3_make(c[0], c[1], c[2]);
    }
    rlf_hull hull = {
        .vertices = copy(stand.vertices, (size_t)corners * sizeof(rlf_vec3)),
        .vertex_count = corners,
        .triangles = copy(stand.triangles, (size_t)triangles * 3 * sizeof(int32_t)),
        .triangle_count = triangles,
    };
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = RLF_SHAPE_HULL;
    const int32_t handle =
        hull.vertices != NULL && hull.triangles != NULL ? add_static(&def, &hull) : -1;
    if (handle < 0) {
        rlf_free((void *)(uintptr_t)hull.vertices);
        rlf_free((void *)(uintptr_t)hull.triangles);
    }
    return handle;
}
