/* A camera that stands, one that moves, and the step from the one to the other; stand_again.c has
 * the way back. */
#include "pipeline/state.h"

#include <string.h>

#define KEEP_NS 1000000000 /* a standing camera's background is kept so often */
#define TOLD_NS 700000000  /* within which it is told that the camera moves */
#define LEFT_M 0.002       /* poses of a source that differ by more moved, */
#define LEFT_RAD 0.002     /* or by more than that */

void camera_stop(rlf_pipeline *p)
{
    if (p->world != NULL && p->joined == NULL) {
        rlf_world_set_room(p->world, NULL);
    }
    moving_stop(&p->camera.moving);
    rlf_free(p->camera.still);
    rlf_free(p->camera.room);
    memset(&p->camera, 0, sizeof(p->camera));
}

static void show_room(rlf_pipeline *p)
{
    if (p->def.world.method == RLF_PHYSICS_LIVE) {
        rlf_world_set_room(p->world, p->camera.moving.map);
    }
}

static rlf_result start_moving(rlf_pipeline *p, const moving_from *from)
{
    rlf_result result = moving_start(&p->camera.moving, &p->def, from);
    if (result == RLF_OK) {
        show_room(p);
    }
    return result;
}

rlf_result camera_start(rlf_pipeline *p)
{
    const rlf_pipeline_def *def = &p->def;
    camera_stop(p);
    p->camera.T_world = p->camera.T_stood = def->T_world_camera;
    const rlf_reconstruct_def *surface = &def->reconstruct;
    p->camera.may_change = def->camera == RLF_CAMERA_AUTO && surface->scale_factor == 1 &&
                           surface->background_method == RLF_BACKGROUND_ADAPTIVE;
    if (p->camera.may_change) {
        const size_t pixels = (size_t)surface->rig.depth.width * (size_t)surface->rig.depth.height;
        p->camera.still = rlf_alloc_array(2 * pixels, sizeof(float));
        p->camera.room = rlf_alloc_array(pixels, sizeof(float));
        if (p->camera.still == NULL || p->camera.room == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    const bool is_known = def->map != NULL && rlf_map_get_status(def->map).block_count > 0;
    if (def->camera == RLF_CAMERA_MOVING || (def->camera == RLF_CAMERA_AUTO && is_known)) {
        return start_moving(p, NULL);
    }
    p->camera.has_stood = true;
    return RLF_OK;
}

/* What the room looked like from where the camera stood: the map begins with it. The first frame
 * counts as it is: who moves the camera from then on shows no background of a standing one. */
static void keep_still(camera *c, const rlf_surface *s)
{
    const int32_t last = (c->still_count + 1) % 2, next = c->still_count % 2;
    const bool is_first = c->still_count == 0;
    const bool is_due = s->time_ns - c->still_ns[last] >= KEEP_NS;
    if (is_first || (is_due && s->background_state == RLF_BACKGROUND_READY)) {
        const size_t count = (size_t)s->width * (size_t)s->height;
        const bool is_learnt = s->background_state == RLF_BACKGROUND_READY;
        const float *room = is_learnt ? s->background_depth : s->depth;
        memcpy(c->still + (size_t)next * count, room, count * sizeof(*c->still));
        c->still_ns[next] = s->time_ns;
        c->still_count++;
    }
}

/* The newest that was kept before the camera can have begun to move; NULL = none was. */
static const float *find_still(const camera *c, const rlf_surface *s)
{
    const size_t count = (size_t)s->width * (size_t)s->height;
    const int32_t last = (c->still_count + 1) % 2;
    const bool is_old = s->time_ns - c->still_ns[last] >= TOLD_NS || c->still_count == 1;
    const int32_t chosen = is_old ? last : 1 - last;
    return c->still_count > 0 ? c->still + (size_t)chosen * count : NULL;
}

/* One line when it begins. */
static void tell_motion(rlf_pipeline *p, const rlf_surface *s)
{
    if (s->camera_moves && !p->camera.has_told) {
        rlf_log(RLF_LOG_WARNING,
                "the camera moves (frame %lld): put it still, or let it move with --camera auto; "
                "while it moves all is taken to be at rest, and bodies do not move with the room",
                (long long)p->frame_index);
        p->camera.has_told = true;
    }
}

static rlf_result see_moving(rlf_pipeline *p, const rlf_surface **out)
{
    moving *m = &p->camera.moving;
    rlf_result result = moving_process(m, &p->last.frame, out);
    p->camera.T_world = m->T_world_camera;
    p->last.track = &m->track;
    p->last.room = m->has_room ? &m->pose.prediction : NULL;
    return result;
}

/* From now on it moves. */
static rlf_result begin_to_move(rlf_pipeline *p, const rlf_surface *s, const rlf_pose *T_now_before)
{
    camera *c = &p->camera;
    rlf_log(RLF_LOG_INFO, "the camera moves (frame %lld): it is tracked from now on",
            (long long)p->frame_index);
    c->was_placed = true; /* where it stood */
    c->rests = false;
    c->before_frames = c->taught_frames = 0;
    if (c->is_prepared) {
        c->moving.is_on = true;
        show_room(p);
        return RLF_OK;
    }
    const moving_from from = {c->T_stood, find_still(c, s), s->time_ns, *T_now_before};
    return start_moving(p, &from);
}

/* Poses of the source that change move the camera, long before it is seen; those that stay the same
 * are a standing camera's. */
static bool has_left(camera *c, const rlf_frame *frame, rlf_pose *T_now_before)
{
    if (!frame->has_pose) {
        return false;
    }
    if (!c->has_source) {
        c->T_source = frame->T_world_camera;
        c->has_source = true;
    }
    const rlf_pose back = rlf_pose_invert(&frame->T_world_camera);
    *T_now_before = rlf_pose_mul(&back, &c->T_source);
    const rlf_quat q = T_now_before->q;
    const double turn = 2.0 * rlf_length(rlf_vec3_make(q.x, q.y, q.z));
    return rlf_length(T_now_before->p) > LEFT_M || turn > LEFT_RAD;
}

/* Who records poses mostly moves the camera: the first frame is a moving one's, too, until the
 * second one's pose tells. */
static rlf_result prepare_to_move(rlf_pipeline *p)
{
    camera *c = &p->camera;
    const rlf_surface *seen;
    if (!p->last.frame.has_pose) {
        return RLF_OK;
    }
    rlf_result result = moving_start(&c->moving, &p->def, NULL);
    if (result == RLF_OK) {
        result = moving_process(&c->moving, &p->last.frame, &seen);
    }
    c->moving.is_on = false;
    c->is_prepared = true;
    return result;
}

static rlf_result see_standing(rlf_pipeline *p, const rlf_surface **out)
{
    camera *c = &p->camera;
    rlf_result result = rlf_reconstruct_process(p->reconstruct, &p->last.frame, out);
    if (result != RLF_OK || !c->may_change) {
        if (result == RLF_OK) {
            tell_motion(p, *out);
        }
        return result;
    }
    rlf_pose T_now_before = (*out)->T_now_before;
    if (!(*out)->camera_moves && !has_left(c, &p->last.frame, &T_now_before)) {
        if (!(*out)->is_blind) {
            keep_still(c, *out);
        }
        if (c->is_prepared) {
            moving_stop(&c->moving);
            c->is_prepared = false;
        }
        return p->frame_index == 0 ? prepare_to_move(p) : RLF_OK;
    }
    result = begin_to_move(p, *out, &T_now_before);
    c->is_prepared = false;
    return result == RLF_OK ? see_moving(p, out) : result;
}

rlf_result camera_see(rlf_pipeline *p, const rlf_surface **out)
{
    camera *c = &p->camera;
    const bool moves = c->moving.is_on;
    p->last.track = NULL;
    p->last.room = NULL;
    rlf_result result = moves ? see_moving(p, out) : see_standing(p, out);
    p->last.T_world_camera = c->T_world;
    return result == RLF_OK && moves && c->may_change ? camera_stand_again(p, *out) : result;
}

rlf_map *rlf_pipeline_get_map(rlf_pipeline *p)
{
    return RLF_ASSERT(p != NULL) ? p->camera.moving.map : NULL;
}
