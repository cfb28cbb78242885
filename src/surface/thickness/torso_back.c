/* Where rays leave the bodies of people by what their torsos say. */
#include "surface/thickness/torso.h"

static const double most_misfit = 0.9, least_area_m2 = 0.03;
static const double surface_m = 0.04; /* what is so near the trunk's front is it */
static const double margin_m = 0.2;   /* by which a ray may rise or fall within a body */
static const double own_share = 0.65; /* of a trunk's back; the rest is what its front shows */

/* Whether a ray at that slope goes by above the torso or below it. */
static bool is_beside(const rlf_torso *torso, double y)
{
    double below = y * torso->head.z - torso->head.y;
    return below < rlf_torso_first - margin_m || below > rlf_torso_last + margin_m;
}

/* Where the ray of a knot leaves the body, of which it is known from depth `front` to `back`. */
static double leave_of(const rlf_torso *torso, double x, double y, double front, double back)
{
    rlf_torso_cut cut[2];
    rlf_torso_cut_ray(torso, x, y, cut);
    double end = back;
    bool is_trunk = cut[0].enter < cut[0].leave && front > cut[0].enter - surface_m &&
                    front < cut[0].enter + surface_m;
    if (is_trunk) {
        end += own_share * (cut[0].leave - end);
    }
    for (int k = 0; k < 4; k++) { /* each part goes on from the other, perhaps */
        const rlf_torso_cut *c = &cut[k % 2];
        bool is_own = is_trunk && k % 2 == 0;
        if (!is_own && c->enter <= end && c->leave > end) {
            end = c->leave;
        }
    }
    return end;
}

static void thicken(const rlf_chord_job *job, const rlf_torso *torso, int32_t knot_row)
{
    const rlf_grid *grid = &job->stage->grid;
    int32_t step = job->step, y = knot_row * step;
    ptrdiff_t row = (ptrdiff_t)y * grid->width;
    for (int32_t x = job->x0 / step * step; x < job->x0 + job->width; x += step) {
        ptrdiff_t knot = knot_row * job->knot_pitch + x / step;
        double front = job->knot[knot], ray_y = grid->ray_y[row + x];
        if (front > 0.0 && job->label[y * job->pitch + x] == torso->label &&
            !is_beside(torso, ray_y)) {
            double back = front + (double)job->thickness[knot];
            double leave = leave_of(torso, grid->ray_x[row + x], ray_y, front, back);
            job->thickness[knot] = (float)rlf_max(leave - front, 0.0);
        }
    }
}

void rlf_torsos_thicken(const rlf_chord_job *job, int32_t knot_row)
{
    const rlf_torsos *torsos = job->torsos;
    for (int32_t k = 0; k < torsos->count; k++) {
        const rlf_torso *torso = &torsos->item[k];
        if (torso->is_seen && torso->misfit <= most_misfit && torso->area_m2 >= least_area_m2) {
            thicken(job, torso, knot_row);
        }
    }
}
