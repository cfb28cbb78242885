/* Which back end opens a SOURCE. */
#define _POSIX_C_SOURCE 200809L
#include "io/source/backends.h"
#include "io/file.h"

#include "relief/io.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#define GUESS_TEXT 64
#define KINDS_TEXT 512 /* all kinds of source, with blanks between */

/* Whether `list`, words with blanks between, has the extension of `path`. */
static bool has_extension(const char *path, const char *list)
{
    const char *dot = strrchr(path, '.');
    if (dot == NULL || list == NULL || strchr(dot, '/') != NULL) {
        return false;
    }
    size_t length = strlen(dot);
    for (const char *word = list; *word != '\0'; word += strspn(word, " ")) {
        size_t size = strcspn(word, " ");
        if (size == length && strncasecmp(word, dot, size) == 0) {
            return true;
        }
        word += size;
    }
    return false;
}

static const rlf_backend *by_scheme(const char *scheme)
{
    const rlf_backend *b;
    for (int32_t i = 0; (b = io_backend_at(i)) != NULL; i++) {
        if (strcmp(b->scheme, scheme) == 0) {
            return b;
        }
    }
    return NULL;
}

/* A plug-in may know what is foreign here. */
static const rlf_backend *by_extension(const char *path)
{
    const rlf_backend *b;
    for (int32_t i = 0; (b = io_backend_at(i)) != NULL; i++) {
        if (has_extension(path, b->extensions)) {
            return b;
        }
    }
    return NULL;
}

static const rlf_backend *by_path(const char *path)
{
    const rlf_backend *b = by_extension(path);
    if (b != NULL) {
        return b;
    }
    for (int32_t i = 0; (b = io_backend_at(i)) != NULL; i++) {
        if (b->recognises != NULL && b->recognises(path)) {
            return b;
        }
    }
    return NULL;
}

static rlf_result fail_absent(const char *source, const io_backend_absent *a)
{
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: this build was made without %s: %s", source,
                    a->scheme, a->cure);
}

/* All kinds with blanks between; "synthetic" is opened before any back end is asked. */
static void join_schemes(char out[KINDS_TEXT])
{
    const rlf_backend *b;
    (void)snprintf(out, KINDS_TEXT, "synthetic");
    for (int32_t i = 0; (b = io_backend_at(i)) != NULL; i++) {
        const size_t used = strlen(out);
        (void)snprintf(out + used, KINDS_TEXT - used, " %s", b->scheme);
    }
}

/* ": did you mean \"freenect:\"?" or nothing. */
static void guess_scheme(const char *text, char out[GUESS_TEXT])
{
    char words[KINDS_TEXT];
    char nearest[32];
    join_schemes(words);
    out[0] = '\0';
    if (rlf_word_nearest(words, text, nearest, sizeof(nearest))) {
        (void)snprintf(out, GUESS_TEXT, ": did you mean \"%s:\"?", nearest);
    }
}

static rlf_result fail_scheme(const char *source, const char *scheme)
{
    const io_backend_absent *a;
    for (int32_t i = 0; (a = io_backend_absent_at(i)) != NULL; i++) {
        if (strcmp(a->scheme, scheme) == 0) {
            return fail_absent(source, a);
        }
    }
    char words[KINDS_TEXT];
    char guess[GUESS_TEXT];
    join_schemes(words);
    guess_scheme(scheme, guess);
    return rlf_fail(
        RLF_ERROR_UNSUPPORTED,
        "'%s': there is no kind of source \"%.40s:\"%s This build has %s (see `relief list "
        "sources`)",
        source, scheme, guess[0] != '\0' ? guess : ".", words);
}

static rlf_result fail_path(const char *source, const char *path)
{
    if (!io_path_exists(path)) {
        char guess[GUESS_TEXT];
        guess_scheme(path, guess);
        return rlf_fail(RLF_ERROR_IO,
                        "%s: no such file or folder%s A SOURCE is a folder with depth.txt and "
                        "camera.json, a recording, or synthetic:room",
                        source, guess[0] != '\0' ? guess : ".");
    }
    const io_backend_absent *a;
    for (int32_t i = 0; (a = io_backend_absent_at(i)) != NULL; i++) {
        if (has_extension(path, a->extensions)) {
            return fail_absent(source, a);
        }
    }
    return rlf_fail(RLF_ERROR_UNSUPPORTED,
                    "%s: is a file of a kind that this build cannot open: give the folder that "
                    "holds depth.txt and camera.json, or what `relief list sources` lists",
                    source);
}

rlf_result io_backend_find(const char *source, const io_address *address, const rlf_backend **out)
{
    const bool is_path = address->scheme[0] == '\0';
    if (is_path && by_extension(address->place) == NULL) {
        rlf_result result = io_foreign_check(source, address->place);
        if (result != RLF_OK) {
            return result;
        }
    }
    *out = is_path ? by_path(address->place) : by_scheme(address->scheme);
    if (*out == NULL) {
        return is_path ? fail_path(source, address->place) : fail_scheme(source, address->scheme);
    }
    const char *reason = (*out)->unavailable != NULL ? (*out)->unavailable() : NULL;
    return reason == NULL
               ? RLF_OK
               : rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: cannot be opened: %s", source, reason);
}
