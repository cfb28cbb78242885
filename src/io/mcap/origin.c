/* What a recording of Relief's own says beside its pictures. */
#include "io/mcap/read.h"

#include "io/mcap/format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int32_t io_mcap_find_topic(const io_mcap_reader *reader, io_ros_type type, const char *topic)
{
    for (int32_t i = 0; i < io_mcap_channel_count(reader); i++) {
        const io_mcap_channel *c = io_mcap_channel_at(reader, i);
        if (c->type == type && strcmp(c->topic, topic) == 0 && c->count > 0) {
            return i;
        }
    }
    return -1;
}

double io_mcap_number(const io_mcap_reader *reader, const char *key, double low, double high,
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

void io_mcap_read_origin(const io_mcap_reader *reader, io_clip_origin *out)
{
    out->gravity = read_gravity(reader);
    out->is_simulated = io_mcap_number(reader, IO_KEY_SIMULATED, 0, 1, 0) > 0.0;
    out->frames_per_second = io_mcap_number(reader, IO_KEY_RATE, 0, IO_RATE_MAX, 0);
    out->has_notes = io_mcap_metadata(reader, IO_KEY_NOTES) != NULL;
}

io_frame_note *io_mcap_read_notes(io_mcap_reader *reader, io_clip_origin *origin)
{
    const int32_t index = io_mcap_find_topic(reader, IO_ROS_STRING, IO_TOPIC_FRAME);
    const io_mcap_channel *c = index >= 0 ? io_mcap_channel_at(reader, index) : NULL;
    io_frame_note *notes =
        c != NULL && origin->has_notes ? rlf_alloc_array((size_t)c->count, sizeof(notes[0])) : NULL;
    int32_t count = 0;
    for (int32_t i = 0; notes != NULL && i < c->count; i++) {
        io_cdr_reader message;
        char text[IO_FRAME_NOTE_TEXT];
        const bool is_read = io_mcap_read(reader, c->first + i, &message) == RLF_OK &&
                             io_ros_read_string(message, text, sizeof(text)) &&
                             io_frame_note_parse(text, &notes[count]);
        count += is_read ? 1 : 0;
    }
    io_frame_notes_sort(notes, count);
    origin->notes = notes;
    origin->note_count = count;
    return notes;
}
