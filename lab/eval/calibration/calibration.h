/* `relief calibrate` measured: simulated boards with known cameras, and public pictures. */
#ifndef RELIEF_APP_EVAL_CALIBRATION_H
#define RELIEF_APP_EVAL_CALIBRATION_H

#include "eval/table.h"

/* A simulated Kinect v2 that sees 20 boards: profile live by all inner corners, thesis by the four
 * corners of the board's outline in depth. Where OpenCV is not there, only lenses are measured. */
rlf_result eval_calibration_run(eval_table *table, int64_t seed, int profile_mask);
/* What every lens model loses there and back, over whole pictures. */
void eval_calibration_lenses(eval_table *table);
/* OpenCV's 13 pairs, left*.jpg and right*.jpg in one folder: a 9x6 board. */
rlf_result eval_chessboards_run(eval_table *table, const char *folder);

#endif
