/* A body that sank into something thin, or over which that was seen too high, leaves it on the side
 * where its middle is. */
#include "grid_room.h"
#include "test.h"

#define TOP_Y 0.3
#define TOP_NEAR 1.6
#define TOP_FAR 2.2
#define TOP_SIDE 0.4
#define TOP_THICK 0.035
#define HALF 0.05

static float thickness[GRID_W * GRID_H];

/* A table's top of known or of guessed thickness. */
static void paint(bool is_known)
{
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        double z = TOP_Y / grid_room_ray(i).y, x = z * grid_room_ray(i).x;
        bool is_top = z > TOP_NEAR && z < TOP_FAR && x > -TOP_SIDE && x < TOP_SIDE;
        if (is_top) {
            grid_room_paint(i, z, rlf_vec3_make(0, -1, 0));
        }
        thickness[i] = is_top && is_known ? (float)(TOP_THICK * z / TOP_Y) : 0.0f;
    }
    grid_room->grid.background.thickness = thickness;
}

/* The height of a cube half a second after its lowest face was so far below the top's face. */
static double rise(double sunk, double z, rlf_vec3 turn)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(2 * HALF, 2 * HALF, 2 * HALF);
    def.position = rlf_vec3_make(0.05, TOP_Y - HALF + sunk, z);
    def.orientation = rlf_quat_from_rotation_vector(turn);
    def.restitution = 0.0;
    const grid_room_way way = grid_room_run(RLF_BORDER_EXTEND, &def, 15);
    assert_true(way.is_there);
    return way.p.y;
}

TEST_CASE(cube_with_its_middle_above_a_top_comes_out_above)
{
    for (int known = 0; known < 2; known++) {
        paint(known != 0);
        for (double sunk = 0.015; sunk < 0.046; sunk += 0.015) {
            for (double z = 1.85; z < 2.11; z += 0.125) {
                assert_true(rise(sunk, z, rlf_vec3_make(0, 0, 0)) < TOP_Y - HALF + 0.005);
                assert_true(rise(sunk, z, rlf_vec3_make(0.3, 0.5, 0.2)) < TOP_Y - HALF + 0.005);
            }
        }
        grid_room_destroy(NULL);
    }
}
