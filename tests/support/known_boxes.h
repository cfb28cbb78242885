/* A model of boxes, for tests of known objects. */
#ifndef RLF_TEST_KNOWN_BOXES_H
#define RLF_TEST_KNOWN_BOXES_H

#include "test.h"
#include "relief/model.h"

#include <string.h>

#define BOXES_MAX 40

/* The boxes, each at its `at`, as one model. */
static inline rlf_model *model_of_boxes(const rlf_vec3 *at, const rlf_vec3 *size, int32_t count)
{
    static const int32_t faces_of_box[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 6, 5, 7, 0, 1, 4, 4, 1, 5,
                                             2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 5, 3, 7};
    static rlf_model_vertex vertices[8 * BOXES_MAX];
    static int32_t triangles[36 * BOXES_MAX];
    memset(vertices, 0, sizeof(vertices));
    for (int32_t i = 0; i < 8 * count; i++) {
        const rlf_vec3 *p = &at[i / 8], *s = &size[i / 8];
        vertices[i].position[0] = (float)(p->x + ((i & 1) != 0 ? 0.5 : -0.5) * s->x);
        vertices[i].position[1] = (float)(p->y + ((i & 2) != 0 ? 0.5 : -0.5) * s->y);
        vertices[i].position[2] = (float)(p->z + ((i & 4) != 0 ? 0.5 : -0.5) * s->z);
    }
    for (int32_t i = 0; i < 36 * count; i++) {
        triangles[i] = faces_of_box[i % 36] + 8 * (i / 36);
    }
    rlf_model_def def = rlf_model_def_default();
    def.vertices = vertices;
    def.vertex_count = 8 * count;
    def.triangles = triangles;
    def.triangle_count = 12 * count;
    rlf_model *model = NULL;
    assert_int_equal(rlf_model_create(&def, &model), RLF_OK);
    return model;
}

#endif
