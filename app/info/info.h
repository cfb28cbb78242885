/* What `relief info` measures of a source. */
#ifndef RELIEF_APP_INFO_H
#define RELIEF_APP_INFO_H

#include "relief/frame.h"
#include "relief/io.h"
#include "relief/source.h"

/* ---- a frame's depth ------------------------------------------------------------------------- */

/* Of a range of distances that are told apart. */
#define INFO_BINS 10
#define INFO_BIN_M                                                                                 \
    0.5 /* bin b is from b / 2 to (b + 1) / 2 metres; the last one takes the rest                  \
         */

static inline int32_t info_bin(double z)
{
    const int32_t bin = (int32_t)(z / INFO_BIN_M);
    return bin < INFO_BINS - 1 ? bin : INFO_BINS - 1;
}

/* Rows of width * height metres; 0 = missing. What is out of the rig's range stays. */
void info_depth_plane(const rlf_frame *frame, float *out);

/* Depth difference over `pixels` pixels that a surface tilted by up to 63 degrees (a slope of 2)
 * and its noise explain, metres; what differs by more is a depth step. */
static inline double info_step(const rlf_rig *rig, double z, int32_t pixels)
{
    return 6.0 * rlf_depth_noise_sigma(&rig->noise, z) + 2.0 * pixels * z / rig->depth.fx;
}

/* ---- what is missing ------------------------------------------------------------------------- */

typedef enum missing_kind {
    MISSING_RIM = 0,    /* whole rows or columns at the picture's border */
    MISSING_BORDER = 1, /* holes that reach the border or the rim */
    MISSING_STEP = 2,   /* beside a depth step: shadows of what is near */
    MISSING_INSIDE = 3, /* holes in a surface: dark, shiny, clear, too bright */
    MISSING_NEAR = 4,   /* measured, but nearer than the range */
    MISSING_FAR = 5,    /* measured, but beyond the range */
    MISSING_KIND_COUNT = 6
} missing_kind;

typedef struct missing_counts {
    int64_t frames, pixels; /* of all frames */
    int64_t kinds[MISSING_KIND_COUNT];
} missing_counts;

/* Adds one frame; `depth` in metres, 0 = missing, in rows without padding. */
void missing_add(missing_counts *counts, const rlf_rig *rig, const float *depth);

/* Percent of all pixels; 0 without frames. */
double missing_percent(const missing_counts *counts, missing_kind kind);
double missing_percent_all(const missing_counts *counts);
/* For a table: "rim", "beside depth steps", ... */
const char *missing_name(missing_kind kind);

/* ---- noise over time ------------------------------------------------------------------------- */

#define STILLNESS_FRAMES_MIN 8
#define STILLNESS_FRAMES_MAX 60
#define STILLNESS_MOST_M 0.2 /* a deviation of that is this or more */

typedef struct stillness stillness;

/* Of pixels that stay, in one range of distances. */
typedef struct stillness_bin {
    int64_t pixels;
    double median_m, most_m; /* standard deviation of half and of 90 % of the pixels, at most */
} stillness_bin;

typedef struct stillness_result {
    int32_t frames;
    double still_percent; /* of the pixels seen in nearly all frames */
    stillness_bin bins[INFO_BINS];
} stillness_result;

/* NULL without memory. */
stillness *stillness_create(const rlf_rig *rig);
void stillness_destroy(stillness **s);
/* Adds one frame, metres, 0 = missing; those after STILLNESS_FRAMES_MAX are not looked at. */
void stillness_add(stillness *s, const float *depth);
/* Without STILLNESS_FRAMES_MIN frames all is 0. */
void stillness_get(const stillness *s, stillness_result *out);

/* ---- noise by distance ----------------------------------------------------------------------- */

#define INFO_NOISE_BINS 20
#define INFO_NOISE_BIN_M 0.5 /* bin b is from b / 2 to (b + 1) / 2 metres */

/* Spatial noise at three steps, then noise from frame to frame. */
typedef enum noise_kind {
    NOISE_STEP_1 = 0,
    NOISE_STEP_2 = 1,
    NOISE_STEP_4 = 2,
    NOISE_TEMPORAL = 3,
    NOISE_KIND_COUNT = 4
} noise_kind;

typedef struct info_noise info_noise;

/* Sums for frames of this rig's depth size; NULL when there is no memory. */
info_noise *info_noise_create(const rlf_rig *rig);
void info_noise_destroy(info_noise **noise);
void info_noise_add(info_noise *noise, const rlf_frame *frame);

/* Standard deviation in metres, as if the noise were normal; < 0 with fewer than 200 samples. */
double info_noise_sigma(const info_noise *noise, noise_kind kind, int32_t bin);
/* Share of pixels with depth in the bin and share without any, percent. */
double info_noise_share(const info_noise *noise, int32_t bin);
double info_noise_missing(const info_noise *noise);
int64_t info_noise_frames(const info_noise *noise);

/* Reads at most so many frames, prints the table; json_path may be NULL. RLF_NO_FRAME: stopped
 * before there was one. */
rlf_result info_noise_run(rlf_source *source, const char *name, int64_t frames,
                          const char *json_path);

/* ---- colour on depth ------------------------------------------------------------------------- */

/* How far off edges are looked for: pixels of the coarser picture. */
#define COLOR_FIT_REACH 16.0

typedef struct color_fit color_fit;

/* Lengths in colour pixels. */
typedef struct color_fit_result {
    int64_t edges; /* edge points used */
    int32_t frames;
    bool is_known;    /* enough edges, and they agree */
    bool is_far_only; /* the farther half of them alone does, and what follows is of it */
    double pixel;     /* what one depth pixel covers, at least 1 */
    double x, y;      /* the colour picture is that far right and down of where it should be */
    double error_x, error_y; /* standard errors of it */
    double widening;         /* depth's edges lie that far outside those of colour, on each side */
    /* The same from the nearer and the farther half of the edges alone; a transform that is missing
     * or wrong makes them differ. NAN = not known. */
    double near_x, near_y, far_x, far_y;
    double apart_x, apart_y; /* standard errors of near minus far */
} color_fit_result;

/* NULL without memory. The rig must have colour. */
color_fit *color_fit_create(const rlf_rig *rig);
void color_fit_destroy(color_fit **fit);
/* Adds one frame: depth in metres, 0 = missing, rows without padding. */
void color_fit_add(color_fit *fit, const float *depth, const rlf_image_rgba8 *color);
void color_fit_get(const color_fit *fit, color_fit_result *out);

/* Length of the offset and its error. */
double color_fit_length(const color_fit_result *r);
double color_fit_error(const color_fit_result *r);
/* Whether colour is off by more than a pixel of the coarser picture, beyond doubt. */
bool color_fit_is_off(const color_fit_result *r);
/* Near and far things are off by more than two pixels' difference, beyond doubt: the parallax is
 * not what the transform says. */
bool color_fit_is_parallax_wrong(const color_fit_result *r);

/* ---- the whole source ------------------------------------------------------------------------ */

typedef struct survey_options {
    double seconds;      /* of a live source */
    int64_t frame_limit; /* of one that has no end; 0 = no limit */
} survey_options;

typedef struct survey {
    int64_t frames, with_color, with_pose, with_confidence, jumps;
    int64_t failed; /* could not be read; `first_error` says why the first of them */
    char first_error[512];
    double duration_s;                     /* from the first frame to the last */
    double interval_s, interval_longest_s; /* median; 0 = fewer than two frames */
    double color_gap_s;                    /* mean |colour time - depth time| */
    uint32_t flags;                        /* of any frame */
    rlf_source_status status;
    missing_counts missing;
    stillness_result stillness;
    bool has_fit;
    color_fit_result fit;
} survey;

/* Reads the source to its end or as far as the options say. */
rlf_result survey_run(rlf_source *source, const survey_options *options, survey *out);

/* ---- what is told ---------------------------------------------------------------------------- */

void report_print(const rlf_source_info *info, const survey *s);
rlf_result report_write_json(const rlf_source_info *info, const survey *s, const char *path);

/* Whether colour and depth are said to be one camera's. */
bool report_says_aligned(const rlf_source_info *info, const survey *s);

/* Prints how the camera looks, as floors, tables and walls of each frame by itself say; and, for a
 * folder with a groundtruth.txt of the TUM RGB-D benchmark (its z is up), how far off that is.
 * At most so many frames. RLF_NO_FRAME: stopped before there was one. */
rlf_result info_up(rlf_source *source, const char *name, int64_t frames);

#endif
