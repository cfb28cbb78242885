/* Where one thing touches another: two points of one convex thing are both behind the other's
 * tangent plane (Stein et al. 2014). At a concave contact both are in front of it, and at a depth
 * step one is. */
#include "surface/objects/objects.h"

#include "kernel/kernel.h"

static const float SIGMAS = 4.0f;       /* in front of the other's tangent plane ... */
static const float LEAST_SLOPE = 0.25f; /* ... and by this much of the way between them */
/* What was one thing, or two, in the image before needs so many times as much to become another. */
static const float STAYS = 1.4f;

/* Pixels i and j, on both sides of a third, are of two things. */
static bool is_contact(const image_grid *grid, const rlf_layer_in *in, rlf_kernel_noise noise,
                       int32_t i, int32_t j)
{
    float zi = in->depth[i], zj = in->depth[j];
    if (!(zi > 0.0f) || !(zj > 0.0f)) {
        return false;
    }
    float d[3] = {zj * grid->ray_x[j] - zi * grid->ray_x[i],
                  zj * grid->ray_y[j] - zi * grid->ray_y[i], zj - zi};
    float above_i = 0.0f, above_j = 0.0f, way = 0.0f;
    for (int k = 0; k < 3; k++) {
        above_i += d[k] * in->normal[k][i];
        above_j -= d[k] * in->normal[k][j];
        way += d[k] * d[k];
    }
    float above = above_i > above_j ? above_i : above_j;
    if (in->previous_label != NULL) {
        above *= in->previous_label[i] == in->previous_label[j] ? 1.0f / STAYS : STAYS;
    }
    return above > SIGMAS * rlf_kernel_sigma(noise, zi) &&
           above * above > LEAST_SLOPE * LEAST_SLOPE * way;
}

/* Links of pixel i to pixels that are linked still, and were not another thing's. */
static uint8_t cut_links(const rlf_reconstruct *stage, const rlf_layer_in *in, int32_t i)
{
    const uint8_t *links = stage->work.links;
    int32_t width = stage->grid.width, link = links[i];
    const int32_t bits[2] = {RLF_LINK_LEFT, RLF_LINK_UP};
    const int32_t step[2] = {-1, -width};
    for (int k = 0; k < 2; k++) {
        if (link & bits[k]) {
            int32_t j = i + step[k];
            bool was_one = in->previous_label == NULL || in->previous_label[i] == 0 ||
                           in->previous_label[j] == 0 ||
                           in->previous_label[i] == in->previous_label[j];
            link &= links[j] == 0 || !was_one ? ~bits[k] : ~0;
        }
    }
    return (uint8_t)link;
}

typedef struct contact_job {
    rlf_reconstruct *stage;
    const rlf_layer_in *in;
    rlf_kernel_noise noise;
    int32_t reach; /* pixels, from a contact to both sides */
} contact_job;

/* Two things meet at pixel i = (x, y), across or down. */
static bool is_cut(const contact_job *job, int32_t i, int32_t x, int32_t y)
{
    const image_grid *grid = &job->stage->grid;
    const uint8_t *support = job->stage->objects->support;
    int32_t across = job->reach, down = job->reach * grid->width;
    bool is_wide = x >= job->reach && x + job->reach < grid->width &&
                   support[i - across] + support[i + across] == 0;
    bool is_high = y >= job->reach && y + job->reach < grid->height &&
                   support[i - down] + support[i + down] == 0;
    return (is_wide && is_contact(grid, job->in, job->noise, i - across, i + across)) ||
           (is_high && is_contact(grid, job->in, job->noise, i - down, i + down));
}

static void cut_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const contact_job *job = context;
    int32_t width = job->stage->grid.width;
    uint8_t *links = job->stage->work.links;
    for (int32_t y = begin; y < end; y++) {
        for (int32_t x = 0; x < width; x++) {
            int32_t i = y * width + x;
            bool is_off =
                job->stage->objects->support[i] != 0 || (links[i] != 0 && is_cut(job, i, x, y));
            links[i] = is_off ? 0 : links[i];
        }
    }
}

void rlf_contacts_cut(rlf_reconstruct *stage, const rlf_layer_in *in)
{
    contact_job job = {.stage = stage,
                       .in = in,
                       .noise = rlf_kernel_noise_make(&stage->def.rig.noise),
                       .reach = stage->objects->side / 2};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, cut_rows, &job);
    uint8_t *links = stage->work.links;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        links[i] = links[i] != 0 ? cut_links(stage, in, i) : 0;
    }
}
