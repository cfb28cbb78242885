/* Driver libraries that are opened at run time. */
#include "io/live/driver.h"

#include "io/source/backends.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NAME_SIZE 1024

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

/* A name in every version that it may have, newest first. */
static void *open_versions(const io_library *l, const char *name, char out_name[NAME_SIZE],
                           const char **out_fault)
{
    const char *mark = strstr(name, "%d");
    void *object = NULL;
    for (int32_t v = l->newest; object == NULL && v >= (mark != NULL ? l->oldest : l->newest);
         v--) {
        if (mark == NULL) {
            snprintf(out_name, NAME_SIZE, "%s", name);
        } else {
            snprintf(out_name, NAME_SIZE, "%.*s%d%s", (int)(mark - name), name, (int)v, mark + 2);
        }
        object = io_object_open(out_name, out_fault);
    }
    return object;
}

static void *open_first(const io_library *l, char out_name[NAME_SIZE], const char **out_fault)
{
    const char *chosen = getenv(l->variable);
    if (chosen != NULL && chosen[0] != '\0') {
        snprintf(out_name, NAME_SIZE, "%s", chosen);
        return io_object_open(chosen, out_fault);
    }
    const char *folder = l->folder != NULL ? getenv(l->folder) : NULL;
    void *object = NULL;
    for (int k = folder != NULL && folder[0] != '\0' ? 0 : 1; k < 2; k++) {
        for (int32_t i = 0; object == NULL && l->names[i] != NULL; i++) {
            char path[NAME_SIZE];
            snprintf(path, sizeof(path), "%.900s%s%s", k == 0 ? folder : "", k == 0 ? "/" : "",
                     l->names[i]);
            object = open_versions(l, path, out_name, out_fault);
        }
    }
    return object;
}

static void say_absent(io_library *l, const char *name, const char *cause)
{
    const bool is_missing = cause == NULL || strstr(cause, "cannot open shared object") != NULL ||
                            strstr(cause, "No such file") != NULL;
    if (is_missing) {
        snprintf(l->reason, sizeof(l->reason), "%.100s is not installed: %s", name, l->cure);
    } else {
        snprintf(l->reason, sizeof(l->reason), "%.100s cannot be loaded (%.160s): %s", name, cause,
                 l->cure);
    }
}

static bool load(io_library *l)
{
    char name[NAME_SIZE] = "";
    const char *fault = NULL;
    void *object = open_first(l, name, &fault);
    if (object == NULL) {
        say_absent(l, name, fault);
        return false;
    }
    for (int32_t i = 0; i < l->symbol_count; i++) {
        const io_symbol *s = &l->symbols[i];
        /* POSIX gives functions as void *: the bytes are the same. */
        void *address = dlsym(object, s->name);
        memcpy((char *)l->table + s->offset, &address, sizeof(address));
        if (address == NULL && !s->is_optional) {
            snprintf(l->reason, sizeof(l->reason), "%.100s has no function %s: %s", name, s->name,
                     l->cure);
            dlclose(object);
            return false;
        }
    }
    const char *problem = l->check != NULL ? l->check() : NULL;
    snprintf(l->reason, sizeof(l->reason), "%s", problem != NULL ? problem : "");
    return problem == NULL;
}

const char *io_library_fault(io_library *l)
{
    pthread_mutex_lock(&lock);
    if (!l->is_tried) {
        l->is_tried = true;
        l->is_loaded = load(l);
    }
    pthread_mutex_unlock(&lock);
    return l->is_loaded ? NULL : l->reason;
}
