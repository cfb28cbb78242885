/* The arrays that `relief export` can write, by name. */
#ifndef RELIEF_APP_EXPORT_ARRAYS_H
#define RELIEF_APP_EXPORT_ARRAYS_H

#include "relief/io.h"

#define EXPORT_KINDS_MAX 32

/* What an array is made from. */
typedef enum export_need {
    EXPORT_NEEDS_SURFACE = 0,
    EXPORT_NEEDS_RENDER = 1, /* a rendered picture */
    EXPORT_NEEDS_TRUTH = 2   /* a source that knows the truth */
} export_need;

/* One frame to take arrays from. */
typedef struct export_frame {
    const rlf_pipeline_output *output;
    const rlf_truth *truth; /* NULL when unknown */
    float *scratch;         /* room for 3 floats per pixel of the largest array */
    uint8_t *scratch_u8;    /* room for 3 bytes per pixel of the largest picture */
} export_frame;

typedef struct export_kind {
    const char *name;
    export_need need;
    const char *description;
    rlf_result (*write)(const export_frame *frame, const char *path);
} export_kind;

/* All kinds, in the order of the help text. */
extern const export_kind export_kinds[];
extern const int export_kind_count;

/* NULL when no kind has that name. */
const export_kind *export_kind_find(const char *name);

#endif
