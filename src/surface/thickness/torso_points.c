/* Points of a person below the head. */
#include "surface/thickness/torso.h"

/* Where point `way` metres from the image's middle is, at depth z, in pixels lo..hi. */
static int32_t pixel_at(double way, double z, double focal, double centre, int32_t lo, int32_t hi)
{
    return (int32_t)rlf_clamp(centre + focal * way / z, lo, hi);
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
    out->count = 0;
    out->area_m2 = step * step * head.z * head.z / (c->fx * c->fy);
    for (int32_t y = y0; y < y1; y += step) {
        for (int32_t x = x0; x < x1; x += step) {
            double z = job->front[y * job->pitch + x];
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            if (z > 0.0 && job->label[y * job->pitch + x] == torso->label) {
                out->p[out->count++] =
                    rlf_vec3_make(z * (double)grid->ray_x[i], z * (double)grid->ray_y[i], z);
            }
        }
    }
}
