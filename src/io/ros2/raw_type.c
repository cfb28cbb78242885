/* DDS messages as bytes: a type for Cyclone DDS that leaves them as they came, so that one reader
 * of messages serves files and networks. They have no keys, as ROS has none. */
#include "io/ros2/ros2.h"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/q_radmin.h>

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ALIGNED(size) (((size) + 3u) & ~(size_t)3u) /* what goes over the network */

typedef struct raw_data {
    struct ddsi_serdata c;
    size_t size, room;
    struct raw_data *next; /* of those that are kept */
    uint8_t bytes[];
} raw_data;

/* Memory of large messages is used again: the system would clear its pages anew for each picture.
 * Cyclone DDS frees them from threads of its own, so this is the program's. */
#define KEPT_MAX 6
#define KEPT_BYTES ((size_t)128 << 10)

static pthread_mutex_t kept_lock = PTHREAD_MUTEX_INITIALIZER;
static raw_data *kept;
static int kept_count;

/* NULL = none of about that size. */
static raw_data *take_kept(size_t room)
{
    raw_data *found = NULL;
    pthread_mutex_lock(&kept_lock);
    for (raw_data **at = &kept; *at != NULL && found == NULL; at = &(*at)->next) {
        if ((*at)->room >= room && (*at)->room / 2 <= room) {
            found = *at;
            *at = found->next;
            kept_count--;
            break;
        }
    }
    pthread_mutex_unlock(&kept_lock);
    return found;
}

/* The oldest one makes room. */
static void keep(raw_data *d)
{
    raw_data *old = NULL;
    pthread_mutex_lock(&kept_lock);
    d->next = kept;
    kept = d;
    if (++kept_count > KEPT_MAX) {
        raw_data **at = &kept;
        while ((*at)->next != NULL) {
            at = &(*at)->next;
        }
        old = *at;
        *at = NULL;
        kept_count--;
    }
    pthread_mutex_unlock(&kept_lock);
    free(old);
}

static const raw_data *raw_of(const struct ddsi_serdata *d)
{
    return (const raw_data *)(const void *)d;
}

/* ---- messages ------------------------------------------------------------------------------- */

/* Cyclone DDS counts them; it is malloc's since its threads end after the program's. */
static raw_data *make(const struct ddsi_sertype *type, enum ddsi_serdata_kind kind, size_t size)
{
    if (size > IO_ROS2_MESSAGE_MAX) {
        return NULL;
    }
    const size_t room = ALIGNED(size);
    raw_data *d = room >= KEPT_BYTES ? take_kept(room) : NULL;
    if (d == NULL) {
        d = malloc(sizeof(*d) + room);
        if (d != NULL) {
            d->room = room;
        }
    }
    if (d != NULL) {
        ddsi_serdata_init(&d->c, type, kind);
        d->size = size;
        memset(d->bytes + size, 0, room - size);
    }
    return d;
}

static void free_data(struct ddsi_serdata *c)
{
    raw_data *d = (raw_data *)(void *)c;
    if (d->room >= KEPT_BYTES) {
        keep(d);
    } else {
        free(d);
    }
}

static bool equal_keys(const struct ddsi_serdata *a, const struct ddsi_serdata *b)
{
    (void)a;
    (void)b;
    return true;
}

static uint32_t size_of(const struct ddsi_serdata *d)
{
    return (uint32_t)raw_of(d)->size;
}

static struct ddsi_serdata *from_fragments(const struct ddsi_sertype *type,
                                           enum ddsi_serdata_kind kind,
                                           const struct nn_rdata *fragment, size_t size)
{
    raw_data *d = make(type, kind, size);
    uint32_t at = 0;
    for (; d != NULL && fragment != NULL; fragment = fragment->nextfrag) {
        const uint32_t end = fragment->maxp1 < size ? fragment->maxp1 : (uint32_t)size;
        if (fragment->min > at) {
            break; /* a gap */
        }
        if (end > at) {
            const uint8_t *bytes =
                NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
            memcpy(d->bytes + at, bytes + (at - fragment->min), end - at);
            at = end;
        }
    }
    if (d != NULL && at < size) {
        free_data(&d->c);
        return NULL;
    }
    return d != NULL ? &d->c : NULL;
}

static struct ddsi_serdata *from_pieces(const struct ddsi_sertype *type,
                                        enum ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                                        const ddsrt_iovec_t *pieces, size_t size)
{
    raw_data *d = make(type, kind, size);
    size_t at = 0;
    for (ddsrt_msg_iovlen_t i = 0; d != NULL && i < count && at < size; i++) {
        const size_t left = size - at;
        const size_t part = pieces[i].iov_len < left ? pieces[i].iov_len : left;
        memcpy(d->bytes + at, pieces[i].iov_base, part);
        at += part;
    }
    if (d != NULL) {
        memset(d->bytes + at, 0, size - at);
    }
    return d != NULL ? &d->c : NULL;
}

static struct ddsi_serdata *from_key(const struct ddsi_sertype *type, const ddsi_keyhash_t *key)
{
    (void)key;
    raw_data *d = make(type, SDK_KEY, 0);
    return d != NULL ? &d->c : NULL;
}

static struct ddsi_serdata *from_sample(const struct ddsi_sertype *type,
                                        enum ddsi_serdata_kind kind, const void *sample)
{
    (void)sample;
    return kind == SDK_KEY ? from_key(type, NULL) : NULL;
}

static void copy_out(const struct ddsi_serdata *d, size_t offset, size_t size, void *out)
{
    memcpy(out, raw_of(d)->bytes + offset, size);
}

static struct ddsi_serdata *lend(const struct ddsi_serdata *d, size_t offset, size_t size,
                                 ddsrt_iovec_t *out)
{
    /* The bytes are not written to: iovec knows no const. */
    out->iov_base = (void *)(uintptr_t)(raw_of(d)->bytes + offset);
    out->iov_len = size;
    return ddsi_serdata_ref(d);
}

static void give_back(struct ddsi_serdata *d, const ddsrt_iovec_t *piece)
{
    (void)piece;
    ddsi_serdata_unref(d);
}

static bool to_sample(const struct ddsi_serdata *d, void *sample, void **buffer, void *limit)
{
    (void)d;
    (void)sample;
    (void)buffer;
    (void)limit;
    return false;
}

static struct ddsi_serdata *to_untyped(const struct ddsi_serdata *d)
{
    raw_data *key = make(d->type, SDK_KEY, 0);
    if (key == NULL) {
        return NULL;
    }
    key->c.type = NULL;
    return &key->c;
}

static bool untyped_to_sample(const struct ddsi_sertype *type, const struct ddsi_serdata *d,
                              void *sample, void **buffer, void *limit)
{
    (void)type;
    (void)d;
    (void)sample;
    (void)buffer;
    (void)limit;
    return true;
}

static size_t print(const struct ddsi_sertype *type, const struct ddsi_serdata *d, char *out,
                    size_t size)
{
    (void)d;
    return (size_t)snprintf(out, size, "%s", type->type_name);
}

static void get_key(const struct ddsi_serdata *d, ddsi_keyhash_t *out, bool is_md5)
{
    (void)d;
    (void)is_md5;
    memset(out, 0, sizeof(*out));
}

static const struct ddsi_serdata_ops data_ops = {.eqkey = equal_keys,
                                                 .get_size = size_of,
                                                 .from_ser = from_fragments,
                                                 .from_ser_iov = from_pieces,
                                                 .from_keyhash = from_key,
                                                 .from_sample = from_sample,
                                                 .to_ser = copy_out,
                                                 .to_ser_ref = lend,
                                                 .to_ser_unref = give_back,
                                                 .to_sample = to_sample,
                                                 .to_untyped = to_untyped,
                                                 .untyped_to_sample = untyped_to_sample,
                                                 .free = free_data,
                                                 .print = print,
                                                 .get_keyhash = get_key};

/* ---- the type ------------------------------------------------------------------------------- */

static void free_type(struct ddsi_sertype *type)
{
    ddsi_sertype_fini(type);
    free(type);
}

static void zero_samples(const struct ddsi_sertype *type, void *samples, size_t count)
{
    (void)type;
    (void)samples;
    (void)count;
}

static void realloc_samples(void **samples, const struct ddsi_sertype *type, void *old,
                            size_t old_count, size_t count)
{
    (void)type;
    (void)old;
    (void)old_count;
    for (size_t i = 0; i < count; i++) {
        samples[i] = NULL;
    }
}

static void free_samples(const struct ddsi_sertype *type, void **samples, size_t count,
                         dds_free_op_t what)
{
    (void)type;
    (void)samples;
    (void)count;
    (void)what;
}

static bool equal_types(const struct ddsi_sertype *a, const struct ddsi_sertype *b)
{
    (void)a;
    (void)b;
    return true; /* their names are */
}

static uint32_t hash_type(const struct ddsi_sertype *type)
{
    (void)type;
    return 0;
}

static const struct ddsi_sertype_ops type_ops = {.version = ddsi_sertype_v0,
                                                 .free = free_type,
                                                 .zero_samples = zero_samples,
                                                 .realloc_samples = realloc_samples,
                                                 .free_samples = free_samples,
                                                 .equal = equal_types,
                                                 .hash = hash_type};

struct ddsi_sertype *io_ros2_raw_type(const char *dds_name)
{
    struct ddsi_sertype *type = calloc(1, sizeof(*type));
    if (type != NULL) {
        ddsi_sertype_init(type, dds_name, &type_ops, &data_ops, true);
        type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
    }
    return type;
}

struct ddsi_serdata *io_ros2_raw_make(const struct ddsi_sertype *type, const void *data,
                                      size_t size)
{
    raw_data *d = make(type, SDK_DATA, size);
    if (d == NULL) {
        return NULL;
    }
    memcpy(d->bytes, data, size);
    return &d->c;
}

const uint8_t *io_ros2_raw_data(const struct ddsi_serdata *data, size_t *out_size)
{
    *out_size = raw_of(data)->size;
    return raw_of(data)->bytes;
}
