/* Bounces on real surfaces against the true scene. */
#ifndef RELIEF_APP_EVAL_MEASURES_COLLISIONS_H
#define RELIEF_APP_EVAL_MEASURES_COLLISIONS_H

#include "eval/measures/angles.h"
#include "relief/io.h"
#include "relief/synthetic.h"

/* Bounces of thrown bodies on real surfaces against the true scene: the first touch after a flight.
 */
typedef struct eval_collisions {
    int64_t bounces; /* contacts that met at more than 0.3 m/s */
    int64_t phantom; /* of them, farther than 5 cm from any true surface */
    int64_t right;   /* of the others, normal within 10 degrees of a true one: at an edge, of any
                        between its faces */
    int64_t wrong;   /* of the others, more than 30 degrees off that of the nearest true face */
    int64_t unexplained; /* of those, the ones that no edge of the true scene explains */
    double off_m;        /* sum of how far the others' places are from the nearest true surface */
    int64_t entries;     /* times a body's centre got inside something real, in view */
    eval_angles angles;
    bool *was_inside;     /* per body */
    double *last_touch_s; /* per body */
    int32_t body_capacity;
} eval_collisions;

/* A scene that throws cubes into the synthetic room from many sides. Destroy with
 * rlf_scene_destroy. */
rlf_result eval_collisions_scene(uint64_t seed, int32_t body_count, rlf_scene *out);
rlf_result eval_collisions_init(eval_collisions *e, int32_t body_capacity);
/* Forgets the bodies' past; once per run. */
void eval_collisions_restart(eval_collisions *e);
void eval_collisions_finish(eval_collisions *e);
/* One bounce, against the true scene of the source's frame. */
void eval_collisions_judge(eval_collisions *e, const rlf_contact *contact, rlf_source *source);
void eval_collisions_add(eval_collisions *e, const rlf_snapshot *snapshot, rlf_source *source);

#endif
