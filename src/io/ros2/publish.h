/* What is published: a camera's topics, as camera drivers of ROS 2 have them, and what a run makes.
 */
#ifndef RLF_IO_ROS2_PUBLISH_H
#define RLF_IO_ROS2_PUBLISH_H

#include "io/clip/clip.h"
#include "io/ros/write.h"
#include "io/ros2/ros2.h"
#include "relief/pipeline.h"

/* Below the camera's name: depth/image_raw (16UC1 millimetres, or 32FC1 metres) and its
 * compressedDepth, color/image_raw (rgb8) and its compressed, camera_info beside each; /tf_static.
 * What nobody reads is not made. */
typedef struct io_ros2_camera {
    io_ros2_writer depth, depth_packed, depth_info, color, color_packed, color_info, tf_static;
    io_ros_encoder encoder;
    io_byte_buffer buffer;
    void *units; /* depth in other units: width x height of 4 bytes */
    char depth_frame[IO_ROS_NAME_MAX], color_frame[IO_ROS_NAME_MAX];
    bool is_tf_sent;
    int64_t last_color_ns;
    uint64_t messages, bytes, dropped; /* dropped: a reader was too slow */
} io_ros2_camera;

/* `name`: "/camera". `out` is zero; close it whatever comes back. */
rlf_result io_ros2_camera_open(io_ros2_node *node, const char *name, const rlf_rig *rig,
                               const rlf_recording_def *def, io_ros2_camera *out);
/* All writers are the node's, which is closed first. */
void io_ros2_camera_close(io_ros2_camera *camera);
/* A frame of that rig; offset_ns makes 1970's of its times. */
rlf_result io_ros2_camera_send(io_ros2_camera *camera, const rlf_frame *frame, int64_t offset_ns);

/* Where a camera or a run is published: "ros2:/camera?domain=1&profile=lan". */
typedef struct io_ros2_target {
    io_ros2_place place;
    char name[IO_ROS2_TOPIC_MAX]; /* "/camera" */
} io_ros2_target;

rlf_result io_ros2_target_read(const char *address, io_ros2_target *out);

/* A topic "NAME/PART" of a type. */
typedef struct io_ros2_output {
    const char *part, *type;
    io_ros2_writer *out;
} io_ros2_output;

rlf_result io_ros2_open_outputs(io_ros2_node *node, const char *name, const io_ros2_output *rows,
                                size_t count);
/* "/front/camera" is "front_camera" in names of frames. */
void io_ros2_frame_name(const char *name, const char *part, char out[IO_ROS_NAME_MAX]);

/* When the clock of frames is another than 1970's: the offset that makes a frame's time `now_ns`,
 * kept while the two clocks go alike. */
typedef struct io_ros2_clock {
    bool has_offset;
    int64_t offset_ns;
} io_ros2_clock;

int64_t io_ros2_clock_offset(io_ros2_clock *clock, int64_t time_ns, int64_t now_ns);

/* ---- One frame of a run, copied for the thread that publishes it ---- */

#define IO_ROS2_BODIES_MAX 1024
#define IO_ROS2_CONTACTS_MAX 1024
#define IO_ROS2_HULL_CORNERS 65536 /* of all bodies of a frame; hulls beyond are left out */

/* What somebody reads; the rest is not copied. */
typedef enum io_ros2_part {
    IO_ROS2_FRAME = 1,
    IO_ROS2_PICTURE = 2,
    IO_ROS2_CLOUD = 4,
    IO_ROS2_MASK = 8,
    IO_ROS2_BODIES = 16,
    IO_ROS2_CONTACTS = 32
} io_ros2_part;

typedef struct io_ros2_run_frame {
    uint32_t parts;           /* io_ros2_part */
    int64_t time_ns, host_ns; /* host_ns: of this machine's wall clock */
    rlf_pose T_world_camera;
    io_frame_copy frame;
    rlf_image_rgba8 picture;
    size_t picture_room;   /* bytes */
    int32_t width, height; /* of the planes */
    size_t plane_room;     /* pixels */
    float *planes;         /* ray_x ray_y depth normal_x normal_y normal_z, one after the other */
    uint8_t *mask;
    rlf_body_state *bodies;
    int32_t body_count;
    rlf_contact *contacts;
    int32_t contact_count;
    rlf_hull *hulls; /* of the bodies, in their order */
    rlf_vec3 *corners;
    int32_t *triangles;
} io_ros2_run_frame;

rlf_result io_ros2_run_frame_create(const rlf_rig *rig, io_ros2_run_frame *out);
/* One that was never made is allowed, when it is zero. */
void io_ros2_run_frame_destroy(io_ros2_run_frame *frame);
/* Copies what is wanted; allocates when a picture or the planes are larger than before. */
void io_ros2_run_frame_fill(io_ros2_run_frame *frame, const rlf_rig *rig, uint32_t wanted,
                            const rlf_pipeline_output *from);

#endif
