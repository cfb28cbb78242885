/* A source of a moving camera through tracker and map, beside its own poses. */
#ifndef RELIEF_APP_EVAL_MOVING_MOVING_H
#define RELIEF_APP_EVAL_MOVING_MOVING_H

#include "relief/source.h"

typedef struct moving_options {
    int64_t frames; /* at most; 0 = all */
    int64_t covers; /* after them: so often the lens is covered for a second, and so often another
                       camera comes in */
} moving_options;

/* Of one clip. NAN = there is none. */
typedef struct moving_figures {
    double ate_mm;      /* absolute trajectory error, RMSE after the best rigid motion */
    double still_mm;    /* that of a camera that is taken to stand still */
    double drift_mm;    /* a frame's motion against the true one, median */
    double drift_deg;   /* likewise, its turn */
    double lost_share;  /* percent of the frames */
    double wrong_good;  /* percent of the frames said to be good that are more than 5 cm off */
    double found_again; /* percent of the covers: good and within 5 cm of where that frame was
                           found at first, 10 frames later */
    double found_known; /* likewise, of as many cameras that come into the room that is mapped */
    double track_ms, predict_ms, integrate_ms; /* medians */
} moving_figures;

/* Runs the source, which can seek, from where it stands to its end, one thread. */
rlf_result moving_measure(rlf_source *source, const moving_options *options, moving_figures *out);
/* Opens `text` and measures it. Says on stderr what came out. */
rlf_result moving_measure_clip(const char *name, const char *text, moving_figures *out);

#endif
