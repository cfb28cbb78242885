/* The parts that a build may lack: which it has, and how to get the others. */
#ifndef RELIEF_APP_PARTS_H
#define RELIEF_APP_PARTS_H

#include <stdbool.h>

typedef enum part {
    PART_WINDOW,
    PART_PANEL,
    PART_OPENGL,
    PART_MP4,
    PART_PIPEWIRE,
    PART_HULLS,
    PART_MCAP,
    PART_LZ4,
    PART_BZ2,
    PART_OPENNI2,
    PART_FREENECT,
    PART_FREENECT2,
    PART_WEBSOCKET,
    PART_OSC,
    PART_ROS2,
    PART_OPENCV,
    PART_COUNT
} part;

bool part_is_built(part which);
/* "install ... and build again": the packages, and the commands that bring it. */
const char *part_cure(part which);
/* On standard output: those that the build has, and a line for each that it lacks. */
void parts_print(void);

#endif
