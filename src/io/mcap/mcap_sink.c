/* Recording into an MCAP file with ROS 2 messages. */
#define _POSIX_C_SOURCE 200809L
#include "io/clip/sink.h"

#include "io/clip/clip.h"
#include "io/mcap/mcap.h"
#include "io/ros/write.h"

#include <stdio.h>
#include <time.h>

/* A chunk is also written once it is this large, which bounds the memory. */
#define CHUNK_BYTES_MAX ((size_t)64 << 20)

/* What ROS 2 calls these policies in a recording: every message counts; late ones come too. */
#define QOS(durability)                                                                            \
    "- history: keep_last\n  depth: 10\n  reliability: reliable\n  durability: " durability        \
    "\n  deadline:\n    sec: 9223372036\n    nsec: 854775807\n  lifespan:\n    sec: 9223372036\n"  \
    "    nsec: 854775807\n  liveliness: automatic\n  liveliness_lease_duration:\n"                 \
    "    sec: 9223372036\n    nsec: 854775807\n  avoid_ros_namespace_conventions: false\n"

typedef struct mcap_sink {
    io_mcap_writer *writer;
    rlf_source_info info;
    rlf_recording_def def;
    bool is_started;
    uint16_t depth, color, depth_info, color_info, tf_static, tf, pose, note;
    io_frame_notes notes;
    io_ros_encoder encoder;
    int64_t chunk_begin_ns, last_color_ns;
    uint64_t frames, colors, bytes;
} mcap_sink;

/* ---- what stands before the pictures -------------------------------------------------------- */

static void add_metadata(mcap_sink *s, const rlf_frame *frame)
{
    const rlf_rig *r = &s->info.rig;
    struct timespec now = {0};
    clock_gettime(CLOCK_REALTIME, &now);
    const int64_t unix_ns = (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
    char numbers[9][32];
    char gravity[96];
    const rlf_vec3 g = s->info.gravity;
    const double values[7] = {frame->depth_f32 != NULL ? 1000.0 : frame->depth_units_per_metre,
                              r->depth_min_m,
                              r->depth_max_m,
                              r->noise.c0,
                              r->noise.c1,
                              r->noise.c2,
                              s->info.frames_per_second};
    for (int i = 0; i < 7; i++) {
        snprintf(numbers[i], sizeof(numbers[i]), "%.17g", values[i]);
    }
    snprintf(numbers[7], sizeof(numbers[7]), "%u", (unsigned)s->notes.flags);
    snprintf(numbers[8], sizeof(numbers[8]), "%lld", (long long)(unix_ns - frame->time_ns));
    snprintf(gravity, sizeof(gravity), "%.17g %.17g %.17g", g.x, g.y, g.z);
    const io_mcap_pair pairs[] = {
        {"version", "1"},
        {IO_KEY_UNITS, numbers[0]},
        {IO_KEY_DEPTH_MIN, numbers[1]},
        {IO_KEY_DEPTH_MAX, numbers[2]},
        {IO_KEY_NOISE_0, numbers[3]},
        {IO_KEY_NOISE_1, numbers[4]},
        {IO_KEY_NOISE_2, numbers[5]},
        {IO_KEY_RATE, numbers[6]},
        {IO_KEY_GRAVITY, gravity},
        {IO_KEY_SIMULATED, s->info.is_simulated ? "1" : "0"},
        {IO_KEY_FLAGS, numbers[7]},
        {IO_KEY_NOTES, "1"},
        {IO_KEY_UNIX_OFFSET, numbers[8]},
        {IO_KEY_SOURCE, s->info.name},
        {IO_KEY_DEVICE, s->info.device},
    };
    io_mcap_add_metadata(s->writer, "relief", pairs, sizeof(pairs) / sizeof(pairs[0]));
}

static void add_schema(mcap_sink *s, io_ros_type type)
{
    io_mcap_add_schema(s->writer, io_ros_type_name(type), io_ros_type_text(type));
}

/* All that may come: a channel cannot be added later. */
static void add_channels(mcap_sink *s, const rlf_frame *frame)
{
    static const char lasting[] = QOS("transient_local");
    static const char passing[] = QOS("volatile");
    io_mcap_writer *w = s->writer;
    const bool is_float = frame->depth_f32 != NULL;
    if (is_float) {
        add_schema(s, IO_ROS_IMAGE);
        s->depth = io_mcap_add_channel(w, IO_TOPIC_DEPTH_RAW, passing);
    }
    add_schema(s, IO_ROS_COMPRESSED_IMAGE);
    if (!is_float) {
        s->depth = io_mcap_add_channel(w, IO_TOPIC_DEPTH_RVL, passing);
    }
    if (s->info.rig.has_color) {
        s->color = io_mcap_add_channel(w, IO_TOPIC_COLOR, passing);
    }
    add_schema(s, IO_ROS_CAMERA_INFO);
    s->depth_info = io_mcap_add_channel(w, IO_TOPIC_DEPTH_INFO, passing);
    if (s->info.rig.has_color) {
        s->color_info = io_mcap_add_channel(w, IO_TOPIC_COLOR_INFO, passing);
    }
    add_schema(s, IO_ROS_TF);
    s->tf_static = io_mcap_add_channel(w, "/tf_static", lasting);
    s->tf = io_mcap_add_channel(w, "/tf", passing);
    add_schema(s, IO_ROS_POSE_STAMPED);
    s->pose = io_mcap_add_channel(w, IO_TOPIC_POSE, passing);
    add_schema(s, IO_ROS_STRING);
    s->note = io_mcap_add_channel(w, IO_TOPIC_FRAME, passing);
}

static void add_info(mcap_sink *s, uint16_t channel, int64_t time_ns, const char *frame_id,
                     const rlf_camera *camera)
{
    const io_ros_header header = io_ros_header_at(time_ns, frame_id);
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(s->writer, channel, time_ns));
    io_ros_write_camera_info(&cdr, &header, camera);
    io_mcap_end(s->writer, true);
}

static void add_static_transform(mcap_sink *s, int64_t time_ns)
{
    io_ros_transform t = {.stamp_ns = time_ns > 0 ? time_ns : 0,
                          .parent = IO_FRAME_COLOR,
                          .child = IO_FRAME_DEPTH,
                          .T_parent_child = s->info.rig.T_color_depth};
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(s->writer, s->tf_static, time_ns));
    io_ros_write_tf(&cdr, &t, 1);
    io_mcap_end(s->writer, true);
}

static void start(mcap_sink *s, const rlf_frame *frame)
{
    const rlf_rig *r = &s->info.rig;
    s->is_started = true;
    s->notes.has_color_camera = r->has_color;
    s->notes.flags = frame->flags & (RLF_FRAME_UNMIRRORED | RLF_FRAME_ALIGNED);
    add_metadata(s, frame);
    add_channels(s, frame);
    add_info(s, s->depth_info, frame->time_ns, IO_FRAME_DEPTH, &r->depth);
    if (r->has_color) {
        add_info(s, s->color_info, frame->time_ns, IO_FRAME_COLOR, &r->color);
        add_static_transform(s, frame->time_ns);
    }
}

/* ---- pictures ------------------------------------------------------------------------------- */

static rlf_result add_depth(mcap_sink *s, const rlf_frame *frame)
{
    const io_ros_header header = io_ros_header_at(frame->time_ns, IO_FRAME_DEPTH);
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(s->writer, s->depth, frame->time_ns));
    rlf_result result = RLF_OK;
    if (frame->depth_f32 != NULL) {
        io_ros_write_depth(&s->encoder, frame, &header, &cdr);
    } else {
        result = io_ros_write_counts(&s->encoder, frame, &header, &cdr);
    }
    io_mcap_end(s->writer, result == RLF_OK);
    return result;
}

static rlf_result add_color(mcap_sink *s, const rlf_frame *frame)
{
    const rlf_image_rgba8 *c = &frame->color;
    const int64_t time_ns = frame->color_time_ns != 0 ? frame->color_time_ns : frame->time_ns;
    if (s->colors > 0 && time_ns == s->last_color_ns) {
        return RLF_OK; /* the same picture again */
    }
    const io_ros_header header = io_ros_header_at(time_ns, IO_FRAME_COLOR);
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(s->writer, s->color, time_ns));
    rlf_result result = io_ros_write_compressed(&s->encoder, c, &header, &cdr);
    io_mcap_end(s->writer, result == RLF_OK);
    s->last_color_ns = time_ns;
    s->colors += result == RLF_OK ? 1 : 0;
    return result;
}

static void add_pose(mcap_sink *s, const rlf_frame *frame)
{
    const io_ros_header header = io_ros_header_at(frame->time_ns, IO_FRAME_WORLD);
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(s->writer, s->pose, frame->time_ns));
    io_ros_write_pose(&cdr, &header, &frame->T_world_camera);
    io_mcap_end(s->writer, true);
}

static void add_notes(mcap_sink *s, const rlf_frame *frame)
{
    io_frame_note notes[2];
    const int32_t count = io_frame_notes_add(&s->notes, frame, notes);
    for (int32_t i = 0; i < count; i++) {
        char text[IO_FRAME_NOTE_TEXT];
        io_frame_note_print(&notes[i], text);
        io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(s->writer, s->note, notes[i].time_ns));
        io_cdr_put_text(&cdr, text);
        io_mcap_end(s->writer, true);
    }
}

/* Written when it is as long as it may be. The first frame goes out at once, so that from then on
 * the file can be read whatever happens. */
static rlf_result flush_when_due(mcap_sink *s, int64_t time_ns)
{
    const double age_s = 1e-9 * (double)(time_ns - s->chunk_begin_ns);
    const bool is_due = s->frames == 1 || age_s >= s->def.chunk_s || age_s < 0.0 ||
                        io_mcap_gathered(s->writer) >= CHUNK_BYTES_MAX;
    if (!is_due) {
        return RLF_OK;
    }
    s->chunk_begin_ns = time_ns;
    s->bytes += io_mcap_gathered(s->writer);
    return io_mcap_flush(s->writer);
}

static rlf_result mcap_add(void *self, const rlf_frame *frame)
{
    mcap_sink *s = self;
    rlf_result result = RLF_OK;
    if (!s->is_started) {
        start(s, frame);
    }
    if (s->info.rig.has_color && frame->color.data != NULL) {
        result = add_color(s, frame);
    }
    result = result == RLF_OK ? add_depth(s, frame) : result;
    if (result == RLF_OK && frame->has_pose) {
        add_pose(s, frame);
    }
    if (result == RLF_OK) {
        add_notes(s, frame);
    }
    s->frames += result == RLF_OK ? 1 : 0;
    return result == RLF_OK ? flush_when_due(s, frame->time_ns) : result;
}

/* Bodies as frames of /tf: any viewer shows them, and no message of another package is needed. */
static rlf_result mcap_add_bodies(void *self, int64_t time_ns, const rlf_snapshot *snapshot)
{
    mcap_sink *s = self;
    if (!s->is_started || snapshot->body_count == 0) {
        return RLF_OK;
    }
    io_ros_transform *list =
        rlf_alloc_array((size_t)snapshot->body_count, sizeof(io_ros_transform));
    if (list == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        list[i] = (io_ros_transform){.stamp_ns = time_ns > 0 ? time_ns : 0,
                                     .parent = IO_FRAME_DEPTH,
                                     .T_parent_child = snapshot->bodies[i].T_world_body};
        snprintf(list[i].child, sizeof(list[i].child), "body_%d_%.64s", (int)i,
                 snapshot->bodies[i].name);
    }
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(s->writer, s->tf, time_ns));
    io_ros_write_tf(&cdr, list, (uint32_t)snapshot->body_count);
    io_mcap_end(s->writer, true);
    rlf_free(list);
    return RLF_OK;
}

static uint64_t mcap_bytes(const void *self)
{
    return ((const mcap_sink *)self)->bytes;
}

static rlf_result mcap_close(void *self, rlf_recording_status *status)
{
    mcap_sink *s = self;
    io_mcap_written written = {0};
    rlf_result result = io_mcap_writer_close(&s->writer, &written);
    status->bytes = written.bytes;
    status->frames =
        s->is_started ? written.of_channel[s->depth - 1] : 0; /* a full disk keeps few */
    io_ros_encoder_free(&s->encoder);
    rlf_free(s);
    return result;
}

rlf_result io_mcap_sink_open(const char *path, const rlf_source_info *info,
                             const rlf_recording_def *def, io_sink *out)
{
    static const io_packing packings[3] = {IO_PACKING_ZSTD, IO_PACKING_LZ4, IO_PACKING_NONE};
    mcap_sink *s = rlf_alloc(sizeof(*s));
    if (s == NULL) {
        return RLF_ERROR_MEMORY;
    }
    s->info = *info;
    s->def = *def;
    rlf_result result = io_ros_encoder_init(&s->encoder, &info->rig, def);
    if (result == RLF_OK) {
        result = io_mcap_writer_create(path, packings[def->compression], &s->writer);
    }
    if (result != RLF_OK) {
        io_ros_encoder_free(&s->encoder);
        rlf_free(s);
        return result;
    }
    *out = (io_sink){.add = mcap_add,
                     .add_bodies = mcap_add_bodies,
                     .close = mcap_close,
                     .bytes = mcap_bytes,
                     .self = s};
    return RLF_OK;
}
