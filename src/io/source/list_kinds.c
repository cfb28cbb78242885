/* What kinds of source this build can open, and why not the others. */
#include "io/source/backends.h"
#include "relief/io.h"

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
