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

/* A part of a leg; only rays at slopes ray_y from y0 to y1 and ray_x from x0 to x1 meet it. */
typedef struct leg_part {
    rlf_kernel_limb limb;
    limb kind;
    double x0, x1, y0, y1;
} leg_part;

/* A person, as rays see one. */
typedef struct sight {
    const rlf_torso *torso;
    rlf_span columns, rows; /* pixels of the region in the block */
    rlf_vec3 camera;        /* in the torso's axes */
    leg_part part[2 * RLF_LEG_PARTS];
    int32_t count;
} sight;

/* Knots of a row that are of the person, and their rays. */
typedef struct knots {
    int32_t count;
    ptrdiff_t knot[RLF_KERNEL_RAYS];
    double x[RLF_KERNEL_RAYS], y[RLF_KERNEL_RAYS];
    double row_y; /* slope of the first in the row */
    rlf_kernel_ray_lanes rays;
} knots;

/* The parts that a ray meets. */
typedef struct cuts {
    rlf_torso_cut item[MOST_CUTS];
    limb limb[MOST_CUTS];
    int32_t count;
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

/* Slopes of the rays that may meet the part. */
static void find_window(const rlf_torso *torso, const rlf_leg_part *part, leg_part *out)
{
    const double wider = 1.1; /* than a ball's radius over its depth: it is seen aslant */
    const rlf_vec3 ends[2] = {rlf_torso_point(torso, part->begin),
                              rlf_torso_point(torso, part->end)};
    out->x0 = out->y0 = 1e9;
    out->x1 = out->y1 = -1e9;
    for (int k = 0; k < 2; k++) {
        double r = wider * part->radius[k], z = rlf_max(ends[k].z, 0.1);
        out->y0 = rlf_min(out->y0, (ends[k].y - r) / z);
        out->y1 = rlf_max(out->y1, (ends[k].y + r) / z);
        out->x0 = rlf_min(out->x0, (ends[k].x - r) / z);
        out->x1 = rlf_max(out->x1, (ends[k].x + r) / z);
    }
}

static void look(const rlf_chord_job *job, const rlf_torso *torso, sight *out)
{
    const rlf_slot *slot = job->slot;
    out->torso = torso;
    out->count = 0;
    out->columns = out->rows = (rlf_span){0, 0};
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        const rlf_region *region = &slot->regions[slot->foreground_region_first + r];
        if (region->label == torso->label) {
            int32_t end = job->x0 + job->width;
            out->columns.x0 = region->x0 > job->x0 ? region->x0 : job->x0;
            out->columns.x1 = region->x1 < end ? region->x1 : end;
            out->rows = (rlf_span){region->y0, region->y1};
        }
    }
    out->camera = rlf_torso_place(torso, rlf_vec3_make(0.0, 0.0, 0.0));
    for (int leg = 0; leg < 2; leg++) {
        rlf_leg_shape shape = rlf_leg_shape_of(torso, leg);
        for (int part = 0; part < RLF_LEG_PARTS; part++) {
            if (is_sure(&torso->leg[leg], part)) {
                leg_part *p = &out->part[out->count++];
                find_window(torso, &shape.part[part], p);
                p->limb = rlf_leg_limb(&shape.part[part], out->camera);
                p->kind = (part == RLF_FOOT ? FOOT : LEG) + leg;
            }
        }
    }
}

static void add_cut(cuts *c, double enter, double leave, limb of)
{
    if (enter < leave) {
        c->item[c->count] = (rlf_torso_cut){enter, leave};
        c->limb[c->count++] = of;
    }
}

static void add_cuts(const rlf_kernel_cuts *cut, int32_t begin, int32_t end, limb of, cuts *met)
{
    for (int32_t i = begin; i < end; i++) {
        add_cut(&met[i], cut->enter[i], cut->leave[i], of);
    }
}

static void cut_legs(const sight *s, const knots *k, cuts *met)
{
    const int32_t lanes = RLF_KERNEL_RAY_LANES;
    for (int32_t p = 0; p < s->count; p++) {
        const leg_part *part = &s->part[p];
        if (!(k->row_y >= part->y0 && k->row_y <= part->y1)) {
            continue;
        }
        int32_t begin = 0, end = k->count;
        while (begin < end && !(k->x[begin] >= part->x0 && k->x[begin] <= part->x1)) {
            begin++;
        }
        while (end > begin && !(k->x[end - 1] >= part->x0 && k->x[end - 1] <= part->x1)) {
            end--;
        }
        rlf_kernel_cuts cut;
        rlf_kernel_cut_limb(&part->limb, &k->rays, begin / lanes * lanes,
                            (end + lanes - 1) / lanes * lanes, &cut);
        add_cuts(&cut, begin, end, part->kind, met);
    }
}

/* What each ray meets. */
static void find_cuts(const sight *s, const knots *k, cuts *met)
{
    const rlf_torso *torso = s->torso;
    double below_top = k->row_y * torso->head.z - torso->head.y;
    double down = s->camera.y + k->row_y * torso->head.z;
    for (int32_t i = 0; i < k->count; i++) {
        met[i].count = 0;
        if (torso->skull.is_seen && below_top < rlf_torso_first) {
            rlf_torso_cut cut = rlf_skull_cut_ray(&torso->skull, k->x[i], k->y[i]);
            add_cut(&met[i], cut.enter, cut.leave, HEAD);
        }
    }
    if (down < rlf_torso_crotch + margin_m) {
        rlf_kernel_cuts trunk, shoulders;
        rlf_torso_cut_rays(torso, &k->rays, &trunk);
        add_cuts(&trunk, 0, k->count, TRUNK, met);
        if (rlf_torso_cut_shoulders(torso, &k->rays, &shoulders)) {
            add_cuts(&shoulders, 0, k->count, SHOULDERS, met);
        }
    }
    if (!(down < rlf_torso_crotch - fold_m)) {
        cut_legs(s, k, met);
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
static double share_of(const rlf_torso *torso, limb own)
{
    switch (own) {
    case TRUNK: return own_share;
    case HEAD: return own_limb_share * torso->skull.face;
    default: return own_limb_share;
    }
}

/* Where the ray of a knot leaves the body, of which it is known from depth `front` to `back`. */
static double leave_of(const rlf_torso *torso, const cuts *c, double front, double back)
{
    double end = back;
    int32_t own = find_own(c, front);
    if (own >= 0) {
        double share = share_of(torso, c->limb[own]);
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

static void thicken(const rlf_chord_job *job, const sight *s, knots *k)
{
    cuts met[RLF_KERNEL_RAYS];
    if (k->count == 0) {
        return;
    }
    rlf_torso_close_rays(&k->rays);
    find_cuts(s, k, met);
    for (int32_t i = 0; i < k->count; i++) {
        float *thickness = &job->thickness[k->knot[i]];
        double front = job->knot[k->knot[i]];
        double leave = leave_of(s->torso, &met[i], front, front + (double)*thickness);
        *thickness = (float)rlf_max(leave - front, 0.0);
    }
    k->count = k->rays.count = 0;
}

static void thicken_row(const rlf_chord_job *job, const sight *s, int32_t knot_row)
{
    const rlf_grid *grid = &job->stage->grid;
    int32_t step = job->step, y = knot_row * step;
    ptrdiff_t row = (ptrdiff_t)y * grid->width;
    knots k;
    bool is_first = true;
    k.count = 0;
    rlf_torso_begin_rays(s->torso, &k.rays);
    for (int32_t x = (s->columns.x0 + step - 1) / step * step; x < s->columns.x1; x += step) {
        ptrdiff_t knot = knot_row * job->knot_pitch + x / step;
        double ray_x = grid->ray_x[row + x], ray_y = grid->ray_y[row + x];
        if (job->knot[knot] > 0.0f && job->label[y * job->pitch + x] == s->torso->label &&
            !is_beside(s->torso, ray_y)) {
            k.row_y = is_first ? ray_y : k.row_y;
            is_first = false;
            k.knot[k.count] = knot;
            k.x[k.count] = ray_x;
            k.y[k.count++] = ray_y;
            rlf_torso_add_ray(s->torso, ray_x, ray_y, &k.rays);
            if (k.count == RLF_KERNEL_RAYS) {
                thicken(job, s, &k);
            }
        }
    }
    thicken(job, s, &k);
}

void rlf_torsos_thicken(const rlf_chord_job *job, int32_t begin, int32_t end)
{
    const rlf_torsos *torsos = job->torsos;
    for (int32_t k = 0; k < torsos->count; k++) {
        const rlf_torso *torso = &torsos->item[k];
        if (torso->is_seen && torso->misfit <= most_misfit && torso->area_m2 >= least_area_m2) {
            sight s;
            look(job, torso, &s);
            for (int32_t row = begin; row < end; row++) {
                if (row * job->step >= s.rows.x0 && row * job->step < s.rows.x1) {
                    thicken_row(job, &s, row);
                }
            }
        }
    }
}
