/* The scenes that have an answer, and a crowd, in Relief and in the engines that are installed. */
#define _POSIX_C_SOURCE 200809L
#include "peer.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define GRAVITY 9.81
#define STACK 10
#define FRICTION 0.5
#define DEGREE (RLF_PI / 180.0)

static const peer *const peers[] = {
    &peer_live,
    &peer_thesis,
#ifdef RLF_PEER_ODE
    &peer_ode,
#endif
#ifdef RLF_PEER_BULLET
    &peer_bullet,
#endif
};
enum { PEERS = sizeof(peers) / sizeof(peers[0]) };

static peer_body cube_at(double x, double y, double z)
{
    peer_body b = {.half = {0.05, 0.05, 0.05}, .mass = 0.1, .friction = FRICTION};
    b.pose = rlf_pose_identity();
    b.pose.p = rlf_vec3_make(x, y, z);
    return b;
}

/* Its upper side is y = 0. */
static peer_body ground(void)
{
    peer_body b = cube_at(0, 0.5, 0);
    b.half = rlf_vec3_make(5, 0.5, 5);
    b.mass = 0.0;
    return b;
}

static void *open_with(const peer *p, rlf_vec3 gravity, const peer_body *bodies, int32_t count)
{
    void *engine = p->open(gravity, count);
    for (int32_t i = 0; i < count && engine != NULL; i++) {
        if (!p->add(engine, &bodies[i])) {
            p->close(engine);
            engine = NULL;
        }
    }
    return engine;
}

static void run(const peer *p, void *engine, double seconds)
{
    for (int32_t k = 0; k < (int32_t)(seconds / PEER_STEP + 0.5); k++) {
        p->step(engine, PEER_STEP, NULL);
    }
}

/* mm away from g t^2 / 2 after a second. */
static double free_fall(const peer *p)
{
    peer_body body = cube_at(0, 0, 0);
    void *engine = open_with(p, rlf_vec3_make(0, GRAVITY, 0), &body, 1);
    if (engine == NULL) {
        return NAN;
    }
    run(p, engine, 1.0);
    double fallen = p->state(engine, 0).pose.p.y;
    p->close(engine);
    return 1e3 * fabs(fallen - 0.5 * GRAVITY);
}

static double turning_energy(const peer_state *s, rlf_vec3 half)
{
    rlf_vec3 w = rlf_rotate(rlf_quat_conjugate(s->pose.q), s->w);
    double x2 = half.x * half.x, y2 = half.y * half.y, z2 = half.z * half.z;
    return ((y2 + z2) * w.x * w.x + (x2 + z2) * w.y * w.y + (x2 + y2) * w.z * w.z) / 6.0;
}

/* Largest share of its energy that a box gains or loses in 100 s without torque. */
static double tumble(const peer *p)
{
    peer_body body = cube_at(0, 0, 0);
    body.half = rlf_vec3_make(0.1, 0.05, 0.02);
    body.mass = 1.0;
    body.w = rlf_vec3_make(0.01, 10, 0.01);
    void *engine = open_with(p, rlf_vec3_make(0, 0, 0), &body, 1);
    double worst = 0.0, start = 0.0;
    for (int32_t k = 0; k <= 6000 && engine != NULL; k++) {
        peer_state s = p->state(engine, 0);
        double energy = turning_energy(&s, body.half);
        start = k == 0 ? energy : start;
        worst = rlf_max(worst, fabs(energy / start - 1.0));
        p->step(engine, PEER_STEP, NULL);
    }
    if (engine == NULL) {
        return NAN;
    }
    p->close(engine);
    return worst;
}

/* Five balls in a row, e = 1: the largest error of a speed, % of the first one's 2 m/s. */
static double chain(const peer *p)
{
    peer_body balls[5];
    for (int32_t i = 0; i < 5; i++) {
        balls[i] = cube_at(i == 0 ? -0.4 : 0.1 * i - 0.1, 0, 0);
        balls[i].radius = 0.05;
        balls[i].restitution = 1.0;
        balls[i].v.x = i == 0 ? 2.0 : 0.0;
    }
    void *engine = open_with(p, rlf_vec3_make(0, 0, 0), balls, 5);
    if (engine == NULL) {
        return NAN;
    }
    run(p, engine, 2.0 / 3.0);
    double worst = 0.0;
    for (int32_t i = 0; i < 5; i++) {
        worst = rlf_max(worst, fabs(p->state(engine, i).v.x - (i == 4 ? 2.0 : 0.0)));
    }
    p->close(engine);
    return 50.0 * worst;
}

/* Ten cubes of 0.1 m after 20 s, mm: sideways, and into each other. */
static void stack(const peer *p, double *out_drift, double *out_depth)
{
    peer_body bodies[STACK + 1] = {ground()};
    for (int32_t i = 1; i <= STACK; i++) {
        bodies[i] = cube_at(0, 0.05 - 0.1 * i, 0);
    }
    void *engine = open_with(p, rlf_vec3_make(0, GRAVITY, 0), bodies, STACK + 1);
    *out_drift = *out_depth = engine != NULL ? 0.0 : NAN;
    if (engine == NULL) {
        return;
    }
    run(p, engine, 20.0);
    double under = 0.0;
    for (int32_t i = 1; i <= STACK; i++) {
        rlf_vec3 at = p->state(engine, i).pose.p;
        *out_depth = rlf_max(*out_depth, 1e3 * (at.y + 0.05 - under));
        *out_drift = rlf_max(*out_drift, 1e3 * hypot(at.x, at.z));
        under = at.y - 0.05;
    }
    p->close(engine);
}

/* Whether a cube on a slope is faster than 1 mm/s after a second. */
static bool slips(const peer *p, double slope)
{
    peer_body bodies[2] = {ground(), cube_at(0, -0.05, 0)};
    rlf_vec3 gravity = rlf_vec3_make(GRAVITY * sin(slope), GRAVITY * cos(slope), 0);
    void *engine = open_with(p, gravity, bodies, 2);
    if (engine == NULL) {
        return false;
    }
    run(p, engine, 1.0);
    double speed = fabs(p->state(engine, 1).v.x);
    p->close(engine);
    return speed > 1e-3;
}

/* Degrees between the slope at which a cube starts to slip and atan(friction). */
static double slope_error(const peer *p)
{
    double low = 10.0, high = 45.0;
    while (high - low > 0.002) {
        double middle = 0.5 * (low + high);
        bool is_slipping = slips(p, middle * DEGREE);
        low = is_slipping ? low : middle;
        high = is_slipping ? middle : high;
    }
    return fabs(low - atan(FRICTION) / DEGREE);
}

enum { ANSWERS = 8, CROWDS = 2 };

static const int32_t COUNTS[CROWDS] = {100, 1000};

/* What one engine did. */
typedef struct result {
    /* Fall, tumble, chain, drift, depth, slope, lifted, swept; NAN: it has none. */
    double answers[ANSWERS];
    peer_cost crowds[CROWDS];
} result;

static void ask(const peer *p, result *out)
{
    double drift = NAN, depth = NAN, slope = NAN;
    int32_t lifted = 0, swept = 0;
    if (p->plays_bodies) {
        stack(p, &drift, &depth);
        slope = slope_error(p);
    }
    bool is_pushed = p->plays_bodies && peer_push(p, &lifted, &swept);
    const double all[ANSWERS] = {
        free_fall(p),           tumble(p), chain(p), drift, depth, slope, is_pushed ? lifted : NAN,
        is_pushed ? swept : NAN};
    printf("%-8s", p->name);
    for (int32_t i = 0; i < ANSWERS; i++) {
        out->answers[i] = all[i];
        printf(" %12.3g", all[i]);
    }
    printf("\n");
    fflush(stdout);
}

static bool ask_crowds(result results[PEERS], double seconds, uint64_t seed)
{
    printf("\ncrowd on the live surface, 512x424, %g s; ms per 1/60 s\n", seconds);
    printf("%-8s %6s %10s %10s %6s\n", "", "cubes", "median", "p95", "lost, in view");
    for (int32_t i = 0; i < CROWDS; i++) {
        for (int32_t k = 0; k < PEERS; k++) {
            peer_cost *cost = &results[k].crowds[i];
            if (!peers[k]->plays_bodies) {
                continue;
            }
            if (!peer_crowd(peers[k], COUNTS[i], seconds, seed, cost)) {
                return false;
            }
            printf("%-8s %6d %10.2f %10.2f %6d\n", peers[k]->name, (int)COUNTS[i], cost->median_ms,
                   cost->p95_ms, (int)cost->lost);
            fflush(stdout);
        }
    }
    return true;
}

static void write_engine(FILE *file, const peer *p, const result *r, bool has_crowds)
{
    static const char *const NAMES[ANSWERS] = {"fall_mm", "tumble",    "chain_percent", "drift_mm",
                                               "deep_mm", "slope_deg", "lifted",        "swept"};
    fprintf(file, "    {\"name\": \"%s\"", p->name);
    for (int32_t i = 0; i < ANSWERS; i++) {
        if (isfinite(r->answers[i])) {
            fprintf(file, ", \"%s\": %.6g", NAMES[i], r->answers[i]);
        }
    }
    fprintf(file, ", \"crowds\": [");
    for (int32_t i = 0; i < CROWDS && has_crowds && p->plays_bodies; i++) {
        fprintf(file, "%s{\"cubes\": %d, \"median_ms\": %.4f, \"p95_ms\": %.4f, \"lost\": %d}",
                i > 0 ? ", " : "", (int)COUNTS[i], r->crowds[i].median_ms, r->crowds[i].p95_ms,
                (int)r->crowds[i].lost);
    }
    fprintf(file, "]}");
}

static int write_json(const char *path, const result results[PEERS], double seconds)
{
    FILE *file = fopen(path, "w");
    if (file == NULL) {
        fprintf(stderr, "bench_peers: %s: cannot be written\n", path);
        return 1;
    }
    fprintf(file, "{\n  \"seconds\": %g, \"engines\": [\n", seconds);
    for (int32_t k = 0; k < PEERS; k++) {
        write_engine(file, peers[k], &results[k], seconds > 0.0);
        fprintf(file, "%s\n", k + 1 < PEERS ? "," : "");
    }
    fprintf(file, "  ]\n}\n");
    return fclose(file) == 0 ? 0 : 1;
}

typedef struct options {
    double seconds;
    uint64_t seed;
    const char *json_path;
} options;

/* -1: go on; else the exit status. */
static int parse(int argc, char **argv, options *o)
{
    static const struct option LONG[] = {{"seconds", required_argument, NULL, 't'},
                                         {"seed", required_argument, NULL, 's'},
                                         {"json", required_argument, NULL, 'j'},
                                         {"help", no_argument, NULL, 'h'},
                                         {0}};
    int option;
    while ((option = getopt_long(argc, argv, "h", LONG, NULL)) != -1) {
        switch (option) {
        case 't': o->seconds = atof(optarg); break;
        case 's': o->seed = (uint64_t)atoll(optarg); break;
        case 'j': o->json_path = optarg; break;
        default:
            printf("usage: bench_peers [--seconds S] [--seed N] [--json FILE]\n"
                   "Relief beside the physics engines that were there when it was built.\n"
                   "  --seconds S  of the crowds, default 10; 0 leaves them out\n"
                   "  --seed N     of the sensor's noise, default 1\n"
                   "  --json FILE  write the figures as JSON too\n");
            return option == 'h' ? 0 : 2;
        }
    }
    if (!(o->seconds >= 0.0 && o->seconds <= 3600.0) || optind != argc) {
        fprintf(stderr, "bench_peers: --seconds: give 0 to 3600, and no other arguments\n");
        return 2;
    }
    return -1;
}

int main(int argc, char **argv)
{
    options o = {.seconds = 10.0, .seed = 1};
    int status = parse(argc, argv, &o);
    if (status >= 0) {
        return status;
    }
    result results[PEERS] = {0};
    printf("%-8s %12s %12s %12s %12s %12s %12s %12s %12s\n", "", "fall, mm", "tumble", "chain, %",
           "stack, mm", "deep, mm", "slope, deg", "LIFT, of 8", "SWIPE, of 8");
    for (int32_t k = 0; k < PEERS; k++) {
        ask(peers[k], &results[k]);
    }
    if (o.seconds > 0.0 && !ask_crowds(results, o.seconds, o.seed)) {
        return 1;
    }
    return o.json_path != NULL ? write_json(o.json_path, results, o.seconds) : 0;
}
