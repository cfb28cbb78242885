/* What others publish, as DDS's discovery tells. */
#include "io/ros2/ros2.h"

#include <dds/dds.h>

#include <stdlib.h>
#include <string.h>

#define AT_ONCE 64

static bool is_reliable(const dds_qos_t *qos)
{
    dds_reliability_kind_t kind = DDS_RELIABILITY_BEST_EFFORT;
    return dds_qget_reliability(qos, &kind, NULL) && kind == DDS_RELIABILITY_RELIABLE;
}

static void add(const dds_builtintopic_endpoint_t *e, io_ros2_topic *list, int32_t capacity,
                int32_t *count)
{
    io_ros2_topic topic = {.is_reliable = is_reliable(e->qos)};
    if (!io_ros2_topic_from_dds(e->topic_name, topic.name, sizeof(topic.name)) ||
        !io_ros2_type_from_dds(e->type_name, topic.type, sizeof(topic.type))) {
        return;
    }
    for (int32_t i = 0; i < *count; i++) {
        if (strcmp(list[i].name, topic.name) == 0 && strcmp(list[i].type, topic.type) == 0) {
            list[i].is_reliable = list[i].is_reliable && topic.is_reliable;
            return;
        }
    }
    if (*count < capacity) {
        list[(*count)++] = topic;
    }
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const io_ros2_topic *)a)->name, ((const io_ros2_topic *)b)->name);
}

/* Those of the node's own participant are not of others. */
static bool is_own(const dds_guid_t *own, const dds_builtintopic_endpoint_t *e)
{
    return memcmp(own, &e->participant_key, sizeof(*own)) == 0;
}

int32_t io_ros2_discover(io_ros2_node *node, io_ros2_topic *out, int32_t capacity)
{
    int32_t count = 0;
    dds_guid_t own;
    if (dds_get_guid(io_ros2_node_participant(node), &own) != DDS_RETCODE_OK) {
        return 0;
    }
    const dds_entity_t reader = io_ros2_node_publications(node);
    const uint32_t states = DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE;
    /* All at once: reading again would give the same ones. */
    static const int32_t limits[] = {AT_ONCE, 1024, 8192};
    for (size_t k = 0; k < sizeof(limits) / sizeof(limits[0]); k++) {
        const int32_t limit = limits[k];
        void **samples = rlf_alloc_array((size_t)limit, sizeof(samples[0]));
        dds_sample_info_t *infos = rlf_alloc_array((size_t)limit, sizeof(infos[0]));
        int32_t got = 0;
        if (samples != NULL && infos != NULL) {
            got = dds_read_mask(reader, samples, infos, (size_t)limit, (uint32_t)limit, states);
        }
        count = 0;
        for (int32_t i = 0; i < got; i++) {
            const dds_builtintopic_endpoint_t *e = samples[i];
            if (infos[i].valid_data && !is_own(&own, e)) {
                add(e, out, capacity, &count);
            }
        }
        if (got > 0) {
            (void)dds_return_loan(reader, samples, got);
        }
        rlf_free(samples);
        rlf_free(infos);
        if (got < limit) {
            break;
        }
    }
    qsort(out, (size_t)count, sizeof(out[0]), by_name);
    return count;
}
