/* Where a point that was seen is a little later. */
#include "surface/past.h"

static const double longest_gap_s = 0.2;
static const float least_z = 0.1f;
static const float body_jump_m = 0.04f;
static const float drift = 0.05f; /* share of the way that velocity is off */

float rlf_past_elapsed(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_slot *before = stage->previous;
    double dt =
        before == NULL ? 0.0 : 1e-9 * (double)(slot->surface.time_ns - before->surface.time_ns);
    return dt > 0.0 && dt <= longest_gap_s ? (float)dt : 0.0f;
}

/* The step in the image is measured with the focal length, as in velocity.h. */
void rlf_past_advance(const rlf_grid *grid, float dt, rlf_past_point *p)
{
    const float *v = p->velocity;
    float x = p->x / p->z, y = p->y / p->z;
    float speed = (float)sqrt((double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    p->x += v[0] * dt;
    p->y += v[1] * dt;
    p->z += v[2] * dt;
    p->z = p->z > least_z ? p->z : least_z;
    p->u += (p->x / p->z - x) * (float)grid->camera.fx;
    p->v += (p->y / p->z - y) * (float)grid->camera.fy;
    p->age += dt;
    p->doubt += drift * dt * speed;
}

bool rlf_past_move_pixel(const rlf_grid *grid, const rlf_slot *slot, int32_t x, int32_t y, float dt,
                         rlf_past_point *out)
{
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    float z = slot->depth[i], square = 0.0f;
    for (int k = 0; k < 3; k++) {
        out->velocity[k] = slot->velocity[k][i];
        square += out->velocity[k] * out->velocity[k];
    }
    if (!(square > 0.0f) || !(z > least_z)) {
        return false;
    }
    out->x = z * grid->ray_x[i];
    out->y = z * grid->ray_y[i];
    out->z = z;
    out->u = (float)x;
    out->v = (float)y;
    out->age = out->doubt = 0.0f;
    rlf_past_advance(grid, dt, out);
    return true;
}

ptrdiff_t rlf_past_pixel_of(const rlf_grid *grid, const rlf_past_point *p)
{
    if (!(p->u > -0.5f) || !(p->v > -0.5f) || !(p->u < (float)grid->width - 0.5f) ||
        !(p->v < (float)grid->height - 0.5f)) {
        return -1;
    }
    return (ptrdiff_t)(int32_t)(p->v + 0.5f) * grid->width + (int32_t)(p->u + 0.5f);
}

/* Pixels of the same body from k on along `step`, up to `limit`. */
static int32_t run_length(const rlf_slot *slot, ptrdiff_t k, ptrdiff_t step, int32_t limit)
{
    int32_t n = 0;
    while (n < limit && rlf_past_is_front(slot, k + (n + 1) * step)) {
        float jump = slot->depth[k + (n + 1) * step] - slot->depth[k + n * step];
        if (jump > body_jump_m || jump < -body_jump_m) {
            break;
        }
        n++;
    }
    return n;
}

static int32_t least_of(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

bool rlf_past_is_narrow(const rlf_grid *grid, const rlf_slot *slot, ptrdiff_t k, int32_t most)
{
    int32_t x = (int32_t)(k % grid->width), y = (int32_t)(k / grid->width);
    int32_t row = run_length(slot, k, 1, least_of(most, grid->width - 1 - x)) +
                  run_length(slot, k, -1, least_of(most, x));
    int32_t column = run_length(slot, k, grid->width, least_of(most, grid->height - 1 - y)) +
                     run_length(slot, k, -(ptrdiff_t)grid->width, least_of(most, y));
    return least_of(row, column) < most;
}
