/* Small pictures of where the camera has been, for finding the way back (Klein and Murray 2008). */
#include "track/tracker.h"

#define ALIKE 0.12     /* a view this near to a keyframe is no new one */
#define DEPTH_SPAN 0.3 /* share of the depth: a larger difference counts as this */
#define GREY_SPAN 40.0 /* levels */
#define TURN_X 8       /* cells by which a view may be turned from its keyframe: a quarter */
#define TURN_Y 6

void track_thumbnail_make(int32_t width, int32_t height, const float *plane, const uint8_t *luma,
                          track_thumbnail *out)
{
    for (int32_t cell = 0; cell < TRACK_THUMB; cell++) {
        const int32_t cx = cell % TRACK_THUMB_WIDTH, cy = cell / TRACK_THUMB_WIDTH;
        const int32_t x0 = cx * width / TRACK_THUMB_WIDTH,
                      x1 = (cx + 1) * width / TRACK_THUMB_WIDTH;
        const int32_t y0 = cy * height / TRACK_THUMB_HEIGHT,
                      y1 = (cy + 1) * height / TRACK_THUMB_HEIGHT;
        double depth = 0.0, grey = 0.0;
        int32_t deep = 0, lit = 0;
        for (int32_t y = y0; y < y1; y += 2) {
            for (int32_t x = x0; x < x1; x += 2) {
                const size_t i = (size_t)y * (size_t)width + (size_t)x;
                const double z = (double)plane[i];
                const bool is_deep = z > 0.0 && z < 100.0;
                depth += is_deep ? z : 0.0;
                deep += is_deep;
                grey += luma != NULL ? luma[i] : 0;
                lit += luma != NULL && luma[i] != 0;
            }
        }
        out->depth[cell] = deep > 0 ? (float)(depth / deep) : 0.0f;
        out->grey[cell] = lit > 0 ? (float)(grey / lit) : 0.0f;
    }
}

/* The part of a grid that lies on another that is moved by (dx, dy). */
typedef struct overlap {
    int32_t x0, x1, y0, y1, shift; /* of a; b's cell is the same less shift */
} overlap;

static overlap overlap_of(int32_t dx, int32_t dy)
{
    return (overlap){dx > 0 ? dx : 0, TRACK_THUMB_WIDTH + (dx < 0 ? dx : 0), dy > 0 ? dy : 0,
                     TRACK_THUMB_HEIGHT + (dy < 0 ? dy : 0), dy * TRACK_THUMB_WIDTH + dx};
}

/* By how much a is brighter: exposure. */
static double brighter(const track_thumbnail *a, const track_thumbnail *b, const overlap *o)
{
    double sum = 0.0;
    int32_t lit = 0;
    for (int32_t y = o->y0; y < o->y1; y++) {
        for (int32_t x = o->x0; x < o->x1; x++) {
            const int32_t i = y * TRACK_THUMB_WIDTH + x;
            if (a->grey[i] > 0.0f && b->grey[i - o->shift] > 0.0f) {
                sum += (double)(a->grey[i] - b->grey[i - o->shift]);
                lit++;
            }
        }
    }
    return lit > 0 ? sum / lit : 0.0;
}

double track_thumbnail_difference(const track_thumbnail *a, const track_thumbnail *b, int32_t dx,
                                  int32_t dy)
{
    const overlap o = overlap_of(dx, dy);
    const double offset = brighter(a, b, &o);
    double sum = 0.0;
    int32_t common = 0;
    for (int32_t y = o.y0; y < o.y1; y++) {
        for (int32_t x = o.x0; x < o.x1; x++) {
            const int32_t i = y * TRACK_THUMB_WIDTH + x, k = i - o.shift;
            const double za = (double)a->depth[i], zb = (double)b->depth[k];
            if (za > 0.0 && zb > 0.0) {
                const double d = za > zb ? (za - zb) / za : (zb - za) / zb;
                sum += rlf_min(d / DEPTH_SPAN, 1.0);
                common++;
            }
            if (a->grey[i] > 0.0f && b->grey[k] > 0.0f) {
                const double d = (double)(a->grey[i] - b->grey[k]) - offset;
                sum += rlf_min((d < 0.0 ? -d : d) / GREY_SPAN, 1.0);
                common++;
            }
        }
    }
    return common > TRACK_THUMB / 4 ? sum / common : 1.0;
}

/* A view is like a keyframe that was turned a little: what it shows is shifted by whole cells. */
static double best_turn(const rlf_tracker *tracker, const track_thumbnail *view,
                        const track_keyframe *keyframe, rlf_pose *out)
{
    double best = 2.0;
    int32_t best_x = 0, best_y = 0;
    for (int32_t dy = -TURN_Y; dy <= TURN_Y; dy += 2) {
        for (int32_t dx = -TURN_X; dx <= TURN_X; dx += 2) {
            const double d = track_thumbnail_difference(view, &keyframe->view, dx, dy);
            if (d < best) {
                best = d;
                best_x = dx;
                best_y = dy;
            }
        }
    }
    const rlf_camera *c = &tracker->def.rig.depth;
    const double right = best_x * (double)c->width / TRACK_THUMB_WIDTH / c->fx;
    const double down = best_y * (double)c->height / TRACK_THUMB_HEIGHT / c->fy;
    const rlf_vec3 turn = {rlf_atan2(down, 1.0), -rlf_atan2(right, 1.0), 0.0};
    const rlf_pose T_key_view = {{0, 0, 0}, rlf_quat_from_rotation_vector(turn)};
    *out = rlf_pose_mul(&keyframe->T_world_camera, &T_key_view);
    return best;
}

int32_t rlf_tracker_recall(rlf_tracker *tracker, const rlf_track_view *view, rlf_pose *out_poses,
                           int32_t max)
{
    if (!RLF_ASSERT(tracker != NULL && view != NULL && view->depth != NULL && out_poses != NULL)) {
        return 0;
    }
    enum { MOST = 16 };
    double best[MOST];
    int32_t count = 0;
    max = max < MOST ? max : MOST;
    track_thumbnail thumbnail;
    const rlf_camera *camera = &tracker->def.rig.depth;
    track_thumbnail_make(camera->width, camera->height, view->depth, view->grey, &thumbnail);
    for (int32_t i = 0; i < tracker->keyframe_count; i++) {
        rlf_pose T;
        const double difference = best_turn(tracker, &thumbnail, &tracker->keyframes[i], &T);
        int32_t at = difference < 1.0 ? (count < max ? count++ : max) : -1;
        while (at > 0 && best[at - 1] > difference) {
            if (at < max) {
                best[at] = best[at - 1];
                out_poses[at] = out_poses[at - 1];
            }
            at--;
        }
        if (at >= 0 && at < max) {
            best[at] = difference;
            out_poses[at] = T;
        }
    }
    return count;
}

/* Keeps the planes as a keyframe unless there is one that looks alike, or no room. */
static void keep(rlf_tracker *tracker, const rlf_camera *camera, const float *depth,
                 const uint8_t *grey, const rlf_pose *T)
{
    if (tracker->keyframe_count >= TRACK_KEYFRAMES) {
        return;
    }
    track_keyframe *next = &tracker->keyframes[tracker->keyframe_count];
    track_thumbnail_make(camera->width, camera->height, depth, grey, &next->view);
    for (int32_t i = 0; i < tracker->keyframe_count; i++) {
        if (track_thumbnail_difference(&next->view, &tracker->keyframes[i].view, 0, 0) < ALIKE) {
            return;
        }
    }
    next->T_world_camera = *T;
    tracker->keyframe_count++;
}

void rlf_tracker_accept(rlf_tracker *tracker, const rlf_track_view *view, int64_t time_ns,
                        const rlf_track_result *result)
{
    if (!RLF_ASSERT(tracker != NULL && result != NULL)) {
        return;
    }
    if (result->health == RLF_TRACK_LOST) {
        tracker->pose_count = tracker->pose_count > 1 ? 1 : tracker->pose_count; /* at rest */
        return;
    }
    tracker->before = tracker->pose;
    tracker->before_ns = tracker->time_ns;
    tracker->pose = result->T_world_camera;
    tracker->time_ns = time_ns;
    tracker->pose_count += tracker->pose_count < 2;
    if (result->health == RLF_TRACK_GOOD && view != NULL && view->depth != NULL) {
        keep(tracker, &tracker->def.rig.depth, view->depth, view->grey, &result->T_world_camera);
    }
}

void rlf_tracker_remember(rlf_tracker *tracker, const rlf_prediction *prediction)
{
    if (!RLF_ASSERT(tracker != NULL && prediction != NULL && prediction->depth != NULL)) {
        return;
    }
    keep(tracker, &prediction->camera, prediction->depth, prediction->grey,
         &prediction->T_world_camera);
}
