/* MCAP files as a source: Relief's own recordings, and anybody's ROS 2 recordings of a depth
 * camera.
 */
#define _POSIX_C_SOURCE 200809L
#include "relief/io.h"
#include "io/mcap/origin.h"
#include "io/mcap/recording_format.h"
#include "io/mcap/topics.h"
#include "io/mcap/transforms.h"
#include "io/source/backends.h"
#include "io/clip/clip.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

typedef struct mcap {
    char path[IO_PATH_MAX];
    io_mcap_reader *reader;
    io_mcap_topics *topics;
    io_mcap_stream depth, color;
    io_ros_decoder decoder;
    rlf_rig rig;
    double units_per_metre;
    uint32_t flags;
    io_clip_origin origin;
} mcap;

static rlf_result read_depth(void *self, int32_t index, void *out)
{
    mcap *m = self;
    io_ros_image image;
    rlf_result result = io_mcap_read_picture(m->reader, &m->depth, index, &image);
    return result == RLF_OK ? io_ros_decode_depth(&m->decoder, &image, m->depth.pixels,
                                                  m->depth.width, m->depth.height, out)
                            : result;
}

static rlf_result read_color(void *self, int32_t index, const rlf_image_rgba8 *out)
{
    mcap *m = self;
    io_ros_image image;
    rlf_result result = io_mcap_read_picture(m->reader, &m->color, index, &image);
    return result == RLF_OK ? io_ros_decode_color(&m->decoder, &image, m->color.pixels, out)
                            : result;
}

static void mcap_destroy(void *self)
{
    mcap *m = self;
    io_mcap_topics_destroy(&m->topics);
    io_mcap_reader_close(&m->reader);
    rlf_free(m->decoder.counts);
    rlf_free(m);
}

/* ---- times ------------------------------------------------------------------------------------
 */

static int32_t count_of(const mcap *m, const io_mcap_stream *s)
{
    return s->channel >= 0 ? io_mcap_channel_at(m->reader, s->channel)->count : 0;
}

static void use_stamp(mcap *m, int32_t index)
{
    io_cdr_span bytes;
    io_ros_header header;
    if (io_mcap_read(m->reader, index, &bytes) == RLF_OK &&
        io_ros_read_header(bytes.data, bytes.size, &header) && header.stamp_ns > 0) {
        io_mcap_set_time(m->reader, index, header.stamp_ns);
    }
}

/* Log times of other recorders are those of the messages' arrival; pictures belong together by when
 * they were taken. Both streams in step, so that each chunk is read once. */
static void use_stamps(mcap *m)
{
    const int32_t counts[2] = {count_of(m, &m->depth), count_of(m, &m->color)};
    const int32_t channels[2] = {m->depth.channel, m->color.channel};
    int32_t at[2] = {0, 0};
    while (at[0] < counts[0] || at[1] < counts[1]) {
        int64_t times[2] = {INT64_MAX, INT64_MAX};
        int32_t indexes[2] = {0, 0};
        for (int i = 0; i < 2; i++) {
            if (at[i] < counts[i]) {
                indexes[i] = io_mcap_channel_at(m->reader, channels[i])->first + at[i];
                times[i] = io_mcap_message_at(m->reader, indexes[i])->time_ns;
            }
        }
        const int turn = at[0] < counts[0] && times[0] <= times[1] ? 0 : at[1] < counts[1] ? 1 : 0;
        use_stamp(m, indexes[turn]);
        at[turn]++;
    }
    io_mcap_sort(m->reader);
}

/* New array. */
static int64_t *times_of(const mcap *m, const io_mcap_stream *s)
{
    const int32_t count = count_of(m, s);
    int64_t *times = rlf_alloc_array((size_t)count, sizeof(times[0]));
    for (int32_t i = 0; times != NULL && i < count; i++) {
        const int32_t first = io_mcap_channel_at(m->reader, s->channel)->first;
        times[i] = io_mcap_message_at(m->reader, first + i)->time_ns;
    }
    return times;
}

/* ---- poses ------------------------------------------------------------------------------------
 */

/* Of each depth picture the pose with its time; a zero quaternion where there is none. NULL when
 * the file has no poses. */
static rlf_pose *poses_of(mcap *m, const int64_t *times, int32_t count)
{
    const int32_t index = io_mcap_find_topic(m->reader, IO_ROS_POSE_STAMPED, IO_TOPIC_POSE);
    rlf_pose *poses = index >= 0 ? rlf_alloc_array((size_t)count, sizeof(poses[0])) : NULL;
    if (poses == NULL) {
        return NULL;
    }
    const io_mcap_channel *c = io_mcap_channel_at(m->reader, index);
    int32_t at = 0;
    for (int32_t i = 0; i < count; i++) {
        while (at < c->count && io_mcap_message_at(m->reader, c->first + at)->time_ns < times[i]) {
            at++;
        }
        io_cdr_span bytes;
        io_ros_header header;
        const bool is_there = at < c->count &&
                              io_mcap_message_at(m->reader, c->first + at)->time_ns == times[i] &&
                              io_mcap_read(m->reader, c->first + at, &bytes) == RLF_OK &&
                              io_ros_read_pose(bytes.data, bytes.size, &header, &poses[i]);
        if (!is_there) {
            memset(&poses[i], 0, sizeof(poses[i]));
        }
    }
    return poses;
}

/* ---- calibration ------------------------------------------------------------------------------
 */

/* clip.json beside clip.mcap, or camera.json in the same folder; "" when there is none. */
static void find_camera_file(const char *path, char out[IO_PATH_MAX])
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(path, '.');
    const size_t stem =
        dot != NULL && (slash == NULL || dot > slash) ? (size_t)(dot - path) : strlen(path);
    const size_t folder = slash != NULL ? (size_t)(slash + 1 - path) : 0;
    out[0] = '\0';
    if (stem + sizeof("camera.json") >= IO_PATH_MAX) {
        return;
    }
    snprintf(out, IO_PATH_MAX, "%.*s.json", (int)stem, path);
    if (access(out, R_OK) != 0) {
        snprintf(out, IO_PATH_MAX, "%.*scamera.json", (int)folder, path);
    }
    if (access(out, R_OK) != 0) {
        out[0] = '\0';
    }
}

static rlf_result fail_camera(const mcap *m)
{
    char problem[256];
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: has no usable CameraInfo for %s (%s): give the calibration with "
                    "?camera=FILE, or as camera.json beside the file",
                    m->path, io_mcap_channel_at(m->reader, m->depth.channel)->topic,
                    io_mcap_why_no_camera(m->topics, &m->depth, problem, sizeof(problem)));
}

/* Colour without a calibration of its own is the depth's when the pictures are of one camera. */
static void find_color_camera(mcap *m)
{
    const bool is_same = strcmp(m->depth.frame_id, m->color.frame_id) == 0;
    m->rig.has_color = io_mcap_find_camera(m->topics, &m->color, &m->rig.color);
    if (!m->rig.has_color && is_same && m->depth.width == m->color.width &&
        m->depth.height == m->color.height) {
        m->rig.color = m->rig.depth;
        m->rig.has_color = true;
    }
    if (!m->rig.has_color) {
        char problem[256];
        rlf_log(RLF_LOG_WARNING, "%s: has no usable CameraInfo for %s (%s): there is no colour",
                m->path, io_mcap_channel_at(m->reader, m->color.channel)->topic,
                io_mcap_why_no_camera(m->topics, &m->color, problem, sizeof(problem)));
        return;
    }
    if (is_same) {
        m->flags |= RLF_FRAME_ALIGNED;
    } else if (!io_mcap_find_transform(m->reader, m->depth.frame_id, m->color.frame_id,
                                       &m->rig.T_color_depth)) {
        rlf_log(RLF_LOG_WARNING,
                "%s: /tf_static does not join %s to %s: the two cameras are taken as one", m->path,
                m->depth.frame_id, m->color.frame_id);
    }
}

static rlf_result find_rig(const rlf_address *address, mcap *m)
{
    m->rig = rlf_rig_default();
    m->units_per_metre = 1000.0; /* what 16UC1 means (REP 118) */
    if (address->rig != NULL) {
        m->rig = *address->rig;
        m->units_per_metre = address->units_per_metre;
        return RLF_OK;
    }
    char file[IO_PATH_MAX];
    if (!io_mcap_find_camera(m->topics, &m->depth, &m->rig.depth)) {
        find_camera_file(m->path, file);
        return file[0] != '\0' ? rlf_rig_load(file, &m->rig, &m->units_per_metre) : fail_camera(m);
    }
    if (m->color.channel >= 0) {
        find_color_camera(m);
    }
    return RLF_OK;
}

static void read_metadata(mcap *m)
{
    rlf_rig *r = &m->rig;
    m->units_per_metre = io_mcap_number(m->reader, IO_KEY_UNITS, 1, 1e6, m->units_per_metre);
    r->depth_max_m = io_mcap_number(m->reader, IO_KEY_DEPTH_MAX, 1e-3, 1000, r->depth_max_m);
    r->depth_min_m = io_mcap_number(m->reader, IO_KEY_DEPTH_MIN, 0, r->depth_max_m, r->depth_min_m);
    r->noise.c0 = io_mcap_number(m->reader, IO_KEY_NOISE_0, -1, 1, r->noise.c0);
    r->noise.c1 = io_mcap_number(m->reader, IO_KEY_NOISE_1, -1, 1, r->noise.c1);
    r->noise.c2 = io_mcap_number(m->reader, IO_KEY_NOISE_2, -1, 1, r->noise.c2);
    m->flags |= (uint32_t)io_mcap_number(m->reader, IO_KEY_FLAGS, 0, 3, 0);
}

/* ---- opening ----------------------------------------------------------------------------------
 */

static rlf_result check_sizes(const mcap *m)
{
    const rlf_camera *d = &m->rig.depth;
    const rlf_camera *c = &m->rig.color;
    const bool is_depth_right = d->width == m->depth.width && d->height == m->depth.height;
    const bool is_color_right =
        !m->rig.has_color || (c->width == m->color.width && c->height == m->color.height);
    if (is_depth_right && is_color_right) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: the calibration is for %s of %d x %d, and the pictures have %d x %d: give "
                    "one of that size with ?camera=FILE",
                    m->path, is_depth_right ? "colour" : "depth",
                    (int)(is_depth_right ? c->width : d->width),
                    (int)(is_depth_right ? c->height : d->height),
                    (int)(is_depth_right ? m->color.width : m->depth.width),
                    (int)(is_depth_right ? m->color.height : m->depth.height));
}

static rlf_result prepare(const rlf_address *address, mcap *m)
{
    const io_mcap_wishes wishes = {rlf_address_get(address, "depth"),
                                   rlf_address_get(address, "color")};
    rlf_result result = io_mcap_topics_create(m->reader, m->path, &m->topics);
    if (result == RLF_OK) {
        result = io_mcap_find_streams(m->topics, &wishes, &m->depth, &m->color);
    }
    if (result == RLF_OK) {
        result = find_rig(address, m);
    }
    if (result != RLF_OK) {
        return result;
    }
    const bool is_own = io_mcap_metadata(m->reader, IO_KEY_UNITS) != NULL;
    if (is_own) {
        io_mcap_read_origin(m->reader, &m->origin);
    }
    if (is_own && address->rig == NULL) {
        read_metadata(m);
    }
    m->rig.has_color = m->rig.has_color && m->color.channel >= 0;
    m->color.channel = m->rig.has_color ? m->color.channel : -1;
    if (!is_own) {
        use_stamps(m);
    }
    io_rvl_init(&m->decoder.rvl);
    m->decoder.name = m->path;
    if (m->depth.pixels == IO_ROS_DEPTH_RVL_F32 || m->depth.pixels == IO_ROS_DEPTH_PNG_F32) {
        m->decoder.counts =
            rlf_alloc_array((size_t)m->depth.width * (size_t)m->depth.height, sizeof(uint16_t));
        result = m->decoder.counts != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    return result == RLF_OK ? check_sizes(m) : result;
}

static rlf_result open_clip(mcap *m, rlf_opened *out)
{
    int64_t *depth_times = times_of(m, &m->depth);
    int64_t *color_times = times_of(m, &m->color);
    const int32_t count = count_of(m, &m->depth);
    rlf_pose *poses = depth_times != NULL ? poses_of(m, depth_times, count) : NULL;
    io_frame_note *notes = io_mcap_read_notes(m->reader, &m->origin);
    rlf_result result = RLF_ERROR_MEMORY;
    if (depth_times != NULL && color_times != NULL) {
        const io_clip_def def = {.name = m->path,
                                 .rig = m->rig,
                                 .units_per_metre =
                                     io_ros_is_metres(m->depth.pixels) ? 0.0 : m->units_per_metre,
                                 .depth_times = depth_times,
                                 .color_times = color_times,
                                 .poses = poses,
                                 .depth_count = count,
                                 .color_count = count_of(m, &m->color),
                                 .flags = m->flags,
                                 .origin = m->origin,
                                 .read_depth = read_depth,
                                 .read_color = read_color,
                                 .destroy = mcap_destroy,
                                 .self = m};
        result = io_clip_open(&def, out);
    }
    rlf_free(depth_times);
    rlf_free(color_times);
    rlf_free(poses);
    rlf_free(notes);
    return result;
}

/* Which topics were taken, for `relief info`. */
static void describe(const mcap *m, rlf_opened *out)
{
    const char *device = io_mcap_metadata(m->reader, IO_KEY_DEVICE);
    const bool has_color = m->color.channel >= 0;
    const char *depth = io_mcap_channel_at(m->reader, m->depth.channel)->topic;
    const char *color = has_color ? io_mcap_channel_at(m->reader, m->color.channel)->topic : "";
    snprintf(out->info.device, sizeof(out->info.device), "MCAP: depth %.40s%s%.40s%s%.30s", depth,
             has_color ? ", colour " : "", color, device != NULL ? "; " : "",
             device != NULL ? device : "");
}

static rlf_result mcap_open(const rlf_address *address, rlf_opened *out)
{
    mcap *m = rlf_alloc(sizeof(*m));
    if (m == NULL) {
        return RLF_ERROR_MEMORY;
    }
    snprintf(m->path, sizeof(m->path), "%s", address->place);
    rlf_result result = io_mcap_reader_open(m->path, &m->reader);
    if (result == RLF_OK) {
        result = prepare(address, m);
    }
    if (result == RLF_OK) {
        result = open_clip(m, out);
    }
    if (result != RLF_OK) {
        mcap_destroy(m);
        return result;
    }
    describe(m, out);
    return RLF_OK;
}

const rlf_backend io_backend_mcap = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "mcap",
    .extensions = ".mcap",
    .keys = "depth color",
    .summary = "a recording: MCAP with ROS 2 pictures, Relief's own or another's",
    .open = mcap_open,
};
