/* Plug-ins that cannot be used, one per BAD_KIND. */
#include "relief/backend.h"

#define BAD_VERSION 1
#define BAD_SYMBOL 2
#define BAD_NULL 3
#define BAD_SCHEME 4
#define BAD_OPEN 5
#define BAD_TAKEN 6
#define BAD_UNAVAILABLE 7 /* loads; its device cannot be used here */

static rlf_result open_none(const rlf_address *address, rlf_opened *out)
{
    (void)address;
    (void)out;
    return RLF_ERROR_DEVICE;
}

static const char *no_driver(void)
{
    return "libnosuch.so is not installed: apt install nosuch";
}

static const rlf_backend table = {
    .version = BAD_KIND == BAD_VERSION ? 999 : RLF_BACKEND_VERSION,
    .scheme = BAD_KIND == BAD_SCHEME  ? "Bad Scheme"
              : BAD_KIND == BAD_TAKEN ? "folder"
                                      : "nosuch",
    .summary = "a camera that is not here",
    .unavailable = BAD_KIND == BAD_UNAVAILABLE ? no_driver : NULL,
    .open = BAD_KIND == BAD_OPEN ? NULL : open_none,
};

#if BAD_KIND == BAD_SYMBOL
#define ENTRY some_other_entry
#else
#define ENTRY rlf_backend_entry
#endif

RLF_PLUGIN_EXPORT const rlf_backend *ENTRY(const rlf_backend_host *host);

const rlf_backend *ENTRY(const rlf_backend_host *host)
{
    (void)host;
    return BAD_KIND == BAD_NULL ? NULL : &table;
}
