/* Depth of the background's pixels that were hardly ever seen.
 *
 * At an outline a driver drops a pixel or two in nearly every frame. What they were filled with
 * goes on level, as the wider face within it does. Which face they are on is told later, by what
 * frames agree on (normals/settle.c, normals/side.c): on the side of a leg, or in the last rows of
 * a top that is seen at a low angle, such a pixel has the right normal and lies up to 7 cm before
 * its face. So its depth follows its normal: it is where the seen pixels about it that face the
 * same way go on. Where none of its face was seen, that begins half way from the nearest seen
 * pixel, behind the front that this is on. */
#include "surface/background/facing.h"
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/kernel.h"

enum { ABOUT = 2 /* pixels */ };

static const float LEAST_FRAMES = 2.0f;    /* with depth; fewer were mixed as likely as not */
static const float ONE_THING = 0.04f;      /* share of the depth between pixels of one thing */
static const float OTHER_FACE = 0.7f;      /* cosine: 45 degrees */
static const float MOST_CHANGE = 0.05f;    /* share of the depth */
static const float STEEPEST_CHANGE = 0.1f; /* the same, of one face from pixel to pixel */

typedef struct rim_job {
    const rlf_grid *grid;
    const float *frames; /* plane: how many are in a pixel's mean over time */
    const uint8_t *foreground;
    const rlf_sheet *sheet;
} rim_job;

static bool is_seen(const rim_job *job, ptrdiff_t i)
{
    return job->frames[i] >= LEAST_FRAMES && job->foreground[i] == 0;
}

/* Both were background, and no outline runs between them. */
static bool is_beside(const rim_job *job, ptrdiff_t i, ptrdiff_t seen)
{
    float z = job->sheet->depth[i];
    return is_seen(job, seen) && rlf_kernel_abs(job->sheet->depth[seen] - z) < ONE_THING * z;
}

/* Inverse depth of pixel i on the face that the seen pixels about it show; 0 = they show none. */
static float go_on(const rim_job *job, ptrdiff_t i, const float normal[3])
{
    float sum = 0.0f, weights = 0.0f, here = rlf_facing(job->grid, normal, i);
    for (int32_t dy = -ABOUT; dy <= ABOUT; dy++) {
        for (int32_t dx = -ABOUT; dx <= ABOUT; dx++) {
            ptrdiff_t at = i + (ptrdiff_t)dy * job->grid->width + dx;
            float other[3];
            rlf_read_normal(job->sheet->normal, at, other);
            float change = here / rlf_facing(job->grid, normal, at);
            if (!is_beside(job, i, at) || !(rlf_cosine(normal, other) > rlf_one_face) ||
                !(rlf_kernel_abs(change - 1.0f) < STEEPEST_CHANGE)) {
                continue;
            }
            float square = (float)(dx * dx + dy * dy), weight = 1.0f / (square * square);
            sum += weight * change / job->sheet->depth[at];
            weights += weight;
        }
    }
    return weights > 0.0f ? sum / weights : 0.0f;
}

/* The same of a face that begins half way to the seen pixel at `at`, behind the other face that
 * this is on; 0 = not there. */
static float begin_at(const rim_job *job, ptrdiff_t i, const float normal[3], ptrdiff_t at)
{
    float front[3];
    rlf_read_normal(job->sheet->normal, at, front);
    if (!(rlf_cosine(normal, front) < OTHER_FACE)) {
        return 0.0f;
    }
    const rlf_grid *grid = job->grid;
    float inverse = 1.0f / (rlf_facing(grid, front, at) * job->sheet->depth[at]);
    float middle = 0.5f * (rlf_facing(grid, front, at) + rlf_facing(grid, front, i)) * inverse;
    float here = rlf_facing(grid, normal, i), there = rlf_facing(grid, normal, at);
    float found = middle * here / (0.5f * (here + there));
    float level = rlf_facing(grid, front, i) * inverse;
    return found < level && found > (1.0f - STEEPEST_CHANGE) * level ? found : 0.0f;
}

/* Along the row and the column, from the nearest seen pixel on each side. */
static float begin(const rim_job *job, ptrdiff_t i, const float normal[3])
{
    const ptrdiff_t step[4] = {-1, 1, -job->grid->width, job->grid->width};
    float sum = 0.0f, count = 0.0f;
    for (int k = 0; k < 4; k++) {
        ptrdiff_t at = is_seen(job, i + step[k]) ? i + step[k] : i + 2 * step[k];
        float found = is_beside(job, i, at) ? begin_at(job, i, normal, at) : 0.0f;
        sum += found;
        count += found > 0.0f ? 1.0f : 0.0f;
    }
    return count > 0.0f ? sum / count : 0.0f;
}

static float depth_at(const rim_job *job, ptrdiff_t i)
{
    float normal[3], z = job->sheet->depth[i];
    rlf_read_normal(job->sheet->normal, i, normal);
    if (!(z > 0.0f) || !(rlf_facing(job->grid, normal, i) < -rlf_least_facing)) {
        return z;
    }
    float inverse = go_on(job, i, normal);
    inverse = inverse > 0.0f ? inverse : begin(job, i, normal);
    float found = inverse > 0.0f ? 1.0f / inverse : z;
    return rlf_kernel_abs(found - z) < MOST_CHANGE * z ? found : z;
}

/* What something hides stays where it was put when it was seen. */
static float hidden_depth(const rlf_reconstruct *stage, const rlf_sheet *old, float z, ptrdiff_t i)
{
    bool is_put = old != NULL && rlf_settle_at(stage, i) != NULL;
    return is_put && rlf_kernel_abs(old->depth[i] - z) < MOST_CHANGE * z ? old->depth[i] : z;
}

void rlf_sheet_fit_rims(const rlf_reconstruct *stage, const rlf_slot *slot, const rlf_sheet *old,
                        rlf_sheet *sheet, rlf_rect r)
{
    const rlf_grid *grid = &stage->grid;
    if (slot == NULL || stage->steady.settled == NULL) {
        return;
    }
    const rim_job job = {grid, stage->steady.frames, slot->foreground, sheet};
    int32_t x0 = r.x0 > ABOUT ? r.x0 : ABOUT, y0 = r.y0 > ABOUT ? r.y0 : ABOUT;
    int32_t x1 = rlf_least(r.x1, grid->width - ABOUT), y1 = rlf_least(r.y1, grid->height - ABOUT);
    for (int32_t y = y0; y < y1; y++) {
        for (int32_t x = x0; x < x1; x++) { /* of those about a pixel only seen ones are read */
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            if (slot->foreground[i] != 0) {
                sheet->depth[i] = hidden_depth(stage, old, sheet->depth[i], i);
            } else if (!is_seen(&job, i)) {
                sheet->depth[i] = depth_at(&job, i);
            }
        }
    }
}
