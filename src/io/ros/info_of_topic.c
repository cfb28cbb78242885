/* The calibration of a topic of pictures. */
#include "io/ros/recording.h"

#include <stdio.h>
#include <string.h>

typedef enum match {
    MATCH_NONE,
    MATCH_SIZE,  /* of pictures as large */
    MATCH_FRAME, /* of the same frame_id */
    MATCH_BESIDE /* of the same folder of topics */
} match;

/* How long the folder of a topic is. */
static size_t folder_of(const char *topic, size_t length)
{
    while (length > 0 && topic[length - 1] != '/') {
        length--;
    }
    return length > 0 ? length - 1 : 0;
}

static bool is_folder(const char *folder, size_t length, const char *topic, size_t topic_length)
{
    return length == topic_length && length > 0 && memcmp(folder, topic, length) == 0;
}

/* Drivers put a camera's calibration into the folder of its pictures. Compressed ones are one
 * further in: "/camera/depth/camera_info", "/camera/depth/image_raw/compressedDepth". librealsense
 * has "Depth_0/info/camera_info" and "Depth_0/image/data". Some have it below the pictures' topic.
 */
static bool is_beside(const char *info, const char *topic)
{
    size_t length = folder_of(info, strlen(info));
    if (length >= 5 && memcmp(info + length - 5, "/info", 5) == 0) {
        length -= 5;
    }
    const size_t whole = strlen(topic);
    const size_t folder = folder_of(topic, whole);
    const char *last = topic + (folder < whole ? folder + 1 : whole);
    const bool is_further_in = strncmp(last, "compressed", 10) == 0 || strcmp(last, "data") == 0;
    return is_folder(info, length, topic, whole) || is_folder(info, length, topic, folder) ||
           (is_further_in && is_folder(info, length, topic, folder_of(topic, folder)));
}

static bool fits(const io_camera_info *info, const io_ros_topic *picture)
{
    int32_t width, height;
    return io_camera_info_size(info, &width, &height) && width == picture->width &&
           height == picture->height;
}

static match match_of(const io_ros_info_topic *info, const io_ros_topic *picture)
{
    if (is_beside(info->name, picture->name)) {
        return MATCH_BESIDE;
    }
    const bool is_same = strcmp(info->info.frame_id, picture->frame_id) == 0;
    return is_same && picture->frame_id[0] != '\0' ? MATCH_FRAME : MATCH_SIZE;
}

/* The best one that fits; -1 = none does. */
static int32_t find(const io_ros_topics *topics, const io_ros_topic *picture, match *out_match)
{
    int32_t found = -1;
    *out_match = MATCH_NONE;
    for (int32_t i = 0; i < topics->info_count; i++) {
        const io_ros_info_topic *info = &topics->infos[i];
        const match value = fits(&info->info, picture) ? match_of(info, picture) : MATCH_NONE;
        if (value > *out_match) {
            *out_match = value;
            found = i;
        }
    }
    return found;
}

/* The calibration beside the pictures, fitting or not; NULL when there is none. */
static const io_ros_info_topic *own_of(const io_ros_topics *topics, const io_ros_topic *picture)
{
    for (int32_t i = 0; i < topics->info_count; i++) {
        if (is_beside(topics->infos[i].name, picture->name)) {
            return &topics->infos[i];
        }
    }
    return NULL;
}

bool io_ros_has_info(const io_ros_topics *topics, const io_ros_topic *picture)
{
    match how;
    find(topics, picture, &how);
    return how >= MATCH_FRAME;
}

int32_t io_ros_find_info(const io_ros_topics *topics, const io_ros_topic *picture)
{
    match how;
    char problem[256];
    const int32_t found = find(topics, picture, &how);
    const bool has_own = own_of(topics, picture) != NULL;
    if (how == MATCH_SIZE && has_own) {
        return -1; /* its own says that its lens is another */
    }
    if (how == MATCH_SIZE || how == MATCH_FRAME) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the lens of %s is that of %s, %s: %s; ?camera=FILE gives another",
                topics->name, picture->name, topics->infos[found].name,
                how == MATCH_SIZE ? "another camera with pictures of that size"
                                  : "which is of the same frame_id",
                io_ros_tell_info(topics, picture, problem, sizeof(problem)));
    }
    return found;
}

const char *io_ros_tell_info(const io_ros_topics *topics, const io_ros_topic *picture, char *out,
                             size_t size)
{
    const io_ros_info_topic *own = own_of(topics, picture);
    int32_t width = 0, height = 0;
    if (own == NULL) {
        snprintf(out, size, "no CameraInfo is beside it");
    } else if (!io_camera_info_size(&own->info, &width, &height)) {
        snprintf(out, size,
                 "the region or the binning of %.80s leaves nothing of its %u x %u pixels",
                 own->name, (unsigned)own->info.width, (unsigned)own->info.height);
    } else if (width == picture->width && height == picture->height) {
        snprintf(out, size, "%.80s is of no use", own->name);
    } else {
        snprintf(out, size, "%.80s describes pictures of %d x %d, and these have %d x %d",
                 own->name, (int)width, (int)height, (int)picture->width, (int)picture->height);
    }
    return out;
}
