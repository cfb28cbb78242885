/* Pixels whose depth was lost beside foreground, settled by the remembered colour of the room. */

#include "environment/real_depth.h"
#include "pinhole.h"
#include "test.h"

#include <string.h>

#define WIDTH 128
#define HEIGHT 96
#define PIXELS (WIDTH * HEIGHT)
#define COLOR_WIDTH 192
#define COLOR_HEIGHT 144
#define NEAR_Z 1.5f
#define FAR_Z 3.0f

/* A leg and a thin one beside it, metres along x at NEAR_Z. */
static const double legs[2][2] = {{-0.20, 0.10}, {0.115, 0.15}};

typedef struct stage {
    rlf_camera depth_camera, color_camera;
    rlf_pose T_color_depth;
    rlf_registration *registration;
    lost_depth lost;
    real_windows needed;
    rlf_frame frame;
    rlf_surface surface;
    float ray_x[PIXELS], ray_y[PIXELS];
    float truth[PIXELS], sensed[PIXELS], background[PIXELS], settled[PIXELS];
    uint8_t foreground[PIXELS], reason[PIXELS];
    uint8_t color[4 * COLOR_WIDTH * COLOR_HEIGHT];
} stage;

static stage s;

static bool is_leg(double x)
{
    return (x > legs[0][0] && x < legs[0][1]) || (x > legs[1][0] && x < legs[1][1]);
}

/* The wall is light grey with a pattern, the legs are blue; `shade` darkens what is left of them.
 */
static void paint(bool with_legs, double light, double shade)
{
    for (int32_t i = 0; i < COLOR_WIDTH * COLOR_HEIGHT; i++) {
        const double ray = (i % COLOR_WIDTH - s.color_camera.cx) / s.color_camera.fx;
        const double x = NEAR_Z * ray - s.T_color_depth.p.x;
        const double wall = light * (x < legs[0][0] ? shade : 1.0) * (150 + i / COLOR_WIDTH % 20);
        const bool is_blue = with_legs && is_leg(x);
        s.color[4 * i] = (uint8_t)(is_blue ? light * 40 : wall);
        s.color[4 * i + 1] = (uint8_t)(is_blue ? light * 60 : wall);
        s.color[4 * i + 2] = (uint8_t)(is_blue ? light * 110 : 0.9 * wall);
    }
    s.frame.color = (rlf_image_rgba8){s.color, COLOR_WIDTH, COLOR_HEIGHT, 4 * COLOR_WIDTH};
}

/* Depth is lost within three pixels of every edge: of the thin leg nothing is left, and it was
 * filled from the far side. */
static void sense(bool with_legs)
{
    for (int32_t i = 0; i < PIXELS; i++) {
        s.truth[i] = with_legs && is_leg(NEAR_Z * s.ray_x[i]) ? NEAR_Z : FAR_Z;
        s.background[i] = FAR_Z;
    }
    for (int32_t i = 0; i < PIXELS; i++) {
        bool is_lost = false;
        for (int32_t k = -3; k <= 3; k++) {
            const int32_t x = i % WIDTH + k;
            is_lost = is_lost || (x >= 0 && x < WIDTH && s.truth[i + k] != s.truth[i]);
        }
        s.reason[i] = is_lost ? RLF_REASON_FILLED : RLF_REASON_OK;
        s.sensed[i] = is_lost ? FAR_Z : s.truth[i];
        s.foreground[i] = s.sensed[i] < FAR_Z;
    }
}

static void update(void)
{
    memcpy(s.settled, s.sensed, sizeof(s.settled));
    s.frame.sequence++;
    lost_depth_update(&s.lost, s.registration, &s.frame, &s.surface, NULL, &s.needed, s.settled,
                      0.0f);
}

static int set_up(void **state)
{
    (void)state;
    memset(&s, 0, sizeof(s));
    s.depth_camera = pinhole(WIDTH, HEIGHT, 100);
    s.color_camera = pinhole(COLOR_WIDTH, COLOR_HEIGHT, 150);
    s.T_color_depth = rlf_pose_identity();
    s.T_color_depth.p.x = -0.05;
    for (int32_t i = 0; i < PIXELS; i++) {
        s.ray_x[i] = (float)((i % WIDTH - s.depth_camera.cx) / s.depth_camera.fx);
        s.ray_y[i] = (float)((i / WIDTH - s.depth_camera.cy) / s.depth_camera.fy);
    }
    s.surface = (rlf_surface){.width = WIDTH,
                              .height = HEIGHT,
                              .depth = s.sensed,
                              .reason = s.reason,
                              .foreground = s.foreground,
                              .background_depth = s.background};
    assert_int_equal(rlf_registration_create(&s.depth_camera, s.ray_x, s.ray_y, &s.color_camera,
                                             &s.T_color_depth, &s.registration),
                     RLF_OK);
    assert_int_equal(
        lost_depth_create(s.registration, &s.depth_camera, &s.T_color_depth, NULL, &s.lost),
        RLF_OK);
    s.needed = (real_windows){{{0, 0, COLOR_WIDTH, COLOR_HEIGHT}}, 1};
    paint(false, 1.0, 1.0);
    sense(false);
    for (int32_t k = 0; k < 10; k++) {
        update();
    }
    paint(true, 1.0, 1.0);
    sense(true);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    lost_depth_destroy(&s.lost);
    rlf_registration_destroy(&s.registration);
    return 0;
}

static int32_t left_of_the_leg(void)
{
    return (int32_t)(s.depth_camera.cx + s.depth_camera.fx * legs[0][0] / NEAR_Z);
}

/* Pixels that are not as far as they truly are, to a centimetre, of the middle rows. */
static int32_t count_wrong(const float *depth)
{
    int32_t wrong = 0;
    for (int32_t i = 20 * WIDTH; i < (HEIGHT - 20) * WIDTH; i++) {
        wrong += depth[i] < s.truth[i] - 0.01f || depth[i] > s.truth[i] + 0.01f;
    }
    return wrong;
}

TEST_CASE(the_picture_tells_which_side_a_lost_pixel_is_on)
{
    const int32_t before = count_wrong(s.sensed);
    update();
    assert_true(before > 400);
    assert_true(count_wrong(s.settled) < before / 10);
}

/* Where the colour camera sees the wall beside the leg; nearer to it the leg is in the way. */
TEST_CASE(what_was_filled_from_the_near_side_is_put_back)
{
    const int32_t beside = left_of_the_leg() - 2;
    for (int32_t i = 0; i < PIXELS; i++) {
        s.sensed[i] = s.reason[i] == RLF_REASON_FILLED ? NEAR_Z : s.sensed[i];
    }
    update();
    assert_true(count_wrong(s.settled) < count_wrong(s.sensed));
    for (int32_t y = 20; y < HEIGHT - 20; y++) {
        assert_true(s.sensed[y * WIDTH + beside] == NEAR_Z);
        assert_true(s.settled[y * WIDTH + beside] > FAR_Z - 0.01f);
    }
}

/* Then the colours around decide alone. */
TEST_CASE(another_exposure_forgets_the_plate)
{
    const int32_t before = count_wrong(s.sensed);
    paint(true, 0.6, 1.0);
    for (int32_t k = 0; k < 10; k++) {
        update();
    }
    assert_true(count_wrong(s.settled) < before / 2);
}

/* A leg's shadow on the wall beside it is not the leg. */
TEST_CASE(a_shadow_is_not_foreground)
{
    paint(true, 1.0, 0.65);
    const int32_t left = left_of_the_leg();
    update();
    for (int32_t y = 20; y < HEIGHT - 20; y++) {
        for (int32_t x = left - 2; x <= left; x++) {
            assert_true(s.settled[y * WIDTH + x] > FAR_Z - 0.01f);
        }
    }
}

TEST_CASE(what_is_not_needed_stays)
{
    s.needed.count = 0;
    update();
    assert_memory_equal(s.settled, s.sensed, sizeof(s.settled));
}

TEST_EACH(set_up, tear_down)
