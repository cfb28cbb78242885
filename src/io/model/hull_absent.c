/* Stands in for hull_qhull.c where it is not built. */
#include "io/model/hull.h"

#include "base/messages.h"

rlf_result io_hull_wrap(const char *name, const rlf_vec3 *points, int32_t count, io_mesh *out)
{
    (void)points;
    (void)count;
    *out = (io_mesh){0};
    return rlf_fail(
        RLF_ERROR_UNSUPPORTED,
        "%s: no hull can be made around points by this build: give a convex OBJ, or " RLF_GET_PART(
            "libqhull-dev", "script/bootstrap", "RELIEF_WITH_QHULL"),
        name);
}
