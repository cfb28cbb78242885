/* `relief fuse --picture`: the room that was fused, and the camera's way in it. */
#ifndef RELIEF_APP_FUSE_PICTURE_H
#define RELIEF_APP_FUSE_PICTURE_H

#include "fuse/fuser.h"
#include "fuse/trajectory.h"

/* After at least one frame. */
rlf_result fuse_picture_write(const char *path, const fuser *f, const trajectory *way,
                              const rlf_orbit *orbit, rlf_pool *pool);

#endif
