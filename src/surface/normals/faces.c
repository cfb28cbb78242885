/* Normals from the faces about a point (thesis 4.1.2).
 *
 * Six faces: the mean weighted equally of the unit normals of the mesh triangles that meet in the
 * point (eq. 4.2; Gouraud 1971; Jin et al. 2005); at borders and corners the triangles that exist.
 * Four faces: up-left, left-down, down-right and right-up (fig. 4.7), summed as cross products as
 * in appendix B; at borders and corners by the rules of fig. 4.8.
 * A missing neighbour that a rule needs leaves the point without a normal: a face with an invented
 * corner would be wrong. */
#include "surface/normals/local.h"

enum { UP, UP_RIGHT, RIGHT, DOWN, DOWN_LEFT, LEFT };

/* Neighbours in clockwise order as seen in the image; consecutive ones span a mesh triangle. */
static const int32_t ring_dx[6] = {0, 1, 1, 0, -1, -1};
static const int32_t ring_dy[6] = {-1, -1, 0, 1, 1, 0};

/* Adds the face (p, a, b). False when a corner is missing. */
static bool add_face(rlf_local *local, int a, int b, bool unit)
{
    if (!local->valid[a] || !local->valid[b]) {
        return false;
    }
    rlf_vec3 face =
        rlf_cross(rlf_sub(local->point[a], local->centre), rlf_sub(local->point[b], local->centre));
    local->sum = rlf_add(local->sum, unit ? rlf_normalize(face) : face);
    return true;
}

bool rlf_local_gather(const rlf_normals_job *job, int32_t x, int32_t y, rlf_local *local)
{
    int32_t i = y * job->width + x;
    local->sum = rlf_vec3_make(0, 0, 0);
    local->centre = rlf_local_point(job, i);
    for (int k = 0; k < 6; k++) {
        int32_t nx = x + ring_dx[k];
        int32_t ny = y + ring_dy[k];
        local->inside[k] = nx >= 0 && nx < job->width && ny >= 0 && ny < job->height;
        int32_t n = ny * job->width + nx;
        local->valid[k] = local->inside[k] && job->depth[n] > 0.0f;
        local->point[k] = local->valid[k] ? rlf_local_point(job, n) : rlf_vec3_make(0, 0, 0);
    }
    return job->depth[i] > 0.0f;
}

bool rlf_local_six_faces(rlf_local *local)
{
    bool complete = true;
    for (int k = 0; k < 6; k++) {
        int next = (k + 1) % 6;
        if (local->inside[k] && local->inside[next]) {
            complete = add_face(local, k, next, true) && complete;
        }
    }
    return complete;
}

bool rlf_local_four_faces(rlf_local *local)
{
    static const int cardinal[4] = {UP, RIGHT, DOWN, LEFT};
    int inside = 0;
    for (int k = 0; k < 4; k++) {
        inside += local->inside[cardinal[k]];
    }
    if (inside <= 2) { /* a corner of the grid: its mesh triangles, diagonal included */
        return rlf_local_six_faces(local);
    }
    bool complete = true;
    for (int k = 0; k < 4; k++) {
        int a = cardinal[k];
        int b = cardinal[(k + 1) % 4];
        if (local->inside[a] && local->inside[b]) {
            complete = add_face(local, a, b, false) && complete;
        }
    }
    return complete;
}

void rlf_normals_faces(const rlf_normals_job *job)
{
    for (int32_t y = 0; y < job->height; y++) {
        for (int32_t x = 0; x < job->width; x++) {
            rlf_local local;
            bool complete = rlf_local_gather(job, x, y, &local);
            if (complete) {
                complete = job->method == RLF_NORMALS_SIX_FACES ? rlf_local_six_faces(&local)
                                                                : rlf_local_four_faces(&local);
            }
            rlf_local_write(job, y * job->width + x, complete, local.sum);
        }
    }
}
