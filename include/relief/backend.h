/* Relief: how a camera driver or a file format becomes an rlf_source.
 *
 * A back end is a table of functions. The built-in ones are compiled into librelief_io; anyone can
 * add one as a plug-in: a shared object that exports rlf_backend_entry. A plug-in needs these
 * headers only and links nothing of Relief: what it needs comes as an rlf_backend_host.
 * examples/plugin_camera.c is one.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_BACKEND_H
#define RELIEF_BACKEND_H

#include "relief/source.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Counts up when a struct of this header or of source.h changes. A plug-in of another version is
 * refused with a line that says so. */
#define RLF_BACKEND_VERSION 1
#define RLF_ADDRESS_KEYS_MAX 16

/* A SOURCE taken apart: "scheme:place?key=value&key=value", or a path in place of "scheme:place".
 * All strings live as long as the call that gets the address. */
typedef struct rlf_address {
    const char *source; /* whole, as the user gave it, for error lines */
    const char *place;  /* what follows "scheme:", or the path; without the keys; "" allowed */
    int32_t key_count;
    const char *keys[RLF_ADDRESS_KEYS_MAX]; /* only those that the back end names in `keys` */
    const char *values[RLF_ADDRESS_KEYS_MAX];
    /* The user's own calibration (?camera=FILE): lens models, transform and range to use in place
     * of the device's; its sizes must be those of the pictures. NULL = none was given. */
    const rlf_rig *rig;
    double units_per_metre; /* of that calibration; 0 = none */
} rlf_address;

/* A device that is plugged in. */
typedef struct rlf_source_entry {
    char source[256];      /* what to give as SOURCE to open it */
    char description[128]; /* for people: model, serial number */
} rlf_source_entry;

/* What `open` makes: the parts of an rlf_source. */
typedef struct rlf_opened {
    rlf_source_methods methods;
    rlf_source_info info;
    void *self;
} rlf_opened;

/* What a back end may ask of the program. All functions are thread-safe. */
typedef struct rlf_backend_host {
    uint32_t version; /* RLF_BACKEND_VERSION of the program */
    /* Sets the error line (what, where, what to do) of the calling thread; returns `result`. */
    rlf_result (*fail)(rlf_result result, const char *line);
    void (*log)(rlf_log_level level, const char *line);
    int64_t (*clock_ns)(void);
} rlf_backend_host;

typedef struct rlf_backend {
    uint32_t version;       /* RLF_BACKEND_VERSION */
    const char *scheme;     /* of "scheme:place": [a-z0-9_-]+; never NULL */
    const char *extensions; /* of files it opens, e.g. ".oni .mkv", lower case; NULL = none */
    const char *keys;       /* its own keys, e.g. "serial mode"; NULL = none */
    const char *summary;    /* one line for `relief sources` */
    /* Devices: frames come by themselves and may stop coming. Relief calls `open` and the methods
     * from one thread of its own, one after the other. `next` may wait some 50 ms for a frame; when
     * it fails (but with RLF_ERROR_FORMAT: one damaged frame) or gives none for a second, the
     * device is closed and opened again until it is back. */
    bool is_live;
    /* NULL = it can be used; else why not and what to do, e.g. "libOpenNI2.so.0 is not installed:
     * apt install libopenni2-0". A NULL function = it always can. */
    const char *(*unavailable)(void);
    /* Whether a file or folder without such an extension is one of its own: looks at names and
     * first bytes only. NULL = never. */
    bool (*recognises)(const char *path);
    /* Devices that are plugged in now: writes at most `capacity`, returns how many there are.
     * NULL = nothing to list. */
    int32_t (*list)(rlf_source_entry *out, int32_t capacity);
    /* Opens. On failure nothing stays open. Required. */
    rlf_result (*open)(const rlf_address *address, rlf_opened *out);
} rlf_backend;

/* Before the definition of rlf_backend_entry, so that the program finds it. */
#if defined(__GNUC__)
#define RLF_PLUGIN_EXPORT __attribute__((visibility("default")))
#else
#define RLF_PLUGIN_EXPORT
#endif

/* The one symbol that a plug-in exports, under the name "rlf_backend_entry". `host` lives as long
 * as the program. The table must stay valid; NULL = the plug-in cannot be used with this host. */
typedef const rlf_backend *(*rlf_backend_entry_fn)(const rlf_backend_host *host);

/* Value of a key, or NULL when it was not given. */
static inline const char *rlf_address_get(const rlf_address *address, const char *key)
{
    for (int32_t i = 0; i < address->key_count; i++) {
        const char *a = address->keys[i];
        const char *b = key;
        while (*a != '\0' && *a == *b) {
            a++;
            b++;
        }
        if (*a == *b) {
            return address->values[i];
        }
    }
    return NULL;
}

#ifdef __cplusplus
}
#endif
#endif
