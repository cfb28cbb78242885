/* The files of a model as assimp reads them: from memory, through io_file_read's checks. */
#ifndef RLF_IO_MODEL_FILES_H
#define RLF_IO_MODEL_FILES_H

#include "io/file.h"

#include <assimp/cfileio.h>

typedef struct io_model_files {
    const io_bytes *main;
    bool is_alone;             /* no other file is opened */
    char missing[IO_PATH_MAX]; /* the first that was not there, or "" */
    struct aiFileIO hooks;     /* give this to assimp */
} io_model_files;

/* Borrows `main`, and `files` must not move. */
void io_model_files_init(io_model_files *files, const io_bytes *main, bool is_alone);

#endif
