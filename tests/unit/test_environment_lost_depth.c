/* Depth of pixels that return no light, and what is seen of virtual things there. */

#include "environment/real_depth.h"
#include "pinhole.h"
#include "test.h"

#include <string.h>

#define WIDTH 160
#define HEIGHT 120
#define PIXELS (WIDTH * HEIGHT)
#define NEAR_Z 1.5f
#define FAR_Z 3.0f

typedef struct stage {
    rlf_camera camera;
    rlf_pose T_picture_depth;
    rlf_registration *registration;
    lost_depth lost;
    edge_matte edges;
    rlf_frame frame;
    rlf_surface surface;
    rlf_plane_f32 z;
    float ray_x[PIXELS], ray_y[PIXELS], nothing[PIXELS], towards[PIXELS];
    float truth[PIXELS], sensed[PIXELS], settled[PIXELS], registered[PIXELS + 16];
    uint8_t reason[PIXELS], color[4 * PIXELS];
    uint32_t seed;
} stage;

static stage s;

static int32_t noise(int32_t most)
{
    s.seed = s.seed * 1664525u + 1013904223u;
    return (int32_t)(s.seed >> 16) % (2 * most + 1) - most;
}

static bool is_disc(int32_t i, double radius)
{
    const double x = i % WIDTH - 80;
    const double y = i / WIDTH - 60;
    return x * x + y * y < radius * radius;
}

static void set_color(int32_t i, int32_t red, int32_t green, int32_t blue)
{
    s.color[4 * i] = (uint8_t)red;
    s.color[4 * i + 1] = (uint8_t)green;
    s.color[4 * i + 2] = (uint8_t)blue;
}

static void lose(int32_t i)
{
    s.sensed[i] = 0.0f;
    s.reason[i] = RLF_REASON_NO_RETURN;
}

/* A blue disc, cut by the left border when `shift` says so, before a grey wall. */
static void sense(int32_t shift)
{
    for (int32_t i = 0; i < PIXELS; i++) {
        const int32_t x = i % WIDTH + shift;
        const bool is_near = is_disc(i - i % WIDTH + (x < WIDTH ? x : WIDTH - 1), 40.0);
        s.truth[i] = is_near ? NEAR_Z : FAR_Z;
        s.sensed[i] = s.truth[i];
        s.reason[i] = RLF_REASON_OK;
        set_color(i, (is_near ? 60 : 150) + noise(3), (is_near ? 80 : 150) + noise(3),
                  (is_near ? 140 : 150) + noise(3));
    }
}

static int32_t update(void)
{
    const real_windows all = {{{0, 0, WIDTH, HEIGHT}}, 1};
    memcpy(s.settled, s.sensed, sizeof(s.settled));
    s.frame.sequence++;
    lost_depth_update(&s.lost, s.registration, &s.frame, &s.surface, NULL, &all, s.settled, 0.0f);
    int32_t wrong = 0;
    for (int32_t i = 0; i < PIXELS; i++) {
        wrong += s.settled[i] < s.truth[i] - 0.05f || s.settled[i] > s.truth[i] + 0.05f;
    }
    return wrong;
}

static int set_up(void **state)
{
    (void)state;
    memset(&s, 0, sizeof(s));
    s.seed = 7;
    s.camera = pinhole(WIDTH, HEIGHT, 150);
    s.T_picture_depth = rlf_pose_identity();
    for (int32_t i = 0; i < PIXELS; i++) {
        s.ray_x[i] = (float)((i % WIDTH - s.camera.cx) / s.camera.fx);
        s.ray_y[i] = (float)((i / WIDTH - s.camera.cy) / s.camera.fy);
        s.towards[i] = -1.0f;
    }
    s.surface = (rlf_surface){.width = WIDTH,
                              .height = HEIGHT,
                              .ray_x = s.ray_x,
                              .ray_y = s.ray_y,
                              .depth = s.sensed,
                              .normal_x = s.nothing,
                              .normal_y = s.nothing,
                              .normal_z = s.towards,
                              .reason = s.reason};
    s.frame.color = (rlf_image_rgba8){s.color, WIDTH, HEIGHT, 4 * WIDTH};
    s.z = (rlf_plane_f32){s.registered, WIDTH, HEIGHT, WIDTH * (ptrdiff_t)sizeof(float)};
    assert_int_equal(rlf_registration_create(&s.camera, s.ray_x, s.ray_y, &s.camera,
                                             &s.T_picture_depth, &s.registration),
                     RLF_OK);
    assert_int_equal(
        lost_depth_create(s.registration, &s.camera, &s.T_picture_depth, NULL, &s.lost), RLF_OK);
    assert_int_equal(edge_matte_create(&s.camera, &s.camera, NULL, &s.edges), RLF_OK);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    edge_matte_destroy(&s.edges);
    lost_depth_destroy(&s.lost);
    rlf_registration_destroy(&s.registration);
    return 0;
}

/* A black print that returns no light belongs to what is around it, whatever its colour. */
TEST_CASE(a_hole_in_a_thing_is_the_thing)
{
    sense(0);
    for (int32_t i = 0; i < PIXELS; i++) {
        if (is_disc(i, 14.0)) {
            lose(i);
            set_color(i, 10, 10, 10);
        }
    }
    assert_int_equal(update(), 0);
}

/* Between two surfaces each pixel goes the way of its colours. */
TEST_CASE(colours_part_a_band_without_depth)
{
    sense(0);
    int32_t lost = 0;
    for (int32_t i = 0; i < PIXELS; i++) {
        if (is_disc(i, 46.0) && !is_disc(i, 33.0)) {
            lose(i);
            lost++;
        }
    }
    assert_true(update() < lost / 20);
}

/* Of a camera that has no depth there, 12 columns wide; a thing goes on up to the border. */
TEST_CASE(a_thing_goes_on_into_the_rim)
{
    sense(60);
    for (int32_t i = 0; i < PIXELS; i++) {
        if (i % WIDTH < 12) {
            lose(i);
        }
    }
    assert_true(update() < HEIGHT / 8);
}

/* A floor that goes down to the lower border, and is not seen in its last 12 rows. */
TEST_CASE(a_plane_goes_on_into_the_rim)
{
    static float up[PIXELS];
    sense(0);
    for (int32_t i = 0; i < PIXELS; i++) {
        const bool is_floor = s.ray_y[i] > 0.25f;
        s.truth[i] = is_floor ? 0.75f / s.ray_y[i] : FAR_Z;
        s.sensed[i] = s.truth[i];
        up[i] = is_floor ? -1.0f : 0.0f;
        s.towards[i] = is_floor ? 0.0f : -1.0f;
        set_color(i, 120, 120, 120);
        if (i / WIDTH >= HEIGHT - 12) {
            lose(i);
        }
    }
    s.surface.normal_y = up;
    assert_int_equal(update(), 0);
}

/* Someone before a void that returns nothing does not fill it. */
TEST_CASE(a_void_is_not_filled)
{
    sense(0);
    for (int32_t i = 0; i < PIXELS; i++) {
        s.truth[i] = is_disc(i, 30.0) ? NEAR_Z : 0.0f;
        s.sensed[i] = s.truth[i];
        if (!is_disc(i, 30.0)) {
            lose(i);
            set_color(i, 10, 10, 10);
        }
    }
    assert_true(update() < 40);
}

/* A void whose colours come and go about those of the thing: there is no depth in it here and not
 * there. */
TEST_CASE(a_void_of_like_colours_has_no_specks)
{
    int32_t changes = 0;
    sense(0);
    for (int32_t i = 0; i < PIXELS; i++) {
        if (!is_disc(i, 30.0)) {
            lose(i);
            const int32_t off = noise(2) < 1 ? 40 : 0;
            set_color(i, 60 + off, 80 + off, 140 + off);
        }
    }
    update();
    for (int32_t i = 0; i + 1 < PIXELS; i++) {
        const bool is_void = !is_disc(i, 34.0) && i % WIDTH + 1 < WIDTH;
        changes += is_void && (s.settled[i] > 0.0f) != (s.settled[i + 1] > 0.0f) ? 1 : 0;
    }
    assert_true(changes < 20);
}

static float shown_depth(int32_t i)
{
    return s.edges.cover.data[i] > 127 ? s.edges.near_z.data[i] : s.edges.far_z.data[i];
}

/* As light in stripes has it: beside an edge depth comes and goes, and edges shift by a pixel. */
TEST_CASE(nothing_flickers_while_nothing_moves)
{
    static float before[PIXELS];
    const rlf_plane_u8 no_state = {NULL, WIDTH, HEIGHT, WIDTH};
    int32_t changes = 0;
    for (int32_t frame = 0; frame < 40; frame++) {
        sense(0);
        for (int32_t i = 0; i < PIXELS; i++) {
            const bool is_edge = is_disc(i, 43.0 + 0.5 * noise(2)) && !is_disc(i, 38.0);
            if ((is_edge && noise(1) != 0) || (is_disc(i, 9.0) && noise(1) == 0)) {
                lose(i);
            }
        }
        update();
        rlf_registration_apply(s.registration, s.settled, &s.z, &no_state);
        edge_matte_clear_bodies(&s.edges);
        edge_matte_add_body(&s.edges, &s.camera, rlf_vec3_make(0, 0, 2.2), 1.5);
        edge_matte_spread_bodies(&s.edges);
        edge_matte_update(&s.edges, &s.z, NULL, &s.frame);
        for (int32_t i = 0; i < PIXELS; i++) {
            const float now = shown_depth(i);
            const bool is_changed = now < before[i] - 0.5f || now > before[i] + 0.5f;
            changes += frame >= 10 && is_changed ? 1 : 0;
            before[i] = now;
        }
    }
    /* 5 of 76,800 pixels a frame. */
    assert_true(changes <= 30 * 5 * PIXELS / 76800);
}

TEST_EACH(set_up, tear_down)
