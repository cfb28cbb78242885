/* What is plugged in, over all back ends. */
#include "io/source/backends.h"
#include "relief/io.h"

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
