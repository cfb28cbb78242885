/* What a camera's topics may also bring: half a picture, sizes that cannot be, another encoding, a
 * second publisher, a clock that is wrong. Each is refused and counted, and the camera goes on. */
#define _POSIX_C_SOURCE 200809L
#include "test.h"

#include "io/ros/write.h"
#include "io/ros2/ros2.h"
#include "io/source/backends.h"
#include "ros2_host.h"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <pthread.h>
#include <stdatomic.h>

#define MS INT64_C(1000000)

typedef struct bench {
    io_ros2_node *node, *other_node;
    io_ros2_writer depth, info, other;
    io_ros_encoder encoder;
    io_byte_buffer buffer;
    uint16_t pixels[HOST_W * HOST_H];
    uint8_t color[HOST_CW * HOST_CH * 4];
    uint32_t number;
    int64_t clock_ns; /* of the host, less this machine's */
    atomic_bool is_running;
    pthread_t thread;
} bench;

static void write_at(const io_ros2_writer *writer, const io_byte_buffer *b, int64_t clock_ns)
{
    struct ddsi_serdata *d = io_ros2_raw_make(writer->type, b->data, b->size);
    assert_non_null(d);
    d->timestamp.v = dds_time() + clock_ns;
    assert_int_equal(dds_forwardcdr(writer->writer, d), DDS_RETCODE_OK);
}

static void begin_picture(bench *b, io_cdr_writer *cdr)
{
    rlf_frame frame;
    host_fill(b->number, b->pixels, b->color, &frame);
    const io_ros_header header =
        io_ros_header_at((1000 + (int64_t)b->number) * HOST_STEP_NS, "bad_frame");
    b->number++;
    b->buffer.size = 0;
    *cdr = io_cdr_begin(&b->buffer);
    io_ros_write_depth(&b->encoder, &frame, &header, cdr);
}

static void write_picture(bench *b, const io_ros2_writer *writer)
{
    io_cdr_writer cdr;
    begin_picture(b, &cdr);
    write_at(writer, &b->buffer, b->clock_ns);
}

static void write_info(bench *b)
{
    const rlf_rig rig = host_rig();
    const io_ros_header header = io_ros_header_at(HOST_STEP_NS, "bad_frame");
    b->buffer.size = 0;
    io_cdr_writer cdr = io_cdr_begin(&b->buffer);
    io_ros_write_camera_info(&cdr, &header, &rig.depth);
    write_at(&b->info, &b->buffer, b->clock_ns);
}

static void *publish(void *self)
{
    bench *b = self;
    while (atomic_load(&b->is_running)) {
        write_info(b);
        write_picture(b, &b->depth);
        const struct timespec rest = {.tv_nsec = 5 * MS};
        nanosleep(&rest, NULL);
    }
    return NULL;
}

static void open_bench(bench *b, const char *name)
{
    const rlf_rig rig = host_rig();
    const rlf_recording_def def = rlf_recording_def_default();
    io_ros2_place place;
    char topic[64];
    memset(b, 0, sizeof(*b));
    assert_int_equal(io_ros_encoder_init(&b->encoder, &rig, &def), RLF_OK);
    assert_int_equal(io_ros2_place_read("test", NULL, NULL, &place), RLF_OK);
    assert_int_equal(io_ros2_node_open("test", &place, &b->node), RLF_OK);
    assert_int_equal(io_ros2_node_open("test", &place, &b->other_node), RLF_OK);
    snprintf(topic, sizeof(topic), "/%s/depth/camera_info", name);
    assert_int_equal(
        io_ros2_writer_open(b->node, topic, "sensor_msgs/msg/CameraInfo", false, &b->info), RLF_OK);
    snprintf(topic, sizeof(topic), "/%s/depth/image_raw", name);
    assert_int_equal(io_ros2_writer_open(b->node, topic, "sensor_msgs/msg/Image", false, &b->depth),
                     RLF_OK);
    assert_int_equal(
        io_ros2_writer_open(b->other_node, topic, "sensor_msgs/msg/Image", false, &b->other),
        RLF_OK);
}

static void close_bench(bench *b)
{
    io_ros2_node_close(&b->other_node);
    io_ros2_node_close(&b->node);
    io_ros_encoder_free(&b->encoder);
    io_byte_buffer_free(&b->buffer);
}

/* Opens the source while the pictures come. */
static rlf_result open_source(bench *b, const char *name, rlf_opened *out)
{
    char place[32], source[32];
    snprintf(place, sizeof(place), "/%s", name);
    snprintf(source, sizeof(source), "ros2:/%s", name);
    const rlf_address address = {.source = source, .place = place};
    atomic_store(&b->is_running, true);
    assert_int_equal(pthread_create(&b->thread, NULL, publish, b), 0);
    const rlf_result result = io_backend_ros2.open(&address, out);
    atomic_store(&b->is_running, false);
    pthread_join(b->thread, NULL);
    return result;
}

static rlf_result next(rlf_opened *o, rlf_frame *out)
{
    memset(out, 0, sizeof(*out));
    return o->methods.next(o->self, out);
}

static uint64_t damaged(rlf_opened *o)
{
    rlf_source_status status = {0};
    o->methods.status(o->self, &status);
    return status.damaged;
}

/* No frame comes of the bytes, one is counted, and the next good picture is taken. */
static void check_refused(bench *b, rlf_opened *o)
{
    rlf_frame frame;
    const uint64_t before = damaged(o);
    write_at(&b->depth, &b->buffer, 0);
    assert_int_equal(next(o, &frame), RLF_NO_FRAME);
    assert_int_equal(damaged(o), before + 1);
    write_picture(b, &b->depth);
    assert_int_equal(next(o, &frame), RLF_OK);
    assert_int_equal(frame.depth_u16[0], b->number);
    assert_int_equal(damaged(o), before + 1);
}

static void put_u32(bench *b, size_t at, uint32_t value)
{
    assert_true(at + 4 <= b->buffer.size);
    for (int k = 0; k < 4; k++) {
        b->buffer.data[at + (size_t)k] = (uint8_t)(value >> 8 * k);
    }
}

/* Head 4, stamp 8, frame_id 4 + 10 and 2 to align, then height, width, encoding. */
#define HEIGHT_AT 28
#define WIDTH_AT 32
#define ENCODING_AT 40
#define LENGTH_AT (b.buffer.size - (size_t)HOST_W * HOST_H * 2 - 4)

static void test_bad_messages_are_refused(void **state)
{
    (void)state;
    static bench b;
    io_cdr_writer cdr;
    rlf_opened o;
    rlf_frame frame;
    open_bench(&b, "bad");
    assert_int_equal(open_source(&b, "bad", &o), RLF_OK);
    while (next(&o, &frame) == RLF_OK) { /* what came meanwhile */
    }
    assert_int_equal(damaged(&o), 0);

    begin_picture(&b, &cdr); /* half a frame */
    b.buffer.size /= 2;
    check_refused(&b, &o);
    begin_picture(&b, &cdr); /* the same, and its sequence says so */
    put_u32(&b, LENGTH_AT, HOST_W * HOST_H);
    b.buffer.size -= (size_t)HOST_W * HOST_H;
    check_refused(&b, &o);
    static const uint32_t absurd[] = {0, 1, HOST_H - 1, 16385, 0x7fffffff, 0xffffffff};
    for (size_t i = 0; i < sizeof(absurd) / sizeof(absurd[0]); i++) {
        begin_picture(&b, &cdr);
        assert_int_equal(b.buffer.data[HEIGHT_AT], HOST_H);
        put_u32(&b, HEIGHT_AT, absurd[i]);
        check_refused(&b, &o);
        begin_picture(&b, &cdr);
        assert_int_equal(b.buffer.data[WIDTH_AT], HOST_W);
        put_u32(&b, WIDTH_AT, absurd[i]);
        check_refused(&b, &o);
        begin_picture(&b, &cdr);
        put_u32(&b, LENGTH_AT, absurd[i] + 0x10000);
        check_refused(&b, &o);
    }
    begin_picture(&b, &cdr);
    assert_memory_equal(b.buffer.data + ENCODING_AT, "16UC1", 5);
    memcpy(b.buffer.data + ENCODING_AT, "bgra8", 5);
    check_refused(&b, &o);
    for (size_t size = 0; size < ENCODING_AT; size += 3) {
        begin_picture(&b, &cdr);
        b.buffer.size = size;
        check_refused(&b, &o);
    }
    o.methods.destroy(o.self);
    close_bench(&b);
}

static void test_a_second_publisher_is_refused(void **state)
{
    (void)state;
    static bench b;
    rlf_opened o;
    rlf_frame frame;
    open_bench(&b, "two");
    assert_int_equal(open_source(&b, "two", &o), RLF_OK);
    while (next(&o, &frame) == RLF_OK) {
    }
    write_picture(&b, &b.depth);
    assert_int_equal(next(&o, &frame), RLF_OK);
    const uint64_t before = damaged(&o);
    write_picture(&b, &b.other);
    assert_int_equal(next(&o, &frame), RLF_NO_FRAME);
    assert_int_equal(damaged(&o), before + 1);
    write_picture(&b, &b.depth);
    assert_int_equal(next(&o, &frame), RLF_OK);
    /* When the first one has been silent, the other's are taken. */
    const struct timespec rest = {.tv_nsec = 400 * MS};
    nanosleep(&rest, NULL);
    write_picture(&b, &b.other);
    assert_int_equal(next(&o, &frame), RLF_OK);
    assert_int_equal(damaged(&o), before + 1);
    o.methods.destroy(o.self);
    close_bench(&b);
}

static void test_a_wrong_clock_is_told(void **state)
{
    (void)state;
    static bench b;
    rlf_opened o;
    open_bench(&b, "clock");
    b.clock_ns = 1250 * MS;
    assert_int_equal(open_source(&b, "clock", &o), RLF_ERROR_DEVICE);
    const char *at = strstr(rlf_error_text(), "clock of the camera's host is ");
    assert_non_null(at);
    const double off_s = strtod(at + strlen("clock of the camera's host is "), NULL);
    assert_true(off_s > 1.2 && off_s < 1.26);
    assert_non_null(strstr(at, "ahead of"));
    b.clock_ns = -5000 * MS;
    assert_int_equal(open_source(&b, "clock", &o), RLF_ERROR_DEVICE);
    assert_non_null(strstr(rlf_error_text(), " behind this machine's"));
    b.clock_ns = 10 * MS; /* within a frame */
    assert_int_equal(open_source(&b, "clock", &o), RLF_OK);
    o.methods.destroy(o.self);
    close_bench(&b);
}

static void test_too_large_is_not_sent(void **state)
{
    (void)state;
    static bench b;
    open_bench(&b, "large");
    uint8_t *data = rlf_alloc(IO_ROS2_MESSAGE_MAX + 1);
    assert_non_null(data);
    assert_false(io_ros2_write(&b.depth, data, IO_ROS2_MESSAGE_MAX + 1));
    rlf_free(data);
    close_bench(&b);
}

static void test_one_profile_in_a_program(void **state)
{
    (void)state;
    io_ros2_node *a = NULL, *c = NULL;
    io_ros2_place place;
    assert_int_equal(io_ros2_place_read("test", NULL, "local", &place), RLF_OK);
    assert_int_equal(io_ros2_node_open("test", &place, &a), RLF_OK);
    place.profile = IO_ROS2_LAN;
    assert_int_equal(io_ros2_node_open("test", &place, &c), RLF_ERROR_INVALID);
    assert_null(c);
    io_ros2_node_close(&a);
}

int main(void)
{
    host_choose_domain();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bad_messages_are_refused),
        cmocka_unit_test(test_a_second_publisher_is_refused),
        cmocka_unit_test(test_a_wrong_clock_is_told),
        cmocka_unit_test(test_too_large_is_not_sent),
        cmocka_unit_test(test_one_profile_in_a_program),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
