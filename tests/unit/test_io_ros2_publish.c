/* What a run publishes for ROS 2: picture, mask, points, bodies, contacts and the camera's place,
 * read back from the topics; and that nobody's slowness costs the frame loop time. */
#define _POSIX_C_SOURCE 200809L
#include "test.h"

#include "io/ros/messages.h"
#include "io/ros/write.h"
#include "io/ros2/ros2.h"
#include "ros2_host.h"

#include <math.h>

#define MS INT64_C(1000000)
#define FRAMES 12

typedef struct inlet {
    io_ros2_reader reader;
    io_ros2_message last;
} inlet;

enum { PICTURE, MASK, POINTS, BODIES, CONTACTS, PLACE, DEPTH, INLETS };

static void open_inlets(io_ros2_node *node, const char *name, inlet *inlets)
{
    static const char *const rows[INLETS][2] = {{"image_raw", "sensor_msgs/msg/Image"},
                                                {"foreground", "sensor_msgs/msg/Image"},
                                                {"points", IO_ROS_CLOUD_TYPE},
                                                {"bodies", IO_ROS_MARKERS_TYPE},
                                                {"contacts", IO_ROS_MARKERS_TYPE},
                                                {"/tf", "tf2_msgs/msg/TFMessage"},
                                                {"depth/image_raw", "sensor_msgs/msg/Image"}};
    for (int i = 0; i < INLETS; i++) {
        const bool is_whole = rows[i][0][0] == '/';
        char topic[64];
        snprintf(topic, sizeof(topic), "%s%s%s", is_whole ? "" : name, is_whole ? "" : "/",
                 rows[i][0]);
        inlets[i] = (inlet){{0, 0}, {0}};
        assert_int_equal(
            io_ros2_reader_open(node, topic, rows[i][1], true, false, 8, &inlets[i].reader),
            RLF_OK);
    }
}

/* Keeps the newest message of each. */
static bool take_inlets(inlet *inlets)
{
    bool is_whole = true;
    for (int i = 0; i < INLETS; i++) {
        io_ros2_message m;
        while (io_ros2_take(&inlets[i].reader, &m)) {
            io_ros2_release(&inlets[i].last);
            inlets[i].last = m;
        }
        is_whole = is_whole && inlets[i].last.data != NULL;
    }
    return is_whole;
}

static void rest_ms(int64_t ms)
{
    const struct timespec rest = {.tv_nsec = (long)(ms * MS)};
    nanosleep(&rest, NULL);
}

static rlf_pipeline *make_pipeline(rlf_source **source)
{
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_open_source("synthetic:room?color=64x48", NULL, source), RLF_OK);
    const rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, *source, NULL);
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    static const rlf_shape_type types[] = {RLF_SHAPE_BOX, RLF_SHAPE_SPHERE, RLF_SHAPE_CAPSULE};
    for (int i = 0; i < 3; i++) {
        rlf_body_def body = rlf_body_def_default();
        body.shape =
            (rlf_shape){.type = types[i], .size = {0.1, 0.2, 0.3}, .radius = 0.1, .height = 0.2};
        body.position = rlf_vec3_make(0.3 * i - 0.3, 0.0, 1.5);
        rlf_body_id id;
        assert_int_equal(rlf_world_add_body(rlf_pipeline_get_world(pipeline), &body, &id), RLF_OK);
    }
    return pipeline;
}

static io_cdr_reader message_of(const inlet *in)
{
    return io_cdr_open(in->last.data, in->last.size);
}

static void check_picture(const inlet *in, const rlf_image_rgba8 *sent)
{
    io_ros_image image;
    assert_true(io_ros_read_image(message_of(in), &image));
    assert_string_equal(image.encoding, "rgb8");
    assert_int_equal(image.width, sent->width);
    assert_int_equal(image.height, sent->height);
    for (int32_t y = 0; y < sent->height; y++) {
        for (int32_t x = 0; x < sent->width; x++) {
            const uint8_t *a = image.data.data + (size_t)y * image.step + 3 * (size_t)x;
            assert_memory_equal(a, sent->data + (ptrdiff_t)y * sent->stride + 4 * x, 3);
        }
    }
}

static void check_mask(const inlet *in, const rlf_surface *s)
{
    io_ros_image image;
    assert_true(io_ros_read_image(message_of(in), &image));
    assert_string_equal(image.encoding, "mono8");
    assert_int_equal(image.data.size, s->width * s->height);
    for (size_t i = 0; i < image.data.size; i++) {
        assert_int_equal(image.data.data[i], s->foreground[i] != 0 ? 255 : 0);
    }
}

static void skip_header(io_cdr_reader *r, const char *frame)
{
    char name[IO_ROS_NAME_MAX];
    (void)io_cdr_get_u32(r);
    (void)io_cdr_get_u32(r);
    io_cdr_get_text(r, name, sizeof(name));
    assert_string_equal(name, frame);
}

static void check_points(const inlet *in, const rlf_surface *s)
{
    io_cdr_reader r = message_of(in);
    skip_header(&r, "relief_depth_optical_frame");
    assert_int_equal(io_cdr_get_u32(&r), s->height);
    assert_int_equal(io_cdr_get_u32(&r), s->width);
    assert_int_equal(io_cdr_get_u32(&r), 6);
    for (uint32_t i = 0; i < 6; i++) {
        char name[16];
        io_cdr_get_text(&r, name, sizeof(name));
        assert_int_equal(io_cdr_get_u32(&r), 4 * i);
        assert_int_equal(io_cdr_get_u8(&r), 7);
        assert_int_equal(io_cdr_get_u32(&r), 1);
    }
    assert_int_equal(io_cdr_get_u8(&r), 0);
    assert_int_equal(io_cdr_get_u32(&r), IO_ROS_CLOUD_STEP);
    assert_int_equal(io_cdr_get_u32(&r), IO_ROS_CLOUD_STEP * s->width);
    const io_cdr_span data = io_cdr_get_bytes(&r);
    assert_int_equal(data.size, IO_ROS_CLOUD_STEP * s->width * s->height);
    for (int32_t i = 0; i < s->width * s->height; i++) {
        float p[6];
        memcpy(p, data.data + (size_t)i * IO_ROS_CLOUD_STEP, sizeof(p));
        assert_true(s->depth[i] > 0 ? p[2] == s->depth[i] : isnan(p[2]));
        assert_true(s->depth[i] > 0 ? p[0] == s->ray_x[i] * s->depth[i] : isnan(p[0]));
        assert_true(s->normal_z[i] != 0 ? p[5] == s->normal_z[i] : true);
    }
    (void)io_cdr_get_u8(&r);
    assert_false(r.is_bad);
    assert_int_equal(r.position, r.size);
}

typedef struct seen_marker {
    int32_t type, action;
    double numbers[10]; /* place, orientation, scale */
    uint32_t points;
} seen_marker;

static seen_marker read_marker(io_cdr_reader *r)
{
    char text[80];
    seen_marker m;
    skip_header(r, "relief_world");
    io_cdr_get_text(r, text, sizeof(text));
    (void)io_cdr_get_u32(r);
    m.type = (int32_t)io_cdr_get_u32(r);
    m.action = (int32_t)io_cdr_get_u32(r);
    io_cdr_get_doubles(r, m.numbers, 10);
    for (int i = 0; i < 6; i++) { /* colour, lifetime */
        (void)io_cdr_get_u32(r);
    }
    (void)io_cdr_get_u8(r);
    m.points = io_cdr_get_u32(r);
    for (uint32_t i = 0; i < 3 * m.points && !r->is_bad; i++) {
        double unused;
        io_cdr_get_doubles(r, &unused, 1);
    }
    assert_int_equal(io_cdr_get_u32(r), 0);
    io_cdr_get_text(r, text, sizeof(text));
    skip_header(r, ""); /* of the texture */
    io_cdr_get_text(r, text, sizeof(text));
    assert_int_equal(io_cdr_get_bytes(r).size, 0);
    assert_int_equal(io_cdr_get_u32(r), 0);
    for (int i = 0; i < 3; i++) { /* text, mesh, mesh's file */
        io_cdr_get_text(r, text, sizeof(text));
        assert_string_equal(text, "");
    }
    assert_int_equal(io_cdr_get_bytes(r).size, 0);
    (void)io_cdr_get_u8(r);
    return m;
}

static void check_bodies(const inlet *in, const rlf_snapshot *s)
{
    static const int32_t types[] = {1, 2, 3, 2, 2}; /* box, ball, capsule of three */
    io_cdr_reader r = message_of(in);
    assert_int_equal(s->body_count, 3);
    assert_int_equal(io_cdr_get_u32(&r), 1 + 5);
    assert_int_equal(read_marker(&r).action, 3);
    for (int i = 0; i < 5; i++) {
        const seen_marker m = read_marker(&r);
        assert_int_equal(m.type, types[i]);
        assert_int_equal(m.action, 0);
        if (i < 3) {
            assert_memory_equal(m.numbers, &s->bodies[i].T_world_body.p, 3 * sizeof(double));
        }
    }
    assert_false(r.is_bad);
    assert_int_equal(r.position, r.size);
}

static void check_contacts(const inlet *in, const rlf_snapshot *s)
{
    io_cdr_reader r = message_of(in);
    const uint32_t count = io_cdr_get_u32(&r);
    assert_int_equal(count, s->contact_count > 0 ? 3 : 1);
    for (uint32_t i = 0; i < count; i++) {
        const seen_marker m = read_marker(&r);
        assert_int_equal(m.points, i * (uint32_t)s->contact_count);
    }
    assert_int_equal(r.position, r.size);
}

static void check_place(const inlet *in, const rlf_rig *rig, const rlf_pose *T_world_camera)
{
    io_ros_transform t;
    uint32_t count;
    assert_true(io_ros_read_tf(message_of(in), &t, 1, &count));
    assert_int_equal(count, 1);
    assert_string_equal(t.parent, "relief_world");
    assert_string_equal(t.child, "relief_color_optical_frame");
    const rlf_pose T_world_depth = rlf_pose_mul(&t.T_parent_child, &rig->T_color_depth);
    assert_true(rlf_length(rlf_sub(T_world_depth.p, T_world_camera->p)) < 1e-12);
}

static void test_a_run_is_published(void **state)
{
    (void)state;
    inlet in[INLETS];
    io_ros2_place place;
    io_ros2_node *node = NULL;
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = make_pipeline(&source);
    rlf_ros2_publisher *p = NULL;
    const rlf_source_info *info = rlf_source_get_info(source);
    assert_int_equal(rlf_ros2_publisher_open("ros2:/relief", info, &p), RLF_OK);
    assert_int_equal(io_ros2_place_read("test", NULL, NULL, &place), RLF_OK);
    assert_int_equal(io_ros2_node_open("test", &place, &node), RLF_OK);
    open_inlets(node, "/relief", in);
    rest_ms(300); /* the publisher looks for readers */
    rlf_pipeline_output out;
    bool is_whole = false;
    for (int i = 0; i < FRAMES; i++) {
        assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
        rlf_ros2_publisher_add(p, &out);
        rest_ms(20);
    }
    for (int i = 0; i < 100; i++) { /* the last frame's */
        is_whole = take_inlets(in);
        rest_ms(is_whole && i > 5 ? 0 : 10);
    }
    assert_true(is_whole);
    check_picture(&in[PICTURE], &out.render.image);
    check_mask(&in[MASK], out.surface);
    check_points(&in[POINTS], out.surface);
    check_bodies(&in[BODIES], out.snapshot);
    check_contacts(&in[CONTACTS], out.snapshot);
    check_place(&in[PLACE], &info->rig, &out.T_world_camera);
    const rlf_ros2_status status = rlf_ros2_publisher_get_status(p);
    assert_int_equal(status.frames + status.dropped, FRAMES);
    assert_int_equal(status.unsent, 0);
    for (int i = 0; i < INLETS; i++) {
        io_ros2_release(&in[i].last);
    }
    io_ros2_node_close(&node);
    rlf_ros2_publisher_close(&p);
    assert_null(p);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

/* A process that reads one picture and stands still from then on. */
static pid_t idler;

static void idle(void)
{
    io_ros2_place place;
    io_ros2_node *node = NULL;
    inlet in[INLETS];
    if (io_ros2_place_read("test", NULL, NULL, &place) != RLF_OK ||
        io_ros2_node_open("test", &place, &node) != RLF_OK) {
        _exit(1);
    }
    open_inlets(node, "/slow", in);
    while (!take_inlets(in)) {
        rest_ms(5);
    }
    raise(SIGSTOP);
    _exit(0);
}

static int start_idler(void **state)
{
    (void)state;
    idler = fork();
    if (idler == 0) {
        idle();
    }
    return idler > 0 ? 0 : -1;
}

static int stop_idler(void **state)
{
    (void)state;
    host_kill(idler);
    return 0;
}

static bool is_idle(void)
{
    int status = 0;
    return waitpid(idler, &status, WNOHANG | WUNTRACED) == idler && WIFSTOPPED(status);
}

static void test_nobody_delays_the_loop(void **state)
{
    (void)state;
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = make_pipeline(&source);
    rlf_ros2_publisher *p = NULL;
    rlf_pipeline_output out;
    assert_int_equal(rlf_ros2_publisher_open("ros2:/slow", rlf_source_get_info(source), &p),
                     RLF_OK);
    assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
    bool is_there = false;
    for (int i = 0; i < 1000 && !is_there; i++) {
        rlf_ros2_publisher_add(p, &out);
        rest_ms(10);
        is_there = is_idle();
    }
    assert_true(is_there);
    int32_t late = 0;
    for (int i = 0; i < 100; i++) {
        const int64_t begin_ns = rlf_clock_ns();
        rlf_ros2_publisher_add(p, &out);
        late += rlf_clock_ns() - begin_ns > 50 * MS ? 1 : 0;
        rest_ms(5);
    }
    assert_true(rlf_ros2_publisher_get_status(p).frames > 0);
    /* Copies cost milliseconds; a write that waits takes a tenth of a second. */
    assert_true(late < 20);
    rlf_ros2_publisher_close(&p);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

static void test_wrong_addresses(void **state)
{
    (void)state;
    rlf_source_info info = {.rig = host_rig()};
    rlf_ros2_publisher *p = NULL;
    static const char *const wrong[] = {"ros2:relief", "ros2:/", "ros2:/relief?depth=1",
                                        "ros2:/relief?profile=wan", "ros2:/relief?domain=x"};
    for (size_t i = 0; i < sizeof(wrong) / sizeof(wrong[0]); i++) {
        assert_int_equal(rlf_ros2_publisher_open(wrong[i], &info, &p), RLF_ERROR_INVALID);
        assert_null(p);
        assert_int_equal(strncmp(rlf_error_text(), wrong[i], strlen(wrong[i])), 0);
    }
    rlf_ros2_publisher_close(NULL);
    rlf_ros2_publisher_close(&p);
}

int main(void)
{
    host_choose_domain();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_run_is_published),
        cmocka_unit_test(test_nobody_delays_the_loop),
        cmocka_unit_test(test_wrong_addresses),
    };
    return cmocka_run_group_tests(tests, start_idler, stop_idler);
}
