/* A source of a moving camera through tracker and map, beside its own poses. */
#ifndef RELIEF_APP_EVAL_MOVING_MOVING_H
#define RELIEF_APP_EVAL_MOVING_MOVING_H

#include "relief/source.h"

/* What happens to the pictures. */
typedef struct moving_options {
    int64_t frames;  /* at most; 0 = all */
    bool is_covered; /* the lens is covered for a second, again and again */
} moving_options;

/* Of one clip. NAN = there is none. */
typedef struct moving_figures {
    double ate_mm;     /* absolute trajectory error, RMSE after the best rigid motion */
    double drift_mm;   /* a frame's motion against the true one, median */
    double drift_deg;  /* likewise, its turn */
    double lost_share; /* percent of the frames */
    double wrong_good; /* percent of the frames said to be good that are more than 5 cm off */
    double track_ms, predict_ms, integrate_ms; /* medians */
    int64_t covers, found_again; /* lens covered; good and within 2 cm 10 frames later */
} moving_figures;

/* Runs the source from where it stands to its end, one thread. */
rlf_result moving_measure(rlf_source *source, const moving_options *options, moving_figures *out);

#endif
