/* Cameras that run, by discovery. */
#define _POSIX_C_SOURCE 200809L
#include "io/ros2/gather.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#define MS INT64_C(1000000)
#define WAIT_NS (180 * MS)  /* all in all */
#define SETTLE_NS (60 * MS) /* after the last one that was heard of */
#define PAUSE_NS (10 * MS)

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
    const int64_t begin_ns = rlf_clock_ns();
    int64_t changed_ns = begin_ns;
    int32_t count = 0;
    for (;;) {
        const int32_t now_count = io_ros2_discover(node, topics, IO_ROS2_TOPICS_MAX);
        const int64_t now_ns = rlf_clock_ns();
        changed_ns = now_count != count ? now_ns : changed_ns;
        count = now_count;
        const bool is_settled = count > 0 && now_ns - changed_ns >= SETTLE_NS;
        if (is_settled || now_ns - begin_ns >= WAIT_NS) {
            break;
        }
        const struct timespec rest = {.tv_nsec = PAUSE_NS};
        nanosleep(&rest, NULL);
    }
    const int32_t found = list_cameras(topics, count, out, capacity);
    io_ros2_node_close(&node);
    rlf_free(topics);
    return found;
}
