/* Touching points of bodies, and the pairs and surfaces that they belong to. */
#ifndef RLF_PHYSICS_CONTACT_H
#define RLF_PHYSICS_CONTACT_H

#include "relief/snapshot.h"

#define PHYS_SURFACE_CONTACTS 12 /* of one body with the real surface */
#define PHYS_PAIR_CONTACTS 4     /* of two bodies */

/* For what is only told: single precision takes half of the memory. */
typedef struct phys_vec3f {
    float x, y, z;
} phys_vec3f;

static inline phys_vec3f phys_narrow(rlf_vec3 v)
{
    return (phys_vec3f){(float)v.x, (float)v.y, (float)v.z};
}

static inline rlf_vec3 phys_widen(phys_vec3f v)
{
    return rlf_vec3_make((double)v.x, (double)v.y, (double)v.z);
}

/* One touching point. The normal points from b (or the surface) to a. What every substep reads
 * comes first. */
typedef struct phys_contact {
    rlf_vec3 anchor_a;  /* in a's frame, metres */
    rlf_vec3 anchor_b;  /* in b's frame; of a surface: world, at surface_time */
    rlf_vec3 normal;    /* world, unit */
    double separation;  /* metres at the start of the substep */
    double rounding_a;  /* the touching point of a is this far from anchor_a along -normal */
    double rounding_b;  /* ... of b from anchor_b along the normal: round shapes roll */
    double impulses[3]; /* along the normal and two tangents in the last substep, N s */
    double impulse_sum; /* N s along the normal that the frame's list does not hold yet ... */
    rlf_vec3 surface_velocity;  /* world, m/s; 0 between bodies */
    double surface_time;        /* world time of anchor_b, s */
    double approach;            /* ... the highest speed at which they met, m/s, 0 = they rest, */
    phys_vec3f met, met_normal; /* ... and where that was, and its normal then, world */
    rlf_contact_other other;
    int32_t a, b;  /* body indices; b < 0: the surface */
    int32_t label; /* region label of the surface, 0 else */
    int64_t log;   /* entry in the list of all contacts there were, -1 = none; see world_state.h */
} phys_contact;

/* What lives on of a contact that is searched again. */
typedef struct phys_trace {
    rlf_vec3 anchor_a, normal;
    rlf_contact_other other;
    double impulses[3];
    int64_t log;
} phys_trace;

static inline phys_trace phys_trace_of(const phys_contact *c)
{
    phys_trace trace = {c->anchor_a, c->normal, c->other, {0, 0, 0}, c->log};
    for (int32_t row = 0; row < 3; row++) {
        trace.impulses[row] = c->impulses[row];
    }
    return trace;
}

static inline void phys_trace_follow(const phys_trace *trace, phys_contact *c)
{
    for (int32_t row = 0; row < 3; row++) {
        c->impulses[row] = trace->impulses[row];
    }
    c->log = trace->log;
}

/* What a group of contacts holds beside them. */
typedef struct phys_stance {
    bool is_set;      /* false: the contacts are new */
    rlf_vec3 rolling; /* angular impulse against rolling of the last substep, N m s */
} phys_stance;

/* The side of a box that gives a pair's contacts their normal, which turns with it. */
typedef struct phys_side {
    enum { PHYS_SIDE_NONE = 0, PHYS_SIDE_OF_A, PHYS_SIDE_OF_B } of;
    int32_t axis; /* 0, 1, 2: the box's */
    double sign;  /* the normal is sign times the axis */
} phys_side;

/* Two bodies that are near each other. */
typedef struct phys_pair {
    int32_t a, b;        /* a < b */
    int32_t age, period; /* substeps since, and between, searches for contacts */
    int32_t contact_count;
    phys_contact *contacts; /* PHYS_PAIR_CONTACTS; they move when pairs are found */
    rlf_vec3 offset;        /* from a to b at the last search */
    double turned_a, turned_b;
    double gap;    /* m between them then, or less; < 0 when they touch or it is not known */
    double margin; /* m within which contacts were searched */
    double friction, restitution;
    phys_side side;
    phys_stance stance;
} phys_pair;

#endif
