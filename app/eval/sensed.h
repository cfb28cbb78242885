/* Physics on surfaces that the synthetic sensor shows with its noise, against the true scene. */
#ifndef RELIEF_APP_EVAL_SENSED_H
#define RELIEF_APP_EVAL_SENSED_H

#include "eval/oracle.h"
#include "eval/sections.h"

#include "relief/io.h"

/* A source and the pipeline that runs on it without pictures. */
typedef struct eval_room {
    rlf_source *truth;   /* the synthetic one; `source` is it, or drops frames of it */
    rlf_source *source;  /* NULL: `truth` itself */
    eval_oracle *oracle; /* NULL: all is sensed */
    int32_t lost;        /* frames dropped after each that is given */
    rlf_pipeline *pipeline;
    rlf_world *world;
    rlf_pipeline_output frame; /* the last one */
} eval_room;

/* Opens a synthetic source; `lost` frames are dropped between any two, and `oracle` says what of
 * the surface is true, bits of eval_oracle_part. */
rlf_result eval_room_open(const char *source, int32_t lost, rlf_profile profile, int32_t oracle,
                          eval_room *out);
void eval_room_close(eval_room *stage);
/* RLF_END after Ctrl-C too. */
rlf_result eval_room_step(eval_room *stage);

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

/* LIFT, SWIPE, CARRY: what stayed on or before the tray. `error` is the leaving speed's, relative.
 */
rlf_result eval_sensed_lift(rlf_profile profile, rlf_shape_type shape, double speed, bool *out_good,
                            double *out_error);
rlf_result eval_sensed_swipe(rlf_profile profile, rlf_shape_type shape, double speed,
                             bool *out_good);
rlf_result eval_sensed_carry(rlf_profile profile, int32_t *out_stayed);

typedef struct eval_rest {
    double jitter_mm; /* RMS about the mean place, from 0.3 s after the last bounce of its landing
                         on; NAN: it never came to rest there */
    double awake_mm;  /* the same while it does not sleep yet */
    double asleep_s;  /* s from the first touch to sleep; EVAL_NEVER = never */
    int32_t wakes;
} eval_rest;

/* NOISE: a cube on the sensed table. */
rlf_result eval_sensed_rest(rlf_profile profile, double seconds, eval_rest *out);
/* CHAIR: frames from its removal until the cube on its seat falls; EVAL_NEVER = never. */
rlf_result eval_sensed_chair(rlf_profile profile, double *out_frames);

#endif
