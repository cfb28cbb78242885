/* Tracker and map with pixels that are larger than voxels, in a room whose walls lie right on
 * voxels, and depth of whole millimetres without noise. */

#include "pipeline/moving/moving.h"
#include "created.h"
#include "pinhole.h"
#include "seen_view.h"
#include "test.h"

#include <string.h>

enum { PIXELS_MOST = 320 * 240, FRAMES = 6 };

#define FRAME_NS 33333333

typedef struct fixture {
    rlf_rig rig;
    rlf_map *map;
    camera_pose camera;
    rlf_reconstruct *stage;
    uint16_t depth_mm[PIXELS_MOST];
    int64_t time_ns;
} fixture;

static fixture f;

/* The room, of which the inside is seen, and two boxes in it. */
static const rlf_aabb room = {{-1.8, -0.9, -1.0}, {1.8, 0.9, 3.0}};
static const rlf_aabb boxes[2] = {{{0.48, 0.42, 1.8}, {1.08, 0.9, 2.4}},
                                  {{-0.9, 0.18, 2.22}, {-0.42, 0.9, 2.7}}};

static void look(rlf_vec3 eye)
{
    const rlf_camera *c = &f.rig.depth;
    for (int32_t i = 0; i < c->width * c->height; i++) {
        const rlf_vec3 ray = {(i % c->width - c->cx) / c->fx, (i / c->width - c->cy) / c->fy, 1.0};
        double in, leave, z;
        (void)box_ray(&room, eye, ray, &in, &z);
        for (int32_t k = 0; k < 2; k++) {
            z = box_ray(&boxes[k], eye, ray, &in, &leave) ? rlf_min(z, in) : z;
        }
        f.depth_mm[i] = (uint16_t)(1000.0 * z + 0.5);
    }
}

static rlf_track_health feed(void)
{
    const rlf_frame frame = {.time_ns = f.time_ns += FRAME_NS,
                             .rig = &f.rig,
                             .depth_u16 = f.depth_mm,
                             .depth_stride = 2 * (ptrdiff_t)f.rig.depth.width,
                             .depth_units_per_metre = 1000.0};
    const rlf_surface *s = surface_of(f.stage, &frame);
    assert_int_equal(camera_pose_find(&f.camera, f.map, s, NULL, f.time_ns), RLF_OK);
    if (f.camera.may_fuse) {
        const rlf_map_view view = {.depth = s->depth,
                                   .normal_x = s->normal_x,
                                   .normal_y = s->normal_y,
                                   .normal_z = s->normal_z};
        assert_int_equal(rlf_map_integrate(f.map, &view, &f.camera.last.T_world_camera, NULL),
                         RLF_OK);
    }
    return f.camera.last.health;
}

/* As a mesh of it has them. */
static void open_stage(void)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f.rig);
    def.background_method = RLF_BACKGROUND_OFF;
    def.background_segment = RLF_SEGMENT_OFF;
    def.foreground_segment = RLF_SEGMENT_OFF;
    def.enable_fill = false;
    def.enable_steadying = false;
    def.enable_hold = false;
    def.enable_edge_normals = false;
    def.enable_velocity = false;
    def.enable_thickness = false;
    def.enable_coast = false;
    def.enable_color_sides = false;
    f.stage = stage_of(&def);
}

static void begin(int32_t width, int32_t height, double focal, double voxel_m)
{
    memset(&f, 0, sizeof(f));
    f.rig.depth = pinhole(width, height, focal);
    f.rig.depth_min_m = 0.1;
    f.rig.depth_max_m = 8.0;
    f.rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    rlf_map_def def = rlf_map_def_default();
    def.rig = f.rig;
    def.voxel_m = voxel_m;
    def.blocks_per_frame = 0;
    f.map = map_of(&def);
    open_stage();
    assert_int_equal(camera_pose_open(&f.camera, &f.rig, NULL), RLF_OK);
}

static void end(void)
{
    camera_pose_close(&f.camera);
    rlf_reconstruct_destroy(&f.stage);
    rlf_map_destroy(&f.map);
}

TEST_CASE(test_small_pictures_are_tracked)
{
    static const struct {
        int32_t width, height;
        double focal, voxel_m, off_m;
    } cameras[] = {{160, 120, 130.0, 0.006, 0.01},
                   {224, 172, 194.0, 0.006, 0.01},
                   {256, 192, 224.0, 0.006, 0.01},
                   {256, 192, 224.0, 0.003, 0.01},
                   {320, 240, 280.0, 0.006, 0.01}};
    for (size_t k = 0; k < sizeof(cameras) / sizeof(cameras[0]); k++) {
        begin(cameras[k].width, cameras[k].height, cameras[k].focal, cameras[k].voxel_m);
        for (int i = 0; i < FRAMES; i++) {
            const rlf_vec3 eye = {0.005 * i, 0.0, 0.002 * i};
            look(eye);
            const rlf_track_health health = feed();
            const rlf_vec3 off = rlf_sub(f.camera.last.T_world_camera.p, eye);
            if (health != RLF_TRACK_GOOD || rlf_length(off) > cameras[k].off_m) {
                fail_msg("%d x %d, voxel %g, frame %d: %s, %.1f mm off", (int)cameras[k].width,
                         (int)cameras[k].height, cameras[k].voxel_m, i,
                         rlf_track_health_name(health), 1000.0 * rlf_length(off));
            }
        }
        end();
    }
}

/* A camera that warms up: the first picture with depth begins the room. */
TEST_CASE(test_pictures_without_depth_do_not_begin_the_room)
{
    begin(256, 192, 224.0, 0.012);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(feed(), RLF_TRACK_LOST);
        assert_false(f.camera.may_fuse);
    }
    look(rlf_vec3_make(0, 0, 0));
    assert_int_equal(feed(), RLF_TRACK_GOOD);
    assert_int_equal(feed(), RLF_TRACK_GOOD);
    assert_int_equal(rlf_map_get_status(f.map).frames, 2);
    end();
}
