/* Normal velocity of the front sheet from the change of depth along each ray.
 *
 * Along a fixed ray m a surface that moves with speed v along its normal changes depth by
 * dz/dt = v / (n.m), exactly for planes (range flow, Spies et al. 2002), so v = (n.m) dz/dt. Only
 * this normal component can be seen. dz is averaged over 9x9 pixels of moving things; what is not
 * significant against the sensor's noise is exactly 0. */
#include "surface/steps.h"

#include "kernel/kernel.h"

enum { REACH = 4 };

static const float fastest_m_per_s = 5.0f;
static const double longest_gap_s = 0.2;
/* Noise of neighbouring pixels is correlated by the drivers' 3x3 filters: 4 count as one. */
static const float correlated_pixels = 4.0f;
static const float significant_sigmas = 3.0f;

typedef struct flow_job {
    const rlf_reconstruct *stage;
    const rlf_slot *before;
    rlf_slot *now;
    float dt;
    bool all;           /* there is no background: everything may move */
    float *sum, *count; /* over 9 pixels of a row */
} flow_job;

/* The same region was seen in both frames, and it is one that may move. */
static inline bool is_followed(const flow_job *job, ptrdiff_t i)
{
    int32_t label = job->now->label[i];
    return label != 0 && label == job->before->label[i] && (job->now->foreground[i] || job->all);
}

/* Depth change of a pixel that shows the same region twice; false when there is none. */
static inline float depth_change(const flow_job *job, ptrdiff_t i, float *usable)
{
    float z = job->now->depth[i], past = job->before->depth[i];
    float change = z - past;
    bool filled = (job->now->reason[i] | job->before->reason[i]) != RLF_REASON_OK;
    bool near = rlf_kernel_abs(change) <= fastest_m_per_s * job->dt;
    *usable = is_followed(job, i) && near && !filled ? 1.0f : 0.0f;
    return *usable > 0.0f ? change : 0.0f;
}

static void row_sums(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const flow_job *job = context;
    int32_t width = job->stage->grid.width;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * width;
        for (int32_t x = 0; x < width; x++) {
            job->sum[row + x] = job->count[row + x] = 0.0f;
        }
        for (int32_t x = 0; x < width; x++) {
            float usable;
            float change = depth_change(job, row + x, &usable);
            if (usable <= 0.0f) {
                continue;
            }
            int32_t first = x > REACH ? x - REACH : 0;
            int32_t last = x + REACH < width ? x + REACH : width - 1;
            for (int32_t k = first; k <= last; k++) {
                job->sum[row + k] += change;
                job->count[row + k] += 1.0f;
            }
        }
    }
}

static float significant_speed(const flow_job *job, ptrdiff_t i, float sum, float count)
{
    const rlf_grid *grid = &job->stage->grid;
    float z = job->now->depth[i];
    if (count < 9.0f || !(z > 0.0f)) {
        return 0.0f;
    }
    float mean = sum / count;
    rlf_kernel_noise noise = rlf_kernel_noise_make(&job->stage->def.rig.noise);
    float sigma = rlf_kernel_sigma(noise, z);
    float variance = 2.0f * sigma * sigma * correlated_pixels / count;
    if (mean * mean <= significant_sigmas * significant_sigmas * variance) {
        return 0.0f;
    }
    float facing = job->now->normal[0][i] * grid->ray_x[i] +
                   job->now->normal[1][i] * grid->ray_y[i] + job->now->normal[2][i];
    float speed = facing * mean / job->dt;
    speed = speed > fastest_m_per_s ? fastest_m_per_s : speed;
    return speed < -fastest_m_per_s ? -fastest_m_per_s : speed;
}

static void speed_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const flow_job *job = context;
    const rlf_grid *grid = &job->stage->grid;
    for (int32_t y = begin; y < end; y++) {
        int32_t first = y > REACH ? y - REACH : 0;
        int32_t last = y + REACH < grid->height ? y + REACH : grid->height - 1;
        for (int32_t x = 0; x < grid->width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            float speed = 0.0f;
            if (is_followed(job, i)) {
                float sum = 0.0f, count = 0.0f;
                for (int32_t k = first; k <= last; k++) {
                    sum += job->sum[(ptrdiff_t)k * grid->width + x];
                    count += job->count[(ptrdiff_t)k * grid->width + x];
                }
                speed = significant_speed(job, i, sum, count);
            }
            for (int k = 0; k < 3; k++) {
                job->now->velocity[k][i] = job->now->normal[k][i] * speed;
            }
        }
    }
}

static void clear_velocity(const rlf_grid *grid, rlf_slot *slot)
{
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i < grid->count; i++) {
            slot->velocity[k][i] = 0.0f;
        }
    }
}

/* The centroid moves when pieces join or leave a region, too: then its step says nothing. */
static bool is_same_shape(const rlf_region *a, const rlf_region *b)
{
    return 5 * a->point_count >= 4 * b->point_count && 5 * b->point_count >= 4 * a->point_count;
}

/* Velocity of the visible part's centroid. A silhouette that flickers moves the centroid a little,
 * so small steps do not count. */
static void region_velocities(const rlf_slot *before, rlf_slot *now, double dt)
{
    const double least_step_m = 0.005;
    for (int32_t r = 0; r < now->foreground_region_count; r++) {
        rlf_region *region = &now->regions[now->foreground_region_first + r];
        for (int32_t k = 0; k < before->foreground_region_count; k++) {
            const rlf_region *old = &before->regions[before->foreground_region_first + k];
            rlf_vec3 step = rlf_sub(region->centroid, old->centroid);
            bool same = old->label == region->label && is_same_shape(old, region);
            if (same && rlf_length(step) > least_step_m) {
                region->linear_velocity = rlf_scale(step, 1.0 / dt);
            }
        }
    }
}

void rlf_velocity_estimate(rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_slot *before = stage->previous;
    double dt =
        before == NULL ? 0.0 : 1e-9 * (double)(slot->surface.time_ns - before->surface.time_ns);
    if (!(dt > 0.0) || dt > longest_gap_s || slot->foreground_region_count == 0) {
        clear_velocity(&stage->grid, slot);
        return;
    }
    bool all = stage->def.background_method == RLF_BACKGROUND_OFF;
    flow_job job = {stage, before, slot, (float)dt, all, stage->work.sum[0], stage->work.sum[1]};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, row_sums, &job);
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, speed_rows, &job);
    region_velocities(before, slot, dt);
}
