/* Whether the camera itself moves: then all that stands still seems to move as one rigid thing.
 *
 * A sparse set of points and normals of an earlier frame is laid onto the newest depth, by
 * point-to-plane distances (Chen and Medioni 1992) under Tukey's weights. Rest is the rival: in
 * each part of the picture the motion must explain what is seen better than rest does. The camera
 * moves when it does so in most parts, and in nearly all at which that motion would be seen.
 * Somebody who walks by, however large, leaves the room behind him at rest; a bare wall cannot tell
 * a motion along itself, so who turns before it decides nothing. */
#include "surface/motion/motion.h"

#include "kernel/kernel.h"
#include "math/rigid.h"

#include <math.h>

enum {
    PERIOD = 8,        /* frames between two views that are kept: the older is 8 to 16 frames old */
    MOVING_PERIOD = 4, /* while the camera moves; motion is taken to go on unseen for as long */
    SURE_FRAMES = 2,   /* in a row */
    FEWEST_OF_PART = 8 /* points that tell anything */
};

static const double gates_m[] = {0.3, 0.15, 0.05, 0.0, 0.0};
static const double tukey = 4.685;      /* sigmas; 95 % efficient (Holland and Welsch 1977) */
static const double rest_square = 1.5;  /* of sigmas, mean: 1 is noise alone */
static const double rest_sigmas = 3.0;  /* what is nearer to rest than that is at rest */
static const double told_square = 64.0; /* sigmas of a part's motion, squared */
static const double off_share = 0.25;   /* of the motion that a point may be off: it is curved */
static const double least_gain = 0.5;   /* of a part's motion that must be gained over rest */
/* More than this share of the parts moves, and of those that would show the motion; or, of all, the
 * second share, which must then determine all of the motion. */
static const double least_parts = 0.75, least_whole = 0.65;
static const double least_share = 3e-3;  /* of the information, for a direction, ... */
static const double least_own = 0.01;    /* ... and so much of that is not another direction's */
static const double least_facing = 0.25; /* cosine: depth of a grazing face says little */
static const double ridge = 3e-3;        /* of the information, for rest */

typedef struct ego_job {
    const image_grid *grid;
    const float *depth;
    rlf_kernel_noise noise;
    const rlf_ego_view *view;
} ego_job;

/* How far the newest depth is before point k of the frame before, moved by `pose`, along its
 * normal; false where there is none. */
static bool distance_to(const ego_job *job, int32_t k, const rlf_pose *pose, rlf_vec3 *out_point,
                        rlf_vec3 *out_normal, double *out)
{
    const image_grid *grid = job->grid;
    const rlf_ego_point *from = &job->view->points[k];
    rlf_vec3 p = rlf_transform(pose, from->point);
    const ptrdiff_t to = rlf_flow_pixel(grid, from->pixel, p);
    if (to < 0) {
        return false;
    }
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
    const rlf_ego_point *from = &job->view->points[k];
    double facing = -rlf_dot(from->normal, from->point) / from->point.z;
    return sqrt(2.0) * rlf_kernel_sigma(job->noise, (float)from->point.z) * facing;
}

/* One step of Gauss and Newton. A direction that hardly any point determines goes back to rest. */
static void improve(const ego_job *job, double gate, rlf_pose *pose)
{
    const rlf_vec3 turned = math_rotation_vector(pose->q);
    const double now[6] = {pose->p.x, pose->p.y, pose->p.z, turned.x, turned.y, turned.z};
    math_rigid_sums sums = {.weight = 0.0};
    double x[6];
    for (int32_t k = 0; k < job->view->count; k++) {
        rlf_vec3 p, n;
        double off, sigma = sigma_at(job, k);
        double bound = rlf_max(gate, tukey * sigma);
        if (!distance_to(job, k, pose, &p, &n, &off) || off > bound || off < -bound) {
            continue;
        }
        const double t = 1.0 - off * off / (bound * bound);
        math_rigid_add(&sums, n, rlf_cross(p, n), off, t * t * 1e-6 / (sigma * sigma));
    }
    for (int r = 0; r < 6; r++) {
        sums.a[r][r] += ridge * (sums.weight + 1.0);
        sums.b[r] -= ridge * (sums.weight + 1.0) * now[r];
    }
    (void)math_rigid_solve(&sums, 0.0, x);
    const rlf_pose step = {{x[0], x[1], x[2]},
                           rlf_quat_from_rotation_vector(rlf_vec3_make(x[3], x[4], x[5]))};
    *pose = rlf_pose_mul(&step, pose);
}

/* One of twelve parts of the picture, in squared sigmas. */
typedef struct ego_part {
    int32_t points, fitting, resting; /* fitting: the motion; resting: at rest */
    double said, gain; /* said: the motion there; gain: how much better than rest it explains */
    double off_rest;
} ego_part;

enum { PARTS_X = 4, PARTS_Y = 3, PARTS = PARTS_X * PARTS_Y, FEWEST = PARTS / 2 * FEWEST_OF_PART };

static double square_of(double off, double sigma)
{
    return rlf_min(off * off / (sigma * sigma), tukey * tukey);
}

static int32_t part_index(const image_grid *grid, int32_t pixel)
{
    const int32_t x = pixel % grid->width, y = pixel / grid->width;
    return y * PARTS_Y / grid->height * PARTS_X + x * PARTS_X / grid->width;
}

/* What each part says of a motion, and of rest. */
static void ask(const ego_job *job, const rlf_pose *pose, ego_part parts[PARTS])
{
    const rlf_pose rest = rlf_pose_identity();
    for (int32_t k = 0; k < job->view->count; k++) {
        const rlf_ego_point *from = &job->view->points[k];
        rlf_vec3 p, n;
        double off, off_rest;
        if (!distance_to(job, k, &rest, &p, &n, &off_rest) ||
            !distance_to(job, k, pose, &p, &n, &off)) {
            continue;
        }
        ego_part *part = &parts[part_index(job->grid, from->pixel)];
        const double sigma = sigma_at(job, k), said = rlf_dot(n, rlf_sub(p, from->point));
        const double bound = tukey * sigma + off_share * (said < 0.0 ? -said : said);
        const double fit = square_of(off * tukey, bound), at_rest = square_of(off_rest, sigma);
        part->points++;
        part->off_rest += at_rest;
        part->resting += at_rest < rest_sigmas * rest_sigmas;
        part->fitting += off < bound && off > -bound;
        part->said += square_of(said, sigma);
        part->gain += at_rest - fit;
    }
}

/* Whether points of the parts that are marked determine all six directions of a motion. A board is
 * one plane: it takes the others from what is at rest. */
static bool is_determined(const ego_job *job, const bool marked[PARTS])
{
    math_rigid_sums sums = {.weight = 0.0};
    double x[6];
    for (int32_t k = 0; k < job->view->count; k++) {
        const rlf_ego_point *from = &job->view->points[k];
        const double sigma = sigma_at(job, k);
        if (marked[part_index(job->grid, from->pixel)]) {
            const rlf_vec3 turn = rlf_cross(from->point, from->normal);
            math_rigid_add(&sums, from->normal, rlf_scale(turn, 1.0 / from->point.z), 0.0,
                           1.0 / (sigma * sigma));
        }
    }
    bool is = math_rigid_solve(&sums, least_own, x);
    for (int r = 0; r < 6; r++) {
        is = is && sums.a[r][r] > least_share * sums.weight;
    }
    return is;
}

/* One large thing leaves some of the picture at rest. */
static bool is_everywhere(const ego_job *job, const ego_part parts[PARTS])
{
    bool moves[PARTS] = {false};
    int32_t seen = 0, asked = 0, moving = 0;
    for (int32_t k = 0; k < PARTS; k++) {
        const ego_part *part = &parts[k];
        const bool is_seen = part->points >= FEWEST_OF_PART;
        const bool is_asked = is_seen && part->said > told_square;
        moves[k] = is_asked && 2 * part->fitting > part->points && part->gain > told_square &&
                   part->gain > least_gain * part->said;
        seen += is_seen;
        asked += is_asked;
        moving += moves[k];
    }
    const bool is_most = 3 * moving >= PARTS && moving > least_parts * asked;
    return is_most && (moving > least_parts * seen ||
                       (moving > least_whole * seen && is_determined(job, moves)));
}

/* What is where it was: as many parts of the picture as more than half of their points say so; and
 * whether all is, but for noise: then no motion need be fitted. */
typedef struct ego_rest {
    int32_t seen, resting;
    bool is_all;
} ego_rest;

static ego_rest find_rest(const ego_job *job)
{
    const rlf_pose rest = rlf_pose_identity();
    ego_part parts[PARTS] = {0};
    ego_rest found = {0, 0, false};
    int32_t points = 0;
    double sum = 0.0;
    ask(job, &rest, parts);
    for (int32_t k = 0; k < PARTS; k++) {
        const bool is_seen = parts[k].points >= FEWEST_OF_PART;
        found.seen += is_seen;
        found.resting += is_seen && 2 * parts[k].resting > parts[k].points;
        points += parts[k].points;
        sum += parts[k].off_rest;
    }
    found.is_all = sum < rest_square * points;
    return found;
}

/* Parts that people and things cover say nothing; so many are enough. */
static bool rests(const ego_rest *found)
{
    return 4 * found->seen >= PARTS && 3 * found->resting >= found->seen;
}

static bool has_moved(const ego_job *job, rlf_pose *pose)
{
    ego_part parts[PARTS] = {0};
    for (size_t pass = 0; pass < sizeof(gates_m) / sizeof(gates_m[0]); pass++) {
        improve(job, gates_m[pass], pose);
    }
    ask(job, pose, parts);
    return is_everywhere(job, parts);
}

void rlf_ego_motion_reset(rlf_ego_motion *ego)
{
    ego->views[0].count = ego->views[1].count = 0;
    ego->newest = ego->age = ego->seen_frames = ego->hold = 0;
    ego->moves = ego->rests = false;
    ego->pose = ego->step = ego->found = ego->newest_pose = rlf_pose_identity();
}

static ego_job make_job(const rlf_reconstruct *stage, const float *depth)
{
    const rlf_ego_motion *ego = &stage->ego;
    return (ego_job){&stage->grid, depth, rlf_kernel_noise_make(&stage->def.rig.noise),
                     &ego->views[1 - ego->newest]};
}

bool rlf_reconstruct_is_as_before(const rlf_reconstruct *stage, const float *depth)
{
    if (!RLF_ASSERT(stage != NULL && depth != NULL)) {
        return false;
    }
    const ego_job job = make_job(stage, depth);
    const ego_rest found = find_rest(&job);
    return rests(&found) && 2 * found.resting >= found.seen;
}

void rlf_ego_motion_watch(rlf_reconstruct *stage, const float *depth)
{
    rlf_ego_motion *ego = &stage->ego;
    const ego_job job = make_job(stage, depth);
    ego->age++;
    ego->rests = false;
    if (job.view->count < FEWEST) {
        return;
    }
    const rlf_pose before = ego->pose, back = rlf_pose_invert(&before);
    const ego_rest rest = find_rest(&job);
    ego->pose = rlf_pose_mul(&ego->step, &ego->pose);
    const bool has = !rest.is_all && has_moved(&job, &ego->pose);
    ego->rests = !has && rests(&rest);
    ego->pose = has ? ego->pose : rlf_pose_identity();
    ego->step = has ? rlf_pose_mul(&ego->pose, &back) : rlf_pose_identity();
    ego->found = has ? ego->pose : ego->found;
    ego->seen_frames = has ? ego->seen_frames + 1 : 0;
    if (has && (ego->moves || ego->seen_frames >= SURE_FRAMES)) {
        ego->moves = true;
        ego->hold = MOVING_PERIOD;
    } else if (ego->moves) {
        ego->hold--;
        ego->moves = ego->hold > 0;
    }
}

/* As many points as there is room for: where much has no depth, what has is asked more closely. */
static void keep(rlf_ego_view *view, const image_grid *grid, const rlf_slot *slot)
{
    int32_t seen = 0, step = 1;
    for (int32_t i = 0; i < grid->count; i++) {
        seen += slot->reason[i] == RLF_REASON_OK;
    }
    while (seen > RLF_EGO_POINTS * step * step) {
        step++;
    }
    view->count = 0;
    for (int32_t y = step / 2; y < grid->height; y += step) {
        for (int32_t x = step / 2; x < grid->width && view->count < RLF_EGO_POINTS; x += step) {
            int32_t i = y * grid->width + x;
            double z = slot->depth[i];
            rlf_vec3 p = {z * grid->ray_x[i], z * grid->ray_y[i], z};
            rlf_vec3 n = {slot->normal[0][i], slot->normal[1][i], slot->normal[2][i]};
            bool faces = -rlf_dot(n, p) > least_facing * rlf_length(p);
            if (z > 0.0 && faces && slot->reason[i] == RLF_REASON_OK) {
                view->points[view->count++] = (rlf_ego_point){p, n, i};
            }
        }
    }
}

/* The newer view becomes the older one, and motion is counted from there. */
void rlf_ego_motion_remember(rlf_reconstruct *stage, const rlf_slot *slot)
{
    rlf_ego_motion *ego = &stage->ego;
    const bool is_first = ego->views[ego->newest].count < FEWEST;
    if (stage->sight.is_blind) {
        return;
    }
    if (!is_first && ego->age < (ego->moves ? MOVING_PERIOD : PERIOD)) {
        return;
    }
    const rlf_pose back = rlf_pose_invert(&ego->newest_pose);
    ego->pose = is_first ? rlf_pose_identity() : rlf_pose_mul(&ego->pose, &back);
    ego->newest_pose = ego->pose;
    ego->age = 0;
    ego->newest = 1 - ego->newest;
    keep(&ego->views[ego->newest], &stage->grid, slot);
    if (is_first) {
        ego->views[1 - ego->newest] = ego->views[ego->newest];
    }
}
