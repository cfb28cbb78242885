/* Throws at sensed surfaces, against the true scene. */
#ifndef RELIEF_APP_EVAL_SENSED_THROW_H
#define RELIEF_APP_EVAL_SENSED_THROW_H

#include "relief/pipeline.h"

typedef enum eval_aim {
    EVAL_AIM_ROOM = 0,   /* anywhere in view */
    EVAL_AIM_ANY = 1,    /* the same, every second one at the person */
    EVAL_AIM_BEHIND = 2, /* at the back of the person, from the wall's side */
    EVAL_AIM_EDGE = 3,   /* at the book seen edge-on, from its side */
    EVAL_AIM_BACK = 4,   /* at the back of anybody, from farther along the view: random rooms */
    EVAL_AIM_SIDE = 5    /* at anybody from the side, across the view: random rooms */
} eval_aim;

/* Whether throws are at one target, without gravity. */
static inline bool eval_is_aimed(eval_aim aim)
{
    return aim >= EVAL_AIM_BEHIND;
}

typedef struct eval_throw_def {
    const char *source;
    eval_aim aim;
    int32_t throws;
    int32_t per_frame; /* thrown together at most; 0: 8 */
    int32_t lost;      /* frames lost after each that arrives, once throwing has begun */
    double begin_s;    /* s before which nothing is thrown */
    double end_s;      /* s after which nothing is; 0 = until all are */
    bool balls_only;
    rlf_profile profile;
    int32_t oracle; /* bits of eval_oracle_part; 0: all is sensed */
    uint64_t seed;  /* of the throws */
} eval_throw_def;

/* What became of the throws. */
typedef struct eval_throws {
    int64_t thrown;
    int64_t not_finite;
    int64_t
        tunnelled; /* whose centre got 2 cm into something true that is seen and stays, in view */
    int64_t swallowed; /* the same with what moves */
    double fastest;    /* m/s */
    int64_t bounced;   /* aimed ones: that came back from the target */
    int64_t passed;    /* aimed ones: that went through it */

    /* Of balls: first touches that the true scene, or the sensed one, has in view. */
    int64_t bounces;
    int64_t right;        /* left within 10 degrees of the true direction ... */
    int64_t right_nearby; /* ... or of that of a throw displaced by one pixel or two sigma */
    int64_t phantom;      /* sensed where no such throw meets anything */
    int64_t missed;       /* true of all such throws, and not sensed */
    int64_t conditioned, conditioned_right; /* of them and of right_nearby: not by more than 10
                                               degrees another one 2 mm beside it */
    int64_t hidden, hidden_right;           /* apart: at a place that the camera cannot see */
} eval_throws;

rlf_result eval_sensed_throw(const eval_throw_def *def, eval_throws *out);

#endif
