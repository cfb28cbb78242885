/* What one person differs in from another: size, build, clothes and gait. */
#ifndef RLF_SIM_FIGURE_H
#define RLF_SIM_FIGURE_H

#include "sim/shape.h"

/* ---- flesh.c: what things are made of, and the rounded solids of bodies. */

#define SYNTH_PERSON_FLESH 24

typedef enum synth_material {
    SYNTH_WALL = 0,
    SYNTH_FLOOR,
    SYNTH_TILES,
    SYNTH_RUBBER,
    SYNTH_CEILING,
    SYNTH_COLUMN,
    SYNTH_CUPBOARD,
    SYNTH_TABLE,
    SYNTH_CARDBOARD,
    SYNTH_BOX_RED,
    SYNTH_BOX_TEAL,
    SYNTH_BALL,
    SYNTH_CHAIR,
    SYNTH_SKIN,
    SYNTH_FACE,
    SYNTH_HAIR,
    SYNTH_SHIRT,
    SYNTH_TROUSERS,
    SYNTH_SHOE,
    SYNTH_BOOK,
    SYNTH_DRAWN, /* as the part's look says */
    SYNTH_MATERIAL_COUNT
} synth_material;

/* A solid fixed to a bone; numbers in metres, bone frame. */
typedef struct synth_flesh {
    const char *name;
    int bone; /* synth_bone */
    synth_material material;
    synth_shape_type type;
    rlf_vec3 offset;
    char axis; /* of the bone that the cone's axis runs along: 'x', 'y' or 'z' */
    rlf_vec3 size;
    double length, radius_a, radius_b;
} synth_flesh;

extern const synth_flesh synth_person_flesh[SYNTH_PERSON_FLESH]; /* of an adult of 1.75 m */

/* ---- One person. */

typedef struct synth_figure {
    double trunk, leg, arm; /* lengths, of those of an adult of 1.75 m */
    double shoulder, hip;   /* metres from the middle plane to the joints */
    double shoulder_height; /* metres above the hips */
    double clear;           /* metres that the hands hang farther out, past the hips */
    double pace;            /* speed of a walk that enters or leaves, of the script's */
    double step;            /* metres between footfalls of opposite feet, about */
    synth_flesh flesh[SYNTH_PERSON_FLESH];
} synth_figure;

/* The figure of seed 1 is an adult of 1.75 m; every other seed draws one, and for `second`
 * another. */
void synth_figure_make(synth_figure *figure, uint64_t seed, bool second);

#endif
