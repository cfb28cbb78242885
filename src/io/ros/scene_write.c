/* Point clouds, masks and markers. */
#include "io/ros/write.h"

#include "io/little.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- planes --------------------------------------------------------------------------------- */

static void put_field(io_cdr_writer *w, const char *name, uint32_t offset)
{
    io_cdr_put_text(w, name);
    io_cdr_put_u32(w, offset);
    io_cdr_put_u8(w, 7); /* FLOAT32 */
    io_cdr_put_u32(w, 1);
}

static void fill_points(const io_ros_cloud *c, float *out)
{
    const int32_t count = c->width * c->height;
    for (int32_t i = 0; i < count; i++) {
        const float z = c->depth[i];
        const bool has_normal = c->normal_x[i] != 0 || c->normal_y[i] != 0 || c->normal_z[i] != 0;
        float *p = out + (ptrdiff_t)6 * i;
        p[0] = z > 0 ? c->ray_x[i] * z : NAN;
        p[1] = z > 0 ? c->ray_y[i] * z : NAN;
        p[2] = z > 0 ? z : NAN;
        p[3] = has_normal ? c->normal_x[i] : NAN;
        p[4] = has_normal ? c->normal_y[i] : NAN;
        p[5] = has_normal ? c->normal_z[i] : NAN;
    }
    io_little(out, (size_t)count * 6, sizeof(out[0]));
}

void io_ros_write_cloud(io_cdr_writer *w, const io_ros_header *header, const io_ros_cloud *c)
{
    static const char *const names[] = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};
    const size_t size = (size_t)c->width * (size_t)c->height * IO_ROS_CLOUD_STEP;
    io_ros_write_header(w, header);
    io_cdr_put_u32(w, (uint32_t)c->height);
    io_cdr_put_u32(w, (uint32_t)c->width);
    io_cdr_put_u32(w, 6);
    for (uint32_t i = 0; i < 6; i++) {
        put_field(w, names[i], 4 * i);
    }
    io_cdr_put_u8(w, 0);
    io_cdr_put_u32(w, IO_ROS_CLOUD_STEP);
    io_cdr_put_u32(w, (uint32_t)c->width * IO_ROS_CLOUD_STEP);
    const size_t begin = io_cdr_begin_bytes(w);
    /* Its place in the buffer is a multiple of 4 behind the head of 4. */
    float *out = (float *)(void *)io_byte_buffer_reserve(w->buffer, size);
    if (out != NULL) {
        fill_points(c, out);
        io_byte_buffer_grow(w->buffer, size);
    }
    io_cdr_end_bytes(w, begin);
    io_cdr_put_u8(w, 0); /* not dense: some are NaN */
}

void io_ros_write_mask(io_cdr_writer *w, const io_ros_header *header, const uint8_t *mask,
                       int32_t width, int32_t height)
{
    const size_t count = (size_t)width * (size_t)height;
    const io_ros_image image = {.header = *header,
                                .width = (uint32_t)width,
                                .height = (uint32_t)height,
                                .step = (uint32_t)width,
                                .encoding = "mono8"};
    const size_t begin = io_ros_begin_image(w, &image);
    uint8_t *out = io_byte_buffer_reserve(w->buffer, count);
    for (size_t i = 0; out != NULL && i < count; i++) {
        out[i] = mask[i] != 0 ? 255 : 0;
    }
    if (out != NULL) {
        io_byte_buffer_grow(w->buffer, count);
    }
    io_cdr_end_bytes(w, begin);
}

/* ---- markers -------------------------------------------------------------------------------- */

/* visualization_msgs/Marker */
typedef enum marker_type {
    MARKER_CUBE = 1,
    MARKER_SPHERE = 2,
    MARKER_CYLINDER = 3,
    MARKER_LINE_LIST = 5,
    MARKER_SPHERE_LIST = 7,
    MARKER_TRIANGLE_LIST = 11
} marker_type;

typedef struct marker {
    const char *name; /* namespace */
    int32_t id;
    marker_type type;
    bool deletes_all;
    rlf_pose pose;
    rlf_vec3 scale;
    float color[4];
} marker;

static void put_float(io_cdr_writer *w, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof(bits));
    io_cdr_put_u32(w, bits);
}

static void put_vec3(io_cdr_writer *w, rlf_vec3 v)
{
    const double numbers[3] = {v.x, v.y, v.z};
    io_cdr_put_doubles(w, numbers, 3);
}

/* Up to its points; their number follows, the points, and put_tail. */
static void put_head(io_cdr_writer *w, const io_ros_header *header, const marker *m)
{
    const double q[4] = {m->pose.q.x, m->pose.q.y, m->pose.q.z, m->pose.q.w};
    io_ros_write_header(w, header);
    io_cdr_put_text(w, m->name);
    io_cdr_put_u32(w, (uint32_t)m->id);
    io_cdr_put_u32(w, (uint32_t)m->type);
    io_cdr_put_u32(w, m->deletes_all ? 3 : 0);
    put_vec3(w, m->pose.p);
    io_cdr_put_doubles(w, q, 4);
    put_vec3(w, m->scale);
    for (int i = 0; i < 4; i++) {
        put_float(w, m->color[i]);
    }
    io_cdr_put_u32(w, 0); /* lifetime: for ever */
    io_cdr_put_u32(w, 0);
    io_cdr_put_u8(w, 0);
}

/* No colours of points, no texture with its picture and places, no text and no mesh. */
static void put_tail(io_cdr_writer *w)
{
    const io_ros_header none = {0};
    io_cdr_put_u32(w, 0);
    io_cdr_put_text(w, "");
    io_ros_write_header(w, &none);
    io_cdr_put_text(w, "");
    io_cdr_put_u32(w, 0);
    io_cdr_put_u32(w, 0);
    io_cdr_put_text(w, "");
    io_cdr_put_text(w, "");
    io_cdr_put_text(w, "");
    io_cdr_put_u32(w, 0);
    io_cdr_put_u8(w, 0);
}

static void put_marker(io_cdr_writer *w, const io_ros_header *header, const marker *m)
{
    put_head(w, header, m);
    io_cdr_put_u32(w, 0);
    put_tail(w);
}

static void put_delete_all(io_cdr_writer *w, const io_ros_header *header, const char *name)
{
    const marker m = {
        .name = name, .type = MARKER_CUBE, .deletes_all = true, .pose = rlf_pose_identity()};
    put_marker(w, header, &m);
}

/* ---- bodies --------------------------------------------------------------------------------- */

/* Ours stand along y, rviz2's along z. */
static rlf_pose turned(const rlf_pose *pose)
{
    const rlf_pose turn = {.q = {-0.70710678118654752, 0.0, 0.0, 0.70710678118654752}};
    return rlf_pose_mul(pose, &turn);
}

static uint32_t markers_of(const rlf_shape *shape)
{
    return shape->type == RLF_SHAPE_CAPSULE ? 3 : 1;
}

static void put_hull(io_cdr_writer *w, const io_ros_header *header, const marker *m,
                     const rlf_hull *hull)
{
    put_head(w, header, m);
    const int32_t count = 3 * hull->triangle_count;
    io_cdr_put_u32(w, (uint32_t)count);
    for (int32_t i = 0; i < count; i++) {
        put_vec3(w, hull->vertices[hull->triangles[i]]);
    }
    put_tail(w);
}

static void put_caps(io_cdr_writer *w, const io_ros_header *header, const marker *m,
                     const rlf_shape *shape)
{
    marker cap = *m;
    cap.type = MARKER_SPHERE;
    cap.scale = rlf_vec3_make(2 * shape->radius, 2 * shape->radius, 2 * shape->radius);
    for (int k = 0; k < 2; k++) {
        const double y = (k == 0 ? 0.5 : -0.5) * shape->height;
        cap.pose.p = rlf_transform(&m->pose, rlf_vec3_make(0.0, 0.0, y));
        cap.id = m->id + 1 + k;
        put_marker(w, header, &cap);
    }
}

static void put_body(io_cdr_writer *w, const io_ros_header *header, const rlf_body_state *b)
{
    const rlf_shape *s = &b->shape;
    const double across = 2 * s->radius;
    marker m = {.name = b->name,
                .id = 4 * (int32_t)b->id.index1,
                .pose = b->T_world_body,
                .color = {b->color[0], b->color[1], b->color[2], 1.0F}};
    switch (s->type) {
    case RLF_SHAPE_BOX:
        m.type = MARKER_CUBE;
        m.scale = s->size;
        put_marker(w, header, &m);
        break;
    case RLF_SHAPE_SPHERE:
        m.type = MARKER_SPHERE;
        m.scale = rlf_vec3_make(across, across, across);
        put_marker(w, header, &m);
        break;
    case RLF_SHAPE_HULL:
        m.type = MARKER_TRIANGLE_LIST;
        m.scale = rlf_vec3_make(1.0, 1.0, 1.0);
        put_hull(w, header, &m, s->hull);
        break;
    case RLF_SHAPE_CAPSULE:
    case RLF_SHAPE_CYLINDER:
    default:
        m.type = MARKER_CYLINDER;
        m.pose = turned(&b->T_world_body);
        m.scale = rlf_vec3_make(across, across, s->height);
        put_marker(w, header, &m);
        if (s->type == RLF_SHAPE_CAPSULE) {
            put_caps(w, header, &m, s);
        }
        break;
    }
}

void io_ros_write_bodies(io_cdr_writer *w, const io_ros_header *header,
                         const rlf_body_state *bodies, int32_t count)
{
    uint32_t markers = 1;
    for (int32_t i = 0; i < count; i++) {
        markers += markers_of(&bodies[i].shape);
    }
    io_cdr_put_u32(w, markers);
    put_delete_all(w, header, "");
    for (int32_t i = 0; i < count; i++) {
        put_body(w, header, &bodies[i]);
    }
}

/* ---- contacts ------------------------------------------------------------------------------- */

#define DOT_M 0.01
#define LINE_M 0.003
#define METRES_PER_NS 0.1

void io_ros_write_contacts(io_cdr_writer *w, const io_ros_header *header,
                           const rlf_contact *contacts, int32_t count)
{
    const marker dots = {.name = "points",
                         .type = MARKER_SPHERE_LIST,
                         .pose = rlf_pose_identity(),
                         .scale = {DOT_M, DOT_M, DOT_M},
                         .color = {1.0F, 0.2F, 0.1F, 1.0F}};
    const marker lines = {.name = "pushes",
                          .type = MARKER_LINE_LIST,
                          .pose = rlf_pose_identity(),
                          .scale = {LINE_M, 0.0, 0.0},
                          .color = {1.0F, 0.8F, 0.1F, 1.0F}};
    io_cdr_put_u32(w, count > 0 ? 3 : 1);
    put_delete_all(w, header, "");
    if (count == 0) {
        return;
    }
    put_head(w, header, &dots);
    io_cdr_put_u32(w, (uint32_t)count);
    for (int32_t i = 0; i < count; i++) {
        put_vec3(w, contacts[i].point);
    }
    put_tail(w);
    put_head(w, header, &lines);
    io_cdr_put_u32(w, 2 * (uint32_t)count);
    for (int32_t i = 0; i < count; i++) {
        const rlf_vec3 push = rlf_scale(contacts[i].normal, METRES_PER_NS * contacts[i].impulse);
        put_vec3(w, contacts[i].point);
        put_vec3(w, rlf_add(contacts[i].point, push));
    }
    put_tail(w);
}
