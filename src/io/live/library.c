/* Driver libraries that are opened at run time. */
#include "io/live/driver.h"

#include "io/source/object_file.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *open_first(const io_library_def *def, const char **out_name, const char **out_fault)
{
    const char *chosen = getenv(def->variable);
    if (chosen != NULL && chosen[0] != '\0') {
        *out_name = chosen;
        return io_object_open(chosen, out_fault);
    }
    void *library = NULL;
    for (int32_t i = 0; library == NULL && def->names[i] != NULL; i++) {
        *out_name = def->names[i];
        library = io_object_open(def->names[i], out_fault);
    }
    return library;
}

static void say_absent(const io_library_def *def, const char *name, const char *cause, char *out,
                       size_t size)
{
    const bool is_missing = cause == NULL || strstr(cause, "cannot open shared object") != NULL ||
                            strstr(cause, "No such file") != NULL;
    if (is_missing) {
        snprintf(out, size, "%s is not installed: %s", name, def->cure);
    } else {
        snprintf(out, size, "%s cannot be loaded (%.160s): %s", name, cause, def->cure);
    }
}

bool io_library_load(const io_library_def *def, void *table, char *out_reason, size_t reason_size)
{
    const char *name = "";
    const char *fault = NULL;
    void *library = open_first(def, &name, &fault);
    if (library == NULL) {
        say_absent(def, name, fault, out_reason, reason_size);
        return false;
    }
    for (int32_t i = 0; i < def->symbol_count; i++) {
        const io_symbol *s = &def->symbols[i];
        /* POSIX gives functions as void *: the bytes are the same. */
        void *address = dlsym(library, s->name);
        memcpy((char *)table + s->offset, &address, sizeof(address));
        if (address == NULL && !s->is_optional) {
            snprintf(out_reason, reason_size, "%s has no function %s: %s", name, s->name,
                     def->cure);
            dlclose(library);
            return false;
        }
    }
    out_reason[0] = '\0';
    return true;
}
