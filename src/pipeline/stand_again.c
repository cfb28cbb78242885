/* A camera that moved stands again: where it is, or where it stood before. */
#include "pipeline/state.h"

#define STANDS_NS 2000000000 /* it has rested for so long, */
#define LOST_NS 400000000    /* or, when nobody knows where it is, its view has */
#define STRAY_M 0.02         /* a pose that is found again and again strays by less, */
#define STRAY_RAD 0.02       /* and less than that */
#define BEFORE_FRAMES 5      /* in a row that show what it saw before */

/* Where the camera is told to be stays the same; when it is not sure, that says nothing. */
static bool stays(const camera *c)
{
    const rlf_pose back = rlf_pose_invert(&c->T_rest);
    const rlf_pose way = rlf_pose_mul(&back, &c->T_world);
    const rlf_vec3 turn = {2.0 * way.q.x, 2.0 * way.q.y, 2.0 * way.q.z};
    const bool is_near = rlf_length(way.p) < STRAY_M && rlf_length(turn) < STRAY_RAD;
    return is_near || c->moving.track.health != RLF_TRACK_GOOD;
}

static void follow_rest(camera *c, const rlf_surface *s)
{
    const bool may_rest = s->camera_rests && !s->camera_moves;
    if (!may_rest || !c->rests || !stays(c)) {
        c->rests = may_rest;
        c->rest_ns = s->time_ns;
        c->T_rest = c->T_world;
        c->taught_frames = 0;
    }
}

static bool has_rested(const camera *c, int64_t now_ns, int64_t for_ns)
{
    return c->rests && now_ns - c->rest_ns >= for_ns;
}

bool camera_is_waited_for(const camera *c, int64_t now_ns)
{
    const bool is_lost = c->moving.is_on && !moving_is_placed(&c->moving);
    return is_lost && !(c->was_placed && has_rested(c, now_ns, LOST_NS));
}

/* The view without what stands in front of the room. */
static void paint_room(const rlf_surface *s, float *room)
{
    for (int32_t i = 0; i < s->width * s->height; i++) {
        const float seen = s->reason[i] == RLF_REASON_OK ? s->depth[i] : 0.0f;
        room[i] = s->foreground[i] != 0 ? s->background_depth[i] : seen;
    }
}

/* The standing camera's stage learns the room from a frame without what stands in front of it: that
 * stays foreground. */
static rlf_result teach(rlf_pipeline *p, const rlf_surface *s)
{
    camera *c = &p->camera;
    rlf_frame room = p->last.frame;
    const rlf_surface *taught;
    if (c->taught_frames == 0) {
        rlf_reconstruct_reset(p->reconstruct);
        c->has_stood = false;
    }
    paint_room(s, c->room);
    room.depth_u16 = NULL;
    room.depth_f32 = c->room;
    room.depth_stride = s->width * (ptrdiff_t)sizeof(*c->room);
    room.color = (rlf_image_rgba8){.data = NULL};
    room.confidence = NULL;
    c->taught_frames++;
    return rlf_reconstruct_process(p->reconstruct, &room, &taught);
}

static void stand(rlf_pipeline *p)
{
    camera *c = &p->camera;
    rlf_log(RLF_LOG_INFO, "the camera stands (frame %lld)", (long long)p->frame_index);
    c->moving.is_on = false;
    c->T_world = c->T_stood;
    c->has_stood = true;
    c->has_source = false;
}

rlf_result camera_stand_again(rlf_pipeline *p, const rlf_surface *s)
{
    camera *c = &p->camera;
    const rlf_track_health health = c->moving.track.health;
    const bool is_unsure = health != RLF_TRACK_GOOD;
    c->was_placed = c->was_placed || health != RLF_TRACK_LOST;
    follow_rest(c, s);
    const bool is_before =
        is_unsure && c->has_stood && rlf_reconstruct_is_as_before(p->reconstruct, s->depth);
    c->before_frames = is_before ? c->before_frames + 1 : 0;
    if (c->before_frames >= BEFORE_FRAMES) {
        stand(p);
        return RLF_OK;
    }
    const int64_t wanted = health == RLF_TRACK_LOST ? LOST_NS : STANDS_NS;
    if (!c->was_placed || !has_rested(c, s->time_ns, wanted)) {
        return RLF_OK;
    }
    const rlf_result result = teach(p, s);
    if (result == RLF_OK && c->taught_frames >= p->def.reconstruct.background_frames) {
        c->T_stood = c->T_world;
        c->still_count = 0;
        stand(p);
    }
    return result;
}
