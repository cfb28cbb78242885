/* Reading MCAP: any file, whole or cut off, with or without a summary. */
#ifndef RLF_IO_MCAP_READ_H
#define RLF_IO_MCAP_READ_H

#include "io/clip/clip.h"
#include "io/file.h"
#include "io/ros/messages.h"

#define IO_MCAP_TOPIC_MAX 256
#define IO_MCAP_CHANNELS_READ_MAX 512 /* of the types looked for */
/* No chunk larger than this is read: it is what bounds the memory. */
#define IO_MCAP_CHUNK_MAX ((uint64_t)256 << 20)
/* No more messages than this are listed: three days of a camera's pictures. */
#define IO_MCAP_MESSAGES_MAX (1 << 24)

/* A stream of messages of a type that is looked for. */
typedef struct io_mcap_channel {
    uint16_t id;
    io_ros_type type;
    char topic[IO_MCAP_TOPIC_MAX];
    int32_t first, count; /* of its messages, in order of log time */
} io_mcap_channel;

typedef struct io_mcap_message {
    int64_t time_ns; /* log time */
    uint64_t offset; /* of the record, in the chunk or in the file */
    int32_t chunk;   /* -1 = in none */
    int32_t channel;
} io_mcap_message;

typedef struct io_mcap_reader io_mcap_reader;

/* Opens and lists what is there. A file that was not closed, or whose summary is damaged, is
 * scanned, with a warning. */
rlf_result io_mcap_reader_open(const char *path, io_mcap_reader **out);
void io_mcap_reader_close(io_mcap_reader **reader);

int32_t io_mcap_channel_count(const io_mcap_reader *reader);
const io_mcap_channel *io_mcap_channel_at(const io_mcap_reader *reader, int32_t index);
const io_mcap_message *io_mcap_message_at(const io_mcap_reader *reader, int32_t index);
/* Content of a message, valid until the next call. RLF_ERROR_FORMAT when its chunk is damaged. */
rlf_result io_mcap_read(io_mcap_reader *reader, int32_t index, io_cdr_reader *out);
/* Topics of pictures in messages that are not read, as text; "" = none. */
const char *io_mcap_strangers(const io_mcap_reader *reader);
/* Value of a key of the Metadata record "relief", or NULL. */
const char *io_mcap_metadata(const io_mcap_reader *reader, const char *key);

/* ---- What a recording of Relief's own says beside its pictures ---- */

/* The channel of that type and topic that has messages; -1 = none. */
int32_t io_mcap_find_topic(const io_mcap_reader *reader, io_ros_type type, const char *topic);
/* What ROS has no message for, from the metadata; nonsense changes nothing. */
double io_mcap_number(const io_mcap_reader *reader, const char *key, double low, double high,
                      double otherwise);
/* What its source said beside the calibration; without the notes. */
void io_mcap_read_origin(const io_mcap_reader *reader, io_clip_origin *out);
/* The notes of its frames, in a new array that *origin borrows; NULL when there are none. */
io_frame_note *io_mcap_read_notes(io_mcap_reader *reader, io_clip_origin *origin);

#endif
