/* What a fusion has seen and done, and why nothing came of it. */
#ifndef RELIEF_APP_FUSE_TALLY_H
#define RELIEF_APP_FUSE_TALLY_H

#include "fuse/fuser.h"

typedef struct fuse_tally {
    const char *source;
    bool is_tracked;
    int64_t seen, fused, without_pose, without_depth;           /* frames */
    int64_t near_pixels, far_pixels, lost_pixels, whole_pixels; /* until one has depth */
    double source_ms, surface_ms, track_ms, map_ms;             /* sums */
} fuse_tally;

/* A frame that went through the fuser. */
void fuse_tally_add(fuse_tally *t, const fuser *f);
/* RLF_ERROR_INVALID with the reason when the map is empty. */
rlf_result fuse_tally_check(const fuse_tally *t, const fuser *f);
/* RLF_ERROR_INVALID with the reason when a mesh of the map is empty; `mesh` stays the caller's. */
rlf_result fuse_tally_check_mesh(const fuse_tally *t, const fuser *f, int32_t min_weight,
                                 const rlf_map_mesh *mesh);
/* The weight below which a mesh of so many frames leaves voxels out. */
int32_t fuse_tally_min_weight(const fuse_tally *t);

#endif
