/* One plug-in: a shared object that exports rlf_backend_entry. */
#define _POSIX_C_SOURCE 200809L
#include "io/source/backends.h"

#include <dlfcn.h>
#include <string.h>

static rlf_result host_fail(rlf_result result, const char *line)
{
    return rlf_fail(result, "%s", line);
}

static void host_log(rlf_log_level level, const char *line)
{
    rlf_log(level, "%s", line);
}

static const rlf_backend_host host = {
    .version = RLF_BACKEND_VERSION, .fail = host_fail, .log = host_log, .clock_ns = rlf_clock_ns};

static bool is_scheme(const char *text)
{
    return text != NULL && text[0] != '\0' && strlen(text) < 64 &&
           text[strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789_-")] == '\0';
}

/* Of a table of another version nothing but the version is looked at. */
static rlf_result check_table(const char *path, const rlf_backend *table)
{
    if (table == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: the plug-in cannot be used with this program, whose interface is "
                        "version %d: get the plug-in made for it",
                        path, RLF_BACKEND_VERSION);
    }
    if (table->version != RLF_BACKEND_VERSION) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: the plug-in is made for version %u of the interface and this program "
                        "has version %d: build it again with this program's relief/backend.h",
                        path, (unsigned)table->version, RLF_BACKEND_VERSION);
    }
    if (!is_scheme(table->scheme) || table->open == NULL) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the plug-in's table has no %s: set it as relief/backend.h says", path,
                        table->open == NULL ? "open function" : "scheme of a-z, 0-9, _ and -");
    }
    return RLF_OK;
}

static rlf_result ask_entry(const char *path, void *object, const rlf_backend **out)
{
    void *symbol = dlsym(object, "rlf_backend_entry");
    if (symbol == NULL) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is a shared object without rlf_backend_entry: give a plug-in of "
                        "Relief, examples/plugin_camera.c is one",
                        path);
    }
    rlf_backend_entry_fn entry;
    memcpy(&entry, &symbol, sizeof(entry)); /* C has no cast from an object to a function */
    const rlf_backend *table = entry(&host);
    rlf_result result = check_table(path, table);
    if (result == RLF_OK) {
        *out = table;
    }
    return result;
}

rlf_result io_plugin_open(const char *path, const rlf_backend **out)
{
    *out = NULL;
    char place[4096]; /* with a slash in it, or dlopen would search the system's folders */
    const size_t length = strlen(path);
    if (length == 0 || length + 3 > sizeof(place)) {
        return rlf_fail(RLF_ERROR_INVALID, "%.100s: is no path of a plug-in", path);
    }
    memcpy(place, "./", 3);
    memcpy(place + (strchr(path, '/') != NULL ? 0 : 2), path, length + 1);
    const char *reason = NULL;
    void *object = io_object_open(place, &reason);
    if (object == NULL) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be loaded as a plug-in: %s", path,
                        reason != NULL ? reason : "no reason is known");
    }
    rlf_result result = ask_entry(path, object, out);
    if (result != RLF_OK) {
        dlclose(object);
    }
    return result;
}
