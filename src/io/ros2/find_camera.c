/* The first messages of a camera's topics. */
#define _POSIX_C_SOURCE 200809L
#include "io/ros2/find_camera.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#define MS INT64_C(1000000)
#define FIND_NS (900 * MS)  /* for somebody to answer */
#define LIST_NS (180 * MS)  /* the same for a list of all */
#define SETTLE_NS (60 * MS) /* all topics of one camera are told within this */
#define LISTEN_NS (500 * MS)
#define PAUSE_MS 10
/* Three pictures tell how often they come, though one may be lost. */
#define PICTURES 3
#define PICTURE_DEPTH 4

int64_t io_ros2_now(void)
{
    struct timespec now = {0};
    clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

/* ---- finding -------------------------------------------------------------------------------- */

static rlf_result fail_absent(const char *source, const io_ros2_topic *topics, int32_t count)
{
    char list[400] = "";
    size_t length = 0;
    for (int32_t i = 0; i < count; i++) {
        const size_t more = strlen(topics[i].name);
        if (strstr(topics[i].type, "Image") != NULL && length + more + 2 < sizeof(list)) {
            list[length++] = ' ';
            memcpy(list + length, topics[i].name, more + 1);
            length += more;
        }
    }
    return rlf_fail(
        RLF_ERROR_DEVICE,
        "%s: nobody publishes pictures there (found:%s): start the camera's ROS 2 node with the "
        "same ROS_DOMAIN_ID, here with ROS_LOCALHOST_ONLY=1, or add ?profile=lan",
        source, length > 0 ? list : " none");
}

/* All topics, once there are pictures of what is wished and no more come; or what is there after so
 * long. */
static int32_t discover(io_ros2_node *node, const io_ros2_wish *wish, int64_t wait_ns,
                        io_ros2_topic *topics)
{
    const int64_t begin_ns = rlf_clock_ns();
    int64_t changed_ns = begin_ns;
    int32_t count = -1;
    for (;;) {
        const int32_t now_count = io_ros2_discover(node, topics, IO_ROS2_TOPICS_MAX);
        const int64_t now_ns = rlf_clock_ns();
        changed_ns = now_count != count ? now_ns : changed_ns;
        count = now_count;
        const bool is_settled = now_ns - changed_ns >= SETTLE_NS &&
                                (wish != NULL ? io_ros2_has_depth(topics, count, wish) : count > 0);
        if (is_settled || now_ns - begin_ns >= wait_ns) {
            return count;
        }
        const struct timespec rest = {.tv_nsec = (long)(PAUSE_MS * MS)};
        nanosleep(&rest, NULL);
    }
}

/* ---- listening ------------------------------------------------------------------------------ */

static io_ros_type type_of(const char *name)
{
    for (io_ros_type type = IO_ROS_IMAGE; type < IO_ROS_TYPE_COUNT; type++) {
        if (strcmp(io_ros_type_name(type), name) == 0) {
            return type;
        }
    }
    return IO_ROS_OTHER;
}

static rlf_result open_channel(io_ros2_node *node, const io_ros2_topic *topic, io_ros2_found *out)
{
    io_ros2_channel *c = &out->channels[out->count];
    *c = (io_ros2_channel){.topic = *topic, .type = type_of(topic->type), .clock_ns = INT64_MAX};
    const bool is_tf = c->type == IO_ROS_TF;
    rlf_result result =
        io_ros2_reader_open(node, topic->name, topic->type, topic->is_reliable || is_tf, is_tf,
                            is_tf ? IO_ROS2_FIRST_MAX : PICTURE_DEPTH, &c->reader);
    out->count += result == RLF_OK ? 1 : 0;
    return result;
}

static void note_times(io_ros2_channel *c, const io_ros2_message *m)
{
    int64_t stamp_ns = 0;
    const int64_t way_ns = io_ros2_now() - m->sent_ns;
    c->clock_ns = way_ns < c->clock_ns ? way_ns : c->clock_ns;
    if (!io_ros_read_stamp(io_cdr_open(m->data, m->size), &stamp_ns)) {
        return;
    }
    const int64_t step_ns = stamp_ns - c->last_stamp_ns;
    if (c->seen > 0 && step_ns > 0 && (c->interval_ns == 0 || step_ns < c->interval_ns)) {
        c->interval_ns = step_ns;
    }
    c->last_stamp_ns = stamp_ns;
}

static void take_all(io_ros2_channel *c)
{
    io_ros2_message m;
    const int32_t room = c->type == IO_ROS_TF ? IO_ROS2_FIRST_MAX : PICTURE_DEPTH;
    while (io_ros2_take(&c->reader, &m)) {
        if (c->type != IO_ROS_TF) {
            note_times(c, &m);
        }
        c->seen++;
        if (c->kept < room) {
            c->messages[c->kept++] = m;
        } else {
            io_ros2_release(&m);
        }
    }
}

static bool is_picture(const io_ros2_channel *c)
{
    return c->type == IO_ROS_IMAGE || c->type == IO_ROS_COMPRESSED_IMAGE;
}

/* Whether each topic has said enough, or all pictures have when `is_late`. */
static bool is_enough(const io_ros2_found *g, bool is_late)
{
    int32_t pictures = 0;
    for (int32_t i = 0; i < g->count; i++) {
        const io_ros2_channel *c = &g->channels[i];
        const int32_t least = is_picture(c) ? PICTURES : 1;
        pictures += is_picture(c) && c->seen > 0 ? 1 : 0;
        if (c->seen < least && !is_late) {
            return false;
        }
    }
    return pictures > 0;
}

static void listen(io_ros2_node *node, io_ros2_found *g)
{
    const int64_t begin_ns = rlf_clock_ns();
    for (;;) {
        for (int32_t i = 0; i < g->count; i++) {
            take_all(&g->channels[i]);
        }
        const int64_t past_ns = rlf_clock_ns() - begin_ns;
        if (is_enough(g, past_ns >= LISTEN_NS) || past_ns >= 2 * LISTEN_NS) {
            return;
        }
        io_ros2_wait(node, PAUSE_MS);
    }
}

rlf_result io_ros2_find_camera(io_ros2_node *node, const char *source, const io_ros2_wish *wish,
                               io_ros2_found *out)
{
    io_ros2_topic *topics = rlf_alloc_array(IO_ROS2_TOPICS_MAX, sizeof(topics[0]));
    int32_t chosen[IO_ROS2_CHANNELS_MAX];
    int32_t count = 0;
    rlf_result result = topics != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    if (result == RLF_OK) {
        count = discover(node, wish, FIND_NS, topics);
        result =
            io_ros2_has_depth(topics, count, wish) ? RLF_OK : fail_absent(source, topics, count);
    }
    const int32_t wanted =
        result == RLF_OK ? io_ros2_choose_topics(topics, count, wish, chosen, IO_ROS2_CHANNELS_MAX)
                         : 0;
    for (int32_t i = 0; i < wanted && result == RLF_OK; i++) {
        result = open_channel(node, &topics[chosen[i]], out);
    }
    rlf_free(topics);
    if (result == RLF_OK) {
        listen(node, out);
    }
    return result;
}

void io_ros2_found_free(io_ros2_found *g)
{
    for (int32_t i = 0; i < g->count; i++) {
        io_ros2_channel *c = &g->channels[i];
        for (int32_t k = 0; k < c->kept; k++) {
            io_ros2_release(&c->messages[k]);
        }
        io_ros2_reader_close(&c->reader);
    }
    g->count = 0;
}

/* ---- as a log ------------------------------------------------------------------------------- */

/* Of message k of channel i the place is i and k. */
static rlf_result read_message(void *self, const io_ros_message *message, io_cdr_reader *out)
{
    const io_ros2_found *g = self;
    const io_ros2_message *m = &g->channels[message->chunk].messages[message->offset];
    *out = io_cdr_open(m->data, m->size);
    return RLF_OK;
}

rlf_result io_ros2_found_log(io_ros2_found *g, const char *source, io_ros_log *out)
{
    *out = (io_ros_log){.name = source, .is_live = true, .self = g, .read = read_message};
    for (int32_t i = 0; i < g->count; i++) {
        const io_ros2_channel *c = &g->channels[i];
        io_ros_log_add_channel(out, (uint32_t)i, c->type, c->topic.name, INT32_MAX);
        for (int32_t k = 0; k < c->kept; k++) {
            io_ros_log_add_message(out, (uint32_t)i, c->messages[k].sent_ns, i, (uint64_t)k);
        }
    }
    return io_ros_log_sort(out);
}

/* ---- cameras that run ------------------------------------------------------------------------ */

static bool is_listed(const rlf_source_entry *out, int32_t count, const char *source)
{
    for (int32_t i = 0; i < count; i++) {
        if (strcmp(out[i].source, source) == 0) {
            return true;
        }
    }
    return false;
}

static int32_t list_cameras(const io_ros2_topic *topics, int32_t topic_count, rlf_source_entry *out,
                            int32_t capacity)
{
    int32_t count = 0;
    for (int32_t i = 0; i < topic_count && count < capacity; i++) {
        char camera[IO_ROS2_TOPIC_MAX];
        char source[sizeof(out[0].source)];
        if (!io_ros2_camera_of(&topics[i], camera, sizeof(camera))) {
            continue;
        }
        snprintf(source, sizeof(source), "ros2:%.240s", camera[0] != '\0' ? camera : "/");
        if (!is_listed(out, count, source)) {
            memcpy(out[count].source, source, sizeof(source));
            snprintf(out[count].description, sizeof(out[count].description),
                     "ROS 2 camera, depth %.90s", topics[i].name);
            count++;
        }
    }
    return count;
}

int32_t io_ros2_list(rlf_source_entry *out, int32_t capacity)
{
    io_ros2_topic *topics = rlf_alloc_array(IO_ROS2_TOPICS_MAX, sizeof(topics[0]));
    io_ros2_place place;
    io_ros2_node *node = NULL;
    if (topics == NULL || capacity < 1 ||
        io_ros2_place_read("ros2", NULL, NULL, &place) != RLF_OK ||
        io_ros2_node_open("ros2", &place, &node) != RLF_OK) {
        rlf_free(topics);
        return 0;
    }
    const int32_t count = discover(node, NULL, LIST_NS, topics);
    const int32_t found = list_cameras(topics, count, out, capacity);
    io_ros2_node_close(&node);
    rlf_free(topics);
    return found;
}
