/* MCAP files (https://mcap.dev/spec, version 0): what they consist of, reading and writing them. */
#ifndef RLF_IO_MCAP_MCAP_H
#define RLF_IO_MCAP_MCAP_H

#include "io/file.h"
#include "io/little.h"
#include "io/picture/picture.h"
#include "io/ros/log.h"

#define IO_MCAP_MAGIC_SIZE 8
extern const uint8_t io_mcap_magic[IO_MCAP_MAGIC_SIZE];

typedef enum io_mcap_op {
    IO_MCAP_HEADER = 0x01,
    IO_MCAP_FOOTER = 0x02,
    IO_MCAP_SCHEMA = 0x03,
    IO_MCAP_CHANNEL = 0x04,
    IO_MCAP_MESSAGE = 0x05,
    IO_MCAP_CHUNK = 0x06,
    IO_MCAP_MESSAGE_INDEX = 0x07,
    IO_MCAP_CHUNK_INDEX = 0x08,
    IO_MCAP_STATISTICS = 0x0B,
    IO_MCAP_METADATA = 0x0C,
    IO_MCAP_METADATA_INDEX = 0x0D,
    IO_MCAP_SUMMARY_OFFSET = 0x0E,
    IO_MCAP_DATA_END = 0x0F
} io_mcap_op;

#define IO_MCAP_RECORD_HEAD 9   /* opcode and length */
#define IO_MCAP_MESSAGE_HEAD 22 /* channel, sequence and two times */
#define IO_MCAP_FOOTER_SIZE (IO_MCAP_RECORD_HEAD + 20)

/* One record: its opcode, and what it holds; 0 at the end, or when the rest is none. */
static inline uint8_t io_mcap_take_record(cursor *c, cursor *out)
{
    const uint8_t op = cursor_u8(c);
    const uint64_t size = cursor_u64(c);
    if (c->is_short || size > c->left) {
        c->is_short = true;
        c->left = 0;
        *out = (cursor){.is_short = true};
        return 0;
    }
    *out = (cursor){cursor_take(c, (size_t)size), (size_t)size, false};
    return op;
}

/* As the file format calls it: "zstd", "lz4" or "". */
const char *io_mcap_packing_name(io_packing packing);

/* ---- Names in Relief's own recordings ---- */

#define IO_TOPIC_DEPTH_RVL "/relief/depth/image_raw/compressedDepth"
#define IO_TOPIC_DEPTH_RAW "/relief/depth/image_raw"
#define IO_TOPIC_DEPTH_INFO "/relief/depth/camera_info"
#define IO_TOPIC_COLOR "/relief/color/image_raw/compressed"
#define IO_TOPIC_COLOR_INFO "/relief/color/camera_info"
#define IO_TOPIC_POSE "/relief/pose"

#define IO_TOPIC_FRAME "/relief/frame"

#define IO_FRAME_DEPTH "relief_depth_optical_frame"
#define IO_FRAME_COLOR "relief_color_optical_frame"
#define IO_FRAME_WORLD "relief_world"

/* Keys of the Metadata record "relief": what ROS 2 has no message for. */
#define IO_KEY_UNITS "units_per_metre"
#define IO_KEY_DEPTH_MIN "depth_min_m"
#define IO_KEY_DEPTH_MAX "depth_max_m"
#define IO_KEY_NOISE_0 "noise_c0"
#define IO_KEY_NOISE_1 "noise_c1"
#define IO_KEY_NOISE_2 "noise_c2"
#define IO_KEY_FLAGS "frame_flags"
#define IO_KEY_SOURCE "source"
#define IO_KEY_DEVICE "device"
#define IO_KEY_GRAVITY "gravity_m_s2" /* "X Y Z" */
#define IO_KEY_SIMULATED "is_simulated"
#define IO_KEY_RATE "frames_per_second"
#define IO_KEY_NOTES "frame_notes" /* there are: what is not noted of a frame is as usual */
#define IO_KEY_UNIX_OFFSET "unix_minus_stamp_ns"

/* ==== Reading: any file, whole or cut off, with or without a summary ==== */

typedef struct io_mcap_reader io_mcap_reader;

/* Opens, and lists what is there in the log, whose name is set. A file that was not closed, or is
 * damaged, is listed as far as it is whole, with a warning. */
rlf_result io_mcap_reader_open(const char *path, io_ros_log *log, io_mcap_reader **out);
void io_mcap_reader_close(io_mcap_reader **reader);

/* Value of a key of the Metadata record "relief", or NULL. */
const char *io_mcap_metadata(const io_mcap_reader *reader, const char *key);

/* ---- What the parts of the reader share ---- */

typedef struct io_mcap_schema {
    uint16_t id;
    io_ros_type type;
    char name[64]; /* of type IO_ROS_OTHER: of pictures that are not read */
} io_mcap_schema;

typedef struct io_mcap_chunk {
    uint64_t offset;                 /* of the record */
    uint64_t index_begin, index_end; /* the index records behind it; the same = none */
    bool is_bad;                     /* and was told */
} io_mcap_chunk;

#define IO_MCAP_METADATA_MAX 8192

struct io_mcap_reader {
    io_file file;
    io_ros_log *log;
    io_mcap_schema *schemas;
    io_mcap_chunk *chunks;
    int32_t schema_count, schema_room, chunk_count, chunk_room, bad_chunks;
    io_ros_cache cache;
    io_buffer packed; /* a chunk before it is decompressed, a record of the file */
    io_buffer loose;  /* a message outside chunks */
    io_buffer plain;  /* a message that was compressed by itself */
    char metadata[IO_MCAP_METADATA_MAX]; /* key, 0, value, 0, ..., 0 */
};

/* Bytes of the file; false when they are not all there. */
bool io_mcap_read_at(const io_mcap_reader *reader, uint64_t offset, void *out, size_t size);
/* The same into a buffer of the reader. */
rlf_result io_mcap_read_block(const io_mcap_reader *reader, uint64_t offset, uint64_t size,
                              io_buffer *buffer);

/* Chunk `index` decompressed and checked; false when it is damaged, which is told once for all. */
bool io_mcap_load_chunk(io_mcap_reader *reader, int32_t index, cursor *out);

/* A log's `read`. RLF_ERROR_FORMAT when its chunk is damaged. */
rlf_result io_mcap_message(void *reader, const io_ros_message *message, io_cdr_reader *out);

/* ==== Writing: messages gather in a chunk; a chunk is written whole, with its indexes, and reaches
 * the disk before the next one begins. What is on the disk is readable at any moment ==== */

#define IO_MCAP_CHANNELS_MAX 16 /* and schemas */

typedef struct io_mcap_writer io_mcap_writer;

/* A pair of a Metadata record. */
typedef struct io_mcap_pair {
    const char *key;
    const char *value;
} io_mcap_pair;

typedef struct io_mcap_written {
    uint64_t bytes, messages, chunks;
    uint64_t of_channel[IO_MCAP_CHANNELS_MAX]; /* messages; that of id 1 first */
} io_mcap_written;

/* Makes the file, or replaces what is there. */
rlf_result io_mcap_writer_create(const char *path, io_packing packing, io_mcap_writer **out);

/* Before the first message. Ids count from 1; a channel has the schema added last. */
void io_mcap_add_schema(io_mcap_writer *writer, const char *name, const char *text);
uint16_t io_mcap_add_channel(io_mcap_writer *writer, const char *topic, const char *qos);
void io_mcap_add_metadata(io_mcap_writer *writer, const char *name, const io_mcap_pair *pairs,
                          size_t count);

/* Begins a message; its content is to be appended to the buffer that this returns. */
io_byte_buffer *io_mcap_begin(io_mcap_writer *writer, uint16_t channel, int64_t time_ns);
/* Ends the message; false given: takes it back. */
void io_mcap_end(io_mcap_writer *writer, bool is_good);
/* Bytes of the chunk that is being gathered. */
size_t io_mcap_gathered(const io_mcap_writer *writer);
/* Writes the chunk and waits until the disk has it, unless that was done just before. */
rlf_result io_mcap_flush(io_mcap_writer *writer);

/* Writes what is gathered, and the summary. When the disk is full what was written before is kept
 * and made a whole file; the error says so. The pointer is nulled even then. */
rlf_result io_mcap_writer_close(io_mcap_writer **writer, io_mcap_written *out);

/* Appends the packed bytes. */
rlf_result io_mcap_compress(io_packing packing, const uint8_t *data, size_t size,
                            io_byte_buffer *out);

/* ---- What the parts of the MCAP writer share ---- */

/* What the index says about a chunk, and how the file stood behind it. */
typedef struct chunk_entry {
    uint64_t begin, length, index_length;
    int64_t first_ns, last_ns;
    uint64_t compressed, plain;
    uint64_t index_at[IO_MCAP_CHANNELS_MAX]; /* 0 = none */
    uint32_t messages[IO_MCAP_CHANNELS_MAX];
    uint32_t crc; /* of the file up to its end */
} chunk_entry;

struct io_mcap_writer {
    char path[IO_PATH_MAX];
    int file;
    uint64_t size; /* of what is whole on the disk */
    uint32_t crc;
    int write_errno; /* of the first write that failed; 0 = none */
    io_packing packing;
    io_byte_buffer head; /* schemas, channels, metadata, until the first chunk takes them */
    io_byte_buffer schemas, channels, metadata;
    uint16_t schema_count, channel_count;
    uint32_t metadata_count;
    io_byte_buffer chunk;                       /* the records gathered */
    io_byte_buffer index[IO_MCAP_CHANNELS_MAX]; /* their times and places */
    uint32_t sequence[IO_MCAP_CHANNELS_MAX];
    int64_t first_ns, last_ns; /* of them */
    size_t message_at;         /* where the message being written begins */
    uint16_t message_channel;
    int64_t message_ns;
    int64_t synced_ns; /* when the disk was last waited for */
    io_byte_buffer out;
    io_byte_buffer entries; /* chunk_entry */
};

size_t io_mcap_begin_record(io_byte_buffer *buffer, io_mcap_op op);
void io_mcap_end_record(io_byte_buffer *buffer, size_t begin);
void io_mcap_set_u64(io_byte_buffer *buffer, size_t at, uint64_t value);
void io_mcap_put_text(io_byte_buffer *buffer, const char *text);

/* All of it, or nothing: a half is cut off again, and write_errno set. */
bool io_mcap_append(io_mcap_writer *writer, const io_byte_buffer *bytes);
/* The error line for write_errno. */
rlf_result io_mcap_fail_write(const io_mcap_writer *writer);
/* Closes the file. */
void io_mcap_free_writer(io_mcap_writer *writer);

#endif
