/* Eq. 4.3: the normal from the depths of the four neighbours, as the thesis has it.
 *
 * In this library's frame (y down, z forward) N = ((R_z - L_z)/dx, (D_z - U_z)/dy, -2) with
 * dx = (R_x - L_x)/2 and dy = (D_y - U_y)/2. It ignores perspective (errata 1): exact at the image
 * centre and for slopes along one axis. Borders and corners use faces (fig. 4.8). */
#include "surface/normals/local.h"

enum { UP = 0, RIGHT = 2, DOWN = 3, LEFT = 5 };

static bool is_interior(const rlf_local *local)
{
    return local->inside[UP] && local->inside[RIGHT] && local->inside[DOWN] && local->inside[LEFT];
}

static bool cardinal_slopes(rlf_local *local)
{
    const rlf_vec3 *p = local->point;
    if (!local->valid[UP] || !local->valid[RIGHT] || !local->valid[DOWN] || !local->valid[LEFT]) {
        return false;
    }
    double dx = 0.5 * (p[RIGHT].x - p[LEFT].x);
    double dy = 0.5 * (p[DOWN].y - p[UP].y);
    if (dx == 0.0 || dy == 0.0) {
        return false;
    }
    local->sum = rlf_vec3_make((p[RIGHT].z - p[LEFT].z) / dx, (p[DOWN].z - p[UP].z) / dy, -2.0);
    return true;
}

void rlf_normals_thesis(const rlf_normals_job *job)
{
    for (int32_t y = 0; y < job->height; y++) {
        for (int32_t x = 0; x < job->width; x++) {
            rlf_local local;
            bool complete = rlf_local_gather(job, x, y, &local);
            if (complete) {
                complete =
                    is_interior(&local) ? cardinal_slopes(&local) : rlf_local_four_faces(&local);
            }
            rlf_local_write(job, y * job->width + x, complete, local.sum);
        }
    }
}
