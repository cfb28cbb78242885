/* The pictures of a folder, and which of two folders' are of one moment. */
#ifndef RELIEF_APP_CALIBRATE_PICTURE_LIST_H
#define RELIEF_APP_CALIBRATE_PICTURE_LIST_H

#include "calibrate/views.h"

#define CALIBRATE_PATH_SIZE 4096

typedef struct calibrate_pictures {
    char folder[CALIBRATE_PATH_SIZE];
    char (*names)[CALIBRATE_NAME_SIZE]; /* sorted by number, then by name */
    int32_t count;
} calibrate_pictures;

/* Names of the PNG and JPEG files of a folder, or of those that fit a pattern: "boards/left*".
 * RLF_ERROR_IO when there are none. */
rlf_result calibrate_pictures_list(const char *place, calibrate_pictures *out);
void calibrate_pictures_free(calibrate_pictures *p);
/* The whole path of picture `index`. */
void calibrate_pictures_path(const calibrate_pictures *p, const char *name,
                             char out[CALIBRATE_PATH_SIZE]);
/* The last number in a file's name; -1 = none. */
int64_t calibrate_picture_number(const char *name);

/* One moment: places in both lists, -1 = none. */
typedef struct calibrate_pair {
    int32_t index[CALIBRATE_CAMERAS];
} calibrate_pair;

/* Pairs by the number in the names; by order where numbers are missing or repeat and both have as
 * many. `pairs` has room for both lists; returns how many. -1 when they cannot be paired. */
int32_t calibrate_pictures_pair(const calibrate_pictures *a, const calibrate_pictures *b,
                                calibrate_pair *pairs);

#endif
