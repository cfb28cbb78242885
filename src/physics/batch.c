/* Batches: groups of contacts that share no body that moves, side by side in the solver's lanes.
 *
 * Pairs are coloured greedily in their order (each takes the first colour that neither of its
 * bodies has), then a colour's groups fill batches of eight, those with many points first, so that
 * few lanes are empty. The real surface comes last: nothing gives way less. */
#include "physics/fetch.h"
#include "physics/solver.h"

/* Contacts are springs of half the substep rate, critically damped, solved implicitly (Catto 2011,
 * "Soft constraints"): omega h = pi, a1 = 2 zeta + omega h, a2 = omega h a1. A tall stack stands
 * still where rigid contacts, solved by a few passes, keep tilting it. */
#define SOFT_OMEGA_H RLF_PI
#define SOFT_A1 (2.0 + SOFT_OMEGA_H)
#define SOFT_A2 (SOFT_OMEGA_H * SOFT_A1)
/* Overlaps are pushed apart no faster than this, m/s. */
#define PUSH_SPEED_MAX 3.0
/* Faster than that, what has no restitution meets hard, m/s. */
#define HARD_SPEED 0.1
/* Overlap left alone, as a share of the smaller body's radius, so that contacts persist. */
#define SLOP_SHARE 0.002

enum {
    COLOURS = 63, /* a body with more pairs gives the rest to batches of one lane */
    SURFACE_KEY = (COLOURS + 1) * PHYS_PAIR_CONTACTS,
    KEYS = SURFACE_KEY + PHYS_SURFACE_CONTACTS
};

static int32_t index_of(const rlf_world *world, const phys_body *body)
{
    return (int32_t)(body - world->bodies);
}

static uint64_t colours_of(const rlf_world *world, const phys_body *body)
{
    return phys_body_is_moving(body) ? world->colours[index_of(world, body)] : 0;
}

static void add_colour(rlf_world *world, const phys_body *body, int32_t colour)
{
    if (phys_body_is_moving(body)) {
        world->colours[index_of(world, body)] |= (uint64_t)1 << colour;
    }
}

static int32_t choose_colour(rlf_world *world, const phys_group *g)
{
    uint64_t taken = colours_of(world, g->a) | colours_of(world, g->b);
    int32_t colour = 0;
    while (colour < COLOURS && (taken >> colour & 1) != 0) {
        colour++;
    }
    if (colour < COLOURS) {
        add_colour(world, g->a, colour);
        add_colour(world, g->b, colour);
    }
    return colour;
}

/* Groups of a batch have neighbouring keys: by colour, then by the number of points, most first. */
static int32_t key_of(rlf_world *world, const phys_group *g)
{
    if (g->b == NULL) {
        return SURFACE_KEY + PHYS_SURFACE_CONTACTS - g->point_count;
    }
    return choose_colour(world, g) * PHYS_PAIR_CONTACTS + PHYS_PAIR_CONTACTS - g->point_count;
}

/* A number that is the same for the groups that may share a batch; -1: for none. */
static int32_t colour_of_key(int32_t key)
{
    int32_t colour = key / PHYS_PAIR_CONTACTS;
    return key >= SURFACE_KEY ? COLOURS + 1 : (colour < COLOURS ? colour : -1);
}

/* By counting: groups with the same key stay in their order. */
static void sort_groups(rlf_world *world, const phys_island *island, const phys_group *groups,
                        int32_t count)
{
    int32_t begin[KEYS + 1] = {0};
    int32_t *keys = world->batch_keys + island->pair_begin + island->body_begin;
    int32_t *order = world->batch_order + island->pair_begin + island->body_begin;
    for (int32_t i = island->body_begin; i < island->body_end; i++) {
        world->colours[world->island_bodies[i]] = 0;
    }
    for (int32_t k = 0; k < count; k++) {
        keys[k] = key_of(world, &groups[k]);
        begin[keys[k] + 1]++;
    }
    for (int32_t key = 0; key < KEYS; key++) {
        begin[key + 1] += begin[key];
    }
    for (int32_t k = 0; k < count; k++) {
        order[begin[keys[k]]++] = k;
    }
}

static void set_vec(rlf_lane_vec *of, int32_t lane, rlf_vec3 v)
{
    of->x[lane] = (float)v.x;
    of->y[lane] = (float)v.y;
    of->z[lane] = (float)v.z;
}

/* Whether a blow may be in the group that no impact has answered. */
static bool is_hard(const phys_group *g)
{
    return g->restitution <= 0.0 && g->speed > HARD_SPEED;
}

/* A spring would give way to a blow, whose speed is taken out where the sides just touch. Returns
 * whether the overlap is pushed apart at full speed. */
static bool set_targets(rlf_lane_point *p, int32_t lane, const phys_point *c, double slop, double h,
                        bool is_blow)
{
    float rest = 0.0f, push = 0.0f, ease = 0.0f;
    if (c->separation > 0.0) { /* may close the gap, not more */
        rest = push = (float)(-c->separation / h);
    } else if (!c->is_impacted) {
        double overlap = rlf_min(c->separation + slop, 0.0);
        push = (float)rlf_min(-SOFT_OMEGA_H / SOFT_A1 / h * overlap, PUSH_SPEED_MAX);
        ease = is_blow && !(overlap < 0.0) ? 0.0f : (float)(1.0 / (1.0 + SOFT_A2));
    }
    p->target[0][lane] = rest;
    p->target[1][lane] = push;
    p->ease[lane] = ease;
    return push >= (float)PUSH_SPEED_MAX;
}

static bool is_same(rlf_vec3 a, rlf_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static void add_points(phys_batch *batch, const phys_group *g, int32_t lane, double h)
{
    double radius = g->a->shape.radius;
    double slop = SLOP_SHARE * (g->b != NULL ? rlf_min(radius, g->b->shape.radius) : radius);
    bool is_blow = g->b == NULL && is_hard(g);
    rlf_vec3 tangent = {0, 0, 0};
    for (int32_t i = 0; i < g->point_count; i++) {
        rlf_lane_point *p = &batch->lanes.points[i];
        const phys_point *near = &g->points[i];
        const double *impulses = near->impulses;
        batch->contacts[i].of[lane] = near->contact;
        if (i == 0 || !is_same(near->normal, near[-1].normal)) {
            tangent = rlf_perpendicular(near->normal);
        }
        set_vec(&p->normal, lane, near->normal);
        set_vec(&p->tangent, lane, tangent);
        set_vec(&p->r_a, lane, near->r_a);
        set_vec(&p->r_b, lane, near->r_b);
        batch->is_deep |= set_targets(p, lane, near, slop, h, is_blow) && g->b != NULL;
        p->friction[lane] = (float)g->friction;
        for (int32_t row = 0; row < 3; row++) {
            p->impulse[row][lane] = impulses[0] > 0.0 ? (float)impulses[row] : 0.0f;
        }
    }
}

static float set_inertia(rlf_lane_mat *inertia, int32_t lane, const phys_body *body,
                         float lightness)
{
    if (!phys_body_is_moving(body)) {
        return 0.0f;
    }
    const rlf_mat3 *m = &body->inverse_inertia_world;
    inertia->xx[lane] = (float)m->m[0][0] * lightness;
    inertia->xy[lane] = (float)m->m[0][1] * lightness;
    inertia->xz[lane] = (float)m->m[0][2] * lightness;
    inertia->yy[lane] = (float)m->m[1][1] * lightness;
    inertia->yz[lane] = (float)m->m[1][2] * lightness;
    inertia->zz[lane] = (float)m->m[2][2] * lightness;
    return (float)body->inverse_mass * lightness;
}

static void add_group(const rlf_world *world, phys_batch *batch, const phys_group *g, double h)
{
    rlf_lane_batch *lanes = &batch->lanes;
    int32_t lane = batch->count++;
    batch->groups[lane] = g;
    batch->resists_rolling = batch->resists_rolling || g->a->rolling_resistance > 0.0 ||
                             (g->b != NULL && g->b->rolling_resistance > 0.0);
    batch->is_hard = batch->is_hard || is_hard(g);
    lanes->a[lane] = index_of(world, g->a);
    lanes->b[lane] = g->b != NULL ? index_of(world, g->b) : lanes->a[lane];
    lanes->inverse_mass_a[lane] =
        set_inertia(&lanes->inverse_inertia_a, lane, g->a, world->lightness[lanes->a[lane]]);
    if (g->b != NULL) {
        lanes->inverse_mass_b[lane] =
            set_inertia(&lanes->inverse_inertia_b, lane, g->b, world->lightness[lanes->b[lane]]);
    }
    add_points(batch, g, lane, h);
}

/* A batch for a first group; the next ones have no more points. */
static void start_batch(phys_batch *batch, rlf_lane_point *points, phys_lane_contacts *contacts,
                        const phys_group *first)
{
    *batch = (phys_batch){.lanes = {.points = points, .point_count = first->point_count}};
    batch->contacts = contacts;
    batch->lanes.has_b = first->b != NULL;
    for (int32_t i = 0; i < first->point_count; i++) {
        contacts[i] = (phys_lane_contacts){{NULL}};
    }
}

/* All zero where the lanes from `first` on have no point. */
static void clear_lanes(rlf_lane_point *p, int32_t first)
{
    float(*values)[RLF_LANES] = (float(*)[RLF_LANES])p; /* it holds nothing else */
    for (size_t k = 0; k < sizeof(*p) / sizeof(values[0]); k++) {
        for (int32_t lane = first; lane < RLF_LANES; lane++) {
            values[k][lane] = 0.0f;
        }
    }
}

static void close_batch(phys_batch *batch)
{
    for (int32_t i = 0; i < batch->lanes.point_count; i++) {
        int32_t first = batch->count; /* the last lanes have the fewest points */
        while (first > 0 && batch->contacts[i].of[first - 1] == NULL) {
            first--;
        }
        if (first < RLF_LANES) {
            clear_lanes(&batch->lanes.points[i], first);
        }
    }
    for (int32_t lane = batch->count; lane < RLF_LANES; lane++) {
        batch->lanes.a[lane] = batch->lanes.a[0];
        batch->lanes.b[lane] = batch->lanes.b[0];
    }
    rlf_kernel_lanes_weigh(&batch->lanes);
}

/* What a batch holds of a group's body. */
RLF_KERNEL_PART void fetch_side(const phys_body *body)
{
    RLF_KERNEL_SOON(&body->inverse_mass);
    RLF_KERNEL_SOON(&body->is_alive);
    phys_fetch_weight(body);
}

/* Fetches the groups that will be put into batches after the k-th, and what they are of. */
RLF_KERNEL_PART void fetch_groups(const phys_group *groups, const int32_t *order, int32_t k,
                                  int32_t count)
{
    enum { GROUPS_AHEAD = 8, POINTS_AHEAD = 4 };
    if (k + GROUPS_AHEAD < count) {
        RLF_KERNEL_SOON(&groups[order[k + GROUPS_AHEAD]]);
    }
    if (k + POINTS_AHEAD < count) {
        const phys_group *g = &groups[order[k + POINTS_AHEAD]];
        phys_fetch(g->points, (size_t)g->point_count * sizeof(phys_point));
        fetch_side(g->a);
        if (g->b != NULL) {
            fetch_side(g->b);
        }
    }
}

int32_t phys_batches_make(rlf_world *world, const phys_island *island, const phys_group *groups,
                          int32_t count, double h)
{
    phys_batch *batches = phys_batches_of(world, island);
    int32_t begin =
        island->pair_begin * PHYS_PAIR_CONTACTS + island->body_begin * PHYS_SURFACE_CONTACTS;
    rlf_lane_point *points = world->batch_points + begin;
    phys_lane_contacts *contacts = world->batch_contacts + begin;
    const int32_t *keys = world->batch_keys + island->pair_begin + island->body_begin;
    const int32_t *order = world->batch_order + island->pair_begin + island->body_begin;
    int32_t made = 0, colour = -1;
    sort_groups(world, island, groups, count);
    for (int32_t k = 0; k < count; k++) {
        const phys_group *g = &groups[order[k]];
        fetch_groups(groups, order, k, count);
        int32_t own = colour_of_key(keys[order[k]]);
        if (made == 0 || own < 0 || own != colour || batches[made - 1].count == RLF_LANES) {
            start_batch(&batches[made], points, contacts, g);
            batches[made++].is_apart = own >= 0 && own == colour;
            points += g->point_count;
            contacts += g->point_count;
            colour = own;
        }
        add_group(world, &batches[made - 1], g, h);
    }
    for (int32_t k = 0; k < made; k++) {
        close_batch(&batches[k]);
    }
    return made;
}

static void finish_row(const phys_lane_contacts *row, const rlf_lane_point *point)
{
    for (int32_t lane = 0; lane < RLF_LANES && row->of[lane] != NULL; lane++) {
        phys_contact *c = row->of[lane];
        for (int32_t k = 0; k < 3; k++) {
            c->impulses[k] = (double)point->impulse[k][lane];
        }
        c->impulse_sum += c->impulses[0];
    }
}

RLF_KERNEL_PART void fetch_row(const phys_lane_contacts *row)
{
    for (int32_t lane = 0; lane < RLF_LANES && row->of[lane] != NULL; lane++) {
        RLF_KERNEL_SOON_WRITTEN(row->of[lane]->impulses);
    }
}

void phys_batches_finish(const phys_batch *batches, int32_t count)
{
    enum { AHEAD = 2 };
    if (count == 0) {
        return;
    }
    const phys_batch *last = &batches[count - 1];
    const phys_lane_contacts *rows = batches->contacts; /* those of all batches, side by side */
    ptrdiff_t row_count = last->contacts + last->lanes.point_count - rows;
    for (ptrdiff_t i = 0; i < row_count; i++) {
        if (i + AHEAD < row_count) {
            fetch_row(&rows[i + AHEAD]);
        }
        finish_row(&rows[i], &batches->lanes.points[i]);
    }
}
