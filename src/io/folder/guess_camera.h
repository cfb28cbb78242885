/* The camera of a clip that names none, guessed from the size of its depth pictures. */
#ifndef RLF_IO_FOLDER_GUESS_CAMERA_H
#define RLF_IO_FOLDER_GUESS_CAMERA_H

#include "relief/camera.h"

/* What cameras that give pictures of width x height usually have. NULL: no camera is known for that
 * size. Else the camera's name, for a message. */
const char *io_guess_camera(int32_t width, int32_t height, rlf_camera *out);

/* Counts per metre of a 16-bit depth picture: 1000 (millimetres), or 5000 (TUM RGB-D) where
 * millimetres would put the middle of the picture beyond any room. */
double io_guess_units(const uint16_t *depth, size_t count);

#endif
