/* The files of a model as assimp reads them: from memory, through io_file_read's checks. */
#ifndef RLF_IO_MODEL_FILES_H
#define RLF_IO_MODEL_FILES_H

#include "io/file.h"

#include <assimp/cfileio.h>

typedef struct io_model_files {
    const io_bytes *main;
    bool is_alone;     /* no other file is opened */
    bool is_obj;       /* they are MTL */
    size_t left;       /* bytes that may still be read of others */
    rlf_result result; /* of those that were refused; their line is in `problem` */
    char problem[1024];
    char last[IO_PATH_MAX];    /* the other file that was read last, or "" */
    char missing[IO_PATH_MAX]; /* the first that was not there, or "" */
    struct aiFileIO hooks;     /* give this to assimp */
} io_model_files;

/* Borrows `main`, and `files` must not move. */
void io_model_files_init(io_model_files *files, const io_bytes *main, bool is_alone, bool is_obj);

#endif
