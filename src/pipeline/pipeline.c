/* The frame loop: capture, surface, physics, render, in this order, one frame at a time. */
#include "base/checks.h"
#include "pipeline/state.h"

#include <string.h>

#define ADVANCE_MAX_S 1.0 /* a longer gap between frames advances physics by this much only */
#define AWAY_FRAMES 10    /* missing in such a gap: it is no slow clip, the camera was away */
#define STALE_S 1.0       /* without a frame: what is shown is no longer what is there */
#define BLIND_S 0.5       /* without depth: it is told */
#define GRAVITY_FRAMES 10 /* that are asked at most which way is up */

void rlf_pipeline_set_surface_times(rlf_pipeline *p, rlf_surface_times *times)
{
    if (RLF_ASSERT(p != NULL)) {
        rlf_reconstruct_set_times(p->reconstruct, times);
    }
}

static double elapsed_ms(int64_t *since_ns)
{
    int64_t now = rlf_clock_ns();
    double ms = (double)(now - *since_ns) * 1e-6;
    *since_ns = now;
    return ms;
}

static rlf_known_view known_view(const rlf_pipeline *p)
{
    const rlf_rig *rig = &rlf_source_get_info(p->def.source)->rig;
    const rlf_known_view view = {p->last.surface, rig, p->camera.T_world};
    return view;
}

static bool has_falling_body(const rlf_pipeline *p)
{
    bool any = false;
    for (int32_t i = 0; i < p->scene.body_count; i++) {
        const rlf_body_def *b = &p->scene.bodies[i];
        const bool is_pulled = b->gravity_scale < 0.0 || b->gravity_scale > 0.0;
        any = any || (is_pulled && !b->is_kinematic && !b->is_real);
    }
    return any;
}

/* One line where it is not sure: a warning when bodies fall by it. */
static void tell_gravity(const rlf_pipeline *p)
{
    const rlf_vec3 g = rlf_world_get_snapshot(p->world)->gravity;
    double confidence = p->last.gravity_confidence;
    if (confidence < RLF_UP_SURE) {
        rlf_log(has_falling_body(p) ? RLF_LOG_WARNING : RLF_LOG_INFO,
                "gravity: not sure which way is down (confidence %.2f): taken to be %.2f, %.2f, "
                "%.2f; if that is wrong, pass --gravity X,Y,Z",
                confidence, g.x, g.y, g.z);
    }
}

/* Asks the newest surface; the surest answer so far counts. */
static void find_gravity(rlf_pipeline *p)
{
    rlf_vec3 up;
    double confidence = rlf_surface_find_up(p->last.surface, &up);
    if (confidence > p->last.gravity_confidence) {
        rlf_vec3 down = rlf_neg(rlf_rotate(p->camera.T_world.q, up));
        rlf_world_set_gravity(p->world, rlf_scale(down, rlf_length(p->scene.gravity)));
        p->last.gravity_confidence = confidence;
    }
}

/* The first frame's noise may hide what the next ones show: an answer that is not sure is asked for
 * again, until it is told. */
static void seek_gravity(rlf_pipeline *p)
{
    bool is_first = p->frame_index == 0;
    if (is_first) {
        p->last.gravity_confidence = p->scene.finds_gravity ? 0.0 : 1.0;
        p->gravity_frames = p->scene.finds_gravity ? GRAVITY_FRAMES : 0;
    }
    if (p->gravity_frames > 0 && !p->last.surface->is_blind) {
        find_gravity(p);
        p->gravity_frames = p->last.gravity_confidence < RLF_UP_SURE ? p->gravity_frames - 1 : 0;
        if (p->gravity_frames == 0) {
            tell_gravity(p);
        }
    }
}

/* The real surface for physics, with what its people hide. */
static void make_grid(rlf_pipeline *p, rlf_grid *out)
{
    const rlf_surface *s = p->last.surface;
    rlf_grid_from_surface(s, &p->camera.T_world, p->regions, p->region_capacity, out);
    if (p->def.world.method == RLF_PHYSICS_LIVE && out->foreground.thickness != NULL) {
        rlf_vec3 gravity = rlf_world_get_snapshot(p->world)->gravity;
        rlf_vec3 down = rlf_rotate(rlf_quat_conjugate(p->camera.T_world.q), gravity);
        out->foreground.thickness = far_side_thicken(&p->far, s, down);
    }
}

/* Bodies wait for a camera that was away, that shows no depth, or that does not know where it is:
 * what they would have met meanwhile nobody saw. So they do while the view as a whole seems to
 * move: a room that swings would throw them. What was seen alone decides, so that a recording gives
 * the same bodies. */
static double time_to_advance(const rlf_pipeline *p, double gap_s)
{
    const double rate = rlf_source_get_info(p->def.source)->frames_per_second;
    const bool was_away = gap_s > ADVANCE_MAX_S && gap_s * rate > AWAY_FRAMES;
    const rlf_surface *s = p->last.surface;
    const bool may_move = s->camera_may_move && !p->camera.moving.is_on;
    const bool is_lost = camera_is_waited_for(&p->camera, p->last.frame.time_ns);
    const bool is_unsure = is_lost || may_move || s->is_blind;
    return was_away || is_unsure ? 0.0 : rlf_min(gap_s, ADVANCE_MAX_S);
}

/* One line when bodies have waited for depth for a while, and one when they go on. */
static void tell_blind(rlf_pipeline *p)
{
    const int64_t now = p->last.frame.time_ns;
    if (!p->last.surface->is_blind) {
        if (p->has_told_blind) {
            rlf_log(RLF_LOG_INFO, "there is depth (frame %lld): bodies move",
                    (long long)p->frame_index);
        }
        p->is_blind = p->has_told_blind = false;
        return;
    }
    p->blind_since_ns = p->is_blind ? p->blind_since_ns : now;
    p->is_blind = true;
    if (!p->has_told_blind && (double)(now - p->blind_since_ns) * 1e-9 > BLIND_S) {
        p->has_told_blind = true;
        rlf_log(RLF_LOG_WARNING,
                "no depth, or hardly any, for %.1f s (frame %lld): bodies wait; is the lens "
                "covered?",
                BLIND_S, (long long)p->frame_index);
    }
}

/* Models of known things are placed in the first frame that shows the room. */
static rlf_result place_known(rlf_pipeline *p, rlf_grid *grid)
{
    const rlf_surface *s = p->last.surface;
    if (!p->has_room && s->is_blind) {
        return RLF_OK;
    }
    if (p->has_room) {
        return known_models_clear_grid(&p->known, s, rlf_world_get_snapshot(p->world), grid);
    }
    p->has_room = true;
    const rlf_known_view view = known_view(p);
    return known_models_solve(&p->known, &view, p->world);
}

/* In the order of their cameras. */
static void list_grids(rlf_pipeline *p)
{
    rlf_grid *last = &p->grid;
    last->next = NULL;
    for (int32_t k = 1; k < RLF_WORLD_CAMERAS_MAX; k++) {
        rlf_pipeline *other = p->others[k];
        if (other != NULL && other->has_grid) {
            other->grid.next = NULL;
            last->next = &other->grid;
            last = &other->grid;
        }
    }
}

static void note_time(rlf_pipeline *p)
{
    rlf_pipeline_output *out = &p->last;
    if (p->frame_index == 0) {
        p->first_time_ns = out->frame.time_ns;
    }
    p->last_time_ns = out->frame.time_ns;
    out->time_s = (double)(out->frame.time_ns - p->first_time_ns) * 1e-9;
    out->snapshot = rlf_world_get_snapshot(p->world);
}

/* The surface of one that joined waits for the other's step. */
static void lend_surface(rlf_pipeline *p)
{
    make_grid(p, &p->grid);
    p->grid.camera = p->index;
    p->has_grid = !p->last.surface->is_blind;
    note_time(p);
}

static rlf_result advance_world(rlf_pipeline *p)
{
    rlf_pipeline_output *out = &p->last;
    if (p->joined != NULL) {
        lend_surface(p);
        return RLF_OK;
    }
    seek_gravity(p);
    tell_blind(p);
    make_grid(p, &p->grid);
    hand_stage_show(&p->hands, &p->grid);
    list_grids(p);
    bool is_first = p->frame_index == 0;
    rlf_result result = place_known(p, &p->grid);
    if (result != RLF_OK) {
        return result;
    }
    const double gap = is_first ? 0.0 : (double)(out->frame.time_ns - p->last_time_ns) * 1e-9;
    const double dt = time_to_advance(p, gap);
    if (dt > 0.0) {
        rlf_world_advance(p->world, &p->grid, dt);
    }
    note_time(p);
    return RLF_OK;
}

static void find_hands(rlf_pipeline *p)
{
    int64_t clock = rlf_clock_ns();
    hand_stage_update(&p->hands, p->last.surface, &p->camera.T_world);
    p->last.hands = p->hands.last;
    p->last.times.hands_ms = p->hands.is_on ? elapsed_ms(&clock) : 0.0;
}

static rlf_result answer_hands(rlf_pipeline *p)
{
    const hand_answer answer = {&p->scene, p->world, p->camera.T_world};
    if (!hand_stage_answer(&p->hands, &answer)) {
        return RLF_OK;
    }
    const rlf_vec3 gravity = rlf_world_get_snapshot(p->world)->gravity;
    rlf_world_reset(p->world);
    rlf_world_set_gravity(p->world, gravity);
    return pipeline_add_bodies(p);
}

static rlf_result make_surface(rlf_pipeline *p)
{
    const rlf_surface *surface;
    rlf_result result = camera_see(p, &surface);
    if (result == RLF_OK && p->def.replace_surface != NULL) {
        surface = p->def.replace_surface(p->def.replace_context, surface);
        result = surface != NULL ? RLF_OK : rlf_fail(RLF_ERROR_INVALID, "replace_surface failed");
    }
    if (result == RLF_OK) {
        p->last.surface = surface;
        find_hands(p);
        result = answer_hands(p);
    }
    return result;
}

static double silence_of(const rlf_pipeline *p)
{
    return rlf_source_get_status(p->def.source).silence_s;
}

/* Whether a camera that joined has a frame that is nearer to the first one's than the last it gave.
 * Of a live one the newest counts, and a silent one is asked now and then: it makes others wait.
 * Recordings are paired from the first frames on. */
static bool is_behind(const rlf_pipeline *p, double elapsed_s)
{
    const rlf_source_info *info = rlf_source_get_info(p->def.source);
    if (info->is_live) {
        return silence_of(p) <= STALE_S || elapsed_s > p->asked_s + STALE_S;
    }
    const double rate = info->frames_per_second > 0.0 ? info->frames_per_second : 30.0;
    const double own_s = (double)(p->last.frame.time_ns - p->first_time_ns) * 1e-9;
    return p->frame_index == 0 || own_s + 0.5 / rate < elapsed_s;
}

/* A frame of a camera that joined, if it has one. One that ended, or fails, shows nothing more. */
static void see_other(rlf_pipeline *p, double elapsed_s)
{
    rlf_result result = RLF_NO_FRAME;
    rlf_frame frame;
    bool is_due = is_behind(p, elapsed_s);
    p->asked_s = is_due ? elapsed_s : p->asked_s;
    while (is_due && (result = rlf_source_next(p->def.source, &frame)) == RLF_OK) {
        p->last.frame = frame;
        is_due = p->frame_index > 0 && !rlf_source_get_info(p->def.source)->is_live &&
                 is_behind(p, elapsed_s);
    }
    if (result == RLF_OK) {
        result = make_surface(p);
    }
    if (result == RLF_OK) {
        lend_surface(p);
        p->last.frame_index = p->frame_index++;
    } else if (result != RLF_NO_FRAME) {
        if (p->has_grid) {
            rlf_log(RLF_LOG_WARNING, "camera %d, %s: %s: the others go on", (int)p->index + 1,
                    rlf_source_get_info(p->def.source)->name,
                    result == RLF_END ? "it has no more frames" : rlf_error_text());
        }
        p->has_grid = false;
    } else {
        p->has_grid = p->has_grid && silence_of(p) <= STALE_S;
    }
}

static void see_others(rlf_pipeline *p)
{
    const bool is_first = p->frame_index == 0;
    const double elapsed_s =
        is_first ? 0.0 : (double)(p->last.frame.time_ns - p->first_time_ns) * 1e-9;
    for (int32_t k = 1; k < RLF_WORLD_CAMERAS_MAX; k++) {
        if (p->others[k] != NULL && p->others[k]->pushed.source == NULL) {
            see_other(p->others[k], elapsed_s);
        }
    }
}

rlf_result rlf_pipeline_step(rlf_pipeline *p, rlf_pipeline_output *out)
{
    if (!RLF_ASSERT(p != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_pipeline_output *last = &p->last;
    int64_t clock = rlf_clock_ns();
    rlf_frame frame;
    rlf_result result = rlf_source_next(p->def.source, &frame);
    if (result == RLF_END && p->gravity_frames > 0) {
        p->gravity_frames = 0;
        tell_gravity(p);
    }
    if (result != RLF_OK) {
        return result;
    }
    last->frame = frame;
    last->times.capture_ms = elapsed_ms(&clock);
    see_others(p);
    result = make_surface(p);
    if (result != RLF_OK) {
        return result;
    }
    last->times.surface_ms = elapsed_ms(&clock);
    result = advance_world(p);
    if (result != RLF_OK) {
        return result;
    }
    hand_stage_hold(&p->hands, last->snapshot, &last->T_world_camera);
    last->times.physics_ms = elapsed_ms(&clock);
    result = pipeline_draw(p);
    if (result != RLF_OK) {
        return result;
    }
    last->times.render_ms = elapsed_ms(&clock);
    last->latency_ms = frame.host_time_ns != 0 ? (double)(clock - frame.host_time_ns) * 1e-6 : 0.0;
    last->is_stale = false;
    pipeline_note_times(p);
    last->frame_index = p->frame_index++;
    *out = *last;
    return RLF_OK;
}

rlf_result rlf_pipeline_push(rlf_pipeline *p, const rlf_frame *frame, rlf_pipeline_output *out)
{
    if (!RLF_ASSERT(p != NULL && frame != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (p->pushed.source == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "pipeline: it has a source: call rlf_pipeline_step, or "
                                           "make its def with rlf_pipeline_def_for_rig");
    }
    pushed_frame_put(&p->pushed, frame);
    const rlf_result result = rlf_pipeline_step(p, out);
    pushed_frame_put(&p->pushed, NULL);
    return result;
}

rlf_result rlf_pipeline_redraw(rlf_pipeline *p, rlf_pipeline_output *out)
{
    if (!RLF_ASSERT(p != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (p->frame_index == 0) {
        return RLF_NO_FRAME;
    }
    p->last.snapshot = rlf_world_get_snapshot(p->world);
    p->last.is_stale = silence_of(p) > STALE_S;
    rlf_result result = pipeline_draw(p);
    *out = p->last;
    return result;
}

rlf_result rlf_pipeline_restart(rlf_pipeline *p)
{
    if (!RLF_ASSERT(p != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = rlf_source_restart(p->def.source);
    if (result != RLF_OK) {
        return result;
    }
    for (int32_t k = 1; k < RLF_WORLD_CAMERAS_MAX; k++) {
        if (p->others[k] != NULL && p->others[k]->pushed.source == NULL) {
            (void)rlf_pipeline_restart(p->others[k]); /* a camera goes on */
        }
    }
    rlf_reconstruct_reset(p->reconstruct);
    p->has_grid = false;
    if (p->joined == NULL) {
        rlf_world_reset(p->world);
    }
    hand_stage_restart(&p->hands);
    p->room.path_count = 0;
    p->has_room = p->is_blind = p->has_told_blind = false;
    p->frame_index = 0;
    result = camera_start(p);
    return result == RLF_OK && p->joined == NULL ? pipeline_add_bodies(p) : result;
}

rlf_result rlf_pipeline_set_known(rlf_pipeline *p, const rlf_known_def *def, rlf_known_fit *out_fit)
{
    if (!RLF_ASSERT(p != NULL && def != NULL && def->cookie == RLF_DEF_COOKIE)) {
        return RLF_ERROR_INVALID;
    }
    if (p->frame_index == 0 && def->point_count > 0) {
        return RLF_NO_FRAME;
    }
    const rlf_known_view view = known_view(p);
    rlf_known_def solved = *def;
    rlf_known_fit fit;
    rlf_result result = rlf_known_solve(def, def->point_count > 0 ? &view : NULL, &fit);
    if (result == RLF_OK) {
        solved.T_world_model = fit.T_world_model;
        solved.has_pose = true;
        solved.point_count = 0;
        result = known_models_put(&p->known, &solved, p->world);
    }
    if (result == RLF_OK && out_fit != NULL) {
        *out_fit = fit;
    }
    return result;
}

const rlf_known_def *rlf_pipeline_get_known(const rlf_pipeline *p, int32_t *out_count)
{
    if (!RLF_ASSERT(p != NULL && out_count != NULL)) {
        return NULL;
    }
    *out_count = p->known.count;
    return p->known.defs;
}

rlf_world *rlf_pipeline_get_world(rlf_pipeline *p)
{
    return RLF_ASSERT(p != NULL) ? p->world : NULL;
}
