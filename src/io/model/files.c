/* Assimp's file hooks over whole files in memory. */
#include "io/model/files.h"
#include "io/model/beside.h"
#include "io/model/import.h"

#include <stdint.h>
#include <string.h>

#define TEXT_MIN 8 /* bytes of a text that assimp reads */

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

static rlf_result check_mtl(const io_bytes *file)
{
    return file->size >= TEXT_MIN ? io_model_check_obj(file) : RLF_ERROR_IO;
}

/* Another file than the model's own, checked as that one was. */
static rlf_result read_other(io_model_files *files, const char *path, open_file *f)
{
    char real[IO_PATH_MAX];
    rlf_result result = io_model_beside(files->main->name, path, real);
    if (result == RLF_OK) {
        result = io_file_read(real, files->left, "check the model", &f->buffer, &f->bytes);
    }
    if (result == RLF_OK) {
        files->left -= f->bytes.size;
        (void)snprintf(files->last, sizeof(files->last), "%s", path);
        result = files->is_obj ? check_mtl(&f->bytes) : RLF_OK;
    }
    if (result != RLF_OK) {
        io_buffer_free(&f->buffer);
    }
    return result;
}

/* Assimp is told no more than that the file is not there. */
static void note_failure(io_model_files *files, const char *path, rlf_result result)
{
    if (result == RLF_ERROR_IO && files->missing[0] == '\0') {
        (void)snprintf(files->missing, sizeof(files->missing), "%s", path);
    }
    if (result != RLF_ERROR_IO && files->result == RLF_OK) {
        files->result = result;
        (void)snprintf(files->problem, sizeof(files->problem), "%s", rlf_error_text());
    }
}

static struct aiFile *open_named(struct aiFileIO *io, const char *path, const char *mode)
{
    io_model_files *files = (io_model_files *)(void *)io->UserData;
    open_file *f = mode[0] == 'r' ? rlf_alloc(sizeof(*f)) : NULL;
    rlf_result result = mode[0] == 'r' && f == NULL ? RLF_ERROR_MEMORY : RLF_OK;
    if (f != NULL && strcmp(path, files->main->name) == 0) {
        f->bytes = *files->main;
    } else if (f != NULL) {
        result = files->is_alone ? RLF_ERROR_IO : read_other(files, path, f);
    }
    if (f == NULL || result != RLF_OK) {
        note_failure(files, path, result);
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

void io_model_files_init(io_model_files *files, const io_bytes *main, bool is_alone, bool is_obj)
{
    *files = (io_model_files){
        .main = main, .is_alone = is_alone, .is_obj = is_obj, .left = IO_MODEL_FILE_MAX};
    files->hooks = (struct aiFileIO){open_named, close_file, (aiUserData)(void *)files};
}
