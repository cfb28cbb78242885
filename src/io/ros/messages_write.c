/* ROS 2 messages: from values to CDR. */
#include "io/ros/messages.h"

#define NS_PER_S INT64_C(1000000000)

void io_ros_write_header(io_cdr_writer *w, const io_ros_header *header)
{
    io_cdr_put_u32(w, (uint32_t)(header->stamp_ns / NS_PER_S));
    io_cdr_put_u32(w, (uint32_t)(header->stamp_ns % NS_PER_S));
    io_cdr_put_text(w, header->frame_id);
}

size_t io_ros_begin_image(io_cdr_writer *w, const io_ros_image *image)
{
    io_ros_write_header(w, &image->header);
    io_cdr_put_u32(w, image->height);
    io_cdr_put_u32(w, image->width);
    io_cdr_put_text(w, image->encoding);
    io_cdr_put_u8(w, image->is_bigendian ? 1 : 0);
    io_cdr_put_u32(w, image->step);
    return io_cdr_begin_bytes(w);
}

size_t io_ros_begin_compressed(io_cdr_writer *w, const io_ros_image *image)
{
    io_ros_write_header(w, &image->header);
    io_cdr_put_text(w, image->encoding);
    return io_cdr_begin_bytes(w);
}

void io_ros_write_camera_info(io_cdr_writer *w, const io_ros_header *header,
                              const rlf_camera *camera)
{
    const rlf_camera *c = camera;
    const bool is_rational = c->distortion_model == RLF_DISTORTION_RATIONAL_POLYNOMIAL;
    const double k[9] = {c->fx, 0, c->cx, 0, c->fy, c->cy, 0, 0, 1};
    const double r[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double p[12] = {c->fx, 0, c->cx, 0, 0, c->fy, c->cy, 0, 0, 0, 1, 0};
    io_ros_write_header(w, header);
    io_cdr_put_u32(w, (uint32_t)c->height);
    io_cdr_put_u32(w, (uint32_t)c->width);
    io_cdr_put_text(w, is_rational ? "rational_polynomial" : "plumb_bob");
    io_cdr_put_u32(w, is_rational ? 8 : 5);
    io_cdr_put_doubles(w, c->distortion, is_rational ? 8 : 5); /* in ROS's order: k1 k2 p1 p2 k3 */
    io_cdr_put_doubles(w, k, 9);
    io_cdr_put_doubles(w, r, 9);
    io_cdr_put_doubles(w, p, 12);
    for (int i = 0; i < 6; i++) { /* binning, and a region of interest that is all of it */
        io_cdr_put_u32(w, 0);
    }
    io_cdr_put_u8(w, 0);
}

static void put_transform(io_cdr_writer *w, const io_ros_transform *t)
{
    io_ros_header header = {.stamp_ns = t->stamp_ns};
    memcpy(header.frame_id, t->parent, sizeof(header.frame_id));
    io_ros_write_header(w, &header);
    io_cdr_put_text(w, t->child);
    const rlf_pose *pose = &t->T_parent_child;
    const double numbers[7] = {pose->p.x, pose->p.y, pose->p.z, pose->q.x,
                               pose->q.y, pose->q.z, pose->q.w};
    io_cdr_put_doubles(w, numbers, 7);
}

void io_ros_write_tf(io_cdr_writer *w, const io_ros_transform *transforms, uint32_t count)
{
    io_cdr_put_u32(w, count);
    for (uint32_t i = 0; i < count; i++) {
        put_transform(w, &transforms[i]);
    }
}

void io_ros_write_pose(io_cdr_writer *w, const io_ros_header *header, const rlf_pose *pose)
{
    const double numbers[7] = {pose->p.x, pose->p.y, pose->p.z, pose->q.x,
                               pose->q.y, pose->q.z, pose->q.w};
    io_ros_write_header(w, header);
    io_cdr_put_doubles(w, numbers, 7);
}
