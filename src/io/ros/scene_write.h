/* What Relief makes of a frame as ROS 2 messages, as rviz2 shows them. */
#ifndef RLF_IO_ROS_SCENE_WRITE_H
#define RLF_IO_ROS_SCENE_WRITE_H

#include "io/ros/messages.h"
#include "relief/snapshot.h"

#define IO_ROS_CLOUD_TYPE "sensor_msgs/msg/PointCloud2"
#define IO_ROS_MARKERS_TYPE "visualization_msgs/msg/MarkerArray"
#define IO_ROS_CLOUD_STEP 24 /* bytes of a point: x y z and its normal, floats */

/* Each appends one message. */

/* Planes of width x height, row by row. Rays times depth are the points; 0 is a missing one, and
 * becomes NaN. */
typedef struct io_ros_cloud {
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const float *normal_x, *normal_y, *normal_z; /* 0 = not known: NaN */
} io_ros_cloud;

/* PointCloud2, as many rows and columns as the planes. */
void io_ros_write_cloud(io_cdr_writer *w, const io_ros_header *header, const io_ros_cloud *cloud);
/* Image: mono8, 255 where the mask is not 0. */
void io_ros_write_mask(io_cdr_writer *w, const io_ros_header *header, const uint8_t *mask,
                       int32_t width, int32_t height);
/* MarkerArray: every body by its shape; those of the message before are taken away. A hull is drawn
 * by its triangles, which its body borrows. */
void io_ros_write_bodies(io_cdr_writer *w, const io_ros_header *header,
                         const rlf_body_state *bodies, int32_t count);
/* MarkerArray: a dot where something touches, and a line along the push: 10 cm are 1 N s. */
void io_ros_write_contacts(io_cdr_writer *w, const io_ros_header *header,
                           const rlf_contact *contacts, int32_t count);

#endif
