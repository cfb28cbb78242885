/* ROS 2's messages over DDS (Eclipse Cyclone DDS): who is there, reading and writing. Messages come
 * and go as their bytes; src/io/ros says what is in them. */
#ifndef RLF_IO_ROS2_ROS2_H
#define RLF_IO_ROS2_ROS2_H

#include "io/ros/messages.h"
#include "relief/base.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define IO_ROS2_TOPIC_MAX 256 /* bytes of a topic's name with the ending zero, as DDS has it */
#define IO_ROS2_TYPE_MAX 96
/* Larger messages are not taken: a picture of 4096 x 4096 pixels of 4 bytes. */
#define IO_ROS2_MESSAGE_MAX ((size_t)64 << 20)

/* ---- which network, and how it is used ---- */

typedef enum io_ros2_profile {
    IO_ROS2_LOCAL = 0, /* lo alone: nothing leaves the machine */
    IO_ROS2_LAN = 1,   /* messages that fit an Ethernet frame; pictures are packed */
    IO_ROS2_OWN = 2    /* a file of Cyclone DDS's settings */
} io_ros2_profile;

typedef struct io_ros2_place {
    uint32_t domain; /* 0..232 */
    io_ros2_profile profile;
    char file[1024]; /* of IO_ROS2_OWN */
} io_ros2_place;

/* From the values of ?domain= and ?profile=, which may be NULL: then from ROS_DOMAIN_ID and
 * RELIEF_ROS2_PROFILE, else 0 and local. RLF_ERROR_INVALID with one line that begins with `source`.
 */
rlf_result io_ros2_place_read(const char *source, const char *domain, const char *profile,
                              io_ros2_place *out);
/* Cyclone DDS's settings of a profile; lives as long as the place. */
const char *io_ros2_place_settings(const io_ros2_place *place, char *out, size_t size);

/* ---- one participant ---- */

typedef struct io_ros2_node io_ros2_node;

/* All nodes of a process and domain share its profile: another one is RLF_ERROR_INVALID.
 * RLF_ERROR_DEVICE when the network is not to be had. Thread-safe. */
rlf_result io_ros2_node_open(const char *source, const io_ros2_place *place, io_ros2_node **out);
/* With all its readers and writers; NULL is allowed. */
void io_ros2_node_close(io_ros2_node **node);

/* A topic that somebody publishes, as discovery tells. */
typedef struct io_ros2_topic {
    char name[IO_ROS2_TOPIC_MAX]; /* "/camera/depth/image_raw" */
    char type[IO_ROS2_TYPE_MAX];  /* "sensor_msgs/msg/Image" */
    bool is_reliable;             /* every writer is */
} io_ros2_topic;

#define IO_ROS2_TOPICS_MAX 256

/* Topics of ROS that others publish now, in the order of their names; at most `capacity`. */
int32_t io_ros2_discover(io_ros2_node *node, io_ros2_topic *out, int32_t capacity);

/* ---- reading ---- */

typedef struct io_ros2_reader {
    int32_t topic, reader; /* of Cyclone DDS; 0 = none */
} io_ros2_reader;

typedef struct io_ros2_message {
    const uint8_t *data; /* with the 4 bytes that say how it is encoded */
    size_t size;
    int64_t sent_ns; /* the writer's clock, since 1970 */
    uint64_t writer; /* who */
    void *held;
} io_ros2_message;

/* `is_lasting`: also what was sent before (tf_static). At most `depth` messages wait, newest kept.
 */
rlf_result io_ros2_reader_open(io_ros2_node *node, const char *topic, const char *type,
                               bool is_reliable, bool is_lasting, int32_t depth,
                               io_ros2_reader *out);
void io_ros2_reader_close(io_ros2_reader *reader);
/* False when nothing waits. Release it. */
bool io_ros2_take(const io_ros2_reader *reader, io_ros2_message *out);
void io_ros2_release(io_ros2_message *message);
/* Until one of the node's readers has a message, at most so long. */
void io_ros2_wait(io_ros2_node *node, int32_t wait_ms);

/* ---- writing ---- */

typedef struct io_ros2_writer {
    int32_t topic, writer;
    const void *type;
} io_ros2_writer;

/* Reliable, which all readers take; `is_lasting`: who comes later gets the last message, too. */
rlf_result io_ros2_writer_open(io_ros2_node *node, const char *topic, const char *type,
                               bool is_lasting, io_ros2_writer *out);
/* Whether anybody reads it. */
bool io_ros2_writer_is_read(const io_ros2_writer *writer);
/* False when it was not sent: a reader is too slow. May wait a tenth of a second. */
bool io_ros2_write(const io_ros2_writer *writer, const void *data, size_t size);

/* ---- for the folder's own files ---- */

struct ddsi_sertype;
/* A type whose messages are bytes; the domain's once a topic is made of it. NULL: no memory. */
struct ddsi_sertype *io_ros2_raw_type(const char *dds_name);
/* A message that dds_writecdr takes. NULL: no memory, or longer than IO_ROS2_MESSAGE_MAX. */
struct ddsi_serdata *io_ros2_raw_make(const struct ddsi_sertype *type, const void *data,
                                      size_t size);
const uint8_t *io_ros2_raw_data(const struct ddsi_serdata *data, size_t *out_size);

/* "rt/camera/x" and "sensor_msgs::msg::dds_::Image_" from what ROS says, and back; false when it is
 * none of ROS, or too long. */
bool io_ros2_topic_to_dds(const char *topic, char *out, size_t size);
bool io_ros2_topic_from_dds(const char *topic, char *out, size_t size);
bool io_ros2_type_to_dds(const char *type, char *out, size_t size);
bool io_ros2_type_from_dds(const char *type, char *out, size_t size);
/* "typehash=RIHS01_...;", which newer ROS 2 looks for; NULL where it is not known. */
const char *io_ros2_type_hash(const char *type);
/* The participant, for discovery. */
int32_t io_ros2_node_participant(const io_ros2_node *node);
int32_t io_ros2_node_publications(const io_ros2_node *node);

#endif
