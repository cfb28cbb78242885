/* A grid point and its neighbours, for the thesis's normal methods. */
#ifndef RLF_SURFACE_NORMALS_LOCAL_H
#define RLF_SURFACE_NORMALS_LOCAL_H

#include "surface/steps.h"

typedef struct rlf_local {
    rlf_vec3 centre, sum;
    rlf_vec3 point[6]; /* up, up-right, right, down, down-left, left */
    bool inside[6];    /* of the grid */
    bool valid[6];     /* inside and not missing */
} rlf_local;

static inline rlf_vec3 rlf_local_point(const rlf_normals_job *job, int32_t i)
{
    double z = job->depth[i];
    return rlf_vec3_make(z * job->ray_x[i], z * job->ray_y[i], z);
}

static inline void rlf_local_write(const rlf_normals_job *job, int32_t i, bool complete,
                                   rlf_vec3 sum)
{
    rlf_vec3 n = complete ? rlf_normalize(sum) : rlf_vec3_make(0, 0, 0);
    job->out[0][i] = (float)n.x;
    job->out[1][i] = (float)n.y;
    job->out[2][i] = (float)n.z;
}

/* Fills everything but the sum, which becomes 0. False when the point itself is missing. */
bool rlf_local_gather(const rlf_normals_job *job, int32_t x, int32_t y, rlf_local *local);
/* Add the faces to the sum; false when one of them lacks a corner that lies inside the grid. */
bool rlf_local_six_faces(rlf_local *local);
bool rlf_local_four_faces(rlf_local *local);

#endif
