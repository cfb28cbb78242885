/* Velocity of the front sheet from the change of depth.
 *
 * A region that is of one piece moves as its keyframe does (motion/follow.c). Any other is compared
 * with the frame before: a surface that moves with velocity v meets that, taken back by v dt: along
 * the normal n the two must not differ. Over a region that moves as one rigid thing this gives all
 * six unknowns of its twist (least squares with a weak prior). Then it is fitted cell by cell
 * (motion/cells.c). What is not significant against the sensor's noise is exactly 0.
 */
#include "surface/motion/keyframe.h"
#include "surface/motion/motion.h"

#include <string.h>

enum { STRIDE = 2, LEAST_REGION_SAMPLES = 30, MOST_SAMPLES = 400 };

static const double longest_gap_s = 0.2;
/* Share of a motion by which the normal's error makes it another. */
static const double normal_error = 0.05;
/* Squared sum of 6 normal variables that chance exceeds once in 400 times. */
static const float significant_6 = 20.1f;

/* The published planes hold only what was written into the slot three frames ago. */
static void clear_velocity(const image_grid *grid, rlf_slot *slot)
{
    for (int32_t y = 0; y < grid->height; y++) {
        const rlf_span *span = &slot->moved[y];
        for (int k = 0; k < 3; k++) {
            memset(slot->velocity[k] + (ptrdiff_t)y * grid->width + span->x0, 0,
                   (size_t)(span->x1 - span->x0) * sizeof(float));
        }
    }
    memset(slot->moved, 0, (size_t)grid->height * sizeof *slot->moved);
}

/* Speed along the normal beyond v, from where v says that the point was; false when the region was
 * not seen there. */
static bool speed_beyond(const rlf_flow *job, ptrdiff_t i, rlf_vec3 p, rlf_vec3 n, rlf_vec3 v,
                         double *out)
{
    const image_grid *grid = &job->stage->grid;
    rlf_vec3 q = rlf_mad(p, v, -(double)job->dt);
    const ptrdiff_t k = rlf_flow_pixel(grid, i, q);
    if (k < 0 || !(job->view.seen[k] > 0.0f)) {
        return false;
    }
    rlf_vec3 step = rlf_sub(q, rlf_flow_point(grid, job->before->depth, k));
    *out = rlf_dot(n, step) / (double)job->dt;
    return rlf_dot(step, step) < 4.0 * (double)(rlf_flow_limb_m * rlf_flow_limb_m);
}

/* A region's pixels against a motion of it. */
typedef struct twist_look {
    const rlf_flow *job;
    const rlf_region *region;
    double slack; /* widens what agrees while the motion is still far off */
    math_rigid_sums sums;
} twist_look;

static void add_pixel(twist_look *look, rlf_twist *t, double speed, ptrdiff_t i)
{
    const rlf_flow *job = look->job;
    t->samples++;
    const rlf_vec3 p = rlf_flow_point(&job->stage->grid, job->now->depth, i);
    const rlf_vec3 n = rlf_flow_normal(job->now, i), v = rlf_twist_velocity(t, p);
    const double facing = -rlf_dot(n, p) / p.z, along = rlf_dot(n, v);
    double off;
    if (!(facing > 0.0) || !speed_beyond(job, i, p, n, v, &off)) {
        return;
    }
    /* What the sensor's noise makes of a speed, and the normal's error of the motion. */
    const double noise =
        sqrt(2.0) * rlf_kernel_sigma(job->noise, job->now->depth[i]) / job->dt * facing;
    const double bound = look->slack + 3.0 * noise + normal_error * speed;
    if (off <= bound && off >= -bound) {
        const rlf_vec3 turn = rlf_cross(rlf_sub(p, t->centre), n);
        t->inliers++;
        t->noise += noise * noise;
        t->explained += along * along;
        math_rigid_add(&look->sums, n, rlf_scale(turn, 1.0 / t->length), off, 1.0);
    }
}

/* Sums over the pixels that agree with the motion. */
static void look_at(twist_look *look, rlf_twist *t)
{
    const rlf_flow *job = look->job;
    const rlf_region *region = look->region;
    const double speed = rlf_length(rlf_vec3_make(t->x[0], t->x[1], t->x[2]));
    look->sums = (math_rigid_sums){.weight = 0.0};
    t->samples = t->inliers = 0;
    t->noise = t->explained = 0.0;
    for (int32_t v = region->y0; v < region->y1; v += t->stride) {
        for (int32_t u = region->x0; u < region->x1; u += t->stride) {
            ptrdiff_t i = (ptrdiff_t)v * job->stage->grid.width + u;
            if (job->now->label[i] == region->label && job->now->reason[i] == RLF_REASON_OK) {
                add_pixel(look, t, speed, i);
            }
        }
    }
}

/* One step of Gauss and Newton. */
static void step(twist_look *look, rlf_twist *t)
{
    double x[6];
    for (int k = 0; k < 6; k++) {
        look->sums.a[k][k] += (double)rlf_flow_ridge * (t->inliers + 1);
    }
    (void)math_rigid_solve(&look->sums, 0.0, x);
    for (int k = 0; k < 6; k++) {
        t->x[k] += x[k];
    }
}

static rlf_twist start_from(const rlf_region *region, rlf_vec3 velocity)
{
    rlf_vec3 size = rlf_sub(region->box.max, region->box.min);
    rlf_twist t = {.centre = region->centroid, .x = {velocity.x, velocity.y, velocity.z}};
    t.length = rlf_max(0.25 * rlf_length(size), 0.01);
    t.stride = STRIDE;
    while (region->point_count > MOST_SAMPLES * t.stride * t.stride) {
        t.stride++;
    }
    return t;
}

static rlf_twist fit_from(const rlf_flow *job, const rlf_region *region, rlf_vec3 velocity)
{
    static const double slack[] = {1.0, 0.3, 0.1, 0.0};
    rlf_twist t = start_from(region, velocity);
    for (size_t pass = 0; pass < sizeof(slack) / sizeof(slack[0]); pass++) {
        twist_look look = {.job = job, .region = region, .slack = slack[pass]};
        look_at(&look, &t);
        step(&look, &t);
    }
    return t;
}

/* More than chance, and more than a share of one pixel's noise. */
static bool is_significant(const rlf_twist *t, double least)
{
    return t->inliers >= LEAST_REGION_SAMPLES && t->explained > least * t->noise &&
           t->explained > significant_6 * t->noise / t->inliers * rlf_flow_correlated;
}

/* Someone who stands and moves his arms turns a little as a whole, says the twist; but that he
 * rests explains as much of him. */
static bool is_rest_as_likely(const rlf_twist *rest, const rlf_twist *t)
{
    return 10 * rest->inliers >= 9 * t->inliers;
}

/* The centroid moves when pieces join or leave a region, too: then its step says nothing. */
static bool is_same_shape(const rlf_region *a, const rlf_region *b)
{
    return 5 * a->point_count >= 4 * b->point_count && 5 * b->point_count >= 4 * a->point_count;
}

/* The region of the frame before that it is; NULL = it is new. */
static const rlf_region *find_before(const rlf_flow *job, const rlf_region *region)
{
    const rlf_slot *before = job->before;
    for (int32_t k = 0; k < before->foreground_region_count; k++) {
        const rlf_region *old = &before->regions[before->foreground_region_first + k];
        if (old->label == region->label) {
            return old;
        }
    }
    return NULL;
}

/* Velocity of the visible part's centroid. A contour that flickers moves it by less than a pixel,
 * which does not count. */
static rlf_vec3 centroid_velocity(const rlf_flow *job, const rlf_region *region)
{
    const rlf_region *old = find_before(job, region);
    if (old != NULL && is_same_shape(old, region)) {
        rlf_vec3 step = rlf_sub(region->centroid, old->centroid);
        if (rlf_length(step) > region->centroid.z / job->stage->grid.camera.fx) {
            return rlf_scale(step, 1.0 / (double)job->dt);
        }
    }
    return rlf_vec3_make(0, 0, 0);
}

/* Whether the region moves as one. Tried from rest and from the centroid's motion; what more pixels
 * agree with is right. */
static bool is_moving(const rlf_flow *job, const rlf_region *region, rlf_vec3 seen, rlf_twist *out)
{
    twist_look look = {.job = job, .region = region};
    const rlf_vec3 none = {0, 0, 0};
    rlf_twist rest = start_from(region, none);
    look_at(&look, &rest);
    if (10 * rest.inliers >= 9 * rest.samples) {
        return false; /* whatever the motion */
    }
    *out = fit_from(job, region, none);
    if (rlf_length(seen) > 0.0 && 5 * out->inliers < 4 * rest.samples) {
        rlf_twist other = fit_from(job, region, seen);
        *out = other.inliers > out->inliers ? other : *out;
    }
    /* Half of a pixel's noise: small errors that pixels share, from limbs that move by themselves,
     * do not average out. */
    return is_significant(out, 0.25) && 3 * out->inliers >= rest.samples &&
           !is_rest_as_likely(&rest, out);
}

static bool keyframe_motion(const rlf_keyframe *key, rlf_region *region, rlf_twist *out)
{
    out->centre = rlf_add(key->centre, rlf_vec3_make(key->x[0], key->x[1], key->x[2]));
    out->length = key->length;
    out->reach = key->has_stood ? 2.0 * key->length : 0.0; /* a person may hold one pose, too */
    memcpy(out->x, key->velocity, sizeof(out->x));
    region->angular_velocity = rlf_twist_spin(out);
    region->linear_velocity = rlf_twist_velocity(out, region->centroid);
    return rlf_length(region->linear_velocity) > 0.0 || rlf_length(region->angular_velocity) > 0.0;
}

static bool region_motion(const rlf_flow *job, rlf_region *region, rlf_twist *out)
{
    const rlf_keyframe *key = keyframe_of_region(job->stage, region->label);
    *out = start_from(region, rlf_vec3_make(0, 0, 0));
    const bool is_proven = key != NULL && key->is_whole && key->ring_count == KEYFRAME_RING;
    if (is_proven || (key != NULL && key->has_stood)) {
        return keyframe_motion(key, region, out);
    }
    rlf_vec3 seen = centroid_velocity(job, region);
    if (is_moving(job, region, seen, out)) {
        region->linear_velocity = rlf_vec3_make(out->x[0], out->x[1], out->x[2]);
        region->angular_velocity = rlf_twist_spin(out);
        return true;
    }
    *out = start_from(region, rlf_vec3_make(0, 0, 0));
    region->linear_velocity = seen;
    return key != NULL && key->is_whole && keyframe_motion(key, region, out);
}

/* The frame before as the samples of this one look at it: where something was in front, or was
 * taken for background then, and has left since. */
static rlf_kernel_flow_view look_back(const rlf_reconstruct *stage)
{
    const image_grid *grid = &stage->grid;
    const rlf_slot *before = stage->previous;
    const uint8_t *left = stage->background.depart.left;
    const bool is_all_front = stage->def.background_method == RLF_BACKGROUND_OFF;
    uint8_t *both = stage->velocity.is_steady;
    for (int32_t y = 0; y < grid->height; y++) {
        const ptrdiff_t row = (ptrdiff_t)y * grid->width;
        const uint8_t *front = is_all_front ? stage->work.ones : before->foreground + row;
        for (int32_t x = 0; x < grid->width && !is_all_front && left != NULL; x++) {
            both[x] = before->foreground[row + x] | left[row + x];
            front = both;
        }
        rlf_kernel_front_row(before->depth + row, before->reason + row, front, grid->width,
                             stage->velocity.seen + row);
    }
    return (rlf_kernel_flow_view){.seen = stage->velocity.seen,
                                  .ray_x = grid->ray_x,
                                  .ray_y = grid->ray_y,
                                  .width = grid->width,
                                  .height = grid->height,
                                  .fx = (float)grid->camera.fx,
                                  .fy = (float)grid->camera.fy,
                                  .limb = rlf_flow_limb_m};
}

/* Where the regions are. */
static void unite_spans(rlf_slot *slot)
{
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        const rlf_region *region = &slot->regions[slot->foreground_region_first + r];
        for (int32_t y = region->y0; y < region->y1; y++) {
            slot->moved[y] = rlf_span_unite(slot->moved[y], (rlf_span){region->x0, region->x1});
        }
    }
}

void rlf_velocity_estimate(rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_slot *before = stage->previous;
    clear_velocity(&stage->grid, slot);
    double dt = 1e-9 * (double)rlf_stage_elapsed_ns(stage, slot);
    const bool is_gap = !(dt > 0.0) || dt > longest_gap_s;
    keyframes_follow(stage, slot, is_gap);
    if (is_gap || slot->foreground_region_count == 0) {
        return;
    }
    const rlf_flow job = {
        stage,           before, slot, (float)dt, rlf_kernel_noise_make(&stage->def.rig.noise),
        look_back(stage)};
    unite_spans(slot);
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        rlf_region *region = &slot->regions[slot->foreground_region_first + r];
        rlf_twist twist;
        bool moves = region_motion(&job, region, &twist);
        rlf_velocity_cells(&job, region, &twist, moves);
    }
}
