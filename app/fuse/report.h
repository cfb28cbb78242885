/* What `relief fuse` tells while it works and at the end. */
#ifndef RELIEF_APP_FUSE_REPORT_H
#define RELIEF_APP_FUSE_REPORT_H

#include "fuse/tally.h"
#include "fuse/trajectory.h"

typedef struct fuse_progress {
    int64_t last_ns;
    bool is_shown; /* a line on a terminal that is still to be ended */
} fuse_progress;

/* Now and then: on a terminal often, elsewhere seldom. `frame_count` < 0: nobody knows it. */
void fuse_progress_show(fuse_progress *p, const fuse_tally *t, const fuser *f, int64_t frame_count);
/* Ends the line. */
void fuse_progress_end(fuse_progress *p);

/* The summary: frames, map, time, trajectory. */
void fuse_report_print(const fuse_tally *t, const fuser *f, const trajectory *way);
/* The mesh that was written. */
void fuse_report_mesh(const rlf_map_mesh *mesh, int32_t min_weight, const char *path);

#endif
