/* Reading the pixels about a touch, and what they say together. */
#include "physics/grid/ball/ball.h"
#include "physics/grid/field.h"

#define RAW 3.0 /* noise of one frame beside that of a mean over ten */

double patch_band(double z)
{
    return 0.003 + 0.0005 * z * z;
}

rlf_vec3 patch_centre_at(const grid_job *job, double time)
{
    return rlf_mad(job->motion.centre, job->motion.v, rlf_max(0.0, time));
}

void patch_limit_thickness(const grid_job *job, field_cell *cell)
{
    if (cell->is_guess) {
        cell->thickness = grid_guess_depth(job->query->grid, job->sheet, cell, cell->thickness);
    }
}

rlf_vec3 patch_back_of(const field_cell *cell, rlf_vec3 p)
{
    return rlf_mad(p, grid_cell_inward(cell), cell->thickness);
}

void patch_read(grid_patch *p)
{
    const grid_job *job = p->job;
    double tau = job->query->tau + rlf_max(0.0, p->time);
    p->centre = patch_centre_at(job, p->time);
    p->count = 0;
    int32_t *index = p->index;
    p->nearest = -1;
    for (int32_t dy = -PATCH_PX; dy <= PATCH_PX; dy++) {
        for (int32_t dx = -PATCH_PX; dx <= PATCH_PX; dx++) {
            patch_sample *s = &p->samples[p->count];
            *index = 0;
            index++;
            if (!grid_cell_read(job->query->grid, job->sheet, p->x + dx * p->step,
                                p->y + dy * p->step, &s->cell)) {
                continue;
            }
            s->point = rlf_mad(s->cell.point, s->cell.velocity, tau);
            if (p->face == GRID_TOUCH_BACK) {
                patch_limit_thickness(job, &s->cell);
                s->point = patch_back_of(&s->cell, s->point);
            }
            s->distance = rlf_length(rlf_sub(p->centre, s->point)) - job->body->shape.shape.radius;
            if (p->nearest < 0 || s->distance < p->samples[p->nearest].distance) {
                p->nearest = p->count;
            }
            p->count++;
            index[-1] = p->count;
        }
    }
}

/* As much surface as the pixel shows, in pixels seen head-on at 1 m. */
static double area_of(const field_cell *cell)
{
    double cosine = -rlf_dot(cell->normal, cell->point) / rlf_length(cell->point);
    return cell->point.z * cell->point.z / rlf_max(cosine, 0.15);
}

double patch_weight(const grid_patch *p, const patch_sample *s)
{
    const patch_sample *nearest = &p->samples[p->nearest];
    bool is_of_one_frame = p->job->sheet->velocity_x != NULL;
    double band = patch_band(nearest->cell.point.z) * (is_of_one_frame ? RAW : 1.0);
    double share = 1.0 - (s->distance - nearest->distance) / band;
    if (share <= 0.0 || !patch_is_of_face(s->cell.normal, nearest->cell.normal)) {
        return 0.0;
    }
    return share * share * area_of(&s->cell);
}

patch_mean patch_mean_of(const grid_patch *p)
{
    rlf_vec3 points = {0, 0, 0}, normals = {0, 0, 0}, velocities = {0, 0, 0};
    double total = 0.0;
    rlf_vec3 origin = p->samples[p->nearest].point; /* small differences, few digits lost */
    for (int32_t i = 0; i < p->count; i++) {
        const patch_sample *s = &p->samples[i];
        double weight = patch_weight(p, s);
        if (!(weight > 0.0)) {
            continue;
        }
        rlf_vec3 d = rlf_sub(s->point, origin);
        points = rlf_mad(points, d, weight);
        normals = rlf_mad(normals, s->cell.normal, weight);
        velocities = rlf_mad(velocities, s->cell.velocity, weight);
        total += weight;
    }
    rlf_vec3 d = rlf_scale(points, 1.0 / total);
    rlf_vec3 n = rlf_scale(normals, 1.0 / total);
    patch_mean mean = {.point = rlf_add(origin, d), .normal = rlf_normalize(n)};
    mean.velocity = rlf_scale(velocities, 1.0 / total);
    return mean;
}

rlf_vec3 patch_foot(const grid_patch *p, const patch_mean *mean)
{
    double height = rlf_dot(mean->normal, rlf_sub(p->centre, mean->point));
    return rlf_mad(p->centre, mean->normal, -height);
}
