/* Frames from ROS 1 bags, and from the bags that librealsense records. */
#include "io/number.h"
#include "io/picture/picture.h"
#include "io/pixels/compressed_depth.h"
#include "io/rosbag/bag_rig.h"
#include "io/source/backends.h"
#include "io/clip/clip.h"
#include "io/clip/pairing.h"

#include <stdlib.h>
#include <string.h>

#define COLOR_GAP_NS 50000000 /* what the clip allows when nothing is said */

/* A picture's entry and its time. */
typedef struct shot {
    int64_t time_ns;
    int32_t entry;
} shot;

typedef struct stream {
    shot *pictures;
    int64_t *times;
    int32_t count;
    message_kind kind;
} stream;

typedef struct rosbag {
    bag *bag;
    stream depth, color;
    rlf_rig rig;
    double units_per_metre;
    io_rvl rvl;
} rosbag;

static rlf_result read_image(rosbag *self, const stream *s, int32_t index, message_image *out)
{
    io_bytes message;
    rlf_result result =
        bag_message(self->bag, bag_entry_at(self->bag, s->pictures[index].entry), &message);
    return result == RLF_OK ? message_read_image(&message, s->kind, out) : result;
}

static rlf_result check_size(const rosbag *self, const io_pixels *p)
{
    const rlf_camera *camera = &self->rig.depth;
    if (p->width == camera->width && p->height == camera->height) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: the depth pictures are %lld x %lld but the calibration is for %d x %d: "
                    "give the right one with ?camera=FILE",
                    p->name, (long long)p->width, (long long)p->height, (int)camera->width,
                    (int)camera->height);
}

static rlf_result read_depth(void *context, int32_t index, void *out)
{
    rosbag *self = context;
    message_image image;
    double units = 0.0;
    rlf_result result = read_image(self, &self->depth, index, &image);
    if (result != RLF_OK) {
        return result;
    }
    if (image.is_compressed) {
        return io_compressed_depth_decode(&self->rvl, &image.file, image.encoding,
                                          self->rig.depth.width, self->rig.depth.height, out,
                                          &units);
    }
    image.pixels.encoding = image.encoding;
    result = check_size(self, &image.pixels);
    return result == RLF_OK ? io_pixels_to_depth(&image.pixels, out, &units) : result;
}

static rlf_result read_color(void *context, int32_t index, const rlf_image_rgba8 *out)
{
    rosbag *self = context;
    message_image image;
    rlf_result result = read_image(self, &self->color, index, &image);
    if (result != RLF_OK) {
        return result;
    }
    if (!image.is_compressed) {
        image.pixels.encoding = image.encoding;
        return io_pixels_to_rgba(&image.pixels, out);
    }
    io_picture picture = {
        .width = out->width, .height = out->height, .data = out->data, .is_opaque = true};
    return io_picture_decode(&image.file, &picture);
}

static void free_stream(stream *s)
{
    rlf_free(s->pictures);
    rlf_free(s->times);
}

static void rosbag_destroy(void *context)
{
    rosbag *self = context;
    bag_close(&self->bag);
    free_stream(&self->depth);
    free_stream(&self->color);
    rlf_free(self);
}

static int compare_pictures(const void *a, const void *b)
{
    const shot *x = a;
    const shot *y = b;
    if (x->time_ns != y->time_ns) {
        return x->time_ns < y->time_ns ? -1 : 1;
    }
    return (x->entry > y->entry) - (x->entry < y->entry);
}

/* When the camera took the pictures; when they were recorded where that costs too much to find out.
 */
static bool read_stamps(rosbag *self, stream *s)
{
    for (int32_t i = 0; i < s->count; i++) {
        io_bytes message;
        int64_t stamp = 0;
        if (bag_message(self->bag, bag_entry_at(self->bag, s->pictures[i].entry), &message) !=
                RLF_OK ||
            !message_read_time(&message, &stamp) || stamp <= 0) {
            return false;
        }
        s->times[i] = stamp;
    }
    return true;
}

static rlf_result list_pictures(rosbag *self, int32_t connection, stream *s)
{
    const bag_connection *c = connection >= 0 ? bag_connection_at(self->bag, connection) : NULL;
    s->count = 0;
    s->kind = c != NULL ? message_kind_of(c->type) : MESSAGE_OTHER;
    const size_t room = c != NULL ? (size_t)c->count : 0;
    s->pictures = rlf_alloc_array(room, sizeof(s->pictures[0]));
    s->times = rlf_alloc_array(room, sizeof(s->times[0]));
    if (s->pictures == NULL || s->times == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; c != NULL && i < bag_entry_count(self->bag); i++) {
        const bag_entry *entry = bag_entry_at(self->bag, i);
        if (entry->connection == connection) {
            s->pictures[s->count++] = (shot){entry->time_ns, i};
        }
    }
    return RLF_OK;
}

/* Stamps of both streams, or of none: the clocks need not agree. */
static void use_stamps(rosbag *self)
{
    if (!bag_is_fast(self->bag) || !read_stamps(self, &self->depth) ||
        !read_stamps(self, &self->color)) {
        return;
    }
    stream *const streams[2] = {&self->depth, &self->color};
    for (int k = 0; k < 2; k++) {
        for (int32_t i = 0; i < streams[k]->count; i++) {
            streams[k]->pictures[i].time_ns = streams[k]->times[i];
        }
    }
}

static void sort_pictures(stream *s)
{
    if (s->count > 0) {
        qsort(s->pictures, (size_t)s->count, sizeof(s->pictures[0]), compare_pictures);
    }
    for (int32_t i = 0; i < s->count; i++) {
        s->times[i] = s->pictures[i].time_ns;
    }
}

static rlf_result list_all(rosbag *self, const bag_topics *topics)
{
    const int32_t color = self->rig.has_color ? topics->connections[topics->color] : -1;
    rlf_result result = list_pictures(self, topics->connections[topics->depth], &self->depth);
    if (result == RLF_OK) {
        result = list_pictures(self, color, &self->color);
    }
    if (result == RLF_OK) {
        use_stamps(self);
        sort_pictures(&self->depth);
        sort_pictures(&self->color);
    }
    return result;
}

/* A calibration that the user gave, or that lies beside the file, may be of other pictures. */
static rlf_result check_rig(const rosbag *self, const bag_topics *topics)
{
    const io_ros_topic *d = &topics->pictures[topics->depth];
    const io_pixels depth = {.name = d->name, .width = d->width, .height = d->height};
    rlf_result result = check_size(self, &depth);
    if (result != RLF_OK || !self->rig.has_color) {
        return result;
    }
    const io_ros_topic *c = &topics->pictures[topics->color];
    const rlf_camera *camera = &self->rig.color;
    return c->width == camera->width && c->height == camera->height
               ? RLF_OK
               : io_picture_fail_size(c->name, c->width, c->height, camera->width, camera->height);
}

static rlf_result read_gap(const rlf_address *address, int64_t *out_ns)
{
    const char *text = rlf_address_get(address, "gap");
    double ms = 0.0;
    if (text == NULL) {
        return RLF_OK;
    }
    if (!io_number_parse(text, &ms) || !(ms > 0.0 && ms <= 1e6)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: gap=%.40s: give the milliseconds, > 0, by which a colour picture may "
                        "be away from its depth",
                        address->source, text);
    }
    *out_ns = (int64_t)(ms * 1e6);
    return RLF_OK;
}

/* A recording whose colour is never near its depth would show none, and not say why. */
static void warn_unpaired(const char *name, const rosbag *self, int64_t gap_ns)
{
    int64_t nearest = INT64_MAX;
    for (int32_t i = 0; i < self->depth.count; i++) {
        const int64_t time = self->depth.times[i];
        const int32_t at =
            io_time_nearest(self->color.times, self->color.count, time, INT64_MAX - 1);
        const int64_t gap = at >= 0 ? llabs(self->color.times[at] - time) : nearest;
        nearest = gap < nearest ? gap : nearest;
    }
    if (self->color.count > 0 && nearest > gap_ns) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the colour pictures are %lld ms or more away from the depth, so none is "
                "shown: ?gap=MS allows more",
                name, (long long)(nearest / 1000000));
    }
}

static rlf_result open_clip(const rlf_address *address, rosbag *self, const bag_topics *topics,
                            bool is_aligned, rlf_opened *out)
{
    const bool is_float = strncmp(topics->pictures[topics->depth].encoding, "32FC1", 5) == 0;
    int64_t gap_ns = COLOR_GAP_NS;
    rlf_result result = read_gap(address, &gap_ns);
    if (result == RLF_OK) {
        result = check_rig(self, topics);
    }
    if (result != RLF_OK) {
        return result;
    }
    warn_unpaired(address->source, self, gap_ns);
    const io_clip_def def = {.name = address->place,
                             .rig = self->rig,
                             .units_per_metre =
                                 is_float ? IO_PIXELS_FLOAT_UNITS : self->units_per_metre,
                             .depth_times = self->depth.times,
                             .color_times = self->color.times,
                             .depth_count = self->depth.count,
                             .color_count = self->color.count,
                             .color_gap_max_ns = gap_ns,
                             .flags = is_aligned ? RLF_FRAME_ALIGNED : 0,
                             .read_depth = read_depth,
                             .read_color = read_color,
                             .destroy = rosbag_destroy,
                             .self = self};
    return io_clip_open(&def, out);
}

static rlf_result open_topics(const rlf_address *address, rosbag *self, bag_topics *topics,
                              rlf_opened *out)
{
    bag_rig rig;
    rlf_result result =
        io_ros_choose(&topics->lists, rlf_address_get(address, "depth"),
                      rlf_address_get(address, "color"), &topics->depth, &topics->color);
    if (result == RLF_OK) {
        result = bag_rig_read(address, topics, &rig);
    }
    if (result != RLF_OK) {
        return result;
    }
    self->rig = rig.rig;
    self->rig.has_color = rig.rig.has_color && topics->color >= 0;
    self->units_per_metre = rig.units_per_metre;
    result = list_all(self, topics);
    if (result == RLF_OK) {
        result = open_clip(address, self, topics, rig.is_aligned, out);
    }
    if (result == RLF_OK) {
        memcpy(out->info.device, rig.device, sizeof(out->info.device));
    }
    return result;
}

static rlf_result open_all(const rlf_address *address, rosbag *self, rlf_opened *out)
{
    rlf_result result = bag_open(address->place, &self->bag);
    if (result == RLF_OK) {
        bag_topics_mark(self->bag);
        result = bag_index(self->bag);
    }
    if (result == RLF_OK) {
        bag_topics topics;
        result = bag_topics_read(self->bag, address->place, &topics);
        if (result == RLF_OK) {
            result = open_topics(address, self, &topics, out);
        }
        bag_topics_free(&topics);
    }
    return result;
}

static rlf_result rosbag_open(const rlf_address *address, rlf_opened *out)
{
    rosbag *self = rlf_alloc(sizeof(*self));
    if (self == NULL) {
        return RLF_ERROR_MEMORY;
    }
    io_rvl_init(&self->rvl);
    rlf_result result = open_all(address, self, out);
    if (result != RLF_OK) {
        rosbag_destroy(self);
    }
    return result;
}

const rlf_backend io_backend_rosbag = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "rosbag",
    .extensions = ".bag",
    .keys = "depth color gap",
    .summary = "a recording: ROS 1 or RealSense .bag (depth=TOPIC color=TOPIC gap=MS)",
    .open = rosbag_open,
};
