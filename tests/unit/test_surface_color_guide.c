/* Dropped pixels at the outline of a disc before a wall: the colour picture tells their side, also
 * when it is not where it should be, and does nothing when it shows something else. */

#include "seen_view.h"
#include "test.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 128, HEIGHT = 112, COLOR_WIDTH = 320, COLOR_HEIGHT = 280, FRAMES = 40, LAST = 6 };

typedef enum picture { PICTURE_NONE, PICTURE_PLAIN, PICTURE_DISC, PICTURE_NOISE } picture;

static const double disc_z = 1.0, wall_z = 2.0, radius_px = 40.3, baseline_m = 0.04;
static const double focal = 90.0, color_focal = 225.0;

static uint32_t hash(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

static rlf_rig make_rig(double shift_u, double shift_v)
{
    rlf_rig rig = {.T_color_depth = rlf_pose_identity(),
                   .has_color = true,
                   .depth_min_m = 0.5,
                   .depth_max_m = 4.5,
                   .noise = {0.0015, -0.0005, 0.0003}};
    rig.depth = (rlf_camera){
        .width = WIDTH, .height = HEIGHT, .fx = focal, .fy = focal, .cx = 64.2, .cy = 56.4};
    rig.color = (rlf_camera){.width = COLOR_WIDTH,
                             .height = COLOR_HEIGHT,
                             .fx = color_focal,
                             .fy = color_focal,
                             .cx = 160.0 + shift_u,
                             .cy = 140.0 + shift_v};
    rig.T_color_depth.p.x = -baseline_m;
    return rig;
}

/* Pixels of the depth image from a ray's place at the disc to its outline, > 0 inside. */
static double inside_px(double x, double y)
{
    return radius_px - focal * sqrt(x * x + y * y);
}

/* As the colour camera sees disc and wall from where it is, over an area of one pixel. */
static void paint(picture kind, uint32_t seed, uint8_t *out)
{
    static const uint8_t disc[3] = {180, 60, 50}, wall[3] = {120, 140, 150};
    for (int32_t i = 0; i < COLOR_WIDTH * COLOR_HEIGHT; i++) {
        double x = (i % COLOR_WIDTH - 160.0) / color_focal * disc_z + baseline_m;
        double y = (i / COLOR_WIDTH - 140.0) / color_focal * disc_z;
        double share = 0.5 + inside_px(x / disc_z, y / disc_z) * color_focal / focal;
        share = kind != PICTURE_DISC || share < 0.0 ? 0.0 : (share > 1.0 ? 1.0 : share);
        for (int32_t k = 0; k < 3; k++) {
            double grain = hash(seed + (uint32_t)(4 * i + k)) % 13 - 6.0;
            double value = wall[k] + share * (disc[k] - wall[k]) + grain;
            bool is_noise = kind == PICTURE_NOISE;
            out[4 * i + k] = (uint8_t)(is_noise ? hash((uint32_t)(i / 7 * 4 + k)) & 255 : value);
        }
        out[4 * i + 3] = 255;
    }
}

/* Depth with a ragged band about the outline taken away. */
static void sense(const rlf_rig *rig, uint32_t seed, uint16_t *out)
{
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        double x = (i % WIDTH - rig->depth.cx) / focal, y = (i / WIDTH - rig->depth.cy) / focal;
        double inside = inside_px(x, y), off = fabs(inside);
        bool is_dropped = off < 0.7 + (double)(hash(seed + (uint32_t)i) % 100) / 100.0;
        double z = inside > 0.0 ? disc_z : wall_z;
        out[i] = (uint16_t)(is_dropped ? 0 : 1000.0 * z);
    }
}

static int32_t count_wrong(const rlf_surface *s, const rlf_rig *rig)
{
    int32_t wrong = 0;
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        double x = (i % WIDTH - rig->depth.cx) / focal, y = (i / WIDTH - rig->depth.cy) / focal;
        double z = inside_px(x, y) > 0.0 ? disc_z : wall_z;
        wrong += s->reason[i] == RLF_REASON_FILLED && fabs(s->depth[i] - z) > 0.3 ? 1 : 0;
    }
    return wrong;
}

/* Wrong sides in the last frames; the last one's depth. */
static int32_t run(picture kind, bool enable, double shift_u, double shift_v, float *out_depth)
{
    static uint16_t depth[WIDTH * HEIGHT];
    static uint8_t color[4 * COLOR_WIDTH * COLOR_HEIGHT];
    const rlf_rig rig = make_rig(shift_u, shift_v);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    def.enable_color_sides = enable;
    def.enable_steadying = def.enable_smoothing = def.enable_flying_removal = false;
    def.enable_coast = false;
    def.background_method = RLF_BACKGROUND_OFF;
    rlf_reconstruct *stage = NULL;
    int32_t wrong = 0;
    stage = stage_of(&def);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        const rlf_surface *surface = NULL;
        rlf_frame f = {.sequence = frame,
                       .time_ns = (int64_t)frame * 33000000,
                       .rig = &rig,
                       .depth_u16 = depth,
                       .depth_stride = 2 * WIDTH,
                       .depth_units_per_metre = 1000.0};
        if (kind != PICTURE_NONE) {
            f.color = (rlf_image_rgba8){color, COLOR_WIDTH, COLOR_HEIGHT, 4 * COLOR_WIDTH};
            paint(kind, 77777u * frame, color);
        }
        sense(&rig, 99991u * frame, depth);
        surface = surface_of(stage, &f);
        wrong += frame >= FRAMES - LAST ? count_wrong(surface, &rig) : 0;
        memcpy(out_depth, surface->depth, sizeof(float) * WIDTH * HEIGHT);
    }
    rlf_reconstruct_destroy(&stage);
    return wrong;
}

static float with[WIDTH * HEIGHT], without[WIDTH * HEIGHT];

TEST_CASE(the_picture_tells_the_side)
{
    int32_t by_depth = run(PICTURE_DISC, false, 0.0, 0.0, without);
    int32_t by_color = run(PICTURE_DISC, true, 0.0, 0.0, with);
    assert_true(by_depth > 100);
    assert_true(3 * by_color < 2 * by_depth);
}

TEST_CASE(a_picture_that_is_off_is_put_right)
{
    int32_t by_depth = run(PICTURE_DISC, false, 0.0, 0.0, without);
    assert_true(3 * run(PICTURE_DISC, true, 2.5, 0.0, with) < 2 * by_depth);
    assert_true(3 * run(PICTURE_DISC, true, -1.5, 2.0, with) < 2 * by_depth);
}

TEST_CASE(a_picture_that_says_nothing_changes_nothing)
{
    (void)run(PICTURE_NONE, false, 0.0, 0.0, without);
    (void)run(PICTURE_NONE, true, 0.0, 0.0, with);
    assert_memory_equal(with, without, sizeof with);
    (void)run(PICTURE_PLAIN, true, 0.0, 0.0, with);
    assert_memory_equal(with, without, sizeof with);
}

TEST_CASE(a_picture_of_something_else_is_not_believed)
{
    (void)run(PICTURE_NONE, false, 0.0, 0.0, without);
    (void)run(PICTURE_NOISE, true, 0.0, 0.0, with);
    assert_memory_equal(with, without, sizeof with);
    (void)run(PICTURE_DISC, true, 60.0, 30.0, with); /* all but a corner is beside the disc */
    assert_memory_equal(with, without, sizeof with);
}
