/* SOURCE of a command line: any text gives an address with whole parts, or an error line; and keys
 * of playing that are within their bounds. */
#include "fuzz.h"

#include "io/source/backends.h"
#include "io/source/address.h"
#include "io/clip/clip.h"

#include <stdlib.h>

static const char *const seeds[] = {"openni2:1d27/0601@1/2?mode=640x480&camera=cal.json",
                                    "clip.oni?loop=1&speed=0.5&start=3&count=10",
                                    "/a path/with:colon?drop=0.25&seed=7&aligned=1",
                                    "scheme:", "?a=b&c=d&&=x"};

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    int count = (int)(sizeof seeds / sizeof seeds[0]);
    return index < count ? fuzz_copy(seeds[index], out, capacity) : 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char text[8193];
    static io_address address;
    const rlf_backend backend = {.scheme = "x", .keys = "mode seed"};
    const size_t length = size < sizeof(text) - 1 ? size : sizeof(text) - 1;
    memcpy(text, data, length);
    text[length] = '\0';
    if (io_address_parse(text, &address) != RLF_OK) {
        return 0;
    }
    char nearest[32];
    for (int32_t i = 0; i < address.key_count; i++) {
        if (address.keys[i][0] == '\0' || address.values[i] == NULL) {
            abort();
        }
        rlf_word_nearest("loop speed start count", address.keys[i], nearest, sizeof(nearest));
    }
    io_replay replay;
    if (io_replay_take(&address, &backend, &replay) == RLF_OK &&
        !(replay.speed >= 0.0 && replay.start >= 0 && replay.count >= 0 && replay.drop >= 0.0 &&
          replay.drop <= 1.0)) {
        abort();
    }
    return 0;
}
