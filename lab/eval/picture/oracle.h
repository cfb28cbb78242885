/* What pictures would be with parts of the truth in place of what was sensed. */
#ifndef RELIEF_APP_EVAL_PICTURE_ORACLE_H
#define RELIEF_APP_EVAL_PICTURE_ORACLE_H

#include "eval/oracle.h"
#include "eval/picture/truth.h"

typedef struct picture_oracle {
    int32_t parts; /* bits of eval_oracle_part; 0 = all is sensed */
    rlf_source *source;
    eval_oracle *surface; /* NULL: nothing of the surface is true */

    /* EVAL_ORACLE_CAMERA: a surface at the colour camera. */
    rlf_surface seen;
    float *depth, *ray_x, *ray_y;
    uint8_t *wanted; /* [tile] 1 = near a body */
    rlf_pose T_depth_color;
} picture_oracle;

/* `source` is a synthetic one, borrowed. RLF_ERROR_MEMORY. */
rlf_result picture_oracle_create(rlf_source *source, int32_t parts, picture_oracle *out);
void picture_oracle_destroy(picture_oracle *o);
/* Makes the compositor one for the surface that it will get. */
void picture_oracle_change_def(const picture_oracle *o, rlf_compositor_def *def);
/* Puts the truth of the source's last frame into what is drawn. `t` says where bodies are. */
rlf_result picture_oracle_change_input(picture_oracle *o, const picture_truth *t,
                                       rlf_render_input *input);
/* What pixels that show a body whole or not at all would be. */
void picture_oracle_change_alpha(const picture_oracle *o, const picture_truth *t, float *alpha);

#endif
