/* Where rays leave the bodies of people by what their torsos and legs say. */
#include "surface/thickness/legs.h"

enum { MOST_CUTS = 3 + 2 * RLF_LEG_PARTS };

/* A thigh and its shin are one: what is seen of either shows both. */
typedef enum limb { HEAD, TRUNK, SHOULDERS, LEG, FOOT = LEG + 2 } limb;

static const double most_misfit = 0.9, least_area_m2 = 0.03;
static const double surface_m = 0.04, leg_surface_m = 0.03; /* what is so near the front is it */
static const double own_share = 0.7, own_limb_share = 0.65;
static const double margin_m = 0.2;     /* by which a ray may rise or fall within a body */
static const double most_doubt_m = 0.1; /* of a part's lower end: else it is anywhere */
static const double fold_m = 0.02;      /* by which legs begin above the crotch */
static const double lowest_m = 2.0;     /* below a head's top there are no feet */

/* A part of a leg that a row of knots may meet, from ray_x x0 to x1. */
typedef struct row_part {
    rlf_leg_part part;
    limb limb;
    double x0, x1;
} row_part;

/* What one row of knots may meet of a person. */
typedef struct row_sight {
    const rlf_torso *torso;
    rlf_vec3 camera; /* in the torso's axes */
    bool has_head, has_trunk;
    row_part part[2 * RLF_LEG_PARTS];
    int32_t count;
} row_sight;

/* The parts that a ray meets. */
typedef struct cuts {
    rlf_torso_cut item[MOST_CUTS];
    limb limb[MOST_CUTS];
    int32_t count;
    double face; /* how much of what is seen of the head is that */
} cuts;

/* Whether a ray at that slope goes by above the torso or below the feet. */
static bool is_beside(const rlf_torso *torso, double y)
{
    double below = y * torso->head.z - torso->head.y;
    return below < 0.0 || below > lowest_m;
}

static bool is_sure(const rlf_leg *leg, int part)
{
    int end = part == RLF_THIGH ? RLF_LEG_KNEE : RLF_LEG_ANKLE;
    return leg->doubt[end][end] + leg->doubt[end + 2][end + 2] < most_doubt_m * most_doubt_m;
}

/* Columns, as ray_x, between which a row at that slope may meet the part; false when it does not.
 */
static bool find_columns(const rlf_torso *torso, const rlf_leg_part *part, double y, row_part *out)
{
    const double wider = 1.1; /* than a ball's radius over its depth: it is seen aslant */
    const rlf_vec3 ends[2] = {rlf_torso_point(torso, part->begin),
                              rlf_torso_point(torso, part->end)};
    double top = 1e9, bottom = -1e9;
    out->x0 = 1e9;
    out->x1 = -1e9;
    for (int k = 0; k < 2; k++) {
        double r = wider * part->radius[k], z = rlf_max(ends[k].z, 0.1);
        top = rlf_min(top, (ends[k].y - r) / z);
        bottom = rlf_max(bottom, (ends[k].y + r) / z);
        out->x0 = rlf_min(out->x0, (ends[k].x - r) / z);
        out->x1 = rlf_max(out->x1, (ends[k].x + r) / z);
    }
    return y >= top && y <= bottom;
}

static row_sight look(const rlf_torso *torso, double y)
{
    row_sight out = {.torso = torso};
    out.camera = rlf_torso_place(torso, rlf_vec3_make(0.0, 0.0, 0.0));
    double down = out.camera.y + y * torso->head.z;
    out.has_head = y * torso->head.z - torso->head.y < rlf_torso_first;
    out.has_trunk = down < rlf_torso_crotch + margin_m;
    if (down < rlf_torso_crotch - fold_m) {
        return out;
    }
    for (int leg = 0; leg < 2; leg++) {
        rlf_leg_shape shape = rlf_leg_shape_of(torso, leg);
        for (int part = 0; part < RLF_LEG_PARTS; part++) {
            row_part *p = &out.part[out.count];
            if (is_sure(&torso->leg[leg], part) && find_columns(torso, &shape.part[part], y, p)) {
                p->part = shape.part[part];
                p->limb = (part == RLF_FOOT ? FOOT : LEG) + leg;
                out.count++;
            }
        }
    }
    return out;
}

static void add_cut(cuts *c, const rlf_torso_cut *cut, limb of)
{
    if (cut->enter < cut->leave) {
        c->item[c->count] = *cut;
        c->limb[c->count++] = of;
    }
}

static void find_cuts(const row_sight *row, double x, double y, cuts *out)
{
    const rlf_torso *torso = row->torso;
    rlf_torso_cut cut[2];
    out->count = 0;
    out->face = torso->skull.face;
    if (torso->skull.is_seen && row->has_head) {
        cut[0] = rlf_skull_cut_ray(&torso->skull, x, y);
        add_cut(out, &cut[0], HEAD);
    }
    if (row->has_trunk) {
        rlf_torso_cut_ray(torso, x, y, cut);
        add_cut(out, &cut[0], TRUNK);
        add_cut(out, &cut[1], SHOULDERS);
    }
    const rlf_vec3 way =
        rlf_vec3_make(x * torso->side_x + torso->side_z, y, torso->side_x - x * torso->side_z);
    for (int32_t k = 0; k < row->count; k++) {
        if (x >= row->part[k].x0 && x <= row->part[k].x1) {
            cut[0] = rlf_leg_cut_ray(&row->part[k].part, row->camera, way);
            add_cut(out, &cut[0], row->part[k].limb);
        }
    }
}

/* The part that is seen at that depth; -1 = none. */
static int32_t find_own(const cuts *c, double front)
{
    int32_t own = -1;
    double nearest = surface_m;
    for (int32_t k = 0; k < c->count; k++) {
        double off = front - c->item[k].enter;
        off = off < 0.0 ? -off : off;
        double most = c->limb[k] == TRUNK ? surface_m : leg_surface_m;
        if (c->limb[k] != SHOULDERS && off < most && off < nearest) {
            nearest = off;
            own = k;
        }
    }
    return own;
}

/* How much a part tells of its back; the rest is what its front shows, for a head all of its side.
 */
static double share_of(const cuts *c, int32_t own)
{
    switch (c->limb[own]) {
    case TRUNK: return own_share;
    case HEAD: return own_limb_share * c->face;
    default: return own_limb_share;
    }
}

/* Where the ray of a knot leaves the body, of which it is known from depth `front` to `back`. */
static double leave_of(const cuts *c, double front, double back)
{
    double end = back;
    int32_t own = find_own(c, front);
    if (own >= 0) {
        double share = share_of(c, own);
        end += share * (c->item[own].leave - end);
    }
    bool is_longer = true;
    while (is_longer) { /* each part goes on from another, perhaps */
        is_longer = false;
        for (int32_t k = 0; k < c->count; k++) {
            bool is_own = own >= 0 && c->limb[k] == c->limb[own];
            if (!is_own && c->item[k].enter <= end && c->item[k].leave > end) {
                end = c->item[k].leave;
                is_longer = true;
            }
        }
    }
    return end;
}

static void thicken(const rlf_chord_job *job, const rlf_torso *torso, int32_t knot_row)
{
    const rlf_grid *grid = &job->stage->grid;
    int32_t step = job->step, y = knot_row * step;
    ptrdiff_t row = (ptrdiff_t)y * grid->width;
    row_sight sight = {.torso = NULL};
    for (int32_t x = job->x0 / step * step; x < job->x0 + job->width; x += step) {
        ptrdiff_t knot = knot_row * job->knot_pitch + x / step;
        double front = job->knot[knot], ray_y = grid->ray_y[row + x];
        if (front > 0.0 && job->label[y * job->pitch + x] == torso->label &&
            !is_beside(torso, ray_y)) {
            if (sight.torso == NULL) {
                sight = look(torso, ray_y);
            }
            cuts met;
            find_cuts(&sight, grid->ray_x[row + x], ray_y, &met);
            double leave = leave_of(&met, front, front + (double)job->thickness[knot]);
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
