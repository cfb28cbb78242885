/* Hands through the whole frame loop: a drawn hand comes in before a wall, opens and pinches. */
#include "hand_scene.h"

#include "relief/pipeline.h"
#include "test.h"

enum { EMPTY_FRAMES = 12, OPEN_FRAMES = 10, ALL_FRAMES = 34 };
#define FRAME_NS INT64_C(33333333)

/* The hand comes up from below, open, and then makes a ring. */
typedef struct hand_source {
    hand_scene *scene;
    scene_hand hand;
    int64_t frame;
} hand_source;

static rlf_result hand_next(void *self, rlf_frame *out)
{
    hand_source *s = self;
    if (s->frame == ALL_FRAMES) {
        return RLF_END;
    }
    const int64_t k = s->frame - EMPTY_FRAMES;
    memset(out, 0, sizeof(*out));
    out->sequence = (uint64_t)s->frame;
    out->time_ns = s->frame++ * FRAME_NS;
    scene_clear(s->scene, 2.0, out->time_ns);
    s->hand.palm =
        rlf_vec3_make(0.0, 0.05 - 0.01 * (double)(k < OPEN_FRAMES ? k : OPEN_FRAMES), 0.9);
    s->hand.fingers = k < OPEN_FRAMES ? FINGERS_ALL : FINGERS_RING;
    if (k >= 0) {
        scene_draw_hand(s->scene, &s->hand);
    }
    out->depth_f32 = s->scene->depth;
    out->depth_stride = SCENE_W * sizeof(float);
    return RLF_OK;
}

static rlf_result hand_restart(void *self)
{
    ((hand_source *)self)->frame = 0;
    return RLF_OK;
}

static rlf_source *open_hand(hand_source *memory)
{
    *memory = (hand_source){.scene = scene_create(), .hand = {.arm = 0.8}};
    rlf_source_info info;
    memset(&info, 0, sizeof(info));
    memcpy(info.name, "hand", sizeof("hand"));
    info.rig.depth = memory->scene->surface.camera;
    info.rig.T_color_depth = rlf_pose_identity();
    info.rig.depth_min_m = 0.3;
    info.rig.depth_max_m = 8.0;
    info.rig.noise = memory->scene->surface.noise;
    info.frame_count = ALL_FRAMES;
    info.frames_per_second = 30;
    const rlf_source_methods methods = {.next = hand_next, .restart = hand_restart};
    rlf_source *source = NULL;
    assert_int_equal(rlf_source_create_custom(&methods, &info, memory, &source), RLF_OK);
    return source;
}

/* Frames with a sure hand; the bodies at the end go to out_bodies. */
static int run(rlf_pipeline *pipeline, rlf_gesture *out_last, int32_t *out_bodies)
{
    rlf_pipeline_output out;
    int sure = 0;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        assert_ptr_equal(out.hands, rlf_pipeline_hands(pipeline));
        if (out.hands != NULL && out.hands->count > 0 &&
            out.hands->hand[0].confidence >= RLF_HAND_SURE) {
            sure++;
            *out_last = out.hands->hand[0].gesture;
        }
        *out_bodies = out.snapshot->body_count;
    }
    return sure;
}

TEST_CASE(a_pinch_spawns_a_body)
{
    hand_source memory;
    rlf_source *source = open_hand(&memory);
    rlf_scene scene = {.gravity = {0, 0, 0}};
    scene.on[RLF_HAND_EVENT_PINCH_BEGIN] = RLF_HAND_ACTION_SPAWN;
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    def.scene = &scene;
    def.enable_render = false;
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    rlf_gesture last = RLF_GESTURE_NONE;
    int32_t bodies = 0;
    const int sure = run(pipeline, &last, &bodies);
    assert_true(sure >= ALL_FRAMES - EMPTY_FRAMES - 6);
    assert_int_equal(last, RLF_GESTURE_PINCH);
    assert_int_equal(bodies, 1);
    assert_int_equal(rlf_pipeline_restart(pipeline), RLF_OK);
    assert_null(rlf_pipeline_hands(pipeline));
    assert_int_equal(run(pipeline, &last, &bodies), sure);
    assert_int_equal(bodies, 1);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    free(memory.scene);
}

/* One body, and what a pinch does; the state of all bodies after the last frame. */
static rlf_snapshot run_bound(rlf_hand_action action, const rlf_body_def *body,
                              rlf_body_state *out_first)
{
    hand_source memory;
    rlf_source *source = open_hand(&memory);
    rlf_body_def bodies[1] = {*body};
    rlf_scene scene = {.gravity = {0, 0, 0}, .bodies = bodies, .body_count = 1};
    scene.on[RLF_HAND_EVENT_PINCH_BEGIN] = action;
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    def.scene = &scene;
    def.enable_render = false;
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    rlf_pipeline_output out;
    rlf_snapshot last = {.body_count = -1};
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        last = *out.snapshot;
        if (last.body_count > 0) {
            *out_first = last.bodies[last.body_count - 1];
        }
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    free(memory.scene);
    return last;
}

/* A pinch throws a second body, takes the near one away, or lets all start anew. */
TEST_CASE(a_pinch_throws_removes_and_resets)
{
    rlf_body_state body;
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.02};
    def.position = rlf_vec3_make(0.5, -0.3, 0.9);
    assert_int_equal(run_bound(RLF_HAND_ACTION_THROW, &def, &body).body_count, 2);
    assert_true(rlf_length(body.velocity) > 2.0);
    def.velocity = rlf_vec3_make(0.0, -0.3, 0.0);
    const double way = 0.3 * 1e-9 * (double)(ALL_FRAMES * FRAME_NS); /* without a pinch */
    assert_int_equal(run_bound(RLF_HAND_ACTION_RESET, &def, &body).body_count, 1);
    assert_true(def.position.y - body.T_world_body.p.y < 0.6 * way);
    def.velocity = rlf_vec3_make(0, 0, 0);
    def.position = rlf_vec3_make(-0.15, -0.2, 0.9); /* beside the ring, a hand's breadth away */
    assert_int_equal(run_bound(RLF_HAND_ACTION_REMOVE, &def, &body).body_count, 0);
}

/* Off, nobody looks for hands; the view turns them on and draws them. */
TEST_CASE(the_view_turns_them_on)
{
    hand_source memory;
    rlf_source *source = open_hand(&memory);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    rlf_pipeline_output out;
    for (int k = 0; k < EMPTY_FRAMES; k++) {
        assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
        assert_null(out.hands);
    }
    rlf_pipeline_set_view(pipeline, RLF_VIEW_HANDS);
    for (int k = 0; k < OPEN_FRAMES; k++) {
        assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
    }
    assert_true(out.hands != NULL && out.hands->count == 1);
    bool has_green = false;
    for (int32_t y = 0; y < out.render.image.height; y++) {
        const uint8_t *row = rlf_rgba8_row(&out.render.image, y);
        for (int32_t x = 0; x < out.render.image.width; x++) {
            const uint8_t *p = row + 4 * (ptrdiff_t)x;
            has_green = has_green || (p[0] == 120 && p[1] == 255 && p[2] == 120);
        }
    }
    assert_true(has_green);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    free(memory.scene);
}
