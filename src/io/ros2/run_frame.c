/* What of a frame is published, copied within the frame loop. */
#include "io/ros2/publish.h"

#include <string.h>

#define PLANES 6

rlf_result io_ros2_run_frame_create(const rlf_rig *rig, io_ros2_run_frame *m)
{
    memset(m, 0, sizeof(*m));
    m->bodies = rlf_alloc_array(IO_ROS2_BODIES_MAX, sizeof(m->bodies[0]));
    m->hulls = rlf_alloc_array(IO_ROS2_BODIES_MAX, sizeof(m->hulls[0]));
    m->contacts = rlf_alloc_array(IO_ROS2_CONTACTS_MAX, sizeof(m->contacts[0]));
    m->corners = rlf_alloc_array(IO_ROS2_HULL_CORNERS, sizeof(m->corners[0]));
    m->triangles = rlf_alloc_array(IO_ROS2_HULL_CORNERS, sizeof(m->triangles[0]));
    const bool is_whole = m->bodies != NULL && m->hulls != NULL && m->contacts != NULL &&
                          m->corners != NULL && m->triangles != NULL;
    return is_whole ? io_frame_copy_create(rig, &m->frame) : RLF_ERROR_MEMORY;
}

void io_ros2_run_frame_destroy(io_ros2_run_frame *m)
{
    io_frame_copy_destroy(&m->frame);
    rlf_free(m->picture.data);
    rlf_free(m->planes);
    rlf_free(m->mask);
    rlf_free(m->bodies);
    rlf_free(m->hulls);
    rlf_free(m->contacts);
    rlf_free(m->corners);
    rlf_free(m->triangles);
    memset(m, 0, sizeof(*m));
}

/* False without memory. */
static bool copy_picture(io_ros2_run_frame *m, const rlf_image_rgba8 *from)
{
    const size_t row = (size_t)from->width * 4;
    const size_t size = row * (size_t)from->height;
    if (from->data == NULL) {
        return false;
    }
    if (size > m->picture_room) {
        rlf_free(m->picture.data);
        m->picture.data = rlf_alloc(size);
        m->picture_room = m->picture.data != NULL ? size : 0;
    }
    if (m->picture.data == NULL) {
        return false;
    }
    m->picture.width = from->width;
    m->picture.height = from->height;
    m->picture.stride = (ptrdiff_t)row;
    for (int32_t y = 0; y < from->height; y++) {
        memcpy(m->picture.data + (size_t)y * row, from->data + (ptrdiff_t)y * from->stride, row);
    }
    return true;
}

static bool copy_planes(io_ros2_run_frame *m, uint32_t wanted, const rlf_surface *s)
{
    const size_t count = (size_t)s->width * (size_t)s->height;
    if (count > m->plane_room) {
        rlf_free(m->planes);
        rlf_free(m->mask);
        m->planes = rlf_alloc_array(count, PLANES * sizeof(float));
        m->mask = rlf_alloc_array(count, 1);
        m->plane_room = m->planes != NULL && m->mask != NULL ? count : 0;
    }
    if (m->plane_room == 0) {
        return false;
    }
    m->width = s->width;
    m->height = s->height;
    const float *const from[PLANES] = {s->ray_x,    s->ray_y,    s->depth,
                                       s->normal_x, s->normal_y, s->normal_z};
    for (int k = 0; k < PLANES && (wanted & IO_ROS2_CLOUD) != 0; k++) {
        memcpy(m->planes + (size_t)k * count, from[k], count * sizeof(float));
    }
    if ((wanted & IO_ROS2_MASK) != 0) {
        memcpy(m->mask, s->foreground, count);
    }
    return true;
}

/* A body may go, and its hull with it, before it is sent. */
static void copy_bodies(io_ros2_run_frame *m, const rlf_snapshot *s)
{
    int32_t corners = 0, triangles = 0;
    m->body_count = 0;
    for (int32_t i = 0; i < s->body_count && m->body_count < IO_ROS2_BODIES_MAX; i++) {
        rlf_body_state *to = &m->bodies[m->body_count];
        rlf_hull *hull = &m->hulls[m->body_count];
        *to = s->bodies[i];
        const rlf_hull *from = to->shape.hull;
        if (to->shape.type == RLF_SHAPE_HULL) {
            if (from->vertex_count > IO_ROS2_HULL_CORNERS - corners ||
                from->triangle_count > (IO_ROS2_HULL_CORNERS - triangles) / 3) {
                continue;
            }
            memcpy(m->corners + corners, from->vertices,
                   (size_t)from->vertex_count * sizeof(from->vertices[0]));
            memcpy(m->triangles + triangles, from->triangles,
                   (size_t)from->triangle_count * 3 * sizeof(from->triangles[0]));
            *hull = (rlf_hull){m->corners + corners, from->vertex_count, m->triangles + triangles,
                               from->triangle_count};
            corners += from->vertex_count;
            triangles += 3 * from->triangle_count;
            to->shape.hull = hull;
        }
        m->body_count++;
    }
}

static void copy_contacts(io_ros2_run_frame *m, const rlf_snapshot *s)
{
    m->contact_count =
        s->contact_count < IO_ROS2_CONTACTS_MAX ? s->contact_count : IO_ROS2_CONTACTS_MAX;
    if (m->contact_count > 0) {
        memcpy(m->contacts, s->contacts, (size_t)m->contact_count * sizeof(m->contacts[0]));
    }
}

void io_ros2_run_frame_fill(io_ros2_run_frame *m, const rlf_rig *rig, uint32_t wanted,
                            const rlf_pipeline_output *from)
{
    m->time_ns = from->frame.time_ns;
    m->T_world_camera = from->T_world_camera;
    m->parts = wanted;
    if ((wanted & IO_ROS2_FRAME) != 0) {
        io_frame_copy_set(&m->frame, rig, &from->frame);
    }
    if ((wanted & IO_ROS2_PICTURE) != 0 && !copy_picture(m, &from->render.image)) {
        m->parts &= ~(uint32_t)IO_ROS2_PICTURE;
    }
    const uint32_t planes = IO_ROS2_CLOUD | IO_ROS2_MASK;
    if ((wanted & planes) != 0 && !copy_planes(m, wanted, from->surface)) {
        m->parts &= ~planes;
    }
    if ((wanted & IO_ROS2_BODIES) != 0) {
        copy_bodies(m, from->snapshot);
    }
    if ((wanted & IO_ROS2_CONTACTS) != 0) {
        copy_contacts(m, from->snapshot);
    }
}
