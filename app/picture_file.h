/* Pictures of a run as PNG files. */
#ifndef RELIEF_APP_PICTURE_FILE_H
#define RELIEF_APP_PICTURE_FILE_H

#include "relief/io.h"

/* Writes a picture, `factor` x `factor` pixels averaged into one; a rest at the right and at the
 * bottom is left out. RLF_ERROR_INVALID when nothing would be left. */
rlf_result picture_file_write(const char *path, const rlf_image_rgba8 *image, int32_t factor);

#endif
