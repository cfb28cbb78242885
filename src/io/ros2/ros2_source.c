/* Any camera with a ROS 2 driver as a source. */
#include "io/ros2/find_camera.h"

#include "io/live/driver.h"
#include "io/source/backends.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define NS_PER_S 1000000000.0
#define RATE_MAX 240.0

/* ---- messages of one topic, of one publisher ------------------------------------------------- */

/* Depth or colour of a running camera: message by message into a picture. */
typedef struct stream {
    const char *source, *topic; /* for lines */
    io_ros2_reader reader;
    bool is_compressed, is_told;
    bool has_rival; /* another publisher's message came since the last of its own */
    io_ros_pixels pixels;
    uint64_t writer; /* whose messages are taken; 0 = the first that comes */
    int64_t heard_ns;
    uint64_t *damaged; /* counts what is refused */
} stream;

/* A publisher that was silent so long may be dead: the next one's messages are taken. Cameras make
 * five pictures a second or more. */
#define SILENT_NS INT64_C(300000000)

/* Once. */
static void tell(stream *s, const char *line)
{
    if (!s->is_told) {
        s->is_told = true;
        rlf_log(RLF_LOG_WARNING, "%s: a message of %s is refused: %s", s->source, s->topic, line);
    }
}

/* Counts a picture that could not be decoded, with the error line that is left. */
static void refuse(stream *s, const char *line)
{
    ++*s->damaged;
    tell(s, line);
}

/* Two on one topic would give two rooms in turn. Of one that was killed and started again the first
 * is silent: nothing is told of it. */
static bool is_of_publisher(stream *s, const io_ros2_message *m)
{
    const int64_t now_ns = rlf_clock_ns();
    const bool is_other = s->writer != 0 && m->writer != s->writer;
    if (is_other && now_ns - s->heard_ns < SILENT_NS) {
        s->has_rival = true;
        ++*s->damaged;
        return false;
    }
    if (s->has_rival && !is_other) {
        tell(s, "a second publisher sends to this topic, too: stop one");
    }
    s->has_rival = false;
    s->writer = m->writer;
    s->heard_ns = now_ns;
    return true;
}

static bool read_image(stream *s, const io_ros2_message *m, io_ros_image *out)
{
    const io_cdr_reader reader = io_cdr_open(m->data, m->size);
    const bool is_read =
        s->is_compressed ? io_ros_read_compressed(reader, out) : io_ros_read_image(reader, out);
    if (!is_read) {
        refuse(s, "it is cut short, or no picture");
        return false;
    }
    if (io_ros_pixels_of(out, s->is_compressed) != s->pixels) {
        char line[128];
        snprintf(line, sizeof(line), "its encoding is now \"%.40s\": start again", out->encoding);
        refuse(s, line);
        return false;
    }
    return true;
}

/* The next message that is to be used; false when nothing waits. Messages of a second publisher, of
 * another kind of picture, and bytes that are none are refused and counted. `held` is released by
 * the caller. */
static bool take_message(stream *s, io_ros2_message *held, io_ros_image *out)
{
    while (io_ros2_take(&s->reader, held)) {
        if (is_of_publisher(s, held) && read_image(s, held, out)) {
            out->header.stamp_ns = out->header.stamp_ns > 0 ? out->header.stamp_ns : held->sent_ns;
            return true;
        }
        io_ros2_release(held);
    }
    return false;
}

/* ---- a camera -------------------------------------------------------------------------------- */

typedef struct ros2 {
    char source[256];
    io_ros2_node *node;
    io_ros2_found found;
    io_ros_recording ros; /* of the first messages: what the topics are, cameras, decoder */
    io_stream_pair pair;
    stream depth, color;
    double frames_per_second;
} ros2;

/* ---- frames --------------------------------------------------------------------------------- */

static bool take_color(ros2 *r)
{
    io_ros2_message held = {0};
    io_ros_image image;
    if (!r->ros.rig.has_color || !take_message(&r->color, &held, &image)) {
        return false;
    }
    const rlf_image_rgba8 to = io_stream_pair_color(&r->pair);
    if (io_ros_decode_color(&r->ros.decoder, &image, r->color.pixels, &to) == RLF_OK) {
        io_stream_pair_push_color(&r->pair, image.header.stamp_ns);
    } else {
        refuse(&r->color, rlf_error_text());
    }
    io_ros2_release(&held);
    return true;
}

static bool take_depth(ros2 *r)
{
    io_ros2_message held = {0};
    io_ros_image image;
    if (!take_message(&r->depth, &held, &image)) {
        return false;
    }
    const rlf_camera *c = &r->ros.rig.depth;
    if (io_ros_decode_depth(&r->ros.decoder, &image, r->depth.pixels, c->width, c->height,
                            io_stream_pair_depth(&r->pair)) == RLF_OK) {
        io_stream_pair_push_depth(&r->pair, image.header.stamp_ns, -1);
    } else {
        refuse(&r->depth, rlf_error_text());
    }
    io_ros2_release(&held);
    return true;
}

/* One picture of each: more would push one out that waits for its other half. */
static rlf_result pump(void *self, int32_t wait_ms)
{
    ros2 *r = self;
    const bool has_color = take_color(r);
    if (!take_depth(r) && !has_color) {
        io_ros2_wait(r->node, wait_ms);
    }
    return RLF_OK;
}

static rlf_result ros2_next(void *self, rlf_frame *out)
{
    ros2 *r = self;
    return io_stream_pair_next(&r->pair, pump, r, out);
}

static void ros2_status(void *self, rlf_source_status *out)
{
    const ros2 *r = self;
    out->lost = r->pair.status.lost;
    out->doubled = r->pair.status.doubled;
    out->unpaired = r->pair.status.unpaired;
    out->damaged = r->pair.status.damaged;
}

static void ros2_destroy(void *self)
{
    ros2 *r = self;
    io_stream_pair_finish(&r->pair);
    io_ros_recording_free(&r->ros);
    io_ros2_found_free(&r->found);
    io_ros2_node_close(&r->node);
    rlf_free(r);
}

/* ---- opening -------------------------------------------------------------------------------- */

/* The two machines' clocks tell when a picture was taken: both must be right to a frame. */
static rlf_result check_clock(const ros2 *r, const rlf_address *address,
                              const io_ros2_channel *depth)
{
    const char *wish = rlf_address_get(address, "clock");
    if (wish != NULL && strcmp(wish, "any") != 0) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: clock=%.40s: the one value is any", r->source,
                        wish);
    }
    const double off_s = -1e-9 * (double)depth->clock_ns;
    if (wish != NULL || depth->clock_ns == INT64_MAX || fabs(off_s) * r->frames_per_second <= 1.0) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_DEVICE,
                    "%s: the clock of the camera's host is %.3f s %s this machine's, and a frame "
                    "takes %.3f s: synchronise both (chrony), or add ?clock=any",
                    r->source, fabs(off_s), off_s > 0.0 ? "ahead of" : "behind",
                    1.0 / r->frames_per_second);
}

/* The readers of the other topics are closed: what nobody reads is not sent. */
static void use_streams(ros2 *r)
{
    const io_ros_stream *const from[2] = {&r->ros.depth, &r->ros.color};
    stream *const to[2] = {&r->depth, &r->color};
    for (int k = 0; k < 2; k++) {
        if (from[k]->channel >= 0) {
            const io_ros2_channel *c = &r->found.channels[from[k]->channel];
            *to[k] = (stream){.source = r->source,
                              .topic = c->topic.name,
                              .reader = c->reader,
                              .is_compressed = from[k]->is_compressed,
                              .pixels = from[k]->pixels,
                              .damaged = &r->pair.status.damaged};
        }
    }
    for (int32_t i = 0; i < r->found.count; i++) {
        if (i != r->ros.depth.channel && i != r->ros.color.channel) {
            io_ros2_reader_close(&r->found.channels[i].reader);
        }
    }
}

static void read_rate(ros2 *r, const io_ros2_channel *depth)
{
    const double rate = depth->interval_ns > 0 ? NS_PER_S / (double)depth->interval_ns : 30.0;
    r->frames_per_second = rate < 1.0 ? 1.0 : rate > RATE_MAX ? RATE_MAX : rate;
}

static rlf_result start(ros2 *r, const rlf_address *address)
{
    io_ros2_place place;
    rlf_result result = io_ros2_place_read(r->source, rlf_address_get(address, "domain"),
                                           rlf_address_get(address, "profile"), &place);
    result = result == RLF_OK ? io_ros2_node_open(r->source, &place, &r->node) : result;
    const io_ros2_wish wish = {.place = address->place,
                               .depth = rlf_address_get(address, "depth"),
                               .color = rlf_address_get(address, "color"),
                               .is_packed = place.profile == IO_ROS2_LAN};
    result = result == RLF_OK ? io_ros2_find_camera(r->node, r->source, &wish, &r->found) : result;
    result = result == RLF_OK ? io_ros2_found_log(&r->found, r->source, &r->ros.log) : result;
    result = result == RLF_OK ? io_ros_prepare(&r->ros, address) : result;
    if (result != RLF_OK) {
        return result;
    }
    const io_ros2_channel *depth = &r->found.channels[r->ros.depth.channel];
    read_rate(r, depth);
    result = check_clock(r, address, depth);
    r->ros.decoder.rounds_metres = true; /* pairs are of counts */
    const double units =
        io_ros_is_metres(r->ros.depth.pixels) ? IO_PIXELS_FLOAT_UNITS : r->ros.units_per_metre;
    if (result == RLF_OK) {
        result = io_stream_pair_init(&r->pair, &r->ros.rig, units, r->frames_per_second);
        r->pair.flags |= r->ros.flags;
    }
    if (result == RLF_OK) {
        use_streams(r);
    }
    return result;
}

static void describe(const ros2 *r, char *out, size_t size)
{
    const bool has_color = r->ros.rig.has_color;
    snprintf(out, size, "ROS 2: depth %.50s%s%.50s", r->depth.topic, has_color ? ", colour " : "",
             has_color ? r->color.topic : "");
}

static rlf_result ros2_open(const rlf_address *address, rlf_opened *out)
{
    static const rlf_source_methods methods = {
        .next = ros2_next, .destroy = ros2_destroy, .status = ros2_status};
    ros2 *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    snprintf(r->source, sizeof(r->source), "%.255s", address->source);
    rlf_result result = start(r, address);
    io_live_opened(&methods, r, r->source, &r->ros.rig, r->frames_per_second, out);
    if (result == RLF_OK) {
        describe(r, out->info.device, sizeof(out->info.device));
    }
    return io_open_end(result, r, ros2_destroy);
}

const rlf_backend io_backend_ros2 = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "ros2",
    .keys = "depth color domain profile clock",
    .summary = "any camera with a ROS 2 driver: ros2:/camera?depth=TOPIC&color=TOPIC&profile=lan",
    .is_live = true,
    .list = io_ros2_list,
    .open = ros2_open,
};
