/* `relief fuse --picture`: the room that was fused, and the camera's way in it. */
#ifndef RELIEF_APP_FUSE_PICTURE_H
#define RELIEF_APP_FUSE_PICTURE_H

#include "fuse/fuser.h"
#include "pipeline/moving/room_view.h"

/* After at least one frame, all of which `view` has passed. */
rlf_result fuse_picture_write(const char *path, const fuser *f, room_view *view,
                              const rlf_orbit *orbit, rlf_pool *pool);

#endif
