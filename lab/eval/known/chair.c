/* The chair of the synthetic room as triangles, and bodies seen between its legs and slats. */
#include "eval/known/chair.h"

#include <string.h>

#define BOXES 9
#define X (-1.12)
#define Z 3.42
#define HEIGHT 0.915
#define FLOOR_Y 1.3
#define SIDE 0.045
#define SEAT_BASE 0.43
#define SEAT 0.42
#define LEG (0.5 * (SEAT - 1.6 * SIDE)) /* from the middle to a leg's */

/* src/sim/room.c has them: x, base above the floor, z; width, height, depth. */
static const double boxes[BOXES][6] = {
    {0, SEAT_BASE, 0, SEAT, 0.035, SEAT},  {-LEG, 0, -LEG, SIDE, SEAT_BASE, SIDE},
    {LEG, 0, -LEG, SIDE, SEAT_BASE, SIDE}, {-LEG, 0, LEG, SIDE, SEAT_BASE, SIDE},
    {LEG, 0, LEG, SIDE, SEAT_BASE, SIDE},  {-LEG, 0.465, LEG, SIDE, 0.45, SIDE},
    {LEG, 0.465, LEG, SIDE, 0.45, SIDE},   {0, 0.6, LEG, 0.35, 0.11, 0.02},
    {0, 0.8, LEG, 0.35, 0.11, 0.02}};

static const int32_t faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 6, 5, 7, 0, 1, 4, 4, 1, 5,
                                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 5, 3, 7};

rlf_result known_chair_create(rlf_model **out_model, rlf_known_def *out)
{
    rlf_model_vertex vertices[8 * BOXES];
    int32_t triangles[36 * BOXES];
    memset(vertices, 0, sizeof(vertices));
    for (int32_t i = 0; i < 8 * BOXES; i++) {
        const double *b = boxes[i / 8];
        float *p = vertices[i].position;
        p[0] = (float)(b[0] + ((i & 1) != 0 ? 0.5 : -0.5) * b[3]);
        p[1] = (float)(0.5 * HEIGHT - b[1] - ((i & 2) != 0 ? 0.0 : b[4]));
        p[2] = (float)(b[2] + ((i & 4) != 0 ? 0.5 : -0.5) * b[5]);
    }
    for (int32_t i = 0; i < 36 * BOXES; i++) {
        triangles[i] = faces[i % 36] + 8 * (i / 36);
    }
    rlf_model_def def = rlf_model_def_default();
    def.vertices = vertices;
    def.vertex_count = 8 * BOXES;
    def.triangles = triangles;
    def.triangle_count = 12 * BOXES;
    rlf_result result = rlf_model_create(&def, out_model);
    *out = rlf_known_def_default();
    out->shape.size = rlf_vec3_make(SEAT, HEIGHT, SEAT);
    out->look = (rlf_look){*out_model, 1.0, {0, 0, 0}};
    out->T_world_model.p = rlf_vec3_make(X, FLOOR_Y - 0.5 * HEIGHT, Z);
    out->collides = false;
    return result;
}

int32_t known_chair_place(rlf_body_state *bodies)
{
    static const double at[KNOWN_CHAIR_BODIES][3] = {{X - 0.12, 0.55, 3.76},
                                                     {X + 0.16, 0.7, 3.78},
                                                     {X - 0.1, 1.05, 3.74},
                                                     {X + 0.13, 1.1, 3.76}};
    for (int32_t i = 0; i < KNOWN_CHAIR_BODIES; i++) {
        bodies[i] = (rlf_body_state){.mass = 1.0, .is_held = true, .color = {0.2f, 0.5f, 0.9f}};
        bodies[i].T_world_body.p = rlf_vec3_make(at[i][0], at[i][1], at[i][2]);
        bodies[i].T_world_body.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.2, 0.4 * i, 0.1));
        bodies[i].shape = (rlf_shape){.type = RLF_SHAPE_BOX, .size = {0.16, 0.16, 0.16}};
    }
    return KNOWN_CHAIR_BODIES;
}
