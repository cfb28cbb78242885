/* The cameras of a bag. */
#ifndef RLF_IO_ROSBAG_BAG_RIG_H
#define RLF_IO_ROSBAG_BAG_RIG_H

#include "io/rosbag/topics.h"
#include "relief/backend.h"

typedef struct bag_rig {
    rlf_rig rig;
    double units_per_metre; /* of 16-bit counts */
    bool is_aligned;        /* depth and colour are of one camera */
    char device[128];
} bag_rig;

/* From CameraInfo and transforms, unless the user gave a calibration or one is beside the file. */
rlf_result bag_rig_read(const rlf_address *address, const bag_topics *topics, bag_rig *out);

#endif
