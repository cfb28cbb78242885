/* MCAP files as a source: Relief's own recordings, and anybody's ROS 2 recordings of a depth
 * camera. */
#include "io/mcap/mcap.h"
#include "io/ros/recording.h"
#include "io/source/backends.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- what a recording of Relief's own says beside its pictures --------------------------- */

/* The channel of that type and topic that has messages; -1 = none. */
static int32_t find_topic(const io_ros_log *log, io_ros_type type, const char *topic)
{
    for (int32_t i = 0; i < log->channel_count; i++) {
        const io_ros_channel *c = &log->channels[i];
        if (c->type == type && strcmp(c->topic, topic) == 0 && c->count > 0) {
            return i;
        }
    }
    return -1;
}

/* What ROS has no message for, from the metadata; nonsense changes nothing. */
static double number_of(const io_mcap_reader *reader, const char *key, double low, double high,
                        double otherwise)
{
    const char *text = io_mcap_metadata(reader, key);
    const double value = text != NULL ? strtod(text, NULL) : otherwise;
    return value >= low && value <= high ? value : otherwise;
}

static rlf_vec3 read_gravity(const io_mcap_reader *reader)
{
    rlf_vec3 g = {0};
    const char *text = io_mcap_metadata(reader, IO_KEY_GRAVITY);
    const bool is_good = text != NULL && sscanf(text, "%lf %lf %lf", &g.x, &g.y, &g.z) == 3 &&
                         rlf_vec3_is_finite(g) && rlf_length(g) <= IO_GRAVITY_MAX;
    return is_good ? g : (rlf_vec3){0};
}

/* What its source said beside the calibration; without the notes. */
static void read_origin(const io_mcap_reader *reader, io_clip_origin *out)
{
    out->gravity = read_gravity(reader);
    out->is_simulated = number_of(reader, IO_KEY_SIMULATED, 0, 1, 0) > 0.0;
    out->frames_per_second = number_of(reader, IO_KEY_RATE, 0, IO_RATE_MAX, 0);
    out->has_notes = io_mcap_metadata(reader, IO_KEY_NOTES) != NULL;
}

/* The notes of its frames, in a new array that *origin borrows; NULL when there are none. */
static io_frame_note *read_notes(const io_ros_log *log, io_clip_origin *origin)
{
    const int32_t index = find_topic(log, IO_ROS_STRING, IO_TOPIC_FRAME);
    const int32_t most = index >= 0 && origin->has_notes ? log->channels[index].count : 0;
    io_frame_note *notes = most > 0 ? rlf_alloc_array((size_t)most, sizeof(notes[0])) : NULL;
    int32_t count = 0;
    for (int32_t i = 0; notes != NULL && i < most; i++) {
        io_cdr_reader message;
        char text[IO_FRAME_NOTE_TEXT];
        const bool is_read = io_ros_log_read(log, index, i, &message) == RLF_OK &&
                             io_ros_read_string(message, text, sizeof(text)) &&
                             io_frame_note_parse(text, &notes[count]);
        count += is_read ? 1 : 0;
    }
    io_frame_notes_sort(notes, count);
    origin->notes = notes;
    origin->note_count = count;
    return notes;
}

typedef struct mcap {
    io_ros_recording ros; /* the clip's self */
    char path[IO_PATH_MAX];
    io_mcap_reader *reader;
} mcap;

static void mcap_destroy(void *self)
{
    mcap *m = self;
    io_ros_recording_free(&m->ros);
    io_mcap_reader_close(&m->reader);
    rlf_free(m);
}

/* ---- what Relief's own recordings say beside ROS -------------------------------------------- */

/* Of each depth picture the pose with its time; a zero quaternion where there is none. NULL when
 * the file has no poses. */
static rlf_pose *poses_of(mcap *m, const io_shots *shots)
{
    const io_ros_log *log = &m->ros.log;
    const int32_t index = find_topic(log, IO_ROS_POSE_STAMPED, IO_TOPIC_POSE);
    rlf_pose *poses = index >= 0 ? rlf_alloc_array((size_t)shots->count, sizeof(poses[0])) : NULL;
    int32_t at = 0;
    for (int32_t i = 0; poses != NULL && i < shots->count; i++) {
        const int32_t count = log->channels[index].count;
        const int64_t time_ns = shots->items[i].time_ns;
        while (at < count && io_ros_log_at(log, index, at)->time_ns < time_ns) {
            at++;
        }
        io_cdr_reader message;
        io_ros_header header;
        const bool is_there = at < count && io_ros_log_at(log, index, at)->time_ns == time_ns &&
                              io_ros_log_read(log, index, at, &message) == RLF_OK &&
                              io_ros_read_pose(message, &header, &poses[i]);
        if (!is_there) {
            memset(&poses[i], 0, sizeof(poses[i]));
        }
    }
    return poses;
}

static void read_metadata(mcap *m)
{
    rlf_rig *r = &m->ros.rig;
    m->ros.units_per_metre = number_of(m->reader, IO_KEY_UNITS, 1, 1e6, m->ros.units_per_metre);
    r->depth_max_m = number_of(m->reader, IO_KEY_DEPTH_MAX, 1e-3, 1000, r->depth_max_m);
    r->depth_min_m = number_of(m->reader, IO_KEY_DEPTH_MIN, 0, r->depth_max_m, r->depth_min_m);
    r->noise.c0 = number_of(m->reader, IO_KEY_NOISE_0, -1, 1, r->noise.c0);
    r->noise.c1 = number_of(m->reader, IO_KEY_NOISE_1, -1, 1, r->noise.c1);
    r->noise.c2 = number_of(m->reader, IO_KEY_NOISE_2, -1, 1, r->noise.c2);
    m->ros.flags |= (uint32_t)number_of(m->reader, IO_KEY_FLAGS, 0, 3, 0);
}

/* ---- opening -------------------------------------------------------------------------------- */

/* Which topics were taken, for `relief info`. */
static void describe(const mcap *m, char *out, size_t size)
{
    const char *device = io_mcap_metadata(m->reader, IO_KEY_DEVICE);
    const io_ros_recording *r = &m->ros;
    const bool has_color = r->color.channel >= 0;
    snprintf(out, size, "MCAP: depth %.40s%s%.40s%s%.30s", r->pictures[r->depth.picture].name,
             has_color ? ", colour " : "", has_color ? r->pictures[r->color.picture].name : "",
             device != NULL ? "; " : "", device != NULL ? device : "");
}

static rlf_result open_clip(const rlf_address *address, mcap *m, bool is_own, rlf_opened *out)
{
    char device[128];
    describe(m, device, sizeof(device));
    io_clip_def def = {.device = device, .destroy = mcap_destroy, .self = m};
    if (is_own) {
        read_origin(m->reader, &def.origin);
    }
    rlf_pose *poses = poses_of(m, &m->ros.depth.shots);
    io_frame_note *notes = read_notes(&m->ros.log, &def.origin);
    def.poses = poses;
    rlf_result result = io_ros_open_clip(&m->ros, address, &def, out);
    rlf_free(poses);
    rlf_free(notes);
    return result;
}

static rlf_result open_recording(const rlf_address *address, mcap *m, rlf_opened *out)
{
    const bool is_own = io_mcap_metadata(m->reader, IO_KEY_UNITS) != NULL;
    rlf_result result = io_ros_prepare(&m->ros, address);
    if (result == RLF_OK && is_own && address->rig == NULL) {
        read_metadata(m);
    }
    result = result == RLF_OK ? io_ros_list_pictures(&m->ros, !is_own) : result;
    return result == RLF_OK ? open_clip(address, m, is_own, out) : result;
}

static rlf_result open_all(const rlf_address *address, mcap *m, rlf_opened *out)
{
    snprintf(m->path, sizeof(m->path), "%s", address->place);
    m->ros.log.name = m->path;
    rlf_result result = io_mcap_reader_open(m->path, &m->ros.log, &m->reader);
    return result == RLF_OK ? open_recording(address, m, out) : result;
}

static rlf_result mcap_open(const rlf_address *address, rlf_opened *out)
{
    mcap *m = rlf_alloc(sizeof(*m));
    return io_open_end(m != NULL ? open_all(address, m, out) : RLF_ERROR_MEMORY, m, mcap_destroy);
}

const rlf_backend io_backend_mcap = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "mcap",
    .extensions = ".mcap",
    .keys = "depth color gap",
    .summary = "a recording: MCAP with ROS 2 pictures, Relief's own or another's",
    .open = mcap_open,
};
