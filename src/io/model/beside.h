/* Which other files a model may name. */
#ifndef RLF_IO_MODEL_BESIDE_H
#define RLF_IO_MODEL_BESIDE_H

#include "io/file.h"

/* `path` is a file that the model at `model` names, joined with the model's folder. *out is the
 * path to read it by. RLF_ERROR_UNSUPPORTED when it is neither in the model's folder nor below,
 * links followed: whoever made the model may not have files read for him. */
rlf_result io_model_beside(const char *model, const char *path, char out[IO_PATH_MAX]);

#endif
