/* The parts of the contour step: where a contour is, what is known on the way in, and the normal
 * that is read off it. */

#include "surface/normals/contour.h"
#include "test.h"

#include <math.h>
#include <string.h>

static depth_step make_step(void)
{
    const rlf_depth_noise noise = {0.0015, -0.0005, 0.0003};
    return depth_step_make(&noise, 365.0);
}

/* Half of what is about every second pixel lies a metre behind: the contour is at its border. */
TEST_CASE(contours_point_to_what_is_behind)
{
    const depth_step step = make_step();
    for (int32_t t = 0; t < 8; t++) {
        double angle = 0.25 * 3.14159265358979 * t, x = cos(angle), y = sin(angle);
        contour_batch b = {0};
        for (int32_t k = 0; k < RLF_WINDOW_SIZE * RLF_BATCH; k++) {
            int32_t at = k / RLF_BATCH, i = k % RLF_BATCH;
            bool behind = x * (at % 5 - 2) + y * (at / 5 - 2) > 0.9;
            b.depth.at[at][i] = behind && i % 2 == 0 ? 3.0f : 2.0f;
            b.spacing[i] = i < 8 ? 1.0f : 2.0f;
        }
        contour_find(&step, &b);
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            if (i % 2 != 0) {
                assert_true(b.distance[i] == 0.0f);
                continue;
            }
            assert_true(fabs(b.out_x[i] - x) < 0.01 && fabs(b.out_y[i] - y) < 0.01);
            double nearest = t % 2 == 0 ? 0.5 : sqrt(2.0) - 0.5;
            assert_true(fabs(b.distance[i] - b.spacing[i] * nearest) < 1e-5);
        }
    }
}

/* A face, or a slope of 0.4 percent of the depth a pixel, and what lies 0.5, 3 or 4.5 percent
 * farther behind it: a contour where noise and a slope do not explain that, on both alike. */
TEST_CASE(slopes_have_no_contours)
{
    const depth_step step = make_step();
    const float slopes[2] = {0.0f, 0.004f}, behind[4] = {0.0f, 0.005f, 0.03f, 0.045f};
    contour_batch b = {0};
    for (int32_t k = 0; k < RLF_WINDOW_SIZE * RLF_BATCH; k++) {
        int32_t x = k / RLF_BATCH % RLF_WINDOW_SIDE - RLF_WINDOW_ABOUT, i = k % RLF_BATCH;
        float z = 2.0f + 2.0f * slopes[i / 4 % 2] * (float)x;
        b.depth.at[k / RLF_BATCH][i] = x == RLF_WINDOW_ABOUT ? z + 2.0f * behind[i % 4] : z;
        b.spacing[i] = 1.0f;
    }
    contour_find(&step, &b);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        assert_true((b.distance[i] > 0.0f) == (i % 4 >= 2));
        assert_true(b.distance[i] == 0.0f || b.out_x[i] > 0.99f);
    }
}

/* Ways inwards from contours to the right of the pixels: `out` is the component outwards. */
static void set_way(contour_batch *b, contour_way *way, int32_t i, int32_t k, double out)
{
    way->s[k][i] = b->distance[i] + (float)k;
    way->normal[k].x[i] = (float)out;
    way->normal[k].z[i] = (float)-sqrt(1.0 - out * out);
}

/* On a ball or a cylinder the sine of the angle to the ray falls linearly from 1 at the contour;
 * windows find it 0.8 pixels farther in. A flat face has no contour that it turns to. Of a filled
 * pixel the first normal is that of the next one. */
TEST_CASE(normals_near_a_contour_are_moved_out)
{
    const double radius = 20.0, inside = 0.8;
    contour_batch b = {0};
    contour_way way = {0};
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        b.out_x[i] = 1.0f;
        b.distance[i] = 0.5f + 0.25f * (float)i;
        way.moves[i] = 1.0f;
        for (int32_t k = i % 4 < 2 ? 0 : 1; k < CONTOUR_WAY; k++) {
            double s = b.distance[i] + k;
            set_way(&b, &way, i, k, i % 2 != 0 ? 0.5 : 1.0 - (s + inside) / radius);
        }
    }
    contour_normals found;
    contour_lean_out(&b, &way, &found);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        double out = 1.0 - b.distance[i] / radius, most = 0.98;
        bool turns = i % 2 == 0;
        assert_true(fabs(found.x[i] - (turns ? fmin(out, most) : 0.0)) < 1e-4);
        assert_true((found.z[i] < 0.0f) == turns);
    }
}

/* Two faces or folds, in turn, beside a contour: what is not flat leans out by a tangent of 0.45
 * within two pixels of it, if it is rounded. */
TEST_CASE(what_is_uneven_leans_out)
{
    const double lean = 0.45;
    contour_batch b = {0};
    contour_way way = {0};
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        b.out_x[i] = 1.0f;
        b.distance[i] = i < 8 ? 1.5f : 2.5f;
        way.is_round[i] = i % 4 < 2 ? 1.0f : 0.0f;
        double by = i % 2 == 0 ? 0.05 : 0.01; /* of a flat thing's noise, or more */
        for (int32_t k = 0; k < CONTOUR_WAY; k++) {
            set_way(&b, &way, i, k, 0.2 + (k % 2 == 0 ? by : -by));
        }
    }
    contour_normals found;
    contour_lean_out(&b, &way, &found);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        double own = way.normal[0].x[i], length = sqrt(1.0 + 2.0 * own * lean + lean * lean);
        bool leans = i < 8 && i % 4 == 0;
        assert_true(fabs(found.x[i] - (leans ? (own + lean) / length : 0.0)) < 1e-5);
        assert_true(fabs(found.z[i] - (leans ? way.normal[0].z[i] / length : 0.0)) < 1e-5);
    }
}

/* The outermost normal is that of another face than those farther in, turned outwards or inwards.
 */
TEST_CASE(the_last_face_goes_on)
{
    contour_batch b = {0};
    contour_way way = {0};
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        b.out_x[i] = 1.0f;
        b.distance[i] = 0.5f;
        for (int32_t k = 1; k < CONTOUR_WAY; k++) {
            set_way(&b, &way, i, k, k == 1 ? (i % 2 == 0 ? 0.8 : -0.8) : 0.0);
        }
    }
    contour_normals found;
    contour_lean_out(&b, &way, &found);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        assert_true(fabs(found.x[i] - (i % 2 == 0 ? 0.8 : 0.0)) < 1e-6);
    }
}

/* A surface of ten columns, one of them filled, before a wall: the ways go from its right side
 * inwards and end with it. */
TEST_CASE(ways_end_with_their_surface)
{
    enum { ACROSS = 24, DOWN = 6, FIRST = 8, FILLED = 15, LAST = 17, STEPS = CONTOUR_WAY };
    const depth_step step = make_step();
    float depth[ACROSS * DOWN], ray[ACROSS * DOWN], nx[ACROSS * DOWN], nz[ACROSS * DOWN];
    uint8_t known[ACROSS * DOWN];
    for (int32_t i = 0; i < ACROSS * DOWN; i++) {
        int32_t x = i % ACROSS;
        depth[i] = x >= FIRST && x <= LAST ? 2.0f : 3.0f;
        known[i] = x != FILLED;
        ray[i] = (float)i;
        nx[i] = 0.01f * (float)x;
        nz[i] = -1.0f;
    }
    float *const normal[3] = {nx, nx, nz};
    const contour_planes planes = {ACROSS, DOWN, ray, ray, depth, known, normal};
    contour_batch b = {0};
    contour_way way;
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        b.x[k] = LAST - k % 10;
        b.y[k] = k % DOWN;
        b.out_x[k] = 1.0f;
        b.distance[k] = 0.5f;
    }
    contour_walk_in(&planes, &step, &b, &way);
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        int32_t x = b.x[k], row = b.y[k] * ACROSS;
        int32_t last = x - FIRST < STEPS ? x - FIRST : STEPS - 1;
        assert_int_equal(way.inner[k], row + x - last);
        assert_true(way.ray_x[k] == (float)(row + x));
        for (int32_t n = 0; n < STEPS; n++) {
            int32_t at = x - n;
            bool has = n <= last && at != FILLED;
            assert_true(way.s[n][k] == 0.5f + (float)n);
            assert_true(way.normal[n].x[k] == (has ? nx[at] : 0.0f));
            assert_true(way.normal[n].z[k] == (has ? -1.0f : 0.0f));
        }
    }
}

/* A thing of 12 columns before a wall: those within four of the wall, where something was in
 * front before. */
TEST_CASE(what_is_seen_beside_a_contour_is_marked)
{
    enum { ACROSS = 32, DOWN = 9, FIRST = 10, COLUMNS = 12, REACH = CONTOUR_REACH };
    const depth_step step = make_step();
    float depth[ACROSS * DOWN];
    uint8_t known[ACROSS * DOWN], front[ACROSS * DOWN], mark[ACROSS];
    for (int32_t i = 0; i < ACROSS * DOWN; i++) {
        int32_t x = i % ACROSS;
        depth[i] = x >= FIRST && x < FIRST + COLUMNS ? 2.0f : 3.0f;
        known[i] = x != FIRST;
        front[i] = x >= FIRST && x < FIRST + 4;
    }
    ptrdiff_t row = REACH * ACROSS;
    contour_mark_row(depth + row, front + row, known + row, &step, ACROSS, REACH, ACROSS - REACH,
                     mark);
    for (int32_t x = REACH; x < ACROSS - REACH; x++) {
        bool beside = (x > FIRST && x < FIRST + 4) || (x >= FIRST + 8 && x < FIRST + COLUMNS);
        assert_int_equal(mark[x], beside && x < FIRST + 8);
    }
}
