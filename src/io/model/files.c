/* Assimp's file hooks over whole files in memory. */
#include "io/model/files.h"
#include "io/model/model.h"

#include <stdint.h>
#include <string.h>

/* One open file; aiFile's user data points back to it. */
typedef struct open_file {
    struct aiFile hooks;
    io_buffer buffer;
    io_bytes bytes;
    size_t at;
} open_file;

static open_file *of(struct aiFile *file)
{
    return (open_file *)(void *)file->UserData;
}

static size_t read_some(struct aiFile *file, char *out, size_t size, size_t count)
{
    open_file *f = of(file);
    size_t left = f->bytes.size - f->at;
    size_t items = size > 0 ? left / size : 0;
    items = items < count ? items : count;
    if (items > 0) {
        memcpy(out, f->bytes.data + f->at, items * size);
    }
    f->at += items * size;
    return items;
}

static size_t write_none(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file;
    (void)data;
    (void)size;
    (void)count;
    return 0;
}

static size_t tell(struct aiFile *file)
{
    return of(file)->at;
}

static size_t size_of(struct aiFile *file)
{
    return of(file)->bytes.size;
}

static void flush(struct aiFile *file)
{
    (void)file;
}

static enum aiReturn seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    open_file *f = of(file);
    size_t base = origin == aiOrigin_SET ? 0 : (origin == aiOrigin_CUR ? f->at : f->bytes.size);
    size_t to = base + offset; /* backwards is a wrap round */
    if (to > f->bytes.size) {
        return aiReturn_FAILURE;
    }
    f->at = to;
    return aiReturn_SUCCESS;
}

static struct aiFile *open_named(struct aiFileIO *io, const char *path, const char *mode)
{
    io_model_files *files = (io_model_files *)(void *)io->UserData;
    open_file *f = mode[0] == 'r' ? rlf_alloc(sizeof(*f)) : NULL;
    if (f == NULL) {
        return NULL;
    }
    if (strcmp(path, files->main->name) == 0) {
        f->bytes = *files->main;
    } else if (files->is_alone || io_file_read(path, IO_MODEL_FILE_MAX, "check the model",
                                               &f->buffer, &f->bytes) != RLF_OK) {
        if (files->missing[0] == '\0') {
            (void)snprintf(files->missing, sizeof(files->missing), "%s", path);
        }
        rlf_free(f);
        return NULL;
    }
    f->hooks = (struct aiFile){read_some, write_none, tell, size_of, seek, flush, NULL};
    f->hooks.UserData = (aiUserData)(void *)f;
    return &f->hooks;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    open_file *f = of(file);
    io_buffer_free(&f->buffer);
    rlf_free(f);
}

void io_model_files_init(io_model_files *files, const io_bytes *main, bool is_alone)
{
    *files = (io_model_files){.main = main, .is_alone = is_alone};
    files->hooks = (struct aiFileIO){open_named, close_file, (aiUserData)(void *)files};
}
