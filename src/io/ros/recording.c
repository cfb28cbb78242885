/* A ROS recording as a source: its two streams in the order in which the camera took them. */
#include "io/ros/recording.h"
#include "io/clip/clip.h"
#include "io/file.h"
#include "io/picture/pixels.h"

#include <stdlib.h>
#include <string.h>

/* ---- pictures ------------------------------------------------------------------------------- */

static rlf_result read_depth(void *self, int32_t index, void *out)
{
    io_ros_recording *r = self;
    const io_ros_stream *s = &r->depth;
    io_ros_image image;
    rlf_result result =
        io_ros_read_picture(&r->log, s, (int32_t)s->shots.items[index].position, &image);
    return result == RLF_OK ? io_ros_decode_depth(&r->decoder, &image, s->pixels,
                                                  r->rig.depth.width, r->rig.depth.height, out)
                            : result;
}

static rlf_result read_color(void *self, int32_t index, const rlf_image_rgba8 *out)
{
    io_ros_recording *r = self;
    const io_ros_stream *s = &r->color;
    io_ros_image image;
    rlf_result result =
        io_ros_read_picture(&r->log, s, (int32_t)s->shots.items[index].position, &image);
    return result == RLF_OK ? io_ros_decode_color(&r->decoder, &image, s->pixels, out) : result;
}

void io_ros_recording_free(io_ros_recording *r)
{
    rlf_free(r->streams);
    rlf_free(r->pictures);
    rlf_free(r->infos);
    rlf_free(r->transforms);
    io_shots_free(&r->depth.shots);
    io_shots_free(&r->color.shots);
    rlf_free(r->decoder.counts);
    io_ros_log_free(&r->log);
}

/* ---- opening -------------------------------------------------------------------------------- */

rlf_result io_ros_prepare(io_ros_recording *r, const rlf_address *address)
{
    rlf_result result = io_ros_list_topics(r);
    int32_t depth = -1, color = -1;
    if (result == RLF_OK) {
        result = io_ros_choose(&r->lists, rlf_address_get(address, "depth"),
                               rlf_address_get(address, "color"), &depth, &color);
    }
    if (result != RLF_OK) {
        return result;
    }
    r->depth = r->streams[depth];
    r->depth.picture = depth;
    r->color = color >= 0 ? r->streams[color] : (io_ros_stream){.channel = -1};
    r->color.picture = color;
    io_rvl_init(&r->decoder.rvl);
    r->decoder.name = r->log.name;
    r->decoder.rounds_metres = r->log.is_ros1;
    return io_ros_read_rig(r, address);
}

/* ---- times ---------------------------------------------------------------------------------- */

static rlf_result list_shots(const io_ros_log *log, io_ros_stream *s)
{
    const int32_t count = s->channel >= 0 ? log->channels[s->channel].count : 0;
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        const io_shot shot = {io_ros_log_at(log, s->channel, i)->time_ns, i, 0};
        result = io_shots_add(&s->shots, log->name, shot);
    }
    return result;
}

/* False when the message has no time of its own. */
static bool use_stamp(const io_ros_log *log, io_ros_stream *s, int32_t index)
{
    io_cdr_reader message;
    int64_t stamp_ns = 0;
    const bool is_good = io_ros_log_read(log, s->channel, index, &message) == RLF_OK &&
                         io_ros_read_stamp(message, &stamp_ns) && stamp_ns > 0;
    s->shots.items[index].time_ns = is_good ? stamp_ns : s->shots.items[index].time_ns;
    return is_good;
}

/* Times in the log are those of the messages' arrival; pictures belong together by when they were
 * taken. Both streams in step, so that each chunk is read once. ROS 1 lets the clocks of log and
 * camera differ: there all pictures have stamps, or none does. */
static void use_stamps(io_ros_recording *r)
{
    io_ros_stream *const streams[2] = {&r->depth, &r->color};
    int32_t at[2] = {0, 0};
    bool is_good = true;
    for (;;) {
        int64_t arrival_ns[2];
        for (int k = 0; k < 2; k++) {
            const io_ros_stream *s = streams[k];
            arrival_ns[k] = at[k] < s->shots.count ? s->shots.items[at[k]].time_ns : INT64_MAX;
        }
        const bool is_color = at[0] == r->depth.shots.count || arrival_ns[1] < arrival_ns[0];
        if (at[is_color] == streams[is_color]->shots.count || (!is_good && r->log.is_ros1)) {
            break;
        }
        is_good = use_stamp(&r->log, streams[is_color], at[is_color]++) && is_good;
    }
    for (int k = 0; k < 2 && r->log.is_ros1 && !is_good; k++) {
        for (int32_t i = 0; i < at[k]; i++) {
            streams[k]->shots.items[i].time_ns =
                io_ros_log_at(&r->log, streams[k]->channel, i)->time_ns;
        }
    }
}

rlf_result io_ros_list_pictures(io_ros_recording *r, bool has_stamps)
{
    r->color.channel = r->rig.has_color ? r->color.channel : -1;
    rlf_result result = list_shots(&r->log, &r->depth);
    result = result == RLF_OK ? list_shots(&r->log, &r->color) : result;
    if (result == RLF_OK && has_stamps) {
        use_stamps(r);
        (void)io_shots_sort(&r->depth.shots);
        (void)io_shots_sort(&r->color.shots);
    }
    return result;
}

/* ---- the clip ------------------------------------------------------------------------------- */

static rlf_result read_gap(const rlf_address *address, int64_t *out_ns)
{
    const char *text = rlf_address_get(address, "gap");
    double ms = 0.0;
    if (text == NULL) {
        return RLF_OK;
    }
    if (!io_number_parse(text, &ms) || !(ms > 0.0 && ms <= 10000.0)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: gap=%.40s: give milliseconds, more than 0 and at most 10000",
                        address->source, text);
    }
    *out_ns = (int64_t)(ms * 1e6);
    return RLF_OK;
}

/* A recording whose colour is never near its depth would show none, and not say why. */
static void warn_unpaired(const io_clip_def *def)
{
    int64_t nearest = INT64_MAX;
    for (int32_t i = 0; i < def->depth.count; i++) {
        const int64_t time_ns = io_time_at(&def->depth, i);
        const int32_t at = io_time_nearest(&def->color, time_ns, INT64_MAX - 1);
        const int64_t gap = at >= 0 ? llabs(io_time_at(&def->color, at) - time_ns) : nearest;
        nearest = gap < nearest ? gap : nearest;
    }
    if (def->color.count > 0 && nearest > def->color_gap_max_ns) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the colour pictures are %lld ms or more away from the depth, so none is "
                "shown: ?gap=MS allows more",
                def->name, (long long)(nearest / 1000000));
    }
}

rlf_result io_ros_open_clip(io_ros_recording *r, const rlf_address *address, io_clip_def *def,
                            rlf_opened *out)
{
    int64_t gap_ns = IO_COLOR_GAP_MAX_NS;
    rlf_result result = read_gap(address, &gap_ns);
    const bool is_metres = io_ros_is_metres(r->depth.pixels);
    if (result == RLF_OK && is_metres && !r->decoder.rounds_metres) {
        r->decoder.counts = rlf_alloc_array(
            (size_t)r->rig.depth.width * (size_t)r->rig.depth.height, sizeof(uint16_t));
        result = r->decoder.counts != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    if (result != RLF_OK) {
        return result;
    }
    def->name = r->log.name;
    def->rig = r->rig;
    def->units_per_metre = !is_metres                 ? r->units_per_metre
                           : r->decoder.rounds_metres ? IO_PIXELS_FLOAT_UNITS
                                                      : 0.0;
    def->depth = io_shots_times(&r->depth.shots);
    def->color = io_shots_times(&r->color.shots);
    def->color_gap_max_ns = gap_ns;
    def->flags = r->flags;
    def->read_depth = read_depth;
    def->read_color = read_color;
    if (!def->origin.has_notes) {
        warn_unpaired(def);
    }
    return io_clip_open(def, out);
}
