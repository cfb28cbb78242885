/* Small pictures of where the camera has been, for finding the way back (Klein and Murray 2008). */
#include "track/tracker.h"

#define ALIKE 0.12     /* a view this near to a keyframe is no new one */
#define DEPTH_SPAN 0.3 /* share of the depth: a larger difference counts as this */
#define GREY_SPAN 40.0 /* levels */

void track_thumbnail_make(const rlf_tracker *tracker, const rlf_track_view *view,
                          track_thumbnail *out)
{
    const int32_t width = tracker->def.rig.depth.width, height = tracker->def.rig.depth.height;
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
                const double z = (double)view->depth[i];
                const bool is_deep = z > 0.0 && z < 100.0;
                depth += is_deep ? z : 0.0;
                deep += is_deep;
                grey += view->grey != NULL ? view->grey[i] : 0;
                lit += view->grey != NULL && view->grey[i] != 0;
            }
        }
        out->depth[cell] = deep > 0 ? (float)(depth / deep) : 0.0f;
        out->grey[cell] = lit > 0 ? (float)(grey / lit) : 0.0f;
    }
}

double track_thumbnail_difference(const track_thumbnail *a, const track_thumbnail *b)
{
    double offset = 0.0, sum = 0.0;
    int32_t lit = 0, common = 0;
    for (int32_t i = 0; i < TRACK_THUMB; i++) {
        if (a->grey[i] > 0.0f && b->grey[i] > 0.0f) {
            offset += (double)(a->grey[i] - b->grey[i]);
            lit++;
        }
    }
    offset = lit > 0 ? offset / lit : 0.0; /* exposure */
    for (int32_t i = 0; i < TRACK_THUMB; i++) {
        const double za = (double)a->depth[i], zb = (double)b->depth[i];
        if (za > 0.0 && zb > 0.0) {
            const double d = za > zb ? (za - zb) / za : (zb - za) / zb;
            sum += rlf_min(d / DEPTH_SPAN, 1.0);
            common++;
        }
        if (a->grey[i] > 0.0f && b->grey[i] > 0.0f) {
            const double d = (double)(a->grey[i] - b->grey[i]) - offset;
            sum += rlf_min((d < 0.0 ? -d : d) / GREY_SPAN, 1.0);
            common++;
        }
    }
    return common > TRACK_THUMB / 8 ? sum / common : 1.0;
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
    track_thumbnail_make(tracker, view, &thumbnail);
    for (int32_t i = 0; i < tracker->keyframe_count; i++) {
        const track_keyframe *keyframe = &tracker->keyframes[i];
        const double difference = track_thumbnail_difference(&thumbnail, &keyframe->view);
        int32_t at = count < max ? count++ : max;
        while (at > 0 && best[at - 1] > difference) {
            if (at < max) {
                best[at] = best[at - 1];
                out_poses[at] = out_poses[at - 1];
            }
            at--;
        }
        if (at < max) {
            best[at] = difference;
            out_poses[at] = keyframe->T_world_camera;
        }
    }
    return count;
}

/* Keeps the view as a keyframe unless there is one that looks alike, or no room. */
static void keep(rlf_tracker *tracker, const rlf_track_view *view, const rlf_pose *T)
{
    if (tracker->keyframe_count >= tracker->def.keyframe_max) {
        return;
    }
    track_keyframe *next = &tracker->keyframes[tracker->keyframe_count];
    track_thumbnail_make(tracker, view, &next->view);
    for (int32_t i = 0; i < tracker->keyframe_count; i++) {
        if (track_thumbnail_difference(&next->view, &tracker->keyframes[i].view) < ALIKE) {
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
        keep(tracker, view, &result->T_world_camera);
    }
}
