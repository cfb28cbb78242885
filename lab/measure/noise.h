/* The noise of a depth sensor, by distance, as a still scene shows it. */
#ifndef RELIEF_APP_MEASURE_NOISE_H
#define RELIEF_APP_MEASURE_NOISE_H

#include "relief/io.h"

#define MEASURE_NOISE_BINS 20
#define MEASURE_NOISE_BIN_M 0.5 /* bin b is from b / 2 to (b + 1) / 2 metres */

/* Spatial noise at three steps, then noise from frame to frame. */
typedef enum noise_kind {
    NOISE_STEP_1 = 0,
    NOISE_STEP_2 = 1,
    NOISE_STEP_4 = 2,
    NOISE_TEMPORAL = 3,
    NOISE_KIND_COUNT = 4
} noise_kind;

typedef struct measure_noise measure_noise;

/* Sums for frames of this rig's depth size; NULL when there is no memory. */
measure_noise *measure_noise_create(const rlf_rig *rig);
void measure_noise_destroy(measure_noise **noise);
void measure_noise_add(measure_noise *noise, const rlf_frame *frame);

/* Standard deviation in metres, as if the noise were normal; < 0 with fewer than 200 samples. */
double measure_noise_sigma(const measure_noise *noise, noise_kind kind, int32_t bin);
/* Share of pixels with depth in the bin and share without any, percent. */
double measure_noise_share(const measure_noise *noise, int32_t bin);
double measure_noise_missing(const measure_noise *noise);
int64_t measure_noise_frames(const measure_noise *noise);

/* `relief-lab measure SOURCE --noise`: reads the source, prints the table; json_path may be NULL.
 */
rlf_result measure_noise_run(const char *source_name, int64_t frames, const char *json_path);

#endif
