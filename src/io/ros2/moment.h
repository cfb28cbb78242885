/* One frame of a run, copied for the thread that publishes it. */
#ifndef RLF_IO_ROS2_MOMENT_H
#define RLF_IO_ROS2_MOMENT_H

#include "io/live/live.h"
#include "relief/pipeline.h"

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

typedef struct io_ros2_moment {
    uint32_t parts;           /* io_ros2_part */
    int64_t time_ns, host_ns; /* host_ns: of this machine's wall clock */
    rlf_pose T_world_camera;
    live_slot frame;
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
} io_ros2_moment;

rlf_result io_ros2_moment_create(const rlf_rig *rig, io_ros2_moment *out);
/* One that was never made is allowed, when it is zero. */
void io_ros2_moment_destroy(io_ros2_moment *moment);
/* Copies what is wanted; allocates when a picture or the planes are larger than before. */
void io_ros2_moment_fill(io_ros2_moment *moment, const rlf_rig *rig, uint32_t wanted,
                         const rlf_pipeline_output *from);

#endif
