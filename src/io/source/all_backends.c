/* The back ends of this build, then those of plug-ins: the ones asked for, then the ones found in
 * folders. */
#define _POSIX_C_SOURCE 200809L
#include "io/source/backends.h"
#include "relief/io.h"

#include <dirent.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PLUGINS_MAX 64
#define FILES_MAX 256 /* looked at in one folder */
#define PATH_SIZE 4096

/* Entries below `plugin_count` never change; what adds one holds the lock. */
static const rlf_backend *plugins[PLUGINS_MAX];
static char *plugin_paths[PLUGINS_MAX];
static atomic_int plugin_count;
static pthread_mutex_t plugin_lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_once_t folders_once = PTHREAD_ONCE_INIT;

static int32_t built_in_count(void)
{
    int32_t count = 0;
    while (io_backend_built_in_at(count) != NULL) {
        count++;
    }
    return count;
}

static const rlf_backend *known_at(int32_t index)
{
    const int32_t built_in = built_in_count();
    if (index < built_in) {
        return io_backend_built_in_at(index);
    }
    const int32_t count = atomic_load(&plugin_count);
    return index - built_in < count ? plugins[index - built_in] : NULL;
}

/* RLF_NO_FRAME = this very table is there already. */
static rlf_result check_scheme(const char *path, const rlf_backend *table)
{
    bool is_taken = strcmp(table->scheme, "synthetic") == 0;
    const rlf_backend *b;
    for (int32_t i = 0; (b = known_at(i)) != NULL; i++) {
        if (b == table) {
            return RLF_NO_FRAME;
        }
        is_taken = is_taken || strcmp(b->scheme, table->scheme) == 0;
    }
    return is_taken ? rlf_fail(RLF_ERROR_INVALID,
                               "%s: the plug-in's scheme \"%s:\" is taken: it is not used", path,
                               table->scheme)
                    : RLF_OK;
}

static rlf_result add(const char *path)
{
    const rlf_backend *table = NULL;
    rlf_result result = io_plugin_open(path, &table);
    result = result == RLF_OK ? check_scheme(path, table) : result;
    if (result != RLF_OK) {
        return result == RLF_NO_FRAME ? RLF_OK : result;
    }
    const int32_t count = atomic_load(&plugin_count);
    if (count == PLUGINS_MAX) {
        return rlf_fail(RLF_ERROR_CAPACITY, "%s: is one plug-in more than %d", path, PLUGINS_MAX);
    }
    plugin_paths[count] = strdup(path);
    plugins[count] = table;
    atomic_store(&plugin_count, count + 1);
    return RLF_OK;
}

rlf_result rlf_plugin_load(const char *path)
{
    if (!RLF_ASSERT(path != NULL)) {
        return RLF_ERROR_INVALID;
    }
    pthread_mutex_lock(&plugin_lock);
    rlf_result result = add(path);
    pthread_mutex_unlock(&plugin_lock);
    return result;
}

static int is_object(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot != NULL && strcmp(dot, ".so") == 0;
}

/* In order of their names. One that cannot be loaded is one warning. */
static void load_folder(const char *folder)
{
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, is_object, alphasort);
    for (int i = 0; i < count; i++) {
        char path[PATH_SIZE];
        const int length = snprintf(path, sizeof(path), "%s/%s", folder, entries[i]->d_name);
        free(entries[i]);
        if (i < FILES_MAX && length > 0 && length < PATH_SIZE && rlf_plugin_load(path) != RLF_OK) {
            rlf_log(RLF_LOG_WARNING, "%s", rlf_error_text());
        }
    }
    free(entries);
}

/* Folders with colons between. */
static void load_folders(const char *list)
{
    while (*list != '\0') {
        const size_t length = strcspn(list, ":");
        char folder[PATH_SIZE];
        if (length > 0 && length < sizeof(folder)) {
            memcpy(folder, list, length);
            folder[length] = '\0';
            load_folder(folder);
        }
        list += length + (list[length] == ':' ? 1 : 0);
    }
}

static void search_folders(void)
{
    const char *list = getenv("RELIEF_PLUGIN_PATH");
    if (list != NULL) {
        load_folders(list);
    }
    load_folder(RLF_PLUGIN_FOLDER);
    const char *home = getenv("HOME");
    char folder[PATH_SIZE];
    const int length =
        snprintf(folder, sizeof(folder), "%s/.local/lib/relief/plugins", home != NULL ? home : "");
    if (home != NULL && home[0] == '/' && length < PATH_SIZE) {
        load_folder(folder);
    }
}

const rlf_backend *io_backend_at(int32_t index)
{
    if (index < 0) {
        return NULL;
    }
    if (index >= built_in_count()) {
        pthread_once(&folders_once, search_folders);
    }
    return known_at(index);
}

const char *io_backend_plugin_path(int32_t index)
{
    const int32_t plugin = index - built_in_count();
    return plugin >= 0 && plugin < atomic_load(&plugin_count) ? plugin_paths[plugin] : NULL;
}

/* ---- what kinds of source this build can open, and why not the others -------------------------
 */

static void put(rlf_source_kind *out, int32_t capacity, int32_t *count, const rlf_source_kind *kind)
{
    if (*count < capacity) {
        out[*count] = *kind;
    }
    ++*count;
}

int32_t rlf_source_kind_list(rlf_source_kind *out, int32_t capacity)
{
    if (!RLF_ASSERT(capacity >= 0 && (out != NULL || capacity == 0))) {
        return 0;
    }
    int32_t count = 0;
    const rlf_backend *b;
    for (int32_t i = 0; (b = io_backend_at(i)) != NULL; i++) {
        const rlf_source_kind kind = {
            .scheme = b->scheme,
            .extensions = b->extensions,
            .keys = b->keys,
            .summary = b->summary,
            .unavailable = b->unavailable != NULL ? b->unavailable() : NULL,
            .plugin = io_backend_plugin_path(i),
            .is_live = b->is_live,
        };
        put(out, capacity, &count, &kind);
    }
    const io_backend_absent *a;
    for (int32_t i = 0; (a = io_backend_absent_at(i)) != NULL; i++) {
        const rlf_source_kind kind = {.scheme = a->scheme,
                                      .extensions = a->extensions,
                                      .summary = a->summary,
                                      .unavailable = a->cure,
                                      .option = a->option};
        put(out, capacity, &count, &kind);
    }
    return count;
}

int32_t rlf_source_list(rlf_source_entry *out, int32_t capacity)
{
    if (!RLF_ASSERT(capacity >= 0 && (out != NULL || capacity == 0))) {
        return 0;
    }
    int32_t count = 0;
    const rlf_backend *b;
    for (int32_t i = 0; (b = io_backend_at(i)) != NULL; i++) {
        if (b->list == NULL || (b->unavailable != NULL && b->unavailable() != NULL)) {
            continue;
        }
        const int32_t room = count < capacity ? capacity - count : 0;
        const int32_t found = b->list(room > 0 ? out + count : NULL, room);
        count += found > 0 ? found : 0;
    }
    return count;
}
