/* Model files as bodies to throw. */
#ifndef RELIEF_APP_BODY_MODEL_H
#define RELIEF_APP_BODY_MODEL_H

#include "relief/io.h"

#define BODY_MODELS_MAX 64 /* model files, and sizes of them */

typedef struct body_model {
    char path[1024];
    double size_m;
    rlf_model *model; /* owned by the first with that path */
    bool owns_model;
    rlf_hull *hull;
    rlf_look look;
} body_model;

/* All that were loaded, since bodies borrow them; zero = none. */
typedef struct body_models {
    body_model list[BODY_MODELS_MAX];
    int32_t count;
} body_models;

/* The hull around a model, `size_m` metres along its longest side. */
rlf_result body_models_load(body_models *models, const char *path, double size_m,
                            rlf_shape *out_shape, rlf_look *out_look);
void body_models_destroy(body_models *models);

#endif
