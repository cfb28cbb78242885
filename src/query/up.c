/* Which way is up: each end of each axis of the scene is a guess, and what speaks for it is added
 * as logarithms of odds. The answer takes into account that cameras are seldom rolled. Whether it
 * is sure must not hang on that alone, or a rolled camera would be told a wall for sure: confidence
 * believes in it less (Berger 1985: robust Bayesian analysis). */
#include "query/up.h"

enum { PICTURE_WAYS = 4, GUESSES = 2 * RLF_UP_AXES + PICTURE_WAYS };

typedef struct guess {
    rlf_vec3 up;
    double score; /* natural logarithm of odds, whatever the roll */
    double roll;  /* the same of the camera's roll alone */
    rlf_up_evidence evidence;
} guess;

typedef struct guess_list {
    guess at[GUESSES];
    int32_t count;
} guess_list;

static const double nothing_fits = -8.0; /* the odds that none of the guesses is right */
static const double least_share = 0.03;  /* of normals along up: fewer are chance */
static const double doubted_roll = 0.15; /* of the roll's odds that confidence believes */
static const double least_level = 0.996; /* cos 5 degrees: from the picture's up, or floors' */
static const double level_share = 0.1;   /* of normals along an axis: a plane, and no clutter */
static const double alone = 0.65;        /* confidence in what nothing agrees with */

/* Cameras stand upright, or nearly so, far more often than not. The nearer to straight down one
 * looks, the less a picture's up means. */
static double roll_odds(rlf_vec3 up)
{
    const double upright = 0.35, range = 0.87; /* to 20 degrees; from there to 70 */
    double roll = rlf_atan2(up.x, -up.y);
    double off = rlf_clamp(((roll < 0.0 ? -roll : roll) - upright) / range, 0.0, 1.0);
    return -4.0 * (up.x * up.x + up.y * up.y) * off;
}

/* They look ahead or down; seldom straight down, for who looks straight at a face mostly looks at a
 * wall; and seldom up by more than 20 degrees. */
static double pitch_odds(rlf_vec3 up)
{
    double above = rlf_clamp((up.z - 0.34) / 0.4, 0.0, 1.0);
    double below = rlf_clamp((-up.z - 0.85) / 0.12, 0.0, 1.0);
    return -4.0 * (above + below);
}

/* That an axis has floors, tables or ceilings at all, and more of what looks up than down; what its
 * rays end on; and what stands on it. The weights were found on random rooms and real clips. */
static double evidence_odds(const rlf_up_evidence *e)
{
    double along = e->up + e->down;
    double is_axis = rlf_log_e(along + least_share);
    double is_this_end = rlf_log_e((e->up + least_share) / (along + 2.0 * least_share));
    return 0.9 * is_axis + is_this_end + 8.0 * e->likelihood + 50.0 * rlf_min(e->standing, 0.1);
}

static void add_guess(guess_list *list, const rlf_up_samples *samples, rlf_vec3 up)
{
    for (int32_t k = 0; k < list->count; k++) {
        if (rlf_dot(list->at[k].up, up) > RLF_UP_SAME) {
            return;
        }
    }
    guess *g = &list->at[list->count++];
    g->up = up;
    g->evidence = rlf_up_ask(samples, up);
    g->score = evidence_odds(&g->evidence) + pitch_odds(up);
    g->roll = roll_odds(up);
}

/* Before a bare wall, up may be any direction across it. */
static void add_picture_ways(guess_list *list, const rlf_up_samples *samples)
{
    static const rlf_vec3 ways[PICTURE_WAYS] = {{0, -1, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}};
    rlf_vec3 wall = {0, 0, 0};
    double most = 0.0;
    for (int32_t k = 0; k < list->count; k++) {
        if (list->at[k].evidence.up > most) {
            wall = list->at[k].up;
            most = list->at[k].evidence.up;
        }
    }
    for (int32_t k = 0; k < PICTURE_WAYS; k++) {
        rlf_vec3 across = rlf_mad(ways[k], wall, -rlf_dot(ways[k], wall));
        if (rlf_dot(across, across) > 0.5) {
            add_guess(list, samples, rlf_normalize(across));
        }
    }
}

static double share_along(const guess *g)
{
    return g->evidence.up + g->evidence.down;
}

/* Walls and sides are square to it: of what is nearly square, most is. */
static bool has_square(const guess *g, double least)
{
    return g->evidence.square > least && 2.0 * g->evidence.square > g->evidence.across;
}

/* A floor or a ceiling, and walls square to it, that the picture is level with: no other camera but
 * one that was set up to be level sees them so. */
static bool is_level(const guess *g)
{
    return -g->up.y > least_level && share_along(g) > level_share && has_square(g, level_share);
}

/* One plane alone may as well be a wall that a tilted camera sees, or a ramp: walls must agree, or
 * things must stand on it. */
static double bound_of(const guess *g)
{
    return has_square(g, least_share) || g->evidence.standing > 0.0 ? 1.0 : alone;
}

/* The share of a guess among all. */
static double confidence_in(const guess_list *list, int32_t best)
{
    const guess *b = &list->at[best];
    double believed = is_level(b) ? 1.0 : doubted_roll;
    double own = b->score + believed * b->roll, sum = rlf_exp(nothing_fits - own);
    for (int32_t k = 0; k < list->count; k++) {
        sum += rlf_exp(list->at[k].score + believed * list->at[k].roll - own);
    }
    return rlf_min(1.0 / sum, bound_of(b));
}

double rlf_surface_find_up(const rlf_surface *surface, rlf_vec3 *out_up)
{
    rlf_up_samples samples;
    rlf_vec3 axes[RLF_UP_AXES];
    guess_list list = {.count = 0};
    if (!RLF_ASSERT(surface != NULL && out_up != NULL)) {
        return 0.0;
    }
    rlf_up_samples_take(surface, &samples);
    int32_t axis_count = rlf_up_axes(&samples, axes), best = 0;
    for (int32_t k = 0; k < axis_count; k++) {
        add_guess(&list, &samples, axes[k]);
        add_guess(&list, &samples, rlf_neg(axes[k]));
    }
    *out_up = rlf_vec3_make(0, -1, 0);
    if (list.count == 0) {
        return 0.0;
    }
    add_picture_ways(&list, &samples);
    for (int32_t k = 1; k < list.count; k++) {
        const guess *a = &list.at[k], *b = &list.at[best];
        best = a->score + a->roll > b->score + b->roll ? k : best;
    }
    *out_up = rlf_up_level(surface, list.at[best].up);
    /* A ramp before a wall: between both is what all normals fit, and the ramp is far from it. */
    bool agrees = rlf_dot(*out_up, list.at[best].up) > least_level;
    return rlf_min(confidence_in(&list, best), agrees ? 1.0 : alone);
}
