/* Relief: how a camera driver or a file format becomes an rlf_source.
 *
 * A back end is a table of functions. The built-in ones are compiled into librelief_io; anyone can
 * add one as a plug-in: a shared object that exports rlf_backend_entry. A plug-in needs these
 * headers only and links nothing of Relief: what it needs comes as an rlf_backend_host.
 * examples/plugin_camera.c is one. It is found by name (relief run --plugin FILE) or in the folders
 * of $RELIEF_PLUGIN_PATH. A plug-in runs with the rights of the program: load only what you trust.
 * Its functions report errors by host->fail and never end the program.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_BACKEND_H
#define RELIEF_BACKEND_H

#include "relief/source.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Counts up when a struct of this header or of source.h changes. A plug-in of another version is
 * refused with a line that says so. */
#define RLF_BACKEND_VERSION 2 /* checked before any other field is read */
/* Most "key=value" pairs of one SOURCE; more are an error before a back end is asked. */
#define RLF_ADDRESS_KEYS_MAX 16

/* A SOURCE taken apart: "scheme:place?key=value&key=value", or a path in place of "scheme:place".
 * All strings live as long as the call that gets the address. */
typedef struct rlf_address {
    const char *source; /* whole, as the user gave it, for error lines */
    const char *place;  /* what follows "scheme:", or the path; without the keys; "" allowed */
    int32_t key_count;  /* of keys and values, each in the order given */
    const char *keys[RLF_ADDRESS_KEYS_MAX];   /* only those that the back end names in `keys` */
    const char *values[RLF_ADDRESS_KEYS_MAX]; /* text as given; "" for "key=" */
    /* The user's own calibration (?camera=FILE): lens models, transform and range to use in place
     * of the device's; its sizes must be those of the pictures. NULL = none was given. */
    const rlf_rig *rig;
    double units_per_metre; /* of that calibration; 0 = none */
} rlf_address;

/* A device that is plugged in. Both texts end with a zero byte within their size. */
typedef struct rlf_source_entry {
    char source[256];      /* what to give as SOURCE to open it */
    char description[128]; /* for people: model, serial number */
} rlf_source_entry;

/* What `open` makes: the parts of an rlf_source. Relief copies methods and info; `self` is the back
 * end's own and is given to each method, last to `destroy`, which frees it. */
typedef struct rlf_opened {
    rlf_source_methods methods; /* `next` is required */
    rlf_source_info info;       /* rig and name above all; `name` "" = the SOURCE as given */
    void *self;                 /* first argument of each method */
} rlf_opened;

/* What a back end may ask of the program. All functions are thread-safe, and none is NULL. Texts
 * are copied before they return. */
typedef struct rlf_backend_host {
    uint32_t version; /* RLF_BACKEND_VERSION of the program */
    /* Sets the error line (what, where, what to do) of the calling thread; returns `result`. */
    rlf_result (*fail)(rlf_result result, const char *line);
    /* One line for the program's log, without a newline; see rlf_log. */
    void (*log)(rlf_log_level level, const char *line);
    /* Monotonic time, the clock of rlf_frame.host_time_ns; see rlf_clock_ns. */
    int64_t (*clock_ns)(void);
} rlf_backend_host;

/* A camera driver or file format, as a table that lives as long as the program. Relief reads it and
 * changes nothing in it. Functions that may be NULL say so; `list`, `recognises` and `unavailable`
 * may be called at any time from any thread, also while a source is open. */
typedef struct rlf_backend {
    uint32_t version;       /* RLF_BACKEND_VERSION */
    const char *scheme;     /* of "scheme:place": [a-z0-9_-]+; never NULL */
    const char *extensions; /* of files it opens, e.g. ".oni .mkv", lower case; NULL = none */
    const char *keys;       /* its own keys, e.g. "serial mode"; NULL = none */
    const char *summary;    /* one line for `relief list sources` */
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

/* Before the definition of rlf_backend_entry, so that the program finds it in a plug-in that is
 * compiled with hidden symbols, too. */
#if defined(__GNUC__)
#define RLF_PLUGIN_EXPORT __attribute__((visibility("default")))
#else
#define RLF_PLUGIN_EXPORT
#endif

/* The one symbol that a plug-in exports, under the name "rlf_backend_entry". `host` lives as long
 * as the program. The table must stay valid; NULL = the plug-in cannot be used with this host. */
typedef const rlf_backend *(*rlf_backend_entry_fn)(const rlf_backend_host *host);

/* Value of a key, or NULL when it was not given; of NULL, too. Compares whole names. Inline, since
 * a plug-in links nothing of Relief; the text lives as long as the address. */
static inline const char *rlf_address_get(const rlf_address *address, const char *key)
{
    for (int32_t i = 0; address != NULL && key != NULL && i < address->key_count; i++) {
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
