/* Oracles: sensed quantities replaced by the truth, to see what each of them costs the bodies. */
#ifndef RELIEF_APP_EVAL_ORACLE_H
#define RELIEF_APP_EVAL_ORACLE_H

#include "relief/surface.h"
#include "relief/synthetic.h"

/* What is true; any of them together. */
typedef enum eval_oracle_part {
    EVAL_ORACLE_VELOCITY = 1,    /* of what moves */
    EVAL_ORACLE_THICKNESS = 2,   /* of what moves */
    EVAL_ORACLE_DEPTH = 4,       /* of the front sheet, and which of its pixels are foreground */
    EVAL_ORACLE_NORMALS = 8,     /* of the front sheet */
    EVAL_ORACLE_BACKGROUND = 16, /* its depth and normals */
    EVAL_ORACLE_SURFACE = 31,    /* all of these: "all" */
    EVAL_ORACLE_CAMERA = 32,     /* of pictures: the depth that the colour camera would see */
    EVAL_ORACLE_PIXELS = 64      /* of pictures: whole pixels of bodies, shown or hidden */
} eval_oracle_part;

/* "velocity,thickness,depth,normals,background,camera,pixels" in any choice, or "all" of a surface,
 * to bits. */
bool eval_oracle_parse(const char *text, void *out_parts);

typedef struct eval_oracle eval_oracle;

/* `source` is a synthetic one, borrowed. RLF_ERROR_MEMORY. */
rlf_result eval_oracle_create(rlf_source *source, int32_t parts, eval_oracle **out);
void eval_oracle_destroy(eval_oracle **oracle);
/* An rlf_surface_fn: the surface with the truth of the source's last frame in it. */
const rlf_surface *eval_oracle_replace(void *oracle, const rlf_surface *sensed);

#endif
