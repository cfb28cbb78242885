/* The cameras of a recording. */
#include "io/ros/recording.h"
#include "io/clip/clip.h"

#include <string.h>

/* False when no calibration fits, or the one that does cannot be used; `out_problem` tells. */
static bool read_camera(const io_ros_recording *r, int32_t picture, rlf_camera *out,
                        char out_problem[256])
{
    const io_ros_topic *topic = &r->pictures[picture];
    const int32_t found = io_ros_find_info(&r->lists, topic);
    if (found < 0) {
        io_ros_tell_info(&r->lists, topic, out_problem, 256);
        return false;
    }
    rlf_result result = io_camera_info_lens(&r->infos[found].info, r->lists.name, topic->name, out);
    snprintf(out_problem, 256, "%.255s", result != RLF_OK ? rlf_error_text() : "");
    return result == RLF_OK;
}

/* Colour without a calibration of its own is the depth's when the pictures are of one camera. */
static void read_color(io_ros_recording *r)
{
    const io_ros_topic *d = &r->pictures[r->depth.picture], *c = &r->pictures[r->color.picture];
    const bool is_same = strcmp(d->frame_id, c->frame_id) == 0;
    char problem[256];
    r->rig.has_color = read_camera(r, r->color.picture, &r->rig.color, problem);
    if (!r->rig.has_color && is_same && d->width == c->width && d->height == c->height) {
        r->rig.color = r->rig.depth;
        r->rig.has_color = true;
    }
    if (!r->rig.has_color) {
        rlf_log(RLF_LOG_WARNING,
                "%s: has no usable CameraInfo for %s (%s), so there is no colour: record its "
                "camera_info, or give ?camera=FILE",
                r->log.name, c->name, problem);
    } else if (r->log.has_own_poses) {
        return;
    } else if (is_same) {
        r->flags |= RLF_FRAME_ALIGNED;
    } else if (!io_ros_transforms_find(r->transforms, d->frame_id, c->frame_id,
                                       &r->rig.T_color_depth)) {
        rlf_log(RLF_LOG_WARNING,
                "%s: no transform leads from \"%s\" to \"%s\", so depth and colour are taken as "
                "seen from one place: record /tf_static, or give ?camera=FILE",
                d->name, d->frame_id, c->frame_id);
    }
}

static rlf_result check_size(const io_ros_recording *r, int32_t picture, const rlf_camera *camera)
{
    const io_ros_topic *t = &r->pictures[picture];
    return io_rig_check_size(r->log.name, t->name, t->width, t->height, camera);
}

rlf_result io_ros_read_rig(io_ros_recording *r, const rlf_address *address)
{
    char problem[256] = "";
    r->rig = rlf_rig_default();
    r->units_per_metre = 1000.0; /* what 16UC1 means (REP 118) */
    if (address->rig != NULL || !read_camera(r, r->depth.picture, &r->rig.depth, problem)) {
        rlf_result result = io_rig_beside(address, &r->rig, &r->units_per_metre, &r->has_given_rig);
        if (result == RLF_OK && !r->has_given_rig) {
            result = rlf_fail(RLF_ERROR_FORMAT,
                              "%s: has no usable CameraInfo for %s (%s): %s its camera_info, or "
                              "give the calibration with ?camera=FILE%s",
                              address->source, r->pictures[r->depth.picture].name, problem,
                              r->log.is_live ? "publish" : "record",
                              r->log.is_live ? "" : ", or as camera.json beside the file");
        }
        if (result != RLF_OK) {
            return result;
        }
    } else if (r->color.picture >= 0) {
        read_color(r);
    }
    r->rig.has_color = r->rig.has_color && r->color.picture >= 0;
    rlf_result result = check_size(r, r->depth.picture, &r->rig.depth);
    return result == RLF_OK && r->rig.has_color ? check_size(r, r->color.picture, &r->rig.color)
                                                : result;
}
