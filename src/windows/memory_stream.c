/* open_memstream: a temporary file, read when it is closed. */
#include "windows/posix.h"

#include "windows/wide.h"

#include <stdbool.h>
#include <windows.h>

#undef fclose

#define STREAMS_MAX 16 /* at a time */

typedef struct stream {
    FILE *file; /* NULL = the place is free */
    char **text;
    size_t *size;
} stream;

static stream streams[STREAMS_MAX];
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

/* Its file is gone when it is closed. */
static FILE *open_temporary(void)
{
    wchar_t folder[MAX_PATH], name[MAX_PATH];
    if (GetTempPathW(MAX_PATH, folder) == 0 || GetTempFileNameW(folder, L"rlf", 0, name) == 0) {
        return NULL;
    }
    return _wfopen(name, L"w+bD");
}

FILE *win_open_memstream(char **out_text, size_t *out_size)
{
    *out_text = NULL;
    *out_size = 0;
    FILE *file = NULL;
    pthread_mutex_lock(&lock);
    for (int i = 0; i < STREAMS_MAX && file == NULL; i++) {
        if (streams[i].file == NULL) {
            file = open_temporary();
            streams[i] = (stream){file, out_text, out_size};
        }
    }
    pthread_mutex_unlock(&lock);
    return file;
}

static bool take(FILE *file, stream *out)
{
    bool is_found = false;
    pthread_mutex_lock(&lock);
    for (int i = 0; i < STREAMS_MAX && !is_found; i++) {
        if (streams[i].file == file) {
            *out = streams[i];
            streams[i].file = NULL;
            is_found = true;
        }
    }
    pthread_mutex_unlock(&lock);
    return is_found;
}

int win_fclose(FILE *file)
{
    stream s;
    bool is_whole = true;
    if (take(file, &s)) {
        const long size = fflush(file) == 0 ? ftell(file) : -1;
        char *text = size >= 0 ? malloc((size_t)size + 1) : NULL;
        rewind(file);
        is_whole = text != NULL && fread(text, 1, (size_t)size, file) == (size_t)size;
        if (is_whole) {
            text[size] = '\0';
            *s.text = text;
            *s.size = (size_t)size;
        } else {
            free(text);
        }
    }
    return fclose(file) == 0 && is_whole ? 0 : EOF;
}
