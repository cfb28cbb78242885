/* The solver's lanes against sequential impulses written out for one group. */

#include "analytic.h"
#include "kernel/lanes.h"
#include "relief/math.h"
#include "test.h"

#include <math.h>
#include <string.h>

enum { POINTS = 4 };

static int32_t points_of(int32_t lane)
{
    return POINTS - lane % POINTS;
}

typedef struct scene {
    rlf_lane_batch batch;
    rlf_lane_point points[POINTS];
    rlf_lane_speed speeds[2 * RLF_LANES];
} scene;

static rlf_vec3 random_vec(analytic_random *r, double size)
{
    double x = random_uniform(r), y = random_uniform(r), z = random_uniform(r);
    return rlf_scale(rlf_vec3_make(x - 0.5, y - 0.5, z - 0.5), 2.0 * size);
}

static void put(rlf_lane_vec *of, int32_t lane, rlf_vec3 v)
{
    of->x[lane] = (float)v.x;
    of->y[lane] = (float)v.y;
    of->z[lane] = (float)v.z;
}

static rlf_vec3 get(const rlf_lane_vec *of, int32_t lane)
{
    return rlf_vec3_make((double)of->x[lane], (double)of->y[lane], (double)of->z[lane]);
}

/* u u^T + 5: symmetric and positive. */
static void put_inertia(rlf_lane_mat *m, int32_t lane, rlf_vec3 u)
{
    m->xx[lane] = (float)(u.x * u.x + 5.0);
    m->yy[lane] = (float)(u.y * u.y + 5.0);
    m->zz[lane] = (float)(u.z * u.z + 5.0);
    m->xy[lane] = (float)(u.x * u.y);
    m->xz[lane] = (float)(u.x * u.z);
    m->yz[lane] = (float)(u.y * u.z);
}

static rlf_vec3 turned(const rlf_lane_mat *m, int32_t lane, rlf_vec3 v)
{
    double xx = (double)m->xx[lane], xy = (double)m->xy[lane], xz = (double)m->xz[lane];
    double yy = (double)m->yy[lane], yz = (double)m->yz[lane], zz = (double)m->zz[lane];
    return rlf_vec3_make(xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                         xz * v.x + yz * v.y + zz * v.z);
}

static void fill_lane(scene *s, analytic_random *r, int32_t lane)
{
    s->batch.a[lane] = 2 * lane;
    s->batch.b[lane] = 2 * lane + 1;
    s->batch.inverse_mass_a[lane] = (float)(1.0 + random_uniform(r));
    put_inertia(&s->batch.inverse_inertia_a, lane, random_vec(r, 3));
    if (s->batch.has_b && lane != 2) { /* what lane 2 touches does not move */
        s->batch.inverse_mass_b[lane] = (float)(1.0 + random_uniform(r));
        put_inertia(&s->batch.inverse_inertia_b, lane, random_vec(r, 3));
    }
    rlf_vec3 normal = rlf_normalize(random_vec(r, 1));
    for (int32_t i = 0; i < points_of(lane); i++) {
        rlf_lane_point *p = &s->points[i];
        put(&p->normal, lane, normal);
        put(&p->tangent, lane, rlf_perpendicular(normal));
        put(&p->r_a, lane, random_vec(r, 0.1));
        put(&p->r_b, lane, random_vec(r, 0.1));
        p->target[0][lane] = (float)-random_uniform(r);
        p->target[1][lane] = (float)random_uniform(r);
        p->ease[lane] = 0.06f;
        p->friction[lane] = 0.5f;
        p->impulse[0][lane] = (float)(0.1 * random_uniform(r));
    }
}

static void make_scene(scene *s, analytic_random *r, bool has_b)
{
    memset(s, 0, sizeof(*s));
    s->batch.points = s->points;
    s->batch.point_count = POINTS;
    s->batch.has_b = has_b;
    for (int32_t i = 0; i < 2 * RLF_LANES; i++) {
        for (int32_t k = 0; k < 6; k++) {
            s->speeds[i].of[k] = (float)(2.0 * random_uniform(r) - 1.0);
        }
    }
    for (int32_t lane = 0; lane < RLF_LANES; lane++) {
        fill_lane(s, r, lane);
    }
    rlf_kernel_lanes_weigh(&s->batch);
}

/* ---- the same for one lane ---- */

static rlf_vec3 speed_at(const rlf_lane_speed *speed, rlf_vec3 r)
{
    double of[6];
    for (int32_t k = 0; k < 6; k++) {
        of[k] = (double)speed->of[k];
    }
    return rlf_add(rlf_vec3_make(of[0], of[1], of[2]),
                   rlf_cross(rlf_vec3_make(of[3], of[4], of[5]), r));
}

static rlf_vec3 relative(const scene *s, const rlf_lane_point *p, int32_t lane)
{
    rlf_vec3 of_a = speed_at(&s->speeds[s->batch.a[lane]], get(&p->r_a, lane));
    rlf_vec3 of_b = get(&p->r_b, lane);
    if (s->batch.has_b) {
        of_b = speed_at(&s->speeds[s->batch.b[lane]], of_b);
    }
    return rlf_sub(of_a, of_b);
}

static void add(float *of, rlf_vec3 v, rlf_vec3 w)
{
    const double change[6] = {v.x, v.y, v.z, w.x, w.y, w.z};
    for (int32_t k = 0; k < 6; k++) {
        of[k] += (float)change[k];
    }
}

static void give(scene *s, const rlf_lane_point *p, int32_t lane, rlf_vec3 impulse)
{
    const rlf_lane_batch *b = &s->batch;
    add(s->speeds[b->a[lane]].of, rlf_scale(impulse, (double)b->inverse_mass_a[lane]),
        turned(&b->inverse_inertia_a, lane, rlf_cross(get(&p->r_a, lane), impulse)));
    if (b->has_b) {
        rlf_vec3 back = rlf_neg(impulse);
        add(s->speeds[b->b[lane]].of, rlf_scale(back, (double)b->inverse_mass_b[lane]),
            turned(&b->inverse_inertia_b, lane, rlf_cross(get(&p->r_b, lane), back)));
    }
}

static void solve_normal(scene *s, rlf_lane_point *p, int32_t lane, bool push)
{
    rlf_vec3 n = get(&p->normal, lane);
    double ease = push ? (double)p->ease[lane] : 0.0, before = (double)p->impulse[0][lane];
    double wanted = (double)p->target[push][lane] - rlf_dot(n, relative(s, p, lane));
    double sum = before + (1.0 - ease) * (double)p->mass[0][lane] * wanted - ease * before;
    p->impulse[0][lane] = (float)rlf_max(sum, 0.0);
    give(s, p, lane, rlf_scale(n, rlf_max(sum, 0.0) - before));
}

static void solve_friction(scene *s, rlf_lane_point *p, int32_t lane)
{
    rlf_vec3 v = relative(s, p, lane), t0 = get(&p->tangent, lane);
    rlf_vec3 t1 = rlf_cross(get(&p->normal, lane), t0);
    double before0 = (double)p->impulse[1][lane], before1 = (double)p->impulse[2][lane];
    double j0 = before0 - (double)p->mass[1][lane] * rlf_dot(t0, v);
    double j1 = before1 - (double)p->mass[2][lane] * rlf_dot(t1, v);
    double length = sqrt(j0 * j0 + j1 * j1);
    double limit = (double)p->friction[lane] * (double)p->impulse[0][lane];
    double scale = length > limit ? limit / length : 1.0;
    rlf_vec3 change = rlf_scale(t0, scale * j0 - before0);
    give(s, p, lane, rlf_mad(change, t1, scale * j1 - before1));
    p->impulse[1][lane] = (float)(scale * j0);
    p->impulse[2][lane] = (float)(scale * j1);
}

static void solve_lane(scene *s, int32_t lane, bool push)
{
    for (int32_t i = 0; i < points_of(lane); i++) {
        solve_normal(s, &s->points[i], lane, push);
    }
    for (int32_t i = 0; i < points_of(lane); i++) {
        solve_friction(s, &s->points[i], lane);
    }
}

static void assert_same_speeds(const scene *a, const scene *b)
{
    for (int32_t i = 0; i < 2 * RLF_LANES; i++) {
        for (int32_t k = 0; k < 6; k++) {
            assert_float_equal(a->speeds[i].of[k], b->speeds[i].of[k], 2e-5);
        }
    }
}

TEST_CASE(a_pass_is_that_of_each_lane)
{
    analytic_random r = {1};
    for (int32_t run = 0; run < 200; run++) {
        scene ours, plain;
        float excess[RLF_LANES];
        bool push = run % 2 == 1;
        make_scene(&ours, &r, run % 4 < 2);
        plain = ours;
        plain.batch.points = plain.points;
        rlf_kernel_lanes_solve(&ours.batch, ours.speeds, push, 1e-6f, excess);
        for (int32_t lane = 0; lane < RLF_LANES; lane++) {
            solve_lane(&plain, lane, push);
        }
        assert_same_speeds(&ours, &plain);
    }
}

/* Two batches of different lengths, the second one's bodies behind the first one's. */
TEST_CASE(two_are_solved_as_each_alone)
{
    analytic_random r = {4};
    for (int32_t run = 0; run < 200; run++) {
        scene alone[2], both[2];
        rlf_lane_speed speeds[4 * RLF_LANES];
        float excess[2][RLF_LANES], excess_alone[RLF_LANES];
        bool push = run % 2 == 1;
        for (int32_t k = 0; k < 2; k++) {
            make_scene(&alone[k], &r, run % 4 < 2);
            alone[k].batch.point_count = k == run / 4 % 2 ? POINTS : 1 + run % POINTS;
            both[k] = alone[k];
            both[k].batch.points = both[k].points;
            memcpy(&speeds[2 * RLF_LANES * k], both[k].speeds, sizeof(both[k].speeds));
            for (int32_t lane = 0; lane < RLF_LANES; lane++) {
                both[k].batch.a[lane] += 2 * RLF_LANES * k;
                both[k].batch.b[lane] += 2 * RLF_LANES * k;
            }
        }
        const rlf_lane_batch *batches[2] = {&both[0].batch, &both[1].batch};
        rlf_kernel_lanes_solve_two(batches, speeds, push, 1e-6f, excess);
        for (int32_t k = 0; k < 2; k++) {
            scene *s = &alone[k];
            s->batch.points = s->points;
            rlf_kernel_lanes_solve(&s->batch, s->speeds, push, 1e-6f, excess_alone);
            assert_memory_equal(excess[k], excess_alone, sizeof(excess_alone));
            assert_memory_equal(&speeds[2 * RLF_LANES * k], s->speeds, sizeof(s->speeds));
            assert_memory_equal(both[k].points, s->points, sizeof(s->points));
        }
    }
}

/* A point of the weighed mass changes its speed by 1 / mass for a unit impulse. */
TEST_CASE(mass_is_impulse_by_speed)
{
    analytic_random r = {2};
    for (int32_t run = 0; run < 50; run++) {
        scene s;
        make_scene(&s, &r, run % 2 == 0);
        for (int32_t lane = 0; lane < RLF_LANES; lane++) {
            const rlf_lane_point *p = &s.points[0];
            rlf_vec3 n = get(&p->normal, lane), t = get(&p->tangent, lane);
            const rlf_vec3 directions[3] = {n, t, rlf_cross(n, t)};
            for (int32_t row = 0; row < 3; row++) {
                double before = rlf_dot(directions[row], relative(&s, p, lane));
                give(&s, p, lane, directions[row]);
                double change = rlf_dot(directions[row], relative(&s, p, lane)) - before;
                assert_float_equal(change * (double)p->mass[row][lane], 1.0, 1e-5);
            }
        }
    }
}

/* Impulses kept from the last substep, and passes until nothing is in excess: no point closes. */
TEST_CASE(passes_settle)
{
    analytic_random r = {3};
    for (int32_t run = 0; run < 50; run++) {
        scene s;
        float excess[RLF_LANES] = {1, 1, 1, 1, 1, 1, 1, 1};
        make_scene(&s, &r, run % 2 == 0);
        rlf_kernel_lanes_push(&s.batch, s.speeds);
        for (int32_t pass = 0; pass < 2000; pass++) {
            rlf_kernel_lanes_solve(&s.batch, s.speeds, false, 1e-5f, excess);
        }
        for (int32_t lane = 0; lane < RLF_LANES; lane++) {
            assert_true(excess[lane] <= 0.0f);
            for (int32_t i = 0; i < points_of(lane); i++) {
                const rlf_lane_point *p = &s.points[i];
                double v = rlf_dot(get(&p->normal, lane), relative(&s, p, lane));
                assert_true(v >= (double)p->target[0][lane] - 1e-4);
            }
        }
    }
}
