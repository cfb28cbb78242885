/* Writes small ROS 1 bags. Include after cmocka.h. */
#ifndef RLF_TEST_BAG_FILE_H
#define RLF_TEST_BAG_FILE_H

#include "byte_file.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct bag_file {
    byte_file file, chunk;
    uint32_t places[64][4]; /* connection, seconds, nanoseconds, offset of the chunk's messages */
    int32_t place_count;
    byte_file connections; /* their records again, for the end of the file */
} bag_file;

static inline void bag_field(byte_file *header, const char *name, const void *value, size_t size)
{
    bytes_u32(header, (uint32_t)(strlen(name) + 1 + size));
    bytes_put(header, name, strlen(name));
    bytes_u8(header, '=');
    bytes_put(header, value, size);
}

static inline void bag_op(byte_file *header, uint8_t op)
{
    header->size = 0;
    bag_field(header, "op", &op, 1);
}

static inline void bag_record_put(byte_file *to, const byte_file *header, const void *data,
                                  size_t size)
{
    bytes_block(to, header->data, header->size);
    bytes_block(to, data, size);
}

static inline bag_file *bag_file_new(void)
{
    bag_file *b = calloc(1, sizeof(*b));
    byte_file *header = calloc(1, sizeof(*header));
    const char magic[] = "#ROSBAG V2.0\n";
    bytes_put(&b->file, magic, sizeof(magic) - 1);
    bag_op(header, 3);
    const uint64_t position = 0;
    bag_field(header, "index_pos", &position, 8);
    bag_record_put(&b->file, header, "   ", 3);
    free(header);
    return b;
}

static inline void bag_file_connect(bag_file *b, uint32_t id, const char *topic, const char *type)
{
    byte_file *header = calloc(1, sizeof(*header));
    byte_file *data = calloc(1, sizeof(*data));
    bag_op(header, 7);
    bag_field(header, "conn", &id, 4);
    bag_field(header, "topic", topic, strlen(topic));
    bag_field(data, "topic", topic, strlen(topic));
    bag_field(data, "type", type, strlen(type));
    bag_record_put(&b->chunk, header, data->data, data->size);
    bag_record_put(&b->connections, header, data->data, data->size);
    free(header);
    free(data);
}

static inline void bag_file_message(bag_file *b, uint32_t id, double seconds,
                                    const byte_file *message)
{
    byte_file *header = calloc(1, sizeof(*header));
    const uint32_t time[2] = {(uint32_t)seconds,
                              (uint32_t)((seconds - (double)(uint32_t)seconds) * 1e9 + 0.5)};
    const uint32_t place[4] = {id, time[0], time[1], (uint32_t)b->chunk.size};
    memcpy(b->places[b->place_count++], place, sizeof(place));
    bag_op(header, 2);
    bag_field(header, "conn", &id, 4);
    bag_field(header, "time", time, 8);
    bag_record_put(&b->chunk, header, message->data, message->size);
    free(header);
}

/* Ends the chunk: `packed` in place of its bytes, unless NULL. */
static inline void bag_file_flush(bag_file *b, const char *compression, const byte_file *packed,
                                  bool has_index)
{
    byte_file *header = calloc(1, sizeof(*header));
    const uint32_t size = (uint32_t)b->chunk.size;
    bag_op(header, 5);
    bag_field(header, "compression", compression, strlen(compression));
    bag_field(header, "size", &size, 4);
    const byte_file *data = packed != NULL ? packed : &b->chunk;
    bag_record_put(&b->file, header, data->data, data->size);
    for (int32_t i = 0; i < b->place_count && has_index; i++) {
        const uint32_t one = 1;
        bag_op(header, 4);
        bag_field(header, "ver", &one, 4);
        bag_field(header, "conn", &b->places[i][0], 4);
        bag_field(header, "count", &one, 4);
        bag_record_put(&b->file, header, &b->places[i][1], 12);
    }
    b->chunk.size = 0;
    b->place_count = 0;
    free(header);
}

/* What a recorder that is closed in order adds. */
static inline void bag_file_finish(bag_file *b)
{
    bytes_put(&b->file, b->connections.data, b->connections.size);
}

/* ---- messages ------------------------------------------------------------------------------- */

static inline void bag_header(byte_file *m, double stamp, const char *frame)
{
    m->size = 0;
    bytes_u32(m, 0);
    bytes_u32(m, (uint32_t)stamp);
    bytes_u32(m, (uint32_t)((stamp - (double)(uint32_t)stamp) * 1e9 + 0.5));
    bytes_text(m, frame);
}

static inline void bag_image(byte_file *m, const char *encoding, const uint32_t size[2],
                             const void *data, size_t bytes)
{
    bytes_u32(m, size[1]);
    bytes_u32(m, size[0]);
    bytes_text(m, encoding);
    bytes_u8(m, 0);
    bytes_u32(m, (uint32_t)(bytes / size[1]));
    bytes_block(m, data, bytes);
}

static inline void bag_camera_info(byte_file *m, const uint32_t size[2], const char *model,
                                   const double *d, uint32_t d_count, const double f[4])
{
    const double k[9] = {f[0], 0, f[2], 0, f[1], f[3], 0, 0, 1};
    bytes_u32(m, size[1]);
    bytes_u32(m, size[0]);
    bytes_text(m, model);
    bytes_u32(m, d_count);
    bytes_put(m, d, d_count * sizeof(double));
    bytes_put(m, k, sizeof(k));
    for (int i = 0; i < 9 + 12; i++) {
        bytes_f64(m, 0.0);
    }
    for (int i = 0; i < 6; i++) {
        bytes_u32(m, 0);
    }
    bytes_u8(m, 0);
}

/* Translation and unit quaternion x y z w. */
static inline void bag_transform(byte_file *m, const double t[3], const double q[4])
{
    bytes_put(m, t, 3 * sizeof(double));
    bytes_put(m, q, 4 * sizeof(double));
}

#endif
