/* What MCAP files consist of: https://mcap.dev/spec (version 0). */
#ifndef RLF_IO_MCAP_FORMAT_H
#define RLF_IO_MCAP_FORMAT_H

#include "io/little.h"
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

#endif
