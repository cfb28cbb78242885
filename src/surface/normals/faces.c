/* Normals from a point and its neighbours (thesis 4.1.2).
 *
 * Six faces: the mean weighted equally of the unit normals of the mesh triangles that meet in the
 * point (eq. 4.2; Gouraud 1971; Jin et al. 2005); at borders and corners the triangles that exist.
 * Four faces: up-left, left-down, down-right and right-up (fig. 4.7), summed as cross products as
 * in appendix B; at borders and corners by the rules of fig. 4.8.
 * A missing neighbour that a rule needs leaves the point without a normal: a face with an invented
 * corner would be wrong.
 *
 * Eq. 4.3: the normal from the depths of the four neighbours, as the thesis has it. In this
 * library's frame (y down, z forward) N = ((R_z - L_z)/dx, (D_z - U_z)/dy, -2) with
 * dx = (R_x - L_x)/2 and dy = (D_y - U_y)/2. It ignores perspective (errata 1): exact at the image
 * centre and for slopes along one axis. Borders and corners use faces (fig. 4.8). */
#include "surface/steps.h"

enum { UP, UP_RIGHT, RIGHT, DOWN, DOWN_LEFT, LEFT };

/* A grid point and its neighbours. */
typedef struct local_point {
    rlf_vec3 centre, sum;
    rlf_vec3 point[6]; /* up, up-right, right, down, down-left, left */
    bool inside[6];    /* of the grid */
    bool valid[6];     /* inside and not missing */
} local_point;

static rlf_vec3 point_at(const rlf_normals_job *job, int32_t i)
{
    double z = job->depth[i];
    return rlf_vec3_make(z * job->ray_x[i], z * job->ray_y[i], z);
}

static void write_normal(const rlf_normals_job *job, int32_t i, bool complete, rlf_vec3 sum)
{
    rlf_vec3 n = complete ? rlf_normalize(sum) : rlf_vec3_make(0, 0, 0);
    job->out[0][i] = (float)n.x;
    job->out[1][i] = (float)n.y;
    job->out[2][i] = (float)n.z;
}

/* Neighbours in clockwise order as seen in the image; consecutive ones span a mesh triangle. */
static const int32_t ring_dx[6] = {0, 1, 1, 0, -1, -1};
static const int32_t ring_dy[6] = {-1, -1, 0, 1, 1, 0};

/* Adds the face (p, a, b). False when a corner is missing. */
static bool add_face(local_point *local, int a, int b, bool unit)
{
    if (!local->valid[a] || !local->valid[b]) {
        return false;
    }
    rlf_vec3 face =
        rlf_cross(rlf_sub(local->point[a], local->centre), rlf_sub(local->point[b], local->centre));
    local->sum = rlf_add(local->sum, unit ? rlf_normalize(face) : face);
    return true;
}

/* Fills everything but the sum, which becomes 0. False when the point itself is missing. */
static bool gather(const rlf_normals_job *job, int32_t x, int32_t y, local_point *local)
{
    int32_t i = y * job->width + x;
    local->sum = rlf_vec3_make(0, 0, 0);
    local->centre = point_at(job, i);
    for (int k = 0; k < 6; k++) {
        int32_t nx = x + ring_dx[k];
        int32_t ny = y + ring_dy[k];
        local->inside[k] = nx >= 0 && nx < job->width && ny >= 0 && ny < job->height;
        int32_t n = ny * job->width + nx;
        local->valid[k] = local->inside[k] && job->depth[n] > 0.0f;
        local->point[k] = local->valid[k] ? point_at(job, n) : rlf_vec3_make(0, 0, 0);
    }
    return job->depth[i] > 0.0f;
}

/* Adds the faces to the sum; false when one lacks a corner that lies inside the grid. */
static bool six_faces(local_point *local)
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

static bool four_faces(local_point *local)
{
    static const int cardinal[4] = {UP, RIGHT, DOWN, LEFT};
    int inside = 0;
    for (int k = 0; k < 4; k++) {
        inside += local->inside[cardinal[k]];
    }
    if (inside <= 2) { /* a corner of the grid: its mesh triangles, diagonal included */
        return six_faces(local);
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

static bool is_interior(const local_point *local)
{
    return local->inside[UP] && local->inside[RIGHT] && local->inside[DOWN] && local->inside[LEFT];
}

static bool cardinal_slopes(local_point *local)
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

/* Eq. 4.3. */
static bool cardinal_or_faces(local_point *local)
{
    return is_interior(local) ? cardinal_slopes(local) : four_faces(local);
}

void rlf_normals_local(const rlf_normals_job *job)
{
    bool (*const methods[])(local_point *) = {[RLF_NORMALS_SIX_FACES] = six_faces,
                                              [RLF_NORMALS_FOUR_FACES] = four_faces,
                                              [RLF_NORMALS_THESIS] = cardinal_or_faces};
    for (int32_t y = 0; y < job->height; y++) {
        for (int32_t x = 0; x < job->width; x++) {
            local_point local;
            bool complete = gather(job, x, y, &local) && methods[job->method](&local);
            write_normal(job, y * job->width + x, complete, local.sum);
        }
    }
}
