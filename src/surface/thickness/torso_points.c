/* Points of a person below the head, as the sensor gave them: what is filled at an outline lies too
 * near, by a centimetre at its edge, and so would make solids too thick. */
#include "surface/thickness/torso.h"

static const float rim_jump_m = 0.04f;

/* Where point `way` metres from the image's middle is, at depth z, in pixels lo..hi. */
static int32_t pixel_at(double way, double z, double focal, double centre, int32_t lo, int32_t hi)
{
    return (int32_t)rlf_clamp(centre + focal * way / z, lo, hi);
}

/* Adds where the row's pixels x0 <= x < x1 of the torso begin and end before something farther. */
static void find_rim(const rlf_chord_job *job, const rlf_torso *torso, int32_t y, int32_t x0,
                     int32_t x1, int32_t most, rlf_torso_points *out)
{
    const rlf_grid *grid = &job->stage->grid;
    ptrdiff_t row = (ptrdiff_t)y * grid->width;
    for (int32_t x = x0 + 1; x < x1 && out->rim_count < most; x++) {
        float left = job->slot->depth[row + x - 1], right = job->slot->depth[row + x];
        bool ends = right > left + rim_jump_m, begins = left > right + rim_jump_m;
        ptrdiff_t nearer = y * job->pitch + (ends ? x - 1 : x);
        if ((ends || begins) && job->front[nearer] > 0.0f && job->label[nearer] == torso->label) {
            const float *ray_x = grid->ray_x + row + x;
            double z = (double)job->front[nearer], middle = 0.5 * (double)(ray_x[-1] + ray_x[0]);
            out->rim[out->rim_count++] =
                rlf_vec3_make(z * middle, z * (double)grid->ray_y[row + x], z);
        }
    }
}

void rlf_torso_find_points(const rlf_chord_job *job, const rlf_torso *torso,
                           const rlf_torso_window *window, rlf_torso_points *out)
{
    const rlf_grid *grid = &job->stage->grid;
    const rlf_camera *c = &grid->camera;
    rlf_vec3 head = torso->head;
    int32_t right = job->x0 + job->width, bottom = job->y0 + job->height;
    int32_t x0 = pixel_at(head.x - window->beside, head.z, c->fx, c->cx, job->x0, right);
    int32_t x1 = pixel_at(head.x + window->beside, head.z, c->fx, c->cx, job->x0, right);
    int32_t y0 = pixel_at(head.y + window->top, head.z, c->fy, c->cy, job->y0, bottom);
    int32_t y1 = pixel_at(head.y + window->bottom, head.z, c->fy, c->cy, job->y0, bottom);
    int32_t step = 1;
    while (((x1 - x0) / step + 1) * ((y1 - y0) / step + 1) > window->most) {
        step++;
    }
    out->count = out->rim_count = 0;
    out->area_m2 = step * step * head.z * head.z / (c->fx * c->fy);
    for (int32_t y = y0; y < y1; y += step) {
        find_rim(job, torso, y, x0, x1, window->most_rim, out);
        for (int32_t x = x0; x < x1; x += step) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x, k = y * job->pitch + x;
            if (job->front[k] > 0.0f && job->inverse[k] > 0.0f && job->label[k] == torso->label) {
                double z = 1.0 / (double)job->inverse[k];
                out->p[out->count++] =
                    rlf_vec3_make(z * (double)grid->ray_x[i], z * (double)grid->ray_y[i], z);
            }
        }
    }
}
