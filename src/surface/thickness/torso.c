/* Which torsos there are, and where each is expected in the next frame. */
#include "surface/thickness/legs.h"

#include "math/inverse.h"

#include <math.h>

enum {
    N = RLF_TORSO_UNKNOWNS,
    MOST_POINTS = 400,
    MOST_PLACES = 900,
    MOST_RIM = 400,
    MOST_TRUNK_RIM = 200,
    DIRECTIONS = 8,
    FIRST_PASSES = 5,
    PASSES = 2
};

static const double beside_m = 0.3; /* from below the head: points of the trunk lie nearer */
static const double beside_legs_m = 0.55, legs_begin = 0.86, legs_end = 1.9; /* the same */
static const double longest_unseen_s = 0.5;
static const double least_age_s = 0.25, most_misfit = 0.6; /* then it is looked for anew */
static const double odd_share = 0.01; /* misfit of a torso that is one deviation off the usual */
/* How unknowns wander, per square root of a second: how people turn, and how little their measures
 * seem to change as other parts of them are seen. */
static const double turn_wander = 0.44, drop_wander = 0.016, way_wander = 0.002,
                    measure_wander = 0.001;
static const double remind_s = 4.0; /* measures are drawn to the usual ones, once in so long */
static const double spin_gain = 0.5, spin_s = 0.3; /* it dies down in so many seconds */

void rlf_torsos_expect(rlf_torsos *torsos, double dt)
{
    int32_t kept = 0;
    for (int32_t k = 0; k < torsos->count; k++) {
        rlf_torso *torso = &torsos->item[k];
        torso->is_seen = false;
        torso->unseen_s += dt;
        torso->age_s += dt;
        if (dt > 0.0 && torso->unseen_s <= longest_unseen_s) {
            torsos->item[kept++] = *torso;
        }
    }
    torsos->count = kept;
}

static double wander_of(int unknown)
{
    switch (unknown) {
    case RLF_TORSO_TURN: return turn_wander;
    case RLF_TORSO_DROP: return drop_wander;
    case RLF_TORSO_AHEAD:
    case RLF_TORSO_LEAN: return way_wander;
    default: return measure_wander;
    }
}

/* How well a torso fits, and how usual it is. */
static double oddness(const rlf_torso *torso)
{
    double unknown[N], covariance[N][N], sum = torso->misfit;
    rlf_torso_usual(unknown, covariance);
    for (int k = 0; k < N; k++) {
        double off = k == RLF_TORSO_TURN ? 0.0 : torso->unknown[k] - unknown[k];
        sum += odd_share * off * off / covariance[k][k];
    }
    return sum;
}

/* The usual torso, turned in each of several ways, fitted; and the best of these. */
static void begin(rlf_torso *torso, const rlf_torso_points *points)
{
    static const double cosine[DIRECTIONS] = {1.0, 0.92388,  0.70711,  0.38268,
                                              0.0, -0.38268, -0.70711, -0.92388};
    rlf_torso best = {.misfit = 1.0};
    double least = INFINITY;
    for (int q = 0; q < DIRECTIONS; q++) {
        rlf_torso one = {.label = torso->label, .head = torso->head, .side_x = cosine[q]};
        one.side_z = sqrt(1.0 - cosine[q] * cosine[q]);
        rlf_torso_usual(one.unknown, one.doubt);
        rlf_torso_improve(&one, points, FIRST_PASSES);
        double odd = oddness(&one);
        if (odd < least) {
            least = odd;
            best = one;
        }
    }
    *torso = best;
}

/* Says again what people are usually like: what is seen of one has errors that do not average out.
 * The doubts' inverses add up. */
static void remind(rlf_torso *torso, double dt)
{
    double usual[N], reminder[N][N], off[N];
    rlf_torso_usual(usual, reminder);
    math_invert(&reminder[0][0], N);
    math_invert(&torso->doubt[0][0], N);
    reminder[RLF_TORSO_TURN][RLF_TORSO_TURN] = 0.0; /* nobody is turned in a usual way */
    for (int r = 0; r < N; r++) {
        off[r] = 0.0;
        for (int c = 0; c < N; c++) {
            reminder[r][c] *= dt / remind_s;
            torso->doubt[r][c] += reminder[r][c];
            off[r] += reminder[r][c] * (usual[c] - torso->unknown[c]);
        }
    }
    math_invert(&torso->doubt[0][0], N);
    for (int r = 0; r < N; r++) {
        for (int c = 0; c < N; c++) {
            torso->unknown[r] += torso->doubt[r][c] * off[c];
        }
    }
}

static void go_on(rlf_torso *torso, const rlf_torso_points *points, double dt)
{
    for (int k = 0; k < RLF_TORSO_UNKNOWNS; k++) {
        double wander = wander_of(k);
        torso->doubt[k][k] += wander * wander * dt;
    }
    remind(torso, dt);
    torso->unknown[RLF_TORSO_TURN] = torso->spin * dt;
    rlf_torso_improve(torso, points, PASSES);
    torso->spin += spin_gain * torso->unknown[RLF_TORSO_TURN] / dt;
    torso->spin *= spin_s / (spin_s + dt);
}

/* The torso of that label, or a new one; NULL when there is no room. */
static rlf_torso *find_torso(rlf_torsos *torsos, int32_t label, bool *is_new)
{
    int32_t k = 0;
    while (k < torsos->count && torsos->item[k].label != label) {
        k++;
    }
    *is_new = k == torsos->count;
    if (*is_new && k < RLF_TORSOS) {
        torsos->item[k] = (rlf_torso){.label = label};
        torsos->count++;
    }
    return k < RLF_TORSOS ? &torsos->item[k] : NULL;
}

static void follow_legs(const rlf_chord_job *job, rlf_torso *torso, double dt)
{
    rlf_vec3 seen[MOST_PLACES];
    rlf_vec3 rim[MOST_RIM];
    rlf_torso_points points = {.p = seen, .rim = rim};
    const rlf_torso_window window = {beside_legs_m, legs_begin, legs_end, MOST_PLACES, MOST_RIM};
    rlf_torso_find_points(job, torso, &window, &points);
    for (int32_t i = 0; i < points.count; i++) {
        seen[i] = rlf_torso_place(torso, seen[i]);
    }
    for (int32_t i = 0; i < points.rim_count; i++) {
        rim[i] = rlf_torso_place(torso, rim[i]);
    }
    rlf_legs_follow(torso, &points, dt);
}

void rlf_torso_follow(const rlf_chord_job *job, int32_t label, rlf_vec3 head, double brow)
{
    rlf_vec3 seen[MOST_POINTS];
    rlf_vec3 rim[MOST_TRUNK_RIM];
    rlf_torso_points points = {.p = seen, .rim = rim};
    bool is_new;
    rlf_torso *torso = find_torso(job->torsos, label, &is_new);
    if (torso == NULL || torso->is_seen) {
        return;
    }
    double dt = torso->unseen_s;
    torso->head = head;
    const rlf_torso_window window = {beside_m, rlf_torso_first, rlf_torso_last, MOST_POINTS,
                                     MOST_TRUNK_RIM};
    rlf_torso_find_points(job, torso, &window, &points);
    if (is_new || (torso->misfit > most_misfit && torso->age_s > least_age_s)) {
        begin(torso, &points);
    } else {
        go_on(torso, &points, dt);
    }
    torso->unseen_s = 0.0;
    torso->is_seen = true;
    rlf_skull_follow(job, torso, brow, dt);
    follow_legs(job, torso, dt);
}
