/* Names of the figures and where each comes from. */
#include "eval/figures.h"

#include "eval/measures/angles.h"
#include "eval/measures/behind.h"
#include "eval/measures/collisions.h"
#include "eval/measures/depth.h"
#include "eval/measures/foreground.h"
#include "eval/measures/percent.h"
#include "eval/measures/solid.h"

#include <math.h>

typedef enum figure_index {
    STILL_RMS,
    STILL_RAW_RMS,
    STILL_FLYING,
    STILL_RAW_FLYING,
    STILL_MISSING,
    STILL_RAW_MISSING,
    STILL_FILLED,
    STILL_FILLED_RMS,
    STILL_FILLED_WRONG,
    MOVING_RMS,
    MOVING_RAW_RMS,
    MOVING_FLYING,
    MOVING_RAW_FLYING,
    MOVING_MISSING,
    MOVING_RAW_MISSING,
    MOVING_FILLED,
    MOVING_FILLED_RMS,
    MOVING_FILLED_WRONG,
    INTERIOR_MEDIAN,
    INTERIOR_MEAN,
    INTERIOR_WRONG,
    INTERIOR_MISSING,
    BAND_MEDIAN,
    BAND_MEAN,
    BAND_WRONG,
    BAND_MISSING,
    SEEN_MEDIAN,
    SEEN_MEAN,
    SEEN_WRONG,
    SEEN_MISSING,
    SHOWN_WRONG,
    CENTRE_BAD,
    CENTRE_MISSING,
    FOREGROUND_PRECISION,
    FOREGROUND_RECALL,
    FOREGROUND_F,
    FOREGROUND_F_VALID,
    FOREGROUND_FALSE,
    EXIT_MEAN,
    EXIT_CLOSE,
    UNLIKE_EXIT_MEAN,
    BOOK_EXIT_MEAN,
    STANDING_EXIT_MEAN,
    STANDING_EXIT_CLOSE,
    STANDING_KNOWN,
    SPEED_MEDIAN,
    SPEED_MEAN,
    VELOCITY_MEDIAN,
    SWIFT_MEAN,
    STILL_ZERO,
    BEHIND_MISSING,
    BEHIND_OFF,
    BEHIND_RMS,
    BEHIND_NORMAL_MEAN,
    BEHIND_NORMAL_WRONG,
    PHANTOMS_SOON,
    PHANTOMS_LATE,
    BOUNCES,
    BOUNCES_PHANTOM,
    BOUNCES_OFF,
    BOUNCES_MEAN,
    BOUNCES_RIGHT,
    BOUNCES_CLOSE,
    BOUNCES_WRONG,
    BOUNCES_UNEXPLAINED,
    ENTRIES,
    FIGURE_COUNT
} figure_index;

typedef struct figure_name {
    const char *key, *title;
} figure_name;

static const figure_name names[FIGURE_COUNT] = {
    [STILL_RMS] = {"depth_still_rmse_mm", "depth at rest: RMSE, mm"},
    [STILL_RAW_RMS] = {"depth_still_raw_rmse_mm", "  raw frame: RMSE, mm"},
    [STILL_FLYING] = {"depth_still_flying_percent", "depth at rest: flying pixels, %"},
    [STILL_RAW_FLYING] = {"depth_still_raw_flying_percent", "  raw frame: flying pixels, %"},
    [STILL_MISSING] = {"depth_still_missing_percent", "depth at rest: missing, %"},
    [STILL_RAW_MISSING] = {"depth_still_raw_missing_percent", "  raw frame: missing, %"},
    [STILL_FILLED] = {"depth_still_filled_percent", "depth at rest: filled, %"},
    [STILL_FILLED_RMS] = {"depth_still_filled_rmse_mm", "  filled: RMSE, mm"},
    [STILL_FILLED_WRONG] = {"depth_still_filled_wrong_percent",
                            "  filled: wrong side of an edge, %"},
    [MOVING_RMS] = {"depth_moving_rmse_mm", "depth new in a frame: RMSE, mm"},
    [MOVING_RAW_RMS] = {"depth_moving_raw_rmse_mm", "  raw frame: RMSE, mm"},
    [MOVING_FLYING] = {"depth_moving_flying_percent", "depth new in a frame: flying pixels, %"},
    [MOVING_RAW_FLYING] = {"depth_moving_raw_flying_percent", "  raw frame: flying pixels, %"},
    [MOVING_MISSING] = {"depth_moving_missing_percent", "depth new in a frame: missing, %"},
    [MOVING_RAW_MISSING] = {"depth_moving_raw_missing_percent", "  raw frame: missing, %"},
    [MOVING_FILLED] = {"depth_moving_filled_percent", "depth new in a frame: filled, %"},
    [MOVING_FILLED_RMS] = {"depth_moving_filled_rmse_mm", "  filled: RMSE, mm"},
    [MOVING_FILLED_WRONG] = {"depth_moving_filled_wrong_percent",
                             "  filled: wrong side of an edge, %"},
    [INTERIOR_MEDIAN] = {"normals_interior_median_deg", "normals, interior: median, deg"},
    [INTERIOR_MEAN] = {"normals_interior_mean_deg", "normals, interior: mean, deg"},
    [INTERIOR_WRONG] = {"normals_interior_over_30_percent", "normals, interior: > 30 deg off, %"},
    [INTERIOR_MISSING] = {"normals_interior_missing_percent", "normals, interior: missing, %"},
    [BAND_MEDIAN] = {"normals_band_median_deg", "normals, edge band: median, deg"},
    [BAND_MEAN] = {"normals_band_mean_deg", "normals, edge band: mean, deg"},
    [BAND_WRONG] = {"normals_band_over_30_percent", "normals, edge band: > 30 deg off, %"},
    [BAND_MISSING] = {"normals_band_missing_percent", "normals, edge band: missing, %"},
    [SEEN_MEDIAN] = {"normals_band_seen_median_deg", "  not filled: median, deg"},
    [SEEN_MEAN] = {"normals_band_seen_mean_deg", "normals, edge, not filled: mean, deg"},
    [SEEN_WRONG] = {"normals_band_seen_over_30_percent",
                    "normals, edge, not filled: > 30 deg off, %"},
    [SEEN_MISSING] = {"normals_band_seen_missing_percent", "  not filled: missing, %"},
    [SHOWN_WRONG] = {"normals_band_shown_over_30_percent",
                     "  of the surface that depth shows: > 30 deg off, %"},
    [CENTRE_BAD] = {"centre_bad_percent", "thesis grid's centre: wrong or missing, %"},
    [CENTRE_MISSING] = {"centre_missing_percent", "  missing, %"},
    [FOREGROUND_PRECISION] = {"foreground_precision", "foreground: precision"},
    [FOREGROUND_RECALL] = {"foreground_recall", "foreground: recall"},
    [FOREGROUND_F] = {"foreground_f", "foreground: F, all pixels"},
    [FOREGROUND_F_VALID] = {"foreground_f_valid", "foreground: F, pixels with raw depth"},
    [FOREGROUND_FALSE] = {"foreground_false_percent", "background taken for foreground, %"},
    [EXIT_MEAN] = {"exit_mean_cm", "thickness of people: exit error, cm"},
    [EXIT_CLOSE] = {"exit_within_5_cm_percent", "thickness of people: within 5 cm, %"},
    [UNLIKE_EXIT_MEAN] = {"unlike_exit_mean_cm",
                          "  children, coats, skirts, backpacks: exit error, cm"},
    [BOOK_EXIT_MEAN] = {"book_exit_mean_cm", "thickness of a held book: exit error, cm"},
    [STANDING_EXIT_MEAN] = {"standing_exit_mean_cm", "thickness of what stands: exit error, cm"},
    [STANDING_EXIT_CLOSE] = {"standing_within_5_cm_percent",
                             "thickness of what stands: within 5 cm, %"},
    [STANDING_KNOWN] = {"standing_known_percent", "thickness of what stands: known, %"},
    [SPEED_MEDIAN] = {"speed_median_percent", "speed along the normal: median error, %"},
    [SPEED_MEAN] = {"speed_mean_percent", "speed along the normal: mean error, %"},
    [VELOCITY_MEDIAN] = {"velocity_median_percent", "velocity, whole vector: median error, %"},
    [SWIFT_MEAN] = {"velocity_swift_mean_percent", "velocity above 1.5 m/s: mean error, %"},
    [STILL_ZERO] = {"still_zero_percent", "still pixels exactly still, %"},
    [BEHIND_MISSING] = {"behind_missing_percent", "room behind what moves: missing, %"},
    [BEHIND_OFF] = {"behind_off_percent", "room behind what moves: > 4 cm off, %"},
    [BEHIND_RMS] = {"behind_rmse_mm", "room behind what moves: RMSE, mm"},
    [BEHIND_NORMAL_MEAN] = {"behind_normals_mean_deg",
                            "room behind what moves: normals, mean, deg"},
    [BEHIND_NORMAL_WRONG] = {"behind_normals_over_30_percent",
                             "room behind what moves: normals > 30 deg, %"},
    [PHANTOMS_SOON] = {"background_phantoms_soon_percent", "phantoms 3 frames after, %"},
    [PHANTOMS_LATE] = {"background_phantoms_late_percent", "phantoms 30 frames after, %"},
    [BOUNCES] = {"bounces", "bounces on the real scene"},
    [BOUNCES_PHANTOM] = {"bounces_phantom_percent", "bounces where nothing real is, %"},
    [BOUNCES_OFF] = {"bounces_off_mm", "bounces: mean error of the place, mm"},
    [BOUNCES_MEAN] = {"bounces_mean_deg", "bounces: mean error of the normal, deg"},
    [BOUNCES_RIGHT] = {"bounces_right_percent", "bounces within 10 deg of a true direction, %"},
    [BOUNCES_CLOSE] = {"bounces_within_10_percent", "  of that of the nearest true face, %"},
    [BOUNCES_WRONG] = {"bounces_over_30_percent", "bounces > 30 deg off, %"},
    [BOUNCES_UNEXPLAINED] = {"bounces_unexplained_percent",
                             "bounces > 30 deg off, not at an edge, %"},
    [ENTRIES] = {"entries", "a body in view got inside something, times"},
};

int32_t eval_figure_count(void)
{
    return FIGURE_COUNT;
}

const char *eval_figure_key(int32_t index)
{
    return names[index].key;
}

const char *eval_figure_title(int32_t index)
{
    return names[index].title;
}

/* The nine figures of a depth group follow each other. */
static void get_depth(const eval_depth_group *g, double *v)
{
    v[STILL_RMS] = eval_depth_rms_mm(&g->seen);
    v[STILL_RAW_RMS] = eval_depth_rms_mm(&g->raw);
    v[STILL_FLYING] = eval_depth_flying_percent(&g->seen);
    v[STILL_RAW_FLYING] = eval_depth_flying_percent(&g->raw);
    v[STILL_MISSING] = eval_depth_missing_percent(g);
    v[STILL_RAW_MISSING] = eval_depth_raw_missing_percent(g);
    v[STILL_FILLED] = eval_depth_filled_percent(g);
    v[STILL_FILLED_RMS] = eval_depth_rms_mm(&g->filled);
    v[STILL_FILLED_WRONG] = eval_depth_other_side_percent(&g->filled);
}

/* So do the four of a band of normals. */
static void get_angles(const eval_angles *a, double *v)
{
    v[0] = eval_median_deg(a);
    v[1] = eval_mean_deg(a);
    v[2] = eval_wrong_percent(a);
    v[3] = eval_missing_percent(a);
}

static void get_solid(const eval_solid *s, double *v)
{
    v[EXIT_MEAN] = eval_exit_mean_cm(&s->body);
    v[EXIT_CLOSE] = eval_exit_close_percent(&s->body);
    v[UNLIKE_EXIT_MEAN] = eval_exit_mean_cm(&s->unlike);
    v[BOOK_EXIT_MEAN] = eval_exit_mean_cm(&s->book);
    v[STANDING_EXIT_MEAN] = eval_exit_mean_cm(&s->standing);
    v[STANDING_EXIT_CLOSE] = eval_exit_close_percent(&s->standing);
    v[STANDING_KNOWN] = eval_standing_known_percent(s);
    v[SPEED_MEDIAN] = eval_speed_median_percent(&s->normal);
    v[SPEED_MEAN] = eval_speed_mean_percent(&s->normal);
    v[VELOCITY_MEDIAN] = eval_speed_median_percent(&s->full);
    v[SWIFT_MEAN] = eval_speed_mean_percent(&s->swift);
    v[STILL_ZERO] = eval_percent(s->still_zero, s->still);
    v[PHANTOMS_SOON] = eval_percent(s->phantoms.left_soon, s->phantoms.seen_soon);
    v[PHANTOMS_LATE] = eval_percent(s->phantoms.left_late, s->phantoms.seen_late);
}

static void get_behind(const eval_behind *b, double *v)
{
    v[BEHIND_MISSING] = eval_behind_missing_percent(b);
    v[BEHIND_OFF] = eval_behind_off_percent(b);
    v[BEHIND_RMS] = eval_behind_rms_mm(b);
    v[BEHIND_NORMAL_MEAN] = eval_mean_deg(&b->angles);
    v[BEHIND_NORMAL_WRONG] = eval_wrong_percent(&b->angles);
}

static void get_collisions(const eval_collisions *c, double *v)
{
    v[BOUNCES] = (double)c->bounces;
    v[BOUNCES_PHANTOM] = eval_percent(c->phantom, c->bounces);
    v[BOUNCES_OFF] = c->angles.count > 0 ? 1e3 * c->off_m / (double)c->angles.count : NAN;
    v[BOUNCES_MEAN] = eval_mean_deg(&c->angles);
    v[BOUNCES_RIGHT] = eval_percent(c->right, c->angles.count);
    v[BOUNCES_CLOSE] = eval_within_percent(&c->angles, 10.0);
    v[BOUNCES_WRONG] = eval_wrong_percent(&c->angles);
    v[BOUNCES_UNEXPLAINED] = eval_percent(c->unexplained, c->angles.count);
    v[ENTRIES] = (double)c->entries;
}

void eval_figures_get(const eval_measures *m, double *values)
{
    get_depth(&m->depth.still, values);
    get_depth(&m->depth.moving, values + (MOVING_RMS - STILL_RMS));
    get_angles(&m->normals.interior, values + INTERIOR_MEDIAN);
    get_angles(&m->normals.band, values + BAND_MEDIAN);
    get_angles(&m->normals.seen, values + SEEN_MEDIAN);
    values[SHOWN_WRONG] = eval_wrong_percent(&m->normals.shown);
    values[CENTRE_BAD] = eval_percent(m->centre.wrong + m->centre.missing, m->centre.points);
    values[CENTRE_MISSING] = eval_percent(m->centre.missing, m->centre.points);
    const eval_foreground *f = &m->foreground;
    bool is_there = f->all.true_positive + f->all.false_negative > 0;
    values[FOREGROUND_PRECISION] = is_there ? eval_precision(&f->all) : NAN;
    values[FOREGROUND_RECALL] = is_there ? eval_recall(&f->all) : NAN;
    values[FOREGROUND_F] = is_there ? eval_f_measure(&f->all) : NAN;
    values[FOREGROUND_F_VALID] = is_there ? eval_f_measure(&f->valid) : NAN;
    values[FOREGROUND_FALSE] =
        eval_percent(f->all.false_positive, f->all.false_positive + f->all.true_negative);
    get_solid(&m->solid, values);
    get_behind(&m->behind, values);
    get_collisions(&m->collisions, values);
}
