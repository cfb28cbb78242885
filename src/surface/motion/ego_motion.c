/* Whether the camera itself moves: then all that stands still seems to move as one rigid thing.
 *
 * A sparse set of points and normals of a frame a little earlier is laid onto the newest depth, by
 * point-to-plane distances (Chen and Medioni 1992) under Tukey's weights. The camera moves when
 * most of the points at which that motion can be told from rest agree with it and hardly any with
 * rest. Somebody who walks by, however large, leaves the room behind him at rest. */
#include "surface/motion/ego_motion.h"

#include "surface/stage.h"

#include "kernel/kernel.h"
#include "math/solve_six.h"

enum {
    PASSES = 5,
    MOST_AGE = 8,      /* frames that slow motion may take to be seen, and is taken to go on */
    SURE_FRAMES = 2,   /* in a row */
    FEWEST_OF_PART = 8 /* points that tell anything */
};

static const double gates_m[PASSES] = {0.3, 0.15, 0.05, 0.0, 0.0};
static const double tukey = 4.685;       /* sigmas; 95 % efficient (Holland and Welsch 1977) */
static const double rest_square = 1.5;   /* of sigmas, mean: 1 is noise alone */
static const double told_square = 64.0;  /* sigmas of a part's motion, squared */
static const double off_share = 0.25;    /* of the motion that a point may be off: it is curved */
static const double moving_off = 0.4;    /* share of its motion that a part may be off */
static const double least_parts = 0.75;  /* of the parts move, and more */
static const double least_facing = 0.25; /* cosine: depth of a grazing face says little */
static const double ridge = 1e-3;

typedef struct ego_job {
    const image_grid *grid;
    const float *depth;
    rlf_kernel_noise noise;
    const rlf_ego_motion *ego;
} ego_job;

/* How far the newest depth is before point k of the frame before, moved by `pose`, along its
 * normal; false where there is none. */
static bool distance_to(const ego_job *job, int32_t k, const rlf_pose *pose, rlf_vec3 *out_point,
                        rlf_vec3 *out_normal, double *out)
{
    const image_grid *grid = job->grid;
    const rlf_ego_point *from = &job->ego->points[k];
    rlf_vec3 p = rlf_transform(pose, from->point);
    if (!(p.z > 0.05)) {
        return false;
    }
    int32_t i = from->pixel;
    double u = i % grid->width + (p.x / p.z - grid->ray_x[i]) * grid->camera.fx;
    double v = i / grid->width + (p.y / p.z - grid->ray_y[i]) * grid->camera.fy;
    if (!(u > -0.5 && v > -0.5 && u < grid->width - 0.5 && v < grid->height - 0.5)) {
        return false;
    }
    int32_t to = (int32_t)(v + 0.5) * grid->width + (int32_t)(u + 0.5);
    double z = job->depth[to];
    if (!(z > 0.0)) {
        return false;
    }
    rlf_vec3 seen = {z * grid->ray_x[to], z * grid->ray_y[to], z};
    *out_point = p;
    *out_normal = rlf_rotate(pose->q, from->normal);
    *out = rlf_dot(*out_normal, rlf_sub(seen, p));
    return true;
}

/* Noise of such a distance. */
static double sigma_at(const ego_job *job, int32_t k)
{
    const rlf_ego_point *from = &job->ego->points[k];
    double facing = -rlf_dot(from->normal, from->point) / from->point.z;
    return 1.41421356 * rlf_kernel_sigma(job->noise, (float)from->point.z) * facing;
}

/* One step of Gauss and Newton. */
static void improve(const ego_job *job, double gate, rlf_pose *pose)
{
    double a[6][6] = {{0}}, b[6] = {0}, x[6], total = 0.0;
    for (int32_t k = 0; k < job->ego->count; k++) {
        rlf_vec3 p, n;
        double off, sigma = sigma_at(job, k);
        double bound = rlf_max(gate, tukey * sigma);
        if (!distance_to(job, k, pose, &p, &n, &off) || off > bound || off < -bound) {
            continue;
        }
        double t = 1.0 - off * off / (bound * bound), weight = t * t * 1e-6 / (sigma * sigma);
        rlf_vec3 turn = rlf_cross(p, n);
        const double row[6] = {n.x, n.y, n.z, turn.x, turn.y, turn.z};
        total += weight;
        for (int r = 0; r < 6; r++) {
            b[r] += weight * row[r] * off;
            for (int c = 0; c <= r; c++) {
                a[r][c] += weight * row[r] * row[c];
            }
        }
    }
    for (int r = 0; r < 6; r++) {
        a[r][r] += ridge * (total + 1.0);
    }
    math_solve_six(a, b, x);
    const rlf_pose step = {{x[0], x[1], x[2]},
                           rlf_quat_from_rotation_vector(rlf_vec3_make(x[3], x[4], x[5]))};
    *pose = rlf_pose_mul(&step, pose);
}

/* One of twelve parts of the picture: how what its points have moved along their normals follows
 * what the motion says, by weighted least squares. product / square is 1 when they move so, 0 at
 * rest. */
typedef struct ego_part {
    int32_t points, fitting;
    double square, product; /* of said motions; of said and seen ones; in sigmas */
} ego_part;

enum { PARTS_X = 4, PARTS_Y = 3, PARTS = PARTS_X * PARTS_Y, FEWEST = PARTS / 2 * FEWEST_OF_PART };

static void ask(const ego_job *job, const rlf_pose *pose, ego_part parts[PARTS])
{
    const image_grid *grid = job->grid;
    for (int32_t k = 0; k < job->ego->count; k++) {
        const rlf_ego_point *from = &job->ego->points[k];
        rlf_vec3 p, n;
        double off;
        if (!distance_to(job, k, pose, &p, &n, &off)) {
            continue;
        }
        int32_t x = from->pixel % grid->width, y = from->pixel / grid->width;
        ego_part *part = &parts[y * PARTS_Y / grid->height * PARTS_X + x * PARTS_X / grid->width];
        double sigma = sigma_at(job, k), said = rlf_dot(n, rlf_sub(p, from->point));
        double bound = tukey * sigma + off_share * (said < 0.0 ? -said : said);
        part->points++;
        if (off < bound && off > -bound) {
            part->fitting++;
            part->square += said * said / (sigma * sigma);
            part->product += said * (said + off) / (sigma * sigma);
        }
    }
}

/* The motion must be seen nearly all over the picture: one large thing leaves some of it at rest.
 */
static bool is_everywhere(const ego_part parts[PARTS])
{
    int32_t asked = 0, moving = 0;
    for (int32_t k = 0; k < PARTS; k++) {
        const ego_part *part = &parts[k];
        if (part->points >= FEWEST_OF_PART) {
            bool is_told = part->square > told_square && 2 * part->fitting > part->points;
            asked++;
            moving += is_told && part->product > (1.0 - moving_off) * part->square &&
                      part->product < (1.0 + moving_off) * part->square;
        }
    }
    return asked >= PARTS / 2 && moving > least_parts * asked;
}

/* Whether all is where it was but for noise: then nothing need be fitted. */
static bool is_at_rest(const ego_job *job)
{
    const rlf_pose rest = rlf_pose_identity();
    int32_t points = 0;
    double sum = 0.0;
    for (int32_t k = 0; k < job->ego->count; k++) {
        rlf_vec3 p, n;
        double off, sigma = sigma_at(job, k);
        if (distance_to(job, k, &rest, &p, &n, &off)) {
            points++;
            sum += rlf_min(off * off / (sigma * sigma), tukey * tukey);
        }
    }
    return sum < rest_square * points;
}

static bool has_moved(const ego_job *job, rlf_pose *pose)
{
    ego_part parts[PARTS] = {0};
    if (is_at_rest(job)) {
        *pose = rlf_pose_identity();
        return false;
    }
    for (int32_t pass = 0; pass < PASSES; pass++) {
        improve(job, gates_m[pass], pose);
    }
    ask(job, pose, parts);
    bool moves = is_everywhere(parts);
    *pose = moves ? *pose : rlf_pose_identity();
    return moves;
}

void rlf_ego_motion_reset(rlf_ego_motion *ego)
{
    ego->count = ego->age = ego->seen_frames = ego->hold = 0;
    ego->moves = false;
    ego->pose = ego->step = ego->found = rlf_pose_identity();
}

void rlf_ego_motion_watch(rlf_reconstruct *stage, const float *depth)
{
    rlf_ego_motion *ego = &stage->ego;
    const ego_job job = {&stage->grid, depth, rlf_kernel_noise_make(&stage->def.rig.noise), ego};
    if (ego->count < FEWEST) {
        return;
    }
    const rlf_pose before = ego->pose, back = rlf_pose_invert(&before);
    ego->pose = rlf_pose_mul(&ego->step, &ego->pose);
    bool has = has_moved(&job, &ego->pose);
    ego->step = has ? rlf_pose_mul(&ego->pose, &back) : rlf_pose_identity();
    ego->found = has ? ego->pose : ego->found;
    ego->age++;
    ego->seen_frames = has ? ego->seen_frames + 1 : 0;
    if (has && (ego->moves || ego->seen_frames >= SURE_FRAMES)) {
        ego->moves = true;
        ego->hold = MOST_AGE;
        ego->age = MOST_AGE;
    } else if (ego->moves) {
        ego->hold--;
        ego->moves = ego->hold > 0;
    }
}

void rlf_ego_motion_remember(rlf_reconstruct *stage, const rlf_slot *slot)
{
    rlf_ego_motion *ego = &stage->ego;
    const image_grid *grid = &stage->grid;
    if (ego->count >= FEWEST && ego->age < MOST_AGE) {
        return;
    }
    int32_t step = 1;
    while ((int64_t)(grid->width / step + 1) * (grid->height / step + 1) > RLF_EGO_POINTS) {
        step++;
    }
    ego->count = ego->age = 0;
    ego->pose = rlf_pose_identity();
    for (int32_t y = step / 2; y < grid->height; y += step) {
        for (int32_t x = step / 2; x < grid->width; x += step) {
            int32_t i = y * grid->width + x;
            double z = slot->depth[i];
            rlf_vec3 p = {z * grid->ray_x[i], z * grid->ray_y[i], z};
            rlf_vec3 n = {slot->normal[0][i], slot->normal[1][i], slot->normal[2][i]};
            bool faces = -rlf_dot(n, p) > least_facing * rlf_length(p);
            if (z > 0.0 && faces && slot->reason[i] == RLF_REASON_OK) {
                ego->points[ego->count++] = (rlf_ego_point){p, n, i};
            }
        }
    }
}
