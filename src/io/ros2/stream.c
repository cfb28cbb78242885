/* Messages of one topic, of one publisher. */
#include "io/ros2/stream.h"

#include <stdio.h>

/* A publisher that was silent so long may be dead: the next one's messages are taken. Cameras make
 * five pictures a second or more. */
#define SILENT_NS INT64_C(300000000)

/* Once. */
static void tell(io_ros2_stream *s, const char *line)
{
    if (!s->is_told) {
        s->is_told = true;
        rlf_log(RLF_LOG_WARNING, "%s: a message of %s is refused: %s", s->source, s->topic, line);
    }
}

void io_ros2_stream_refuse(io_ros2_stream *s, const char *line)
{
    ++*s->damaged;
    tell(s, line);
}

/* Two on one topic would give two rooms in turn. Of one that was killed and started again the first
 * is silent: nothing is told of it. */
static bool is_of_publisher(io_ros2_stream *s, const io_ros2_message *m)
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

static bool read_image(io_ros2_stream *s, const io_ros2_message *m, io_ros_image *out)
{
    const io_cdr_reader reader = io_cdr_open(m->data, m->size);
    const bool is_read =
        s->is_compressed ? io_ros_read_compressed(reader, out) : io_ros_read_image(reader, out);
    if (!is_read) {
        io_ros2_stream_refuse(s, "it is cut short, or no picture");
        return false;
    }
    if (io_ros_pixels_of(out, s->is_compressed) != s->pixels) {
        char line[128];
        snprintf(line, sizeof(line), "its encoding is now \"%.40s\": start again", out->encoding);
        io_ros2_stream_refuse(s, line);
        return false;
    }
    return true;
}

bool io_ros2_stream_take(io_ros2_stream *s, io_ros2_message *held, io_ros_image *out)
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
