/* Segmentation eq. 4.4, regions, dilation, and what is stored of each region. */

#include "surface/steps.h" /* before the names of painted.h */

#include "painted.h"
#include "test.h"

/* A stage whose whole picture, empty at first, is segmented: no background, nothing filtered. */
static void begin(int32_t width, int32_t height, rlf_segment_method method, bool dilate)
{
    see_size(width, height);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_THESIS, &rig);
    def.scale_factor = 1;
    def.background_method = RLF_BACKGROUND_OFF;
    def.foreground_segment = method;
    def.segment_tau_m = 0.1;
    def.enable_dilation = dilate;
    def.min_region_points = 1;
    start_seeing(&def);
    paint_all(0.0f);
}

/* Bits by hand: a pixel is 1 when its right and its lower neighbours are within tau. */
TEST_CASE(bits_are_the_and_of_both_directions)
{
    const float values[16] = {1.0f, 1.0f, 2.0f, 2.0f, /* */
                              1.0f, 1.0f, 2.0f, 2.0f, /* */
                              1.0f, 1.0f, 1.0f, 1.0f, /* */
                              1.0f, 0.0f, 1.0f, 1.0f};
    const uint8_t expected[16] = {1, 0, 1, 1, /* */
                                  1, 0, 0, 0, /* */
                                  1, 0, 1, 1, /* */
                                  0, 0, 1, 1};
    image_grid grid = {.width = 4, .height = 4, .count = 16};
    uint8_t bits[16];
    rlf_segment_thesis_bits(&grid, 0.1, values, NULL, bits);
    assert_memory_equal(bits, expected, 16);
    rlf_segment_thesis_bits(&grid, 1.0, values, NULL, bits); /* |z_i - z_j| <= tau */
    assert_int_equal(bits[1], 1);
    assert_int_equal(bits[9], 0); /* above the hole */
}

/* Two halves at different depths: each is one region, dilation gives back what eq. 4.4 lost. */
TEST_CASE(dilation_restores_lost_pixels_and_keeps_labels)
{
    enum { W = 16, H = 12 };
    int labelled[2];
    int32_t labels[2][W * H];
    for (int dilate = 0; dilate < 2; dilate++) {
        begin(W, H, RLF_SEGMENT_THESIS, dilate);
        paint((area){0, W, 0, 6}, 1.0f);
        paint((area){0, W, 6, H}, 2.0f);
        depth[3 * W + 3] = 0.0f;
        const rlf_surface *s = see();
        assert_int_equal(s->region_count, 2);
        memcpy(labels[dilate], s->label, sizeof labels[0]);
        labelled[dilate] = 0;
        for (int i = 0; i < W * H; i++) {
            labelled[dilate] += s->label[i] != 0;
        }
    }
    /* lost: row 5 (16 pixels), the hole's left and upper neighbour */
    assert_int_equal(labelled[0], W * H - 1 - W - 2);
    assert_int_equal(labelled[1], W * H - 1);
    for (int i = 0; i < W * H; i++) {
        bool hole = i == 3 * W + 3;
        assert_true(labels[0][i] == 0 || labels[0][i] == labels[1][i]);
        assert_true((labels[1][i] == 0) == hole);
    }
    /* upper neighbour and left neighbour of the hole belong to the upper half */
    assert_int_equal(labels[1][2 * W + 3], labels[1][0]);
    assert_int_equal(labels[1][3 * W + 2], labels[1][0]);
}

/* Regions are 4-connected: two squares that touch at a corner stay apart. */
TEST_CASE(regions_are_4_connected)
{
    enum { W = 12, H = 12 };
    begin(W, H, RLF_SEGMENT_NOISE, false);
    paint((area){0, 6, 0, 6}, 1.0f);
    paint((area){6, W, 6, H}, 1.0f);
    const rlf_surface *s = see();
    assert_int_equal(s->region_count, 2);
    assert_int_not_equal(s->label[0], s->label[W * H - 1]);
}

/* A spiral is one component, however often its arms meet late. */
TEST_CASE(a_spiral_is_one_region)
{
    enum { W = 41, H = 41 };
    begin(W, H, RLF_SEGMENT_NOISE, false);
    int x = 0, y = 0, dx = 1, dy = 0, length = W - 1, count = 1;
    depth[0] = 1.0f;
    for (int leg = 0; length > 0; leg++) {
        for (int k = 0; k < length; k++) {
            x += dx;
            y += dy;
            depth[y * W + x] = 1.0f;
            count++;
        }
        int turn = dx;
        dx = -dy;
        dy = turn;
        length -= leg >= 2 && leg % 2 == 0 ? 2 : 0;
    }
    const rlf_surface *s = see();
    assert_int_equal(s->region_count, 1);
    int valid = 0;
    for (int i = 0; i < W * H; i++) {
        valid += depth[i] > 0.0f;
    }
    assert_int_equal(s->regions[0].point_count, valid);
    assert_in_range(valid, count / 2, count);
}

TEST_CASE(region_holds_points_box_rectangle_and_mask)
{
    enum { W = 40, H = 30 };
    begin(W, H, RLF_SEGMENT_NOISE, false);
    for (int i = 0; i < W * H; i++) {
        depth[i] = is_in((area){10, 25, 8, 20}, i) ? 1.0f + 0.002f * (float)(i % W) : 3.0f;
    }
    const rlf_surface *s = see();
    assert_int_equal(s->region_count, 2);
    int32_t label = s->label[10 * W + 12];
    const rlf_region *r = s->regions[0].label == label ? &s->regions[0] : &s->regions[1];
    assert_int_equal(r->label, label);
    assert_int_equal(r->point_count, 15 * 12);
    assert_int_equal(r->x0, 10);
    assert_int_equal(r->y0, 8);
    assert_int_equal(r->x1, 25);
    assert_int_equal(r->y1, 20);
    assert_float_equal(r->box.min.z, 1.02, 1e-6);
    assert_float_equal(r->box.max.z, 1.048, 1e-6);
    rlf_vec3 sum = {0, 0, 0};
    for (int32_t k = 0; k < r->point_count; k++) {
        int32_t i = s->region_points[r->first_point + k];
        assert_int_equal(s->label[i], label);
        rlf_vec3 p = rlf_surface_point(s, i);
        assert_true(rlf_aabb_distance2(&r->box, p) < 1e-12);
        sum = rlf_add(sum, p);
    }
    rlf_vec3 mean = rlf_scale(sum, 1.0 / r->point_count);
    assert_true(rlf_length(rlf_sub(mean, r->centroid)) < 1e-9);
    assert_true(r->plane_residual >= 0.0 && r->plane_residual < 1e-3);
}

/* A sphere's visible cap is no plane: its residual is far above a plane's. */
TEST_CASE(plane_residual_tells_flat_from_round)
{
    enum { W = 64, H = 64 };
    begin(W, H, RLF_SEGMENT_OFF, false);
    for (int i = 0; i < W * H; i++) {
        depth[i] = (float)sphere_depth(rlf_vec3_make(0, 0, 1.5), 0.3, stage->grid.ray_x[i],
                                       stage->grid.ray_y[i]);
    }
    const rlf_surface *s = see();
    assert_int_equal(s->region_count, 1);
    assert_true(s->regions[0].plane_residual > 0.03);
}

TEST_CASE(labels_stay_while_a_thing_moves)
{
    enum { W = 80, H = 40 };
    begin(W, H, RLF_SEGMENT_NOISE, false);
    int32_t first[2] = {0, 0};
    for (int t = 0; t < 10; t++) {
        paint_all(0.0f);
        paint((area){60 - 4 * t, 74 - 4 * t, 21, H}, 2.0f);
        paint((area){4 + 3 * t, 16 + 3 * t, 0, 15}, 1.0f);
        const rlf_surface *s = see();
        assert_int_equal(s->region_count, 2);
        int32_t now[2] = {s->label[5 * W + 6 + 3 * t], s->label[25 * W + 62 - 4 * t]};
        assert_true(now[0] > 0 && now[1] > 0 && now[0] != now[1]);
        for (int k = 0; k < 2; k++) {
            first[k] = t == 0 ? now[k] : first[k];
            assert_int_equal(now[k], first[k]);
        }
        assert_true(s->regions[0].age_ns == (int64_t)t * 33333333);
    }
}

TEST_CASE(too_many_regions_keep_the_largest)
{
    enum { W = 60, H = 40 };
    rlf_reconstruct_def def = see_size(W, H);
    def.background_method = RLF_BACKGROUND_OFF;
    def.enable_flying_removal = def.enable_fill = false;
    def.region_capacity = 3;
    def.min_region_points = 1;
    start_seeing(&def);
    paint_all(0.0f);
    for (int k = 0; k < 6; k++) { /* bars of 2, 3, ... 7 rows with a gap */
        paint((area){10 * k, 10 * k + 8, 0, k + 2}, 1.0f);
    }
    const rlf_surface *s = see();
    assert_int_equal(s->region_count, 3);
    for (int k = 0; k < 6; k++) {
        assert_true((s->label[10 * k] != 0) == (k >= 3));
    }
}

/* A plate of 0.6 x 0.2 m that is turned in the picture and leans back. */
TEST_CASE(oriented_box_fits_a_leaning_plate)
{
    enum { WIDTH = 256, HEIGHT = 212 };
    begin(WIDTH, HEIGHT, RLF_SEGMENT_NOISE, false);
    const rlf_vec3 normal = {0.0, 0.6, -0.8}, centre = {0.1, -0.05, 2.0};
    const rlf_vec3 across = {1.0, 0.0, 0.0}, up = {0.0, 0.8, 0.6};
    const rlf_vec3 longest = rlf_add(rlf_scale(across, 0.8), rlf_scale(up, 0.6));
    const rlf_vec3 middle = rlf_cross(normal, longest);
    const rlf_camera *c = &stage->def.rig.depth;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double x = (i % WIDTH - c->cx) / c->fx, y = (i / WIDTH - c->cy) / c->fy;
        double z = plane_depth(normal, rlf_dot(normal, centre), x, y);
        rlf_vec3 p = rlf_sub(rlf_vec3_make(x * z, y * z, z), centre);
        double a = rlf_dot(p, longest), b = rlf_dot(p, middle);
        depth[i] = rlf_max(a, -a) < 0.3 && rlf_max(b, -b) < 0.1 ? (float)z : 0.0f;
    }
    const rlf_surface *s = see();
    assert_int_equal(s->region_count, 1);
    const rlf_region *region = &s->regions[0];
    rlf_vec3 x = rlf_rotate(region->oriented_pose.q, rlf_vec3_make(1, 0, 0));
    rlf_vec3 z = rlf_rotate(region->oriented_pose.q, rlf_vec3_make(0, 0, 1));
    assert_true(rlf_length(rlf_cross(x, longest)) < 0.03);
    assert_true(rlf_length(rlf_cross(z, normal)) < 1e-3);
    assert_true(rlf_length(rlf_sub(region->oriented_pose.p, centre)) < 0.02);
    assert_float_equal(region->oriented_half.x, 0.3, 0.02);
    assert_float_equal(region->oriented_half.y, 0.1, 0.02);
    assert_true(region->oriented_half.z < 1e-3 && region->plane_residual < 1e-3);
}

TEST_EACH(NULL, stop_seeing)
