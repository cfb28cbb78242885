/* `relief record SOURCE ros2:/camera`: a machine that lends its camera to others. */
#include "io/ros2/camera_out.h"

#include "io/ros2/gather.h"

#include <stdio.h>
#include <string.h>

typedef struct host {
    io_ros2_node *node;
    io_ros2_camera camera;
    io_ros2_clock clock;
} host;

static rlf_result host_add(void *self, const rlf_frame *frame)
{
    host *h = self;
    const int64_t offset_ns = io_ros2_clock_offset(&h->clock, frame->time_ns, io_ros2_now());
    return io_ros2_camera_send(&h->camera, frame, offset_ns);
}

static uint64_t host_bytes(const void *self)
{
    return ((const host *)self)->camera.bytes;
}

static rlf_result host_close(void *self, rlf_recording_status *status)
{
    host *h = self;
    status->bytes = h->camera.bytes;
    if (h->camera.dropped > 0) {
        rlf_log(RLF_LOG_WARNING, "ros2: %llu messages were not sent: a reader was too slow",
                (unsigned long long)h->camera.dropped);
    }
    io_ros2_node_close(&h->node);
    io_ros2_camera_close(&h->camera);
    rlf_free(h);
    return RLF_OK;
}

static rlf_result open_all(host *h, const char *path, const rlf_source_info *info,
                           const rlf_recording_def *def)
{
    io_ros2_target target;
    rlf_result result = io_ros2_target_read(path, &target);
    result = result == RLF_OK ? io_ros2_node_open(path, &target.place, &h->node) : result;
    return result == RLF_OK ? io_ros2_camera_open(h->node, target.name, &info->rig, def, &h->camera)
                            : result;
}

rlf_result io_ros2_sink_open(const char *path, const rlf_source_info *info,
                             const rlf_recording_def *def, io_sink *out)
{
    host *h = rlf_alloc(sizeof(*h));
    if (h == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = open_all(h, path, info, def);
    if (result != RLF_OK) {
        io_ros2_node_close(&h->node);
        io_ros2_camera_close(&h->camera);
        rlf_free(h);
        return result;
    }
    *out = (io_sink){.add = host_add, .close = host_close, .bytes = host_bytes, .self = h};
    return RLF_OK;
}
