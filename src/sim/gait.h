/* Where the person stands and how he walks: path, heading, footfalls and gestures over time. */
#ifndef RLF_SIM_GAIT_H
#define RLF_SIM_GAIT_H

#include "sim/figure.h"
#include "relief/synthetic.h"

/* Index of a side: 0 left, 1 right. */
typedef struct synth_footing {
    rlf_vec3 position; /* of the ankle's foot point on the floor; y is height above the floor */
    double heading;    /* radians, 0 = along +z, pi/2 = along +x */
} synth_footing;

typedef struct synth_gait {
    rlf_vec3 position; /* of the body on the floor, y = 0 */
    double heading;
    double walking; /* 0 standing .. 1 at full stride */
    double stride;  /* steps since the walk began: whole at mid-stance */
    double swing;   /* left foot's lead over the right one, in steps */
    synth_footing foot[2];
    double foot_offset;  /* of each foot from the middle plane of the body, metres */
    double reach;        /* 0..1: how far the right arm follows its gesture */
    double gesture_time; /* s since the gesture began */
    double sitting;      /* 0 standing .. 1 sitting */
    double seat;         /* height of the hips when sitting, metres */
} synth_gait;

/* begin..end in seconds; from and to are x in metres (walk) or headings in radians (turn). */
typedef struct synth_act {
    bool is_walk;
    double begin, end;
    double from, to;
} synth_act;

typedef struct synth_script {
    double period;
    double z;       /* of the path */
    double heading; /* at first */
    double reach_begin, reach_end;
    const synth_act *acts;
    int act_count;
    double sit_begin, sit_end, seat; /* s; s; height of the hips, metres. End 0 = never */
} synth_script;

#define SYNTH_WEST (-0.5 * RLF_PI) /* heading of a walk towards -x */
#define SYNTH_EAST (-1.5 * RLF_PI)

/* t in seconds since the first frame; the script repeats for ever. */
synth_gait synth_gait_follow(const synth_script *script, const synth_figure *figure, double t);

/* t in seconds since the first frame; the script of each scene repeats for ever. */
synth_gait synth_gait_at(rlf_synthetic_scene kind, const synth_figure *figure, double t);

/* The second person of scene "crossing". */
synth_gait synth_second_gait_at(const synth_figure *figure, double t);

/* Seconds after which the scene's script starts again. */
double synth_gait_period(rlf_synthetic_scene kind);

/* 0 for x <= 0, 1 for x >= 1, between them 3 x^2 - 2 x^3. */
static inline double synth_smooth(double x)
{
    double c = rlf_clamp(x, 0.0, 1.0);
    return c * c * (3.0 - 2.0 * c);
}

#endif
