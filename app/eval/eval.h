/* Measures of one run against ground truth. Each keeps counts over frames and seeds. */
#ifndef RELIEF_APP_EVAL_H
#define RELIEF_APP_EVAL_H

#include "relief/io.h"

#include <math.h>

#define EVAL_ANGLE_BINS 18000 /* 0.01 degrees each */

/* NAN when there was nothing to measure: a figure without samples is not a figure of 0. */
static inline double eval_percent(int64_t part, int64_t whole)
{
    return whole > 0 ? 100.0 * (double)part / (double)whole : NAN;
}

/* Distribution of angles between estimated and true normals. */
typedef struct eval_angles {
    int64_t bins[EVAL_ANGLE_BINS];
    double sum_deg;
    int64_t count;   /* samples with both normals */
    int64_t wrong;   /* of them, more than 30 degrees off */
    int64_t missing; /* samples with a true surface in range but no normal */
} eval_angles;

/* Samples inside surfaces, and within 6 pixels (full resolution) of a depth jump. */
typedef struct eval_normals {
    eval_angles interior, band;
    eval_angles seen;  /* of the band, without filled pixels */
    eval_angles shown; /* of the band, against the true surface that the pixel's own depth shows */
} eval_normals;

/* The thesis's own experiment: the centre (56 x 47 of 64 x 53 points) of its grid of every 8th
 * pixel, in frames that show something moving. Finer grids are sampled at the same pixels. */
typedef struct eval_centre {
    int64_t points;  /* with a true surface in range */
    int64_t wrong;   /* of them, normal more than 30 degrees off */
    int64_t missing; /* of them, without a normal */
} eval_centre;

/* Depth samples against truth. */
typedef struct eval_depth_errors {
    int64_t pixels;     /* with a true surface in range */
    int64_t missing;    /* of them, without depth */
    int64_t flying;     /* farther than 4 cm from every true depth of the 3x3 neighbourhood */
    int64_t other_side; /* farther than 4 cm from the pixel's own true depth */
    int64_t count;      /* the others: square_sum's */
    double square_sum;  /* m^2 */
} eval_depth_errors;

typedef struct eval_depth_group {
    eval_depth_errors raw, seen, filled; /* the surface's pixels without depth are in `seen` */
} eval_depth_group;

/* Pixels whose truth has not changed for a second, and pixels whose truth is new in this frame (all
 * of the first frame's): what one frame alone must give. */
typedef struct eval_depth {
    eval_depth_group still, moving;
    float *last;       /* true depth of the frame before */
    int64_t *since_ns; /* when it became so */
} eval_depth;

typedef struct eval_confusion {
    int64_t true_positive, false_positive, false_negative, true_negative;
} eval_confusion;

/* Foreground against truth, on all pixels and where the sensor gave a depth. */
typedef struct eval_foreground {
    eval_confusion all, valid;
} eval_foreground;

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

double eval_median_deg(const eval_angles *angles);
double eval_mean_deg(const eval_angles *angles);
/* Shares in percent. These and the two above are NAN when there is no sample. */
double eval_wrong_percent(const eval_angles *angles);
double eval_missing_percent(const eval_angles *angles);
/* Share of the angles below `degrees`, to 0.01 degrees. */
double eval_within_percent(const eval_angles *angles, double degrees);
void eval_add_angle(eval_angles *angles, double degrees);

/* Marks pixels within 6 of a jump (neighbours whose depths differ by more than 4 % of the nearer).
 * out and scratch hold width * height bytes. */
void eval_mark_band(const float *depth, int32_t width, int32_t height, uint8_t *out,
                    uint8_t *scratch);
void eval_normals_add(eval_normals *e, const rlf_surface *surface, const rlf_truth *truth,
                      const rlf_rig *rig, const uint8_t *band);

void eval_centre_add(eval_centre *e, const rlf_surface *surface, const rlf_truth *truth,
                     const rlf_rig *rig);

rlf_result eval_depth_init(eval_depth *e, const rlf_camera *camera);
void eval_depth_finish(eval_depth *e);
void eval_depth_add(eval_depth *e, const rlf_surface *surface, const rlf_frame *frame,
                    const rlf_truth *truth);
/* The frame's depth at a pixel as it came, metres; <= 0 = missing. */
float eval_raw_depth(const rlf_frame *frame, int32_t x, int32_t y);
/* RMS of the errors below 4 cm. */
double eval_depth_rms_mm(const eval_depth_errors *e);
/* Shares of the samples with depth. */
double eval_depth_flying_percent(const eval_depth_errors *e);
double eval_depth_other_side_percent(const eval_depth_errors *e);
/* Shares of all pixels. */
double eval_depth_raw_missing_percent(const eval_depth_group *g);
double eval_depth_missing_percent(const eval_depth_group *g);
double eval_depth_filled_percent(const eval_depth_group *g);

void eval_foreground_add(eval_foreground *e, const rlf_surface *surface, const rlf_truth *truth,
                         const rlf_rig *rig);
double eval_precision(const eval_confusion *c);
double eval_recall(const eval_confusion *c);
double eval_f_measure(const eval_confusion *c);

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
