/* Participants, readers and writers of Cyclone DDS. */
#include "io/ros2/ros2.h"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <pthread.h>
#include <stdio.h>
#include <string.h>

#define DOMAINS_MAX 8
/* A write may wait so long for a reader that is too slow. */
#define WRITE_WAIT DDS_MSECS(100)
/* ROS's depth of topics whose last message lasts. */
#define LASTING_DEPTH 64
/* Pictures that can be sent again to who lost a part: an eighth of a second. */
#define WRITER_DEPTH 4
#define READERS_MAX 256

/* A domain's settings are the process's, and are made with its first node. */
typedef struct domain {
    io_ros2_place place;
    dds_entity_t entity;
    int32_t users;
} domain;

static pthread_mutex_t domains_lock = PTHREAD_MUTEX_INITIALIZER;
static domain domains[DOMAINS_MAX];

struct io_ros2_node {
    char source[256];
    domain *domain;
    dds_entity_t participant, publications, waitset;
};

/* The last thing that Cyclone DDS complained of. */
static pthread_mutex_t complaint_lock = PTHREAD_MUTEX_INITIALIZER;
static char complaint[160];

static void note_complaint(void *context, const dds_log_data_t *data)
{
    (void)context;
    pthread_mutex_lock(&complaint_lock);
    snprintf(complaint, sizeof(complaint), "%.*s", (int)strcspn(data->message, "\n"),
             data->message);
    pthread_mutex_unlock(&complaint_lock);
}

static rlf_result fail(const char *source, const char *what, dds_return_t code)
{
    char words[sizeof(complaint)];
    pthread_mutex_lock(&complaint_lock);
    memcpy(words, complaint, sizeof(words));
    pthread_mutex_unlock(&complaint_lock);
    return rlf_fail(RLF_ERROR_DEVICE, "%s: %s: Cyclone DDS says \"%s\"%s%s", source, what,
                    dds_strretcode(code), words[0] != '\0' ? ", " : "", words);
}

/* ---- domains -------------------------------------------------------------------------------- */

static bool is_same_place(const io_ros2_place *a, const io_ros2_place *b)
{
    return a->domain == b->domain && a->profile == b->profile && strcmp(a->file, b->file) == 0;
}

/* With the lock held. */
static rlf_result create_domain(const char *source, const io_ros2_place *place, domain *out)
{
    char room[sizeof(place->file) + 16];
    dds_set_log_sink(note_complaint, NULL);
    dds_set_trace_sink(note_complaint, NULL);
    out->entity =
        dds_create_domain(place->domain, io_ros2_place_settings(place, room, sizeof(room)));
    if (out->entity < 0) {
        return fail(source, "DDS does not start: see that this machine has the network",
                    out->entity);
    }
    out->place = *place;
    return RLF_OK;
}

static rlf_result use_domain(const char *source, const io_ros2_place *place, domain **out)
{
    domain *free_one = NULL;
    for (int32_t i = 0; i < DOMAINS_MAX; i++) {
        domain *d = &domains[i];
        if (d->users > 0 && d->place.domain == place->domain) {
            if (!is_same_place(&d->place, place)) {
                return rlf_fail(RLF_ERROR_INVALID,
                                "%s: domain %u has another profile in this program: use one for "
                                "all, with RELIEF_ROS2_PROFILE",
                                source, (unsigned)place->domain);
            }
            d->users++;
            *out = d;
            return RLF_OK;
        }
        free_one = d->users == 0 && free_one == NULL ? d : free_one;
    }
    if (free_one == NULL) {
        return rlf_fail(RLF_ERROR_CAPACITY, "%s: is one domain more than %d", source, DOMAINS_MAX);
    }
    rlf_result result = create_domain(source, place, free_one);
    free_one->users = result == RLF_OK ? 1 : 0;
    *out = result == RLF_OK ? free_one : NULL;
    return result;
}

static void leave_domain(domain *d)
{
    pthread_mutex_lock(&domains_lock);
    if (d != NULL && --d->users == 0) {
        dds_delete(d->entity);
    }
    pthread_mutex_unlock(&domains_lock);
}

/* ---- nodes ---------------------------------------------------------------------------------- */

static rlf_result make_entities(io_ros2_node *n, const io_ros2_place *place)
{
    n->participant = dds_create_participant(place->domain, NULL, NULL);
    if (n->participant < 0) {
        return fail(n->source, "no participant is to be had", n->participant);
    }
    n->publications =
        dds_create_reader(n->participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, NULL, NULL);
    n->waitset = dds_create_waitset(n->participant);
    return n->publications > 0 && n->waitset > 0
               ? RLF_OK
               : fail(n->source, "discovery does not start", n->publications);
}

rlf_result io_ros2_node_open(const char *source, const io_ros2_place *place, io_ros2_node **out)
{
    io_ros2_node *n = rlf_alloc(sizeof(*n));
    *out = NULL;
    if (n == NULL) {
        return RLF_ERROR_MEMORY;
    }
    snprintf(n->source, sizeof(n->source), "%.255s", source);
    pthread_mutex_lock(&domains_lock);
    rlf_result result = use_domain(source, place, &n->domain);
    pthread_mutex_unlock(&domains_lock);
    result = result == RLF_OK ? make_entities(n, place) : result;
    if (result != RLF_OK) {
        io_ros2_node_close(&n);
        return result;
    }
    *out = n;
    return RLF_OK;
}

void io_ros2_node_close(io_ros2_node **node)
{
    io_ros2_node *n = *node;
    *node = NULL;
    if (n == NULL) {
        return;
    }
    if (n->participant > 0) {
        dds_delete(n->participant);
    }
    leave_domain(n->domain);
    rlf_free(n);
}

int32_t io_ros2_node_participant(const io_ros2_node *node)
{
    return node->participant;
}

int32_t io_ros2_node_publications(const io_ros2_node *node)
{
    return node->publications;
}

/* A topic of raw messages; the sertype in use comes back. */
static dds_entity_t make_topic(io_ros2_node *n, const char *topic, const char *type,
                               struct ddsi_sertype **out_type)
{
    char name[IO_ROS2_TOPIC_MAX + 4], type_name[IO_ROS2_TYPE_MAX + 16];
    if (!io_ros2_topic_to_dds(topic, name, sizeof(name)) ||
        !io_ros2_type_to_dds(type, type_name, sizeof(type_name))) {
        return DDS_RETCODE_BAD_PARAMETER;
    }
    *out_type = io_ros2_raw_type(type_name);
    if (*out_type == NULL) {
        return DDS_RETCODE_OUT_OF_RESOURCES;
    }
    struct ddsi_sertype *made = *out_type;
    const dds_entity_t entity =
        dds_create_topic_sertype(n->participant, name, out_type, NULL, NULL, NULL);
    if (entity < 0) {
        ddsi_sertype_unref(made);
    }
    return entity;
}

/* Delete it with dds_delete_qos. */
static dds_qos_t *make_qos(const char *type, bool is_reliable, bool is_lasting, int32_t depth)
{
    dds_qos_t *qos = dds_create_qos();
    const char *hash = io_ros2_type_hash(type);
    if (qos != NULL) {
        dds_qset_reliability(
            qos, is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, WRITE_WAIT);
        dds_qset_durability(qos,
                            is_lasting ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
        dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
        if (hash != NULL) {
            dds_qset_userdata(qos, hash, strlen(hash));
        }
    }
    return qos;
}

/* ---- reading -------------------------------------------------------------------------------- */

rlf_result io_ros2_reader_open(io_ros2_node *node, const char *topic, const char *type,
                               bool is_reliable, bool is_lasting, int32_t depth,
                               io_ros2_reader *out)
{
    struct ddsi_sertype *sertype = NULL;
    *out = (io_ros2_reader){make_topic(node, topic, type, &sertype), 0};
    if (out->topic > 0) {
        dds_qos_t *qos = make_qos(type, is_reliable, is_lasting, depth);
        out->reader = dds_create_reader(node->participant, out->topic, qos, NULL);
        dds_delete_qos(qos);
    }
    const dds_entity_t failed = out->topic < 0 ? out->topic : out->reader;
    if (failed < 0) {
        out->reader = 0;
        io_ros2_reader_close(out);
        return fail(node->source, topic, failed);
    }
    dds_set_status_mask(out->reader, DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(node->waitset, out->reader, (dds_attach_t)out->reader);
    return RLF_OK;
}

void io_ros2_reader_close(io_ros2_reader *reader)
{
    if (reader->reader > 0) {
        dds_delete(reader->reader);
    }
    if (reader->topic > 0) {
        dds_delete(reader->topic);
    }
    *reader = (io_ros2_reader){0, 0};
}

bool io_ros2_take(const io_ros2_reader *reader, io_ros2_message *out)
{
    for (;;) {
        struct ddsi_serdata *data = NULL;
        dds_sample_info_t info;
        if (reader->reader <= 0 ||
            dds_takecdr(reader->reader, &data, 1, &info, DDS_ANY_STATE) != 1) {
            return false;
        }
        if (info.valid_data) {
            *out = (io_ros2_message){
                .sent_ns = info.source_timestamp, .writer = info.publication_handle, .held = data};
            out->data = io_ros2_raw_data(data, &out->size);
            return true;
        }
        ddsi_serdata_unref(data);
    }
}

void io_ros2_release(io_ros2_message *message)
{
    if (message->held != NULL) {
        ddsi_serdata_unref(message->held);
    }
    *message = (io_ros2_message){0};
}

void io_ros2_wait(io_ros2_node *node, int32_t wait_ms)
{
    (void)dds_waitset_wait(node->waitset, NULL, 0, DDS_MSECS((int64_t)wait_ms));
}

/* ---- writing -------------------------------------------------------------------------------- */

rlf_result io_ros2_writer_open(io_ros2_node *node, const char *topic, const char *type,
                               bool is_lasting, io_ros2_writer *out)
{
    struct ddsi_sertype *sertype = NULL;
    *out = (io_ros2_writer){.topic = make_topic(node, topic, type, &sertype)};
    if (out->topic > 0) {
        dds_qos_t *qos = make_qos(type, true, is_lasting, is_lasting ? 1 : WRITER_DEPTH);
        out->writer = dds_create_writer(node->participant, out->topic, qos, NULL);
        dds_delete_qos(qos);
        out->type = sertype;
    }
    const dds_entity_t failed = out->topic < 0 ? out->topic : out->writer;
    return failed > 0 ? RLF_OK : fail(node->source, topic, failed);
}

bool io_ros2_writer_is_read(const io_ros2_writer *writer)
{
    dds_publication_matched_status_t status = {0};
    return writer->writer > 0 &&
           dds_get_publication_matched_status(writer->writer, &status) == DDS_RETCODE_OK &&
           status.current_count > 0;
}

bool io_ros2_write(const io_ros2_writer *writer, const void *data, size_t size)
{
    struct ddsi_serdata *d = io_ros2_raw_make(writer->type, data, size);
    return d != NULL && dds_writecdr(writer->writer, d) == DDS_RETCODE_OK;
}
