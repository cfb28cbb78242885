/* Messages of pictures that are not read: named, so that nobody looks for the fault elsewhere. */
#include "io/ros/recording.h"

#include <stdio.h>
#include <string.h>

bool io_ros_is_stranger(const char *type)
{
    static const char *const words[] = {"Image", "Disparity", "PointCloud", "RGBD",
                                        "Depth", "FFMPEG",    "Video",      "theora"};
    for (size_t i = 0; i < sizeof(words) / sizeof(words[0]); i++) {
        if (strstr(type, words[i]) != NULL) {
            return true;
        }
    }
    return false;
}

void io_ros_add_stranger(char *out, size_t size, const char *topic, const char *type,
                         const char *encoding)
{
    char text[256];
    const size_t length = strlen(out);
    snprintf(text, sizeof(text), " %.120s (%.60s%s%.20s)", topic, type,
             encoding[0] != '\0' ? ", " : "", encoding);
    if (strstr(out, text) == NULL && length + strlen(text) + 2 < size) {
        snprintf(out + length, size - length, "%s%s", length > 0 ? "," : "", text);
    }
}
