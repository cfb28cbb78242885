/* Normals at creases.
 *
 * A window across a crease blends two faces. Each of them is known well a few pixels away, and two
 * planes decide which of them a ray meets: on a convex edge the one that it meets last, in a
 * concave corner the one that it meets first. So the crease lies where the planes meet, to a small
 * part of a pixel, whatever the noise of the pixels on it. Unless that is small: a narrow face is
 * known less well than a pixel that has been averaged for a while, which then decides. */
#include "surface/depth_step.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

enum { MOST_STEPS = 6 };

static const float CREASE = 0.9f;      /* of the normals of two faces that meet in one */
static const float MOST_SIGMAS = 8.0f; /* of the pixel's depth from the face; grazing is noisier */
static const float LEAST_APART = 2.0f; /* sigmas of depth from one face to the other */
/* A pixel's own depth speaks for the other face than the planes choose when it is the mean of at
 * least so many frames, it lies at this share of the way or beyond, and the way is longer than so
 * many sigmas of what is left of the noise: of the mean's, and of the planes' in sigmas of one
 * frame.
 */
static const float OWN_FRAMES = 3.0f, OWN_SHARE = 0.75f, OWN_SIGMAS = 2.0f, PLANE_SIGMAS = 0.2f;

typedef struct crease_job {
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const uint8_t *known;       /* 1 where depth was not filled; NULL = nowhere was it */
    const float *mean, *frames; /* of inverse depth over time; NULL = not kept */
    float *const *normal;
    uint8_t *bent; /* plane of RLF_BEND_; pixels where it is 0 are only read */
    const rlf_reconstruct *stage;
    depth_step step;
} crease_job;

static bool is_known(const crease_job *job, ptrdiff_t i)
{
    return job->known == NULL || job->known[i] != 0;
}

static float cosine(const crease_job *job, ptrdiff_t a, ptrdiff_t b)
{
    return job->normal[0][a] * job->normal[0][b] + job->normal[1][a] * job->normal[1][b] +
           job->normal[2][a] * job->normal[2][b];
}

static rlf_kernel_bend_in row_at(const crease_job *job, ptrdiff_t row)
{
    rlf_kernel_bend_in in = {{job->normal[0] + row, job->normal[1] + row, job->normal[2] + row},
                             job->depth + row};
    return in;
}

static void mark_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const crease_job *job = context;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t width = job->width;
        rlf_kernel_bend_in rows[1 + 2 * RLF_KERNEL_BEND_SPAN];
        for (int32_t k = 0; k <= 2 * RLF_KERNEL_BEND_SPAN; k++) {
            int32_t row = y + k - RLF_KERNEL_BEND_SPAN;
            bool inside = row >= 0 && row < job->height;
            rows[k] = row_at(job, (inside ? row : y) * width);
        }
        rlf_kernel_bend_row(rows, job->width, job->bent + y * width);
        if (job->stage->normals.vote.votes != NULL) {
            vote_watch(job->stage, y * width, job->bent + y * width, job->width);
        }
    }
}

/* Steps of (dx, dy) from (x, y) that stay inside the image, at most MOST_STEPS. */
static int32_t room_for(const crease_job *job, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    int32_t room = MOST_STEPS;
    int32_t across = dx < 0 ? x : (dx > 0 ? job->width - 1 - x : room);
    int32_t along = dy < 0 ? y : (dy > 0 ? job->height - 1 - y : room);
    room = across < room ? across : room;
    return along < room ? along : room;
}

static bool is_averaged(const crease_job *job, ptrdiff_t i)
{
    return job->frames != NULL && job->frames[i] >= OWN_FRAMES;
}

/* A face goes on at pixel i. Where it bends, another thread may just be writing the normal, so that
 * it is not read. */
static bool is_wide(const crease_job *job, ptrdiff_t i)
{
    return job->bent[i] != 0 || cosine(job, i, i) > 0.5f;
}

/* The nearest pixel from pixel i in a direction that lies on a face, not on its crease; -1 = none.
 */
static ptrdiff_t find_face(const crease_job *job, ptrdiff_t i, ptrdiff_t step, int32_t room)
{
    float z = job->depth[i];
    for (int32_t k = 1; k <= room; k++) {
        i += step;
        if (depth_step_between(&job->step, job->depth[i], z)) {
            return -1;
        }
        z = job->depth[i];
        if (!job->bent[i]) {
            bool usable = is_known(job, i) && cosine(job, i, i) > 0.5f;
            return usable && (k + 2 > room || is_averaged(job, i) || is_wide(job, i + 2 * step))
                       ? i
                       : -1;
        }
    }
    return -1;
}

/* At pixel a, face b lies so far from face a that noise does not explain it, even if that is alike
 * in all pixels of a face: real sensors' is, and structured light measures in steps, so that the
 * many pixels of a window prove less than their number. `b_at_a` is 0 where b does not meet the
 * ray. */
static bool is_apart(const crease_job *job, ptrdiff_t a, float b_at_a)
{
    float z = job->depth[a];
    return !(b_at_a > 0.0f) ||
           rlf_kernel_abs(b_at_a - z) >= LEAST_APART * rlf_kernel_sigma(job->step.noise, z);
}

/* What has been seen of pixel i over time is at the depth `other`, not where it would be by the
 * planes alone. */
static bool is_elsewhere(const crease_job *job, ptrdiff_t i, float z, float other)
{
    if (!is_averaged(job, i)) {
        return false;
    }
    float own = 1.0f / job->mean[i], apart = other - z;
    float sigma = OWN_SIGMAS * rlf_kernel_sigma(job->step.noise, own);
    float left = 1.0f / job->frames[i] + PLANE_SIGMAS * PLANE_SIGMAS;
    bool matters = apart * apart > sigma * sigma * left;
    return matters && (own - z) * apart > OWN_SHARE * apart * apart;
}

/* Which of two faces pixel i is on; -1 when they do not meet in a crease, or not there. */
static ptrdiff_t choose_face(const crease_job *job, ptrdiff_t i, ptrdiff_t a, ptrdiff_t b)
{
    const rlf_faces faces = {job->ray_x, job->ray_y, job->depth, job->normal};
    float a_at_b = rlf_face_depth(&faces, a, b), b_at_a = rlf_face_depth(&faces, b, a);
    rlf_meeting meeting = rlf_faces_meet(job->depth[a], b_at_a, job->depth[b], a_at_b);
    bool convex = meeting == RLF_FACES_CONVEX;
    if (meeting == RLF_FACES_APART || !is_apart(job, a, b_at_a) || !is_apart(job, b, a_at_b)) {
        return -1;
    }
    float za = rlf_face_depth(&faces, a, i), zb = rlf_face_depth(&faces, b, i);
    if (!(za > 0.0f && zb > 0.0f)) {
        return -1;
    }
    bool first = convex ? za > zb : za < zb;
    first = first != is_elsewhere(job, i, first ? za : zb, first ? zb : za);
    float z = first ? za : zb;
    float most = MOST_SIGMAS * rlf_kernel_sigma(job->step.noise, z);
    return rlf_kernel_abs(z - job->depth[i]) <= most ? (first ? a : b) : -1;
}

/* Looks for the sharpest crease along the row and the column, where it turns there, and along the
 * diagonals where it turns in both. */
static void sharpen_pixel(const crease_job *job, int32_t x, int32_t y)
{
    static const int32_t along_x[4] = {1, 0, 1, 1}, along_y[4] = {0, 1, 1, -1};
    static const uint8_t turned[4] = {RLF_BEND_ACROSS, RLF_BEND_DOWN,
                                      RLF_BEND_ACROSS | RLF_BEND_DOWN,
                                      RLF_BEND_ACROSS | RLF_BEND_DOWN};
    ptrdiff_t i = (ptrdiff_t)y * job->width + x, best = -1;
    float sharpest = CREASE;
    for (int32_t k = 0; k < 4; k++) {
        if ((job->bent[i] & turned[k]) != turned[k]) {
            continue;
        }
        ptrdiff_t step = (ptrdiff_t)along_y[k] * job->width + along_x[k];
        ptrdiff_t a = find_face(job, i, -step, room_for(job, x, y, -along_x[k], -along_y[k]));
        if (a < 0) {
            continue;
        }
        ptrdiff_t b = find_face(job, i, step, room_for(job, x, y, along_x[k], along_y[k]));
        if (b < 0 || !(cosine(job, a, b) < sharpest)) {
            continue;
        }
        ptrdiff_t chosen = choose_face(job, i, a, b);
        if (chosen >= 0) {
            sharpest = cosine(job, a, b);
            best = chosen;
        }
    }
    for (int k = 0; k < 3 && best >= 0; k++) {
        job->normal[k][i] = job->normal[k][best];
    }
}

static void sharpen_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const crease_job *job = context;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * job->width;
        const uint8_t *bent = job->bent + row;
        for (int32_t x = 0; (x = rlf_kernel_next_mark(bent, x, job->width)) < job->width; x++) {
            if (is_known(job, row + x)) {
                sharpen_pixel(job, x, y);
            }
        }
    }
}

void rlf_normals_crease(const rlf_reconstruct *stage, const rlf_slot *slot, const uint8_t *known)
{
    const image_grid *grid = &stage->grid;
    crease_job job = {.width = grid->width,
                      .height = grid->height,
                      .ray_x = grid->ray_x,
                      .ray_y = grid->ray_y,
                      .depth = slot->depth,
                      .known = known,
                      .mean = stage->temporal.mean,
                      .frames = stage->temporal.frames,
                      .normal = slot->normal,
                      .bent = stage->normals.bent,
                      .stage = stage,
                      .step = depth_step_make(&stage->def.rig.noise, grid->camera.fx)};
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, mark_rows, &job);
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, sharpen_rows, &job);
}
