/* What a run makes, for ROS 2. The frame loop copies what somebody reads, and waits for nobody; a
 * thread writes it. */
#define _POSIX_C_SOURCE 200809L
#include "io/ros2/find_camera.h"
#include "io/ros2/publish.h"
#include "io/ros/write.h"
#include "relief/io.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>

#define SLOTS 3 /* one is filled, one waits, one is sent */
/* How soon a new reader is noticed. */
#define LOOK_NS INT64_C(50000000)
#define WORLD_FRAME "world"

typedef struct outputs {
    io_ros2_writer picture, packed, cloud, mask, bodies, contacts, tf;
} outputs;

struct rlf_ros2_publisher {
    io_ros2_node *node;
    io_ros2_camera camera;
    outputs out;
    io_ros2_clock clock;
    rlf_rig rig;
    char world_frame[IO_ROS_NAME_MAX];
    io_byte_buffer buffer;
    _Atomic uint32_t wanted; /* io_ros2_part */
    pthread_t thread;
    bool is_running;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t news;
    io_ros2_run_frame slots[SLOTS];
    int32_t waiting, sending; /* slots; -1 = none */
    bool is_ending;
    rlf_ros2_status status;
};

/* ---- messages ------------------------------------------------------------------------------- */

static io_cdr_writer begin(rlf_ros2_publisher *p)
{
    p->buffer.size = 0;
    return io_cdr_begin(&p->buffer);
}

static void send(rlf_ros2_publisher *p, const io_ros2_writer *writer)
{
    const bool is_sent = io_byte_buffer_check(&p->buffer) == RLF_OK &&
                         io_ros2_write(writer, p->buffer.data, p->buffer.size);
    pthread_mutex_lock(&p->lock);
    p->status.messages += is_sent ? 1 : 0;
    p->status.unsent += is_sent ? 0 : 1;
    pthread_mutex_unlock(&p->lock);
    p->buffer.is_short = false;
}

static void send_picture(rlf_ros2_publisher *p, const io_ros2_run_frame *m,
                         const io_ros_header *header)
{
    if (io_ros2_writer_is_read(&p->out.picture)) {
        io_cdr_writer w = begin(p);
        io_ros_write_color(&m->picture, header, &w);
        send(p, &p->out.picture);
    }
    if (io_ros2_writer_is_read(&p->out.packed)) {
        io_cdr_writer w = begin(p);
        if (io_ros_write_compressed(&p->camera.encoder, &m->picture, header, &w) == RLF_OK) {
            send(p, &p->out.packed);
        }
    }
}

static void send_cloud(rlf_ros2_publisher *p, const io_ros2_run_frame *m,
                       const io_ros_header *header)
{
    const size_t count = (size_t)m->width * (size_t)m->height;
    const io_ros_cloud cloud = {.width = m->width,
                                .height = m->height,
                                .ray_x = m->planes,
                                .ray_y = m->planes + count,
                                .depth = m->planes + 2 * count,
                                .normal_x = m->planes + 3 * count,
                                .normal_y = m->planes + 4 * count,
                                .normal_z = m->planes + 5 * count};
    io_cdr_writer w = begin(p);
    io_ros_write_cloud(&w, header, &cloud);
    send(p, &p->out.cloud);
}

/* Where the camera is: of its root, which is the colour camera where there is one. */
static void send_pose(rlf_ros2_publisher *p, const io_ros2_run_frame *m, int64_t stamp_ns)
{
    io_ros_transform t = {.stamp_ns = stamp_ns, .T_parent_child = m->T_world_camera};
    memcpy(t.parent, p->world_frame, sizeof(t.parent));
    memcpy(t.child, p->rig.has_color ? p->camera.color_frame : p->camera.depth_frame,
           sizeof(t.child));
    if (p->rig.has_color) {
        const rlf_pose T_depth_color = rlf_pose_invert(&p->rig.T_color_depth);
        t.T_parent_child = rlf_pose_mul(&m->T_world_camera, &T_depth_color);
    }
    io_cdr_writer w = begin(p);
    io_ros_write_tf(&w, &t, 1);
    send(p, &p->out.tf);
}

static void send_run_frame(rlf_ros2_publisher *p, const io_ros2_run_frame *m)
{
    const int64_t offset_ns = io_ros2_clock_offset(&p->clock, m->time_ns, m->host_ns);
    const int64_t stamp_ns = m->time_ns + offset_ns;
    const io_ros_header world = io_ros_header_at(stamp_ns, p->world_frame);
    const io_ros_header depth = io_ros_header_at(stamp_ns, p->camera.depth_frame);
    const io_ros_header color = io_ros_header_at(
        stamp_ns, p->rig.has_color ? p->camera.color_frame : p->camera.depth_frame);
    send_pose(p, m, stamp_ns);
    if ((m->parts & IO_ROS2_FRAME) != 0) {
        (void)io_ros2_camera_send(&p->camera, &m->frame.frame, offset_ns);
    }
    if ((m->parts & IO_ROS2_PICTURE) != 0) {
        send_picture(p, m, &color);
    }
    if ((m->parts & IO_ROS2_CLOUD) != 0) {
        send_cloud(p, m, &depth);
    }
    if ((m->parts & IO_ROS2_MASK) != 0) {
        io_cdr_writer w = begin(p);
        io_ros_write_mask(&w, &depth, m->mask, m->width, m->height);
        send(p, &p->out.mask);
    }
    if ((m->parts & IO_ROS2_BODIES) != 0) {
        io_cdr_writer w = begin(p);
        io_ros_write_bodies(&w, &world, m->bodies, m->body_count);
        send(p, &p->out.bodies);
    }
    if ((m->parts & IO_ROS2_CONTACTS) != 0) {
        io_cdr_writer w = begin(p);
        io_ros_write_contacts(&w, &world, m->contacts, m->contact_count);
        send(p, &p->out.contacts);
    }
}

/* ---- the thread ----------------------------------------------------------------------------- */

static uint32_t look_for_readers(const rlf_ros2_publisher *p)
{
    const outputs *o = &p->out;
    const io_ros2_camera *c = &p->camera;
    const struct {
        const io_ros2_writer *writer;
        io_ros2_part part;
    } rows[] = {{&c->depth, IO_ROS2_FRAME},        {&c->depth_packed, IO_ROS2_FRAME},
                {&c->depth_info, IO_ROS2_FRAME},   {&c->color, IO_ROS2_FRAME},
                {&c->color_packed, IO_ROS2_FRAME}, {&c->color_info, IO_ROS2_FRAME},
                {&o->picture, IO_ROS2_PICTURE},    {&o->packed, IO_ROS2_PICTURE},
                {&o->cloud, IO_ROS2_CLOUD},        {&o->mask, IO_ROS2_MASK},
                {&o->bodies, IO_ROS2_BODIES},      {&o->contacts, IO_ROS2_CONTACTS}};
    uint32_t wanted = 0;
    for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++) {
        wanted |= io_ros2_writer_is_read(rows[i].writer) ? (uint32_t)rows[i].part : 0u;
    }
    return wanted;
}

static void wait_for_news(rlf_ros2_publisher *p)
{
    const int64_t until_ns = rlf_clock_ns() + LOOK_NS;
    const struct timespec until = {.tv_sec = (time_t)(until_ns / 1000000000),
                                   .tv_nsec = (long)(until_ns % 1000000000)};
    pthread_cond_timedwait(&p->news, &p->lock, &until);
}

static void *run(void *self)
{
    rlf_ros2_publisher *p = self;
    bool is_ending = false;
    while (!is_ending) {
        atomic_store(&p->wanted, look_for_readers(p));
        pthread_mutex_lock(&p->lock);
        if (p->waiting < 0 && !p->is_ending) {
            wait_for_news(p);
        }
        p->sending = p->waiting;
        p->waiting = -1;
        const int32_t sending = p->sending;
        is_ending = p->is_ending && sending < 0;
        pthread_mutex_unlock(&p->lock);
        if (sending >= 0) {
            send_run_frame(p, &p->slots[sending]);
            pthread_mutex_lock(&p->lock);
            p->sending = -1;
            p->status.frames++;
            pthread_mutex_unlock(&p->lock);
        }
    }
    return NULL;
}

/* ---- the frame loop's side ------------------------------------------------------------------ */

void rlf_ros2_publisher_add(rlf_ros2_publisher *p, const rlf_pipeline_output *frame)
{
    if (!RLF_ASSERT(p != NULL && frame != NULL)) {
        return;
    }
    pthread_mutex_lock(&p->lock);
    int32_t slot = 0;
    while (slot == p->sending || slot == p->waiting) {
        slot++;
    }
    pthread_mutex_unlock(&p->lock);
    io_ros2_run_frame *m = &p->slots[slot]; /* nobody else has it */
    m->host_ns = io_ros2_now();
    io_ros2_run_frame_fill(m, &p->rig, atomic_load(&p->wanted), frame);
    pthread_mutex_lock(&p->lock);
    p->status.dropped += p->waiting >= 0 ? 1 : 0;
    p->waiting = slot;
    pthread_cond_signal(&p->news);
    pthread_mutex_unlock(&p->lock);
}

rlf_ros2_status rlf_ros2_publisher_get_status(rlf_ros2_publisher *p)
{
    if (!RLF_ASSERT(p != NULL)) {
        return (rlf_ros2_status){0};
    }
    pthread_mutex_lock(&p->lock);
    rlf_ros2_status status = p->status;
    pthread_mutex_unlock(&p->lock);
    return status;
}

/* ---- opening and closing -------------------------------------------------------------------- */

static rlf_result open_outputs(rlf_ros2_publisher *p, const char *name)
{
    const char *image = io_ros_type_name(IO_ROS_IMAGE);
    const char *packed = io_ros_type_name(IO_ROS_COMPRESSED_IMAGE);
    const io_ros2_output rows[] = {{"image_raw", image, &p->out.picture},
                                   {"image_raw/compressed", packed, &p->out.packed},
                                   {"points", IO_ROS_CLOUD_TYPE, &p->out.cloud},
                                   {"foreground", image, &p->out.mask},
                                   {"bodies", IO_ROS_MARKERS_TYPE, &p->out.bodies},
                                   {"contacts", IO_ROS_MARKERS_TYPE, &p->out.contacts}};
    rlf_result result = io_ros2_open_outputs(p->node, name, rows, sizeof(rows) / sizeof(rows[0]));
    return result == RLF_OK
               ? io_ros2_writer_open(p->node, "/tf", io_ros_type_name(IO_ROS_TF), false, &p->out.tf)
               : result;
}

static rlf_result open_all(rlf_ros2_publisher *p, const char *address)
{
    const rlf_recording_def def = rlf_recording_def_default();
    io_ros2_target target;
    rlf_result result = io_ros2_target_read(address, &target);
    result = result == RLF_OK ? io_ros2_node_open(address, &target.place, &p->node) : result;
    if (result == RLF_OK) {
        result = io_ros2_camera_open(p->node, target.name, &p->rig, &def, &p->camera);
    }
    result = result == RLF_OK ? open_outputs(p, target.name) : result;
    io_ros2_frame_name(target.name, WORLD_FRAME, p->world_frame);
    for (int32_t i = 0; i < SLOTS && result == RLF_OK; i++) {
        result = io_ros2_run_frame_create(&p->rig, &p->slots[i]);
    }
    return result;
}

/* Ctrl-C is the frame loop's. */
static bool start_thread(rlf_ros2_publisher *p)
{
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    p->is_running = pthread_create(&p->thread, NULL, run, p) == 0;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    return p->is_running;
}

static void make_lock(rlf_ros2_publisher *p)
{
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->news, &attributes);
    pthread_condattr_destroy(&attributes);
}

rlf_result rlf_ros2_publisher_open(const char *address, const rlf_source_info *info,
                                   rlf_ros2_publisher **out)
{
    if (!RLF_ASSERT(address != NULL && info != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_ros2_publisher *p = rlf_alloc(sizeof(*p));
    if (p == NULL) {
        return RLF_ERROR_MEMORY;
    }
    make_lock(p);
    p->rig = info->rig;
    p->waiting = p->sending = -1;
    rlf_result result = open_all(p, address);
    if (result == RLF_OK && !start_thread(p)) {
        result = rlf_fail(RLF_ERROR_MEMORY, "%s: no thread can be started", address);
    }
    if (result != RLF_OK) {
        rlf_ros2_publisher_close(&p);
        return result;
    }
    *out = p;
    return RLF_OK;
}

void rlf_ros2_publisher_close(rlf_ros2_publisher **publisher)
{
    if (publisher == NULL || *publisher == NULL) {
        return;
    }
    rlf_ros2_publisher *p = *publisher;
    *publisher = NULL;
    if (p->is_running) {
        pthread_mutex_lock(&p->lock);
        p->is_ending = true;
        pthread_cond_signal(&p->news);
        pthread_mutex_unlock(&p->lock);
        pthread_join(p->thread, NULL);
    }
    io_ros2_node_close(&p->node);
    io_ros2_camera_close(&p->camera);
    io_byte_buffer_free(&p->buffer);
    for (int32_t i = 0; i < SLOTS; i++) {
        io_ros2_run_frame_destroy(&p->slots[i]);
    }
    pthread_cond_destroy(&p->news);
    pthread_mutex_destroy(&p->lock);
    rlf_free(p);
}
