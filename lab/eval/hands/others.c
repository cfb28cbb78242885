/* Section "grasps": another's hands grasp, begin to and do not, and move among bodies; through the
 * whole pipeline, and with parts of it replaced by the truth. */
#include "eval/hands/act.h"
#include "eval/hands/hands.h"
#include "eval/measures/percent.h"

#include <stdlib.h>
#include <string.h>

#define FRAME_S (1.0 / 30.0)
#define PUT_S 0.4
#define EACH 2      /* grasps of a kind for a seed */
#define RISEN 0.7   /* of the hand's rise */
#define HELD_M 0.04 /* from its place in the hand: it is carried */
#define DROPPED_M 0.05
#define LET_GO_S 0.6 /* after the hand begins to open, and a quarter second after it has opened */
#define AIR_M 0.03
#define AIR_FRAMES 10
#define GRABBED_FRAMES 3
#define BACK_S 2.0 /* after so long what was pushed by more than this stands again */
#define MOVED_M 0.03

typedef enum truth_part {
    TRUTH_NONE = 0,
    TRUTH_MASK = 1,
    TRUTH_JOINTS = 2,
    TRUTH_COUNT = 3
} truth_part;

/* One script before the pipeline, or before its parts. */
typedef struct others_run {
    another_act act;
    another_view *view;
    eval_random noise;
    int64_t frame;
    truth_part part;
    rlf_source *source;
    rlf_pipeline *pipeline;
    rlf_world *world; /* the pipeline's, or its own */
    rlf_hand_tracker *tracker;
    rlf_grid_hand hands[2]; /* as they are, or as they were found */
    rlf_vec3 body, place;   /* the first body and its place in the hand, in the frame before */
    rlf_vec3 speed;         /* its velocity then, m/s */
    bool was_held;
    double grab_jump, release_jump; /* most so far, metres in a frame */
    rlf_vec3 palm;                  /* of the first, in the frame before; 0 = none */
    const rlf_snapshot *snapshot;
    double time;
    bool is_put;
} others_run;

static const rlf_surface *show(others_run *run)
{
    run->time = FRAME_S * (double)run->frame;
    const int32_t count = another_act_pose(&run->act, run->time);
    run->frame++;
    return another_view_show(run->view, run->act.hand, count, &run->noise,
                             1000 + (int64_t)(1e9 * run->time));
}

static rlf_result next_frame(void *self, rlf_frame *out)
{
    const rlf_surface *surface = show(self);
    *out = (rlf_frame){.sequence = surface->sequence, .time_ns = surface->time_ns};
    out->depth_f32 = surface->depth;
    out->depth_stride = (ptrdiff_t)sizeof(float) * ANOTHER_WIDTH;
    return RLF_OK;
}

static void close_run(others_run *run)
{
    if (run->pipeline == NULL) {
        rlf_world_destroy(&run->world);
    }
    rlf_pipeline_destroy(&run->pipeline);
    rlf_source_destroy(&run->source);
    rlf_hand_tracker_destroy(&run->tracker);
    another_view_destroy(run->view);
    free(run);
}

static rlf_result open_parts(others_run *run, rlf_vec3 gravity)
{
    if (run->part == TRUTH_NONE) {
        rlf_source_info info = {.name = "another's hands",
                                .frame_count = -1,
                                .frames_per_second = 30.0,
                                .is_simulated = true};
        info.rig = *another_view_rig(run->view);
        const rlf_source_methods methods = {.next = next_frame};
        rlf_result result = rlf_source_create_custom(&methods, &info, run, &run->source);
        if (result == RLF_OK) {
            rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, run->source, NULL);
            def.enable_render = false;
            def.world.enable_grab = true;
            def.world.gravity = gravity;
            result = rlf_pipeline_create(&def, &run->pipeline);
        }
        run->world = result == RLF_OK ? rlf_pipeline_get_world(run->pipeline) : NULL;
        return result;
    }
    rlf_world_def def = rlf_world_def_default();
    def.enable_grab = true;
    def.gravity = gravity;
    const rlf_hand_tracker_def hands = rlf_hand_tracker_def_default(ANOTHER_WIDTH, ANOTHER_HEIGHT);
    const rlf_result result = rlf_world_create(&def, &run->world);
    return result == RLF_OK ? rlf_hand_tracker_create(&hands, &run->tracker) : result;
}

/* NULL when there is no memory for it. */
static others_run *open_run(act_kind kind, bool is_aborted, uint64_t seed, truth_part part)
{
    others_run *run = calloc(1, sizeof(*run));
    if (run == NULL) {
        return NULL;
    }
    eval_random r = eval_random_start(seed);
    another_act_draw(&run->act, kind, is_aborted, &r);
    run->noise = eval_random_start(seed + 7);
    run->part = part;
    run->view = another_view_create();
    const rlf_vec3 down = rlf_rotate(run->act.T_camera_stage.q, rlf_vec3_make(0, -9.81, 0));
    if (run->view != NULL) {
        another_act_room(&run->act, run->view);
    }
    if (run->view == NULL || open_parts(run, down) != RLF_OK) {
        close_run(run);
        return NULL;
    }
    return run;
}

static void put_bodies(others_run *run)
{
    for (int32_t k = 0; k < run->act.body_count; k++) {
        rlf_body_def def = rlf_body_def_default();
        rlf_body_id id;
        const rlf_pose at = rlf_pose_mul(&run->act.T_camera_stage, &run->act.T_stage_body[k]);
        def.shape = run->act.body;
        def.position = at.p;
        def.orientation = at.q;
        def.release_time = run->act.release;
        def.restitution = 0.2;
        def.rolling_resistance = 0.05;
        (void)rlf_world_add_body(run->world, &def, &id);
    }
    run->is_put = true;
}

/* The hands in truth. */
static int32_t true_hands(others_run *run, rlf_grid_hand *out)
{
    const int32_t count = another_act_pose(&run->act, run->time);
    for (int32_t k = 0; k < count; k++) {
        another_cone cones[ANOTHER_CONES];
        another_hand_cones(&run->act.hand[k], cones);
        out[k].is_sure = true;
        out[k].palm = run->act.hand[k].palm;
        for (int32_t i = 0; i < ANOTHER_CONES; i++) {
            out[k].cones[i] =
                (rlf_round_cone){cones[i].a, cones[i].b, cones[i].radius, cones[i].radius};
        }
        out[k].facing = rlf_rotate(run->act.hand[k].T_camera_hand.q, rlf_vec3_make(0, 0, -1));
        out[k].id = k + 1;
    }
    return count;
}

static int32_t found_hands(const rlf_hands *found, rlf_grid_hand *out)
{
    int32_t count = 0;
    for (int32_t k = 0; k < found->count && count < 2; k++) {
        const rlf_hand *h = &found->hand[k];
        if (h->confidence >= RLF_HAND_SURE && h->shape[0].radius_a > 0.0) {
            out[count] = (rlf_grid_hand){
                .id = h->id, .is_sure = h->is_shape_sure, .palm = h->palm, .facing = h->facing};
            memcpy(out[count++].cones, h->shape, sizeof(h->shape));
        }
    }
    return count;
}

/* How far the first body leaps in the frame in which it is taken, against the hand, or is let go,
 * against its own speed. */
static void note_jump(others_run *run)
{
    const rlf_body_state *b = &run->snapshot->bodies[0];
    const rlf_pose at = rlf_pose_mul(&run->act.hand[0].T_camera_hand, &run->act.T_hand_body);
    const rlf_vec3 way = rlf_sub(b->T_world_body.p, run->body);
    const rlf_vec3 with_hand = rlf_sub(at.p, run->place);
    const rlf_vec3 alone = rlf_scale(rlf_add(b->velocity, run->speed), 0.5 * FRAME_S);
    if (b->is_grabbed != run->was_held) {
        const double leap = rlf_length(rlf_sub(way, b->is_grabbed ? with_hand : alone));
        double *most = b->is_grabbed ? &run->grab_jump : &run->release_jump;
        *most = rlf_max(*most, leap);
    }
    run->was_held = b->is_grabbed;
    run->body = b->T_world_body.p;
    run->place = at.p;
    run->speed = b->velocity;
}

static rlf_result step(others_run *run)
{
    if (run->part == TRUTH_NONE) {
        rlf_pipeline_output out;
        const rlf_result result = rlf_pipeline_step(run->pipeline, &out);
        run->snapshot = result == RLF_OK ? out.snapshot : run->snapshot;
        if (result != RLF_OK) {
            return result;
        }
    } else {
        rlf_grid grid;
        const rlf_pose camera = rlf_pose_identity();
        const rlf_surface *surface = show(run);
        const rlf_vec3 palm = run->act.hand[0].palm;
        const double rate = run->palm.z > 0.0 ? 1.0 / FRAME_S : 0.0;
        another_view_flow(run->view, rlf_scale(rlf_sub(palm, run->palm), rate));
        run->palm = palm;
        rlf_grid_from_surface(surface, &camera, NULL, 0, &grid);
        const rlf_hands *found = rlf_hand_tracker_update(run->tracker, surface);
        grid.hands = run->hands;
        grid.hand_count = run->part == TRUTH_JOINTS ? true_hands(run, run->hands)
                                                    : found_hands(found, run->hands);
        rlf_world_advance(run->world, &grid, FRAME_S);
        run->snapshot = rlf_world_get_snapshot(run->world);
    }
    if (run->is_put && run->snapshot->body_count > 0) {
        note_jump(run);
    }
    if (!run->is_put && run->time > PUT_S) {
        put_bodies(run);
    }
    return RLF_OK;
}

static rlf_result step_until(others_run *run, double time)
{
    rlf_result result = RLF_OK;
    while (result == RLF_OK && run->time < time - 1e-6) {
        result = step(run);
    }
    return result;
}

static rlf_vec3 body_at(const others_run *run)
{
    return run->snapshot != NULL && run->snapshot->body_count > 0
               ? run->snapshot->bodies[0].T_world_body.p
               : rlf_vec3_make(0, 0, 1e3);
}

/* Up from the table, metres. */
static double height_of(const others_run *run, rlf_vec3 p)
{
    return rlf_transform_inverse(&run->act.T_camera_stage, p).y;
}

/* From its place in the hand. */
static double off_hand(const others_run *run)
{
    const rlf_pose at = rlf_pose_mul(&run->act.hand[0].T_camera_hand, &run->act.T_hand_body);
    return rlf_length(rlf_sub(at.p, body_at(run)));
}

typedef struct grasp_sums {
    int64_t tried[ACT_KINDS], lifted[ACT_KINDS], carried[ACT_KINDS], whole[ACT_KINDS];
    double grab_jump, release_jump;     /* sums over those that are whole */
    double false_grabs, minutes, moved; /* moved: bodies, each time */
    int64_t aborted, aborted_grabs;
} grasp_sums;

static rlf_result grasp(grasp_sums *s, act_kind kind, uint64_t seed, truth_part part)
{
    others_run *run = open_run(kind, false, seed, part);
    if (run == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const another_act *act = &run->act;
    rlf_result result = step_until(run, act->closed);
    const double low = height_of(run, body_at(run));
    result = result == RLF_OK ? step_until(run, act->lifted) : result;
    const bool is_lifted = height_of(run, body_at(run)) - low > RISEN * act->rise;
    result = result == RLF_OK ? step_until(run, act->opened) : result;
    const bool is_carried = is_lifted && off_hand(run) < HELD_M;
    const double high = height_of(run, body_at(run));
    result = result == RLF_OK ? step_until(run, rlf_max(act->opened + LET_GO_S, act->let_go + 0.25))
                              : result;
    const bool is_let_go = is_carried && high - height_of(run, body_at(run)) > DROPPED_M;
    s->tried[kind]++;
    s->lifted[kind] += is_lifted;
    s->carried[kind] += is_carried;
    s->whole[kind] += is_let_go;
    s->grab_jump += is_let_go ? run->grab_jump : 0.0;
    s->release_jump += is_let_go ? run->release_jump : 0.0;
    close_run(run);
    return result;
}

/* Bodies that were pushed away or are held come back for the next visit; how many there were. */
static int32_t put_back(others_run *run)
{
    const rlf_vec3 still = {0, 0, 0};
    int32_t moved = 0;
    for (int32_t k = 0; k < run->snapshot->body_count; k++) {
        const rlf_body_state *b = &run->snapshot->bodies[k];
        const rlf_pose at = rlf_pose_mul(&run->act.T_camera_stage, &run->act.T_stage_body[k]);
        if (rlf_length(rlf_sub(at.p, b->T_world_body.p)) > MOVED_M) {
            (void)rlf_world_set_body(run->world, b->id, &at, still, still);
            moved++;
        }
    }
    return moved;
}

/* How often something is held that nobody grasps. */
static rlf_result count_false(grasp_sums *s, act_kind kind, bool is_aborted, uint64_t seed,
                              truth_part part)
{
    others_run *run = open_run(kind, is_aborted, seed, part);
    if (run == NULL) {
        return RLF_ERROR_MEMORY;
    }
    int32_t held[ACT_BODIES_MAX] = {0}, in_air[ACT_BODIES_MAX] = {0}, grabs = 0;
    rlf_result result = RLF_OK;
    double back = BACK_S;
    while (result == RLF_OK && run->time < run->act.end) {
        result = step(run);
        if (result == RLF_OK && !is_aborted && run->is_put && run->time > back) {
            s->moved += put_back(run);
            back += BACK_S;
        }
        for (int32_t k = 0; run->snapshot != NULL && k < run->snapshot->body_count && run->is_put;
             k++) {
            const rlf_body_state *b = &run->snapshot->bodies[k];
            const double up = height_of(run, b->T_world_body.p) - run->act.T_stage_body[k].p.y;
            held[k] = b->is_grabbed ? held[k] + 1 : 0;
            in_air[k] = up > AIR_M ? in_air[k] + 1 : 0;
            grabs += held[k] == GRABBED_FRAMES || (in_air[k] == AIR_FRAMES && held[k] == 0);
        }
    }
    if (is_aborted) {
        s->aborted++;
        s->aborted_grabs += grabs > 0;
    } else {
        s->false_grabs += grabs;
        s->minutes += (run->act.end - run->act.begin) / 60.0;
    }
    close_run(run);
    return result;
}

static void add(eval_table *table, const char *key, const char *title, double value)
{
    eval_table_add(table, "grasps", key, title, RLF_PROFILE_LIVE, value);
}

static void report(eval_table *table, const grasp_sums *s, truth_part part)
{
    static const char *const keys[TRUTH_COUNT][5] = {
        {"whole", "lifted", "carried", "aborted", "false"},
        {"mask_whole", "mask_lifted", "mask_carried", "mask_aborted", "mask_false"},
        {"joints_whole", "joints_lifted", "joints_carried", "joints_aborted", "joints_false"}};
    static const char *const kinds[ACT_KINDS][2] = {
        {"above", "    pinch from above, %"},          {"side", "    pinch from the side, %"},
        {"bar", "    a fist around a bar, %"},         {"two", "    two hands at its sides, %"},
        {"scoop", "    in the hollow of the hand, %"}, {"under", "    on the flat hand, %"}};
    static const char *const titles[TRUTH_COUNT] = {
        "another's hands: whole grasps, %", "the same, true mask, %", "the same, true joints, %"};
    int64_t all[4] = {0};
    for (int k = 0; k < ACT_KINDS; k++) {
        all[0] += s->tried[k];
        all[1] += s->whole[k];
        all[2] += s->lifted[k];
        all[3] += s->carried[k];
    }
    add(table, keys[part][0], titles[part], eval_percent(all[1], all[0]));
    for (int k = 0; k < ACT_KINDS && part == TRUTH_NONE; k++) {
        add(table, kinds[k][0], kinds[k][1], eval_percent(s->whole[k], s->tried[k]));
    }
    if (part == TRUTH_NONE && all[1] > 0) {
        add(table, "grab_jump_mm", "  leap against the hand as it is taken, mm",
            1e3 * s->grab_jump / (double)all[1]);
        add(table, "release_jump_mm", "  leap against its own speed as it is let go, mm",
            1e3 * s->release_jump / (double)all[1]);
    }
    add(table, keys[part][1], "  of all: lifted, %", eval_percent(all[2], all[0]));
    add(table, keys[part][2], "  and carried, %", eval_percent(all[3], all[0]));
    add(table, keys[part][3], "  begun and not done, but grabbed, %",
        eval_percent(s->aborted_grabs, s->aborted));
    if (part == TRUTH_NONE) {
        add(table, "moved", "  pushed a minute", s->moved / s->minutes);
    }
    add(table, keys[part][4], "  false grabs a minute among bodies", s->false_grabs / s->minutes);
}

rlf_result hands_others_run(eval_table *table, int64_t seed)
{
    rlf_result result = RLF_OK;
    for (int part = 0; part < TRUTH_COUNT && result == RLF_OK; part++) {
        grasp_sums s = {.minutes = 0.0};
        for (int n = 0; n < ACT_KINDS * (part == 0 ? EACH : 1) && result == RLF_OK; n++) {
            const act_kind kind = (act_kind)(n % ACT_KINDS);
            result = grasp(&s, kind, (uint64_t)(seed * 1000 + n), (truth_part)part);
        }
        for (int n = 0; n < 4 && result == RLF_OK; n++) {
            result = count_false(&s, (act_kind)(n % 3), true, (uint64_t)(seed * 1000 + 100 + n),
                                 (truth_part)part);
        }
        result = result == RLF_OK ? count_false(&s, ACT_AMONG, false, (uint64_t)(seed * 1000 + 200),
                                                (truth_part)part)
                                  : result;
        report(table, &s, (truth_part)part);
    }
    return result;
}
