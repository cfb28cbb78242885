/* Predict, align, accept; after a lost track, poses that looked alike. */
#include "pipeline/moving/moving.h"

#include "camera/pixels.h"

#include <math.h>
#include <string.h>

#define SMALLER 4
#define STARTS 6         /* keyframes that are tried after a lost track */
#define ROUNDS 2         /* of prediction and alignment for each */
#define SURE_OVERLAP 0.5 /* after a lost track so much must lie on the room, ... */
#define SURE_SIGMAS 2.5  /* ... not worse than this: in another room it is 3 to 14, ... */
#define PROOF_FRAMES 5   /* ... for so many frames before anything is fused again */
#define FENCE_FRAMES 10  /* good frames in a row between two fences of the map */
#define GAP_NS 200000000 /* after a longer gap nobody knows where the camera is */
#define APART_M 0.05     /* what is off the room by more than this is no part of it, */
#define APART_SIGMAS 6.0 /* and by more than this */

rlf_result camera_pose_open(camera_pose *c, const rlf_rig *rig, rlf_pool *pool)
{
    memset(c, 0, sizeof(*c));
    rlf_tracker_def def = rlf_tracker_def_default();
    def.rig = *rig;
    def.pool = pool;
    const rlf_camera camera = camera_pinhole(&rig->depth);
    c->camera = rlf_camera_decimate(&camera, SMALLER);
    c->camera.cx -= 0.5 * (SMALLER - 1) / SMALLER;
    c->camera.cy -= 0.5 * (SMALLER - 1) / SMALLER;
    c->noise = rig->noise;
    const size_t pixels = (size_t)c->camera.width * (size_t)c->camera.height;
    for (int i = 0; i < 2; i++) {
        c->planes[i] = rlf_alloc_array(4 * pixels, sizeof(float));
        c->grey[i] = rlf_alloc(pixels);
        if (c->planes[i] == NULL || c->grey[i] == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    const rlf_result result = settled_open(&c->settled, &c->camera, &rig->noise);
    return result == RLF_OK ? rlf_tracker_create(&def, &c->tracker) : result;
}

void camera_pose_close(camera_pose *c)
{
    rlf_tracker_destroy(&c->tracker);
    settled_close(&c->settled);
    for (int i = 0; i < 2; i++) {
        rlf_free(c->planes[i]);
        rlf_free(c->grey[i]);
        c->planes[i] = NULL;
        c->grey[i] = NULL;
    }
}

rlf_result camera_pose_know(camera_pose *c, rlf_map *map)
{
    int32_t count;
    const rlf_pose *viewpoints = rlf_map_get_viewpoints(map, &count);
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        rlf_prediction seen;
        result = rlf_map_predict(map, &c->camera, &viewpoints[i], &seen);
        if (result == RLF_OK) {
            rlf_tracker_remember(c->tracker, &seen);
        }
    }
    c->has_first = true;
    return result;
}

static double ms_since(int64_t start_ns)
{
    return (double)(rlf_clock_ns() - start_ns) * 1e-6;
}

static rlf_result predict(camera_pose *c, rlf_map *map, const rlf_pose *T_world_camera,
                          rlf_prediction *out)
{
    const int64_t begin = rlf_clock_ns();
    const rlf_result result = rlf_map_predict(map, &c->camera, T_world_camera, out);
    c->predict_ms += ms_since(begin);
    return result;
}

static rlf_result align(camera_pose *c, const rlf_track_view *view,
                        const rlf_prediction *prediction, const rlf_pose *start,
                        rlf_track_result *out)
{
    const int64_t begin = rlf_clock_ns();
    const rlf_result result = rlf_tracker_align(c->tracker, view, prediction, start, out);
    c->align_ms += ms_since(begin);
    return result;
}

static rlf_result try_start(camera_pose *c, rlf_map *map, const rlf_track_view *view,
                            const rlf_pose *start, rlf_track_result *out)
{
    rlf_prediction prediction;
    const rlf_result result = predict(c, map, start, &prediction);
    return result == RLF_OK ? align(c, view, &prediction, start, out) : result;
}

/* What the map shows from a pose, in planes of its own: those of the map are anybody's. */
rlf_result camera_pose_predict(camera_pose *c, rlf_map *map, const rlf_pose *T_world_camera)
{
    rlf_prediction *p = &c->prediction;
    const rlf_result result = predict(c, map, T_world_camera, p);
    c->has_prediction = result == RLF_OK;
    if (result != RLF_OK) {
        return result;
    }
    const size_t pixels = (size_t)c->camera.width * (size_t)c->camera.height;
    const int at = c->has_reference && c->reference.depth == c->planes[0]; /* the other's stay */
    const float **from[4] = {&p->depth, &p->normal_x, &p->normal_y, &p->normal_z};
    for (size_t k = 0; k < 4; k++) {
        float *to = c->planes[at] + k * pixels;
        memcpy(to, *from[k], pixels * sizeof(float));
        *from[k] = to;
    }
    if (p->grey != NULL) {
        memcpy(c->grey[at], p->grey, pixels);
        p->grey = c->grey[at];
    }
    return RLF_OK;
}

/* How well a pose fits. What lies on a wrong place of the room is less, and lies worse. */
static double worth(const rlf_track_result *r)
{
    return r->health == RLF_TRACK_LOST ? 0.0 : r->overlap / (1.0 + r->rms_sigma);
}

/* From where the camera was, and from keyframes that look alike: the best of what fits. */
static rlf_result find_again(camera_pose *c, rlf_map *map, const rlf_track_view *view)
{
    rlf_pose starts[STARTS];
    const int32_t count = rlf_tracker_recall(c->tracker, view, starts, STARTS);
    rlf_track_result best = c->last;
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        rlf_track_result tried = {.T_world_camera = starts[i], .health = RLF_TRACK_GOOD};
        for (int k = 0; k < ROUNDS && result == RLF_OK && tried.health != RLF_TRACK_LOST; k++) {
            const rlf_pose start = tried.T_world_camera;
            result = try_start(c, map, view, &start, &tried);
        }
        best = worth(&tried) > worth(&best) ? tried : best;
    }
    if (best.health != RLF_TRACK_GOOD || best.overlap < SURE_OVERLAP ||
        best.rms_sigma > SURE_SIGMAS) {
        best = (rlf_track_result){.T_world_camera = c->last.T_world_camera,
                                  .weak_way = c->last.weak_way};
    }
    c->last = best;
    return result;
}

/* The pose is the reference's to the bit: the tracker saw no motion. */
static bool rests(const camera_pose *c)
{
    const rlf_pose *now = &c->last.T_world_camera;
    return c->has_reference && c->last.health != RLF_TRACK_LOST &&
           memcmp(now, &c->reference.T_world_camera, sizeof(*now)) == 0;
}

/* What was fused just before the track was lost may be wrong: it is taken back. After that poses
 * are proven before anything is fused. */
static void guard_map(camera_pose *c, rlf_map *map)
{
    const bool is_good = c->last.health == RLF_TRACK_GOOD;
    if (c->last.health == RLF_TRACK_LOST) {
        if (c->proven >= PROOF_FRAMES) {
            (void)rlf_map_take_back(map);
        }
        c->proven = 0;
    } else if (is_good && c->proven < PROOF_FRAMES) {
        c->proven++;
    } else if (is_good && ++c->since_fence >= FENCE_FRAMES) {
        rlf_map_fence(map);
        c->since_fence = 0;
    }
    /* Before a bare wall a camera that stands is weak for ever; what it sees again may be fused. */
    const bool is_still = c->last.health == RLF_TRACK_WEAK && rests(c);
    c->may_fuse = (is_good || is_still) && c->proven >= PROOF_FRAMES;
}

/* How much farther a point is than what the map shows there; false = it shows nothing. */
static bool find_behind(const camera_pose *c, rlf_vec3 point, double *out_behind)
{
    const rlf_prediction *p = &c->prediction;
    const int32_t pixel =
        c->has_prediction && point.z > 0.0 ? camera_pixel_of(&p->camera, point) : -1;
    const double room = pixel >= 0 ? (double)p->depth[pixel] : 0.0;
    *out_behind = point.z - room;
    return room > 0.0;
}

static double apart(const camera_pose *c, double depth)
{
    return rlf_max(APART_M, APART_SIGMAS * rlf_depth_noise_sigma(&c->noise, depth));
}

bool camera_pose_is_of_room(const camera_pose *c, rlf_vec3 point)
{
    double behind;
    return find_behind(c, point, &behind) && fabs(behind) <= apart(c, point.z);
}

void camera_pose_mark_static(camera_pose *c, const rlf_surface *s, uint8_t *is_static)
{
    for (int32_t i = 0; i < s->width * s->height; i++) {
        const rlf_vec3 q = rlf_surface_point(s, i);
        double behind;
        is_static[i] = !(find_behind(c, q, &behind) && behind < -apart(c, q.z));
    }
    const rlf_prediction *room = c->has_prediction ? &c->prediction : NULL;
    settled_mark(&c->settled, room, s, &c->last.T_world_camera, is_static);
}

/* What the map shows from where the camera is; a new reference when it is elsewhere. */
static rlf_result refer(camera_pose *c, rlf_map *map)
{
    const rlf_pose *now = &c->last.T_world_camera;
    const bool is_at_rest = rests(c); /* at the reference as it was */
    const bool is_lost = c->last.health == RLF_TRACK_LOST;
    const rlf_result result = is_lost ? RLF_OK : camera_pose_predict(c, map, now);
    if (!is_at_rest) {
        c->has_reference = c->has_prediction;
        c->reference = c->prediction;
    }
    return result;
}

rlf_result camera_pose_find(camera_pose *c, rlf_map *map, const rlf_surface *surface,
                            const uint8_t *grey, int64_t time_ns)
{
    c->predict_ms = c->align_ms = 0.0;
    const rlf_track_view view = {.depth = surface->depth, .grey = grey};
    if (!c->has_first && surface->is_blind) {
        /* A camera that warms up shows nothing that a room could begin with. */
        c->last = (rlf_track_result){.T_world_camera = rlf_tracker_guess(c->tracker, time_ns)};
        c->may_fuse = false;
        c->lost_count++;
        return RLF_OK;
    }
    if (!c->has_first) {
        c->has_first = c->may_fuse = true;
        c->proven = PROOF_FRAMES;
        c->last = (rlf_track_result){.T_world_camera = rlf_tracker_guess(c->tracker, time_ns),
                                     .health = RLF_TRACK_GOOD,
                                     .overlap = 1.0};
        c->time_ns = time_ns;
        rlf_tracker_accept(c->tracker, &view, time_ns, &c->last);
        return RLF_OK;
    }
    const rlf_pose start = rlf_tracker_guess(c->tracker, time_ns);
    const bool was_lost =
        c->last.health == RLF_TRACK_LOST || time_ns - c->time_ns > GAP_NS || time_ns <= c->time_ns;
    /* Against what the map showed from a frame before (Newcombe et al. 2011): one prediction is
     * enough for a frame. */
    rlf_result result = c->has_reference && !was_lost
                            ? align(c, &view, &c->reference, &start, &c->last)
                            : try_start(c, map, &view, &start, &c->last);
    c->time_ns = time_ns;
    if (result == RLF_OK && (was_lost || c->last.health == RLF_TRACK_LOST)) {
        result = find_again(c, map, &view);
    }
    if (result != RLF_OK) {
        return result;
    }
    c->has_prediction = false;
    c->lost_count += c->last.health == RLF_TRACK_LOST;
    guard_map(c, map);
    rlf_tracker_accept(c->tracker, &view, time_ns, &c->last);
    return refer(c, map);
}
