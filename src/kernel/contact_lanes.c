/* Sequential impulses in eight lanes. */
#include "kernel/lanes.h"
#include "kernel/kernel.h"

#include <math.h>
#include <string.h>

typedef struct lane_vec {
    float x, y, z;
} lane_vec;

typedef struct lane_speeds {
    rlf_lane_vec v_a, w_a, v_b, w_b;
} lane_speeds;

/* A copy of the batch's, which no pointer reaches: the compiler need not fear for it. */
typedef struct lane_sides {
    float mass_a[RLF_LANES], mass_b[RLF_LANES];
    rlf_lane_mat inertia_a, inertia_b;
} lane_sides;

RLF_KERNEL_PART lane_vec at(const rlf_lane_vec *of, int32_t lane)
{
    lane_vec v = {of->x[lane], of->y[lane], of->z[lane]};
    return v;
}

RLF_KERNEL_PART float dot(lane_vec a, lane_vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

RLF_KERNEL_PART lane_vec cross(lane_vec a, lane_vec b)
{
    lane_vec v = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return v;
}

RLF_KERNEL_PART lane_vec mad(lane_vec a, lane_vec b, float s)
{
    lane_vec v = {a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
    return v;
}

RLF_KERNEL_PART lane_vec weighed(const rlf_lane_mat *m, int32_t lane, lane_vec v)
{
    lane_vec r = {m->xx[lane] * v.x + m->xy[lane] * v.y + m->xz[lane] * v.z,
                  m->xy[lane] * v.x + m->yy[lane] * v.y + m->yz[lane] * v.z,
                  m->xz[lane] * v.x + m->yz[lane] * v.y + m->zz[lane] * v.z};
    return r;
}

RLF_KERNEL_PART float magnitude(float x)
{
    return x < 0.0f ? -x : x;
}

RLF_KERNEL_PART lane_sides sides_of(const rlf_lane_batch *batch)
{
    lane_sides sides;
    memcpy(sides.mass_a, batch->inverse_mass_a, sizeof(sides.mass_a));
    memcpy(sides.mass_b, batch->inverse_mass_b, sizeof(sides.mass_b));
    sides.inertia_a = batch->inverse_inertia_a;
    sides.inertia_b = batch->inverse_inertia_b;
    return sides;
}

RLF_KERNEL_PART void load_lane(const rlf_lane_speed *speed, int32_t lane, rlf_lane_vec *v,
                               rlf_lane_vec *w)
{
    v->x[lane] = speed->of[0];
    v->y[lane] = speed->of[1];
    v->z[lane] = speed->of[2];
    w->x[lane] = speed->of[3];
    w->y[lane] = speed->of[4];
    w->z[lane] = speed->of[5];
}

RLF_KERNEL_PART lane_speeds load(const rlf_lane_batch *batch, const rlf_lane_speed *speeds)
{
    lane_speeds s;
    for (int32_t lane = 0; lane < RLF_LANES; lane++) {
        load_lane(&speeds[batch->a[lane]], lane, &s.v_a, &s.w_a);
        load_lane(&speeds[batch->b[lane]], lane, &s.v_b, &s.w_b);
    }
    return s;
}

RLF_KERNEL_PART void store_lane(const rlf_lane_vec *v, const rlf_lane_vec *w, int32_t lane,
                                rlf_lane_speed *speed)
{
    speed->of[0] = v->x[lane];
    speed->of[1] = v->y[lane];
    speed->of[2] = v->z[lane];
    speed->of[3] = w->x[lane];
    speed->of[4] = w->y[lane];
    speed->of[5] = w->z[lane];
}

/* What does not move is not written: others may be reading it. */
RLF_KERNEL_PART void store(const rlf_lane_batch *batch, const lane_speeds *s, bool has_b,
                           rlf_lane_speed *speeds)
{
    for (int32_t lane = 0; lane < RLF_LANES; lane++) {
        if (batch->inverse_mass_a[lane] > 0.0f) {
            store_lane(&s->v_a, &s->w_a, lane, &speeds[batch->a[lane]]);
        }
        if (has_b && batch->inverse_mass_b[lane] > 0.0f) {
            store_lane(&s->v_b, &s->w_b, lane, &speeds[batch->b[lane]]);
        }
    }
}

/* Velocity of a's point as b or the surface sees it. */
RLF_KERNEL_PART lane_vec relative(const rlf_lane_point *p, const lane_speeds *s, bool has_b,
                                  int32_t lane)
{
    lane_vec of_a = mad(at(&s->v_a, lane), cross(at(&s->w_a, lane), at(&p->r_a, lane)), 1.0f);
    lane_vec of_b = at(&p->r_b, lane);
    if (has_b) {
        of_b = mad(at(&s->v_b, lane), cross(at(&s->w_b, lane), of_b), 1.0f);
    }
    return mad(of_a, of_b, -1.0f);
}

RLF_KERNEL_PART void add(rlf_lane_vec *sum, int32_t lane, lane_vec v, float scale)
{
    sum->x[lane] += v.x * scale;
    sum->y[lane] += v.y * scale;
    sum->z[lane] += v.z * scale;
}

RLF_KERNEL_PART void push_by(const lane_sides *sides, const rlf_lane_point *p, bool has_b,
                             int32_t lane, lane_vec impulse, lane_speeds *s)
{
    lane_vec turn = cross(at(&p->r_a, lane), impulse);
    add(&s->v_a, lane, impulse, sides->mass_a[lane]);
    add(&s->w_a, lane, weighed(&sides->inertia_a, lane, turn), 1.0f);
    if (has_b) {
        turn = cross(at(&p->r_b, lane), impulse);
        add(&s->v_b, lane, impulse, -sides->mass_b[lane]);
        add(&s->w_b, lane, weighed(&sides->inertia_b, lane, turn), -1.0f);
    }
}

RLF_KERNEL_PART float mass_along(const lane_sides *sides, const rlf_lane_point *p, bool has_b,
                                 int32_t lane, lane_vec direction)
{
    lane_vec turn = cross(at(&p->r_a, lane), direction);
    float mobility = sides->mass_a[lane] + dot(turn, weighed(&sides->inertia_a, lane, turn));
    if (has_b) {
        turn = cross(at(&p->r_b, lane), direction);
        mobility += sides->mass_b[lane] + dot(turn, weighed(&sides->inertia_b, lane, turn));
    }
    float mass = 1.0f / mobility;
    return mobility > 0.0f ? mass : 0.0f;
}

RLF_KERNEL_PART void weigh(const rlf_lane_batch *batch, bool has_b)
{
    const lane_sides sides = sides_of(batch);
    for (int32_t i = 0; i < batch->point_count; i++) {
        rlf_lane_point *p = &batch->points[i];
        for (int32_t lane = 0; lane < RLF_LANES; lane++) {
            lane_vec normal = at(&p->normal, lane), tangent = at(&p->tangent, lane);
            p->mass[0][lane] = mass_along(&sides, p, has_b, lane, normal);
            p->mass[1][lane] = mass_along(&sides, p, has_b, lane, tangent);
            p->mass[2][lane] = mass_along(&sides, p, has_b, lane, cross(normal, tangent));
        }
    }
}

RLF_KERNEL void rlf_kernel_lanes_weigh(const rlf_lane_batch *batch)
{
    if (batch->has_b) {
        weigh(batch, true);
    } else {
        weigh(batch, false);
    }
}

RLF_KERNEL_PART void push_all(const rlf_lane_batch *batch, bool has_b, rlf_lane_speed *speeds)
{
    const lane_vec none = {0, 0, 0};
    const lane_sides sides = sides_of(batch);
    lane_speeds s = load(batch, speeds);
    for (int32_t i = 0; i < batch->point_count; i++) {
        const rlf_lane_point *p = &batch->points[i];
        for (int32_t lane = 0; lane < RLF_LANES; lane++) {
            lane_vec n = at(&p->normal, lane), t = at(&p->tangent, lane);
            lane_vec impulse = mad(none, n, p->impulse[0][lane]);
            impulse = mad(impulse, t, p->impulse[1][lane]);
            impulse = mad(impulse, cross(n, t), p->impulse[2][lane]);
            push_by(&sides, p, has_b, lane, impulse, &s);
        }
    }
    store(batch, &s, has_b, speeds);
}

RLF_KERNEL void rlf_kernel_lanes_push(const rlf_lane_batch *batch, rlf_lane_speed *speeds)
{
    if (batch->has_b) {
        push_all(batch, true, speeds);
    } else {
        push_all(batch, false, speeds);
    }
}

RLF_KERNEL_PART void solve_normal(const lane_sides *sides, rlf_lane_point *p, bool has_b, bool push,
                                  float settled, lane_speeds *s, float *excess)
{
    for (int32_t lane = 0; lane < RLF_LANES; lane++) {
        const lane_vec none = {0, 0, 0};
        lane_vec n = at(&p->normal, lane);
        float before = p->impulse[0][lane], mass = p->mass[0][lane];
        float ease = push ? p->ease[lane] : 0.0f;
        float speed = dot(n, relative(p, s, has_b, lane));
        float change = (1.0f - ease) * mass * (p->target[push][lane] - speed) - ease * before;
        float sum = before + change;
        sum = sum > 0.0f ? sum : 0.0f;
        change = sum - before;
        p->impulse[0][lane] = sum;
        push_by(sides, p, has_b, lane, mad(none, n, change), s);
        float over = magnitude(change) - settled * mass;
        excess[lane] = excess[lane] > over ? excess[lane] : over;
    }
}

RLF_KERNEL_PART void solve_friction(const lane_sides *sides, rlf_lane_point *p, bool has_b,
                                    float settled, lane_speeds *s, float *excess)
{
    for (int32_t lane = 0; lane < RLF_LANES; lane++) {
        const lane_vec none = {0, 0, 0};
        lane_vec n = at(&p->normal, lane), t0 = at(&p->tangent, lane), t1 = cross(n, t0);
        lane_vec v = relative(p, s, has_b, lane);
        float before0 = p->impulse[1][lane], before1 = p->impulse[2][lane];
        float j0 = before0 - p->mass[1][lane] * dot(t0, v);
        float j1 = before1 - p->mass[2][lane] * dot(t1, v);
        float limit = p->friction[lane] * p->impulse[0][lane];
        float length2 = j0 * j0 + j1 * j1;
        float scale = limit / sqrtf(length2); /* Coulomb's cone */
        scale = length2 > limit * limit ? scale : 1.0f;
        j0 *= scale;
        j1 *= scale;
        p->impulse[1][lane] = j0;
        p->impulse[2][lane] = j1;
        push_by(sides, p, has_b, lane, mad(mad(none, t0, j0 - before0), t1, j1 - before1), s);
        float over0 = magnitude(j0 - before0) - settled * p->mass[1][lane];
        float over1 = magnitude(j1 - before1) - settled * p->mass[2][lane];
        float over = over0 > over1 ? over0 : over1;
        excess[lane] = excess[lane] > over ? excess[lane] : over;
    }
}

/* A batch that is being solved. */
typedef struct lane_work {
    const rlf_lane_batch *batch;
    lane_sides sides;
    lane_speeds s;
    float most[RLF_LANES];
} lane_work;

RLF_KERNEL_PART void start(lane_work *work, const rlf_lane_batch *batch,
                           const rlf_lane_speed *speeds)
{
    work->batch = batch;
    work->sides = sides_of(batch);
    work->s = load(batch, speeds);
    for (int32_t lane = 0; lane < RLF_LANES; lane++) {
        work->most[lane] = -1.0f;
    }
}

RLF_KERNEL_PART void finish(const lane_work *work, bool has_b, rlf_lane_speed *speeds,
                            float *excess)
{
    store(work->batch, &work->s, has_b, speeds);
    for (int32_t lane = 0; lane < RLF_LANES; lane++) {
        excess[lane] = work->most[lane];
    }
}

/* Both for the points begin <= i < end. */
RLF_KERNEL_PART void solve_normals(lane_work *work, int32_t begin, int32_t end, bool has_b,
                                   bool push, float settled)
{
    for (int32_t i = begin; i < end; i++) {
        solve_normal(&work->sides, &work->batch->points[i], has_b, push, settled, &work->s,
                     work->most);
    }
}

RLF_KERNEL_PART void solve_frictions(lane_work *work, int32_t begin, int32_t end, bool has_b,
                                     float settled)
{
    for (int32_t i = begin; i < end; i++) {
        solve_friction(&work->sides, &work->batch->points[i], has_b, settled, &work->s, work->most);
    }
}

RLF_KERNEL_PART void solve(const rlf_lane_batch *batch, bool has_b, bool push, float settled,
                           rlf_lane_speed *speeds, float *excess)
{
    lane_work work;
    start(&work, batch, speeds);
    solve_normals(&work, 0, batch->point_count, has_b, push, settled);
    solve_frictions(&work, 0, batch->point_count, has_b, settled);
    finish(&work, has_b, speeds, excess);
}

/* In turn: what a processor does for one batch does not wait for what it does for the other. */
RLF_KERNEL_PART void solve_two(const rlf_lane_batch *const batches[2], bool has_b, bool push,
                               float settled, rlf_lane_speed *speeds, float (*excess)[RLF_LANES])
{
    lane_work one, two;
    int32_t end_one = batches[0]->point_count, end_two = batches[1]->point_count;
    int32_t both = end_one < end_two ? end_one : end_two;
    start(&one, batches[0], speeds);
    start(&two, batches[1], speeds);
    for (int32_t i = 0; i < both; i++) {
        solve_normals(&one, i, i + 1, has_b, push, settled);
        solve_normals(&two, i, i + 1, has_b, push, settled);
    }
    solve_normals(&one, both, end_one, has_b, push, settled);
    solve_normals(&two, both, end_two, has_b, push, settled);
    for (int32_t i = 0; i < both; i++) {
        solve_frictions(&one, i, i + 1, has_b, settled);
        solve_frictions(&two, i, i + 1, has_b, settled);
    }
    solve_frictions(&one, both, end_one, has_b, settled);
    solve_frictions(&two, both, end_two, has_b, settled);
    finish(&one, has_b, speeds, excess[0]);
    finish(&two, has_b, speeds, excess[1]);
}

RLF_KERNEL void rlf_kernel_lanes_solve(const rlf_lane_batch *batch, rlf_lane_speed *speeds,
                                       bool push, float settled, float excess[RLF_LANES])
{
    if (batch->has_b && push) {
        solve(batch, true, true, settled, speeds, excess);
    } else if (batch->has_b) {
        solve(batch, true, false, settled, speeds, excess);
    } else if (push) {
        solve(batch, false, true, settled, speeds, excess);
    } else {
        solve(batch, false, false, settled, speeds, excess);
    }
}

RLF_KERNEL void rlf_kernel_lanes_solve_two(const rlf_lane_batch *const batches[2],
                                           rlf_lane_speed *speeds, bool push, float settled,
                                           float excess[2][RLF_LANES])
{
    bool has_b = batches[0]->has_b;
    if (has_b && push) {
        solve_two(batches, true, true, settled, speeds, excess);
    } else if (has_b) {
        solve_two(batches, true, false, settled, speeds, excess);
    } else if (push) {
        solve_two(batches, false, true, settled, speeds, excess);
    } else {
        solve_two(batches, false, false, settled, speeds, excess);
    }
}
