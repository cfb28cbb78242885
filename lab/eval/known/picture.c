/* Bodies behind the boxes of the room: are they hidden where they ought to be? */
#include "eval/known/picture.h"

#include "eval/known/chair.h"
#include "eval/known/room.h"
#include "eval/picture/edges.h"
#include "eval/picture/truth.h"
#include "eval/table.h"

#include <math.h>
#include <string.h>

#define SETTLE 15
#define JUDGED 3 /* pictures */
#define BODIES 6

/* One run: with or without models, with or without depth on the boxes. */
typedef struct known_case {
    bool has_models, is_lost;
    const char *keys[3], *titles[3];
} known_case;

#define BOX_CASES 4
#define CASES 6
static const known_case cases[CASES] = {
    {false,
     false,
     {"plain_edge_px", "plain_iou", "plain_order_percent"},
     {"edges of the boxes, no model: off by, px", "  hidden pixels: IoU",
      "  wrong though 5 cm apart, %"}},
    {true,
     false,
     {"edge_px", "iou", "order_percent"},
     {"  with models: off by, px", "  hidden pixels: IoU", "  wrong though 5 cm apart, %"}},
    {false,
     true,
     {"lost_plain_edge_px", "lost_plain_iou", "lost_plain_order_percent"},
     {"boxes without depth, no model: off by, px", "  hidden pixels: IoU",
      "  wrong though 5 cm apart, %"}},
    {true,
     true,
     {"lost_edge_px", "lost_iou", "lost_order_percent"},
     {"  with models: off by, px", "  hidden pixels: IoU", "  wrong though 5 cm apart, %"}},
    {false,
     false,
     {"plain_chair_edge_px", "plain_chair_iou", "plain_chair_order_percent"},
     {"legs and slats of the chair, no model: off by, px", "  hidden pixels: IoU",
      "  wrong though 5 cm apart, %"}},
    {true,
     false,
     {"chair_edge_px", "chair_iou", "chair_order_percent"},
     {"  with its triangles: off by, px", "  hidden pixels: IoU", "  wrong though 5 cm apart, %"}}};

/* The models of a case, and the bodies behind them. */
typedef struct known_set {
    const rlf_known_def *models;
    int32_t count;
    int32_t (*place)(rlf_body_state *bodies);
} known_set;

/* Half hidden behind a box each: above it, to its left and to its right, half a metre behind. */
static int32_t place_bodies(rlf_body_state *bodies)
{
    static const double sides[3] = {-0.13, 0.0, 0.13};
    int32_t count = 0;
    for (int32_t i = 0; i < KNOWN_MODELS; i += 2) {
        const rlf_known_def model = known_true_model(i);
        for (int32_t k = 0; k < 3; k++) {
            rlf_body_state *body = &bodies[count++];
            *body = (rlf_body_state){.mass = 1.0, .is_held = true, .color = {0.9f, 0.4f, 0.2f}};
            rlf_vec3 p = rlf_scale(model.T_world_model.p, 1.2);
            p.x += sides[k] * (i == 0 ? 1.6 : 1.0);
            p.y -= k == 1 ? 0.13 : 0.04;
            body->T_world_body.p = p;
            body->T_world_body.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.3, 0.5 * k, 0.2));
            body->shape = (rlf_shape){.type = RLF_SHAPE_BOX, .size = {0.16, 0.16, 0.16}};
        }
    }
    return count;
}

typedef struct known_run {
    rlf_source *source, *room;
    rlf_pipeline *pipeline;
    rlf_compositor *compositor;
    picture_truth truth;
    rlf_body_state bodies[BODIES];
    rlf_snapshot snapshot;
    float *alpha;
} known_run;

static void close_run(known_run *run)
{
    picture_truth_finish(&run->truth);
    rlf_free(run->alpha);
    rlf_compositor_destroy(&run->compositor);
    rlf_pipeline_destroy(&run->pipeline);
    rlf_source_destroy(&run->source);
}

static rlf_result open_run(known_run *run, const known_case *c, int64_t seed, const known_set *set)
{
    rlf_known_def copies[KNOWN_MODELS];
    memcpy(copies, set->models, (size_t)set->count * sizeof(*copies));
    const rlf_scene scene = {.known = copies, .known_count = c->has_models ? set->count : 0};
    rlf_result result = known_open_room(seed, c->is_lost, &run->source, &run->room);
    if (result != RLF_OK) {
        return result;
    }
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, run->source, NULL);
    def.enable_render = false;
    def.scene = &scene;
    result = rlf_pipeline_create(&def, &run->pipeline);
    if (result == RLF_OK) {
        rlf_compositor_def compositor = rlf_pipeline_get_compositor_def(run->pipeline);
        result = rlf_compositor_create_soft(&compositor, &run->compositor);
    }
    if (result == RLF_OK) {
        const rlf_rig *rig = &rlf_source_get_info(run->source)->rig;
        run->snapshot = (rlf_snapshot){.bodies = run->bodies};
        run->snapshot.body_count = set->place(run->bodies);
        run->alpha =
            rlf_alloc_array((size_t)rig->color.width * (size_t)rig->color.height, sizeof(float));
        result = run->alpha != NULL
                     ? picture_truth_init(&run->truth, rig, run->bodies, run->snapshot.body_count)
                     : RLF_ERROR_MEMORY;
    }
    return result;
}

static rlf_result draw(known_run *run)
{
    rlf_pipeline_output frame;
    rlf_render_output out;
    rlf_result result = rlf_pipeline_step(run->pipeline, &frame);
    if (result != RLF_OK) {
        return result;
    }
    run->snapshot.known = frame.snapshot->known;
    run->snapshot.known_count = frame.snapshot->known_count;
    const rlf_render_input input = {.frame = &frame.frame,
                                    .surface = frame.surface,
                                    .snapshot = &run->snapshot,
                                    .T_world_camera = rlf_pose_identity()};
    result = rlf_compositor_render(run->compositor, &input, &out);
    for (int32_t i = 0; result == RLF_OK && i < out.matte.width * out.matte.height; i++) {
        run->alpha[i] = (float)out.matte.data[i] * (1.0f / 255.0f);
    }
    return result;
}

static rlf_result measure(const known_case *c, int64_t seed, const known_set *set,
                          picture_errors *e)
{
    known_run run = {0};
    rlf_result result = open_run(&run, c, seed, set);
    for (int i = 0; i < SETTLE + JUDGED && result == RLF_OK; i++) {
        result = draw(&run);
        if (result == RLF_OK && i == SETTLE) {
            result = picture_truth_update(&run.truth, run.room); /* nothing moves */
        }
        if (result == RLF_OK && i >= SETTLE) {
            picture_errors_add(e, &run.truth, run.alpha, NULL);
        }
    }
    close_run(&run);
    return result;
}

static void add_rows(eval_table *table, const known_case *c, const picture_errors *e)
{
    const double values[3] = {
        picture_mean(&e->things),
        e->either_hidden > 0 ? (double)e->both_hidden / (double)e->either_hidden : NAN,
        e->pixels > 0 ? 100.0 * (double)e->order / (double)e->pixels : NAN};
    for (int k = 0; k < 3; k++) {
        eval_table_add(table, "known", c->keys[k], c->titles[k], RLF_PROFILE_LIVE, values[k]);
    }
}

rlf_result known_run_picture(eval_table *table, int64_t seed,
                             const rlf_known_def models[KNOWN_MODELS])
{
    rlf_known_def chair;
    rlf_model *model = NULL;
    rlf_result result = known_chair_create(&model, &chair);
    const known_set sets[2] = {{models, KNOWN_MODELS, place_bodies},
                               {&chair, 1, known_chair_place}};
    picture_errors *e = rlf_alloc(sizeof(*e));
    result = result == RLF_OK && e == NULL ? RLF_ERROR_MEMORY : result;
    for (int i = 0; i < CASES && result == RLF_OK; i++) {
        memset(e, 0, sizeof(*e));
        result = measure(&cases[i], seed, &sets[i < BOX_CASES ? 0 : 1], e);
        if (result == RLF_OK) {
            add_rows(table, &cases[i], e);
        }
    }
    rlf_free(e);
    rlf_model_destroy(&model);
    return result;
}
