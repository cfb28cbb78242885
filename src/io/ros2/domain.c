/* Domain and profile, and what ROS's names are in DDS. */
#include "io/ros2/ros2.h"

#include "io/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DOMAIN_MAX 232 /* ports of larger ones do not exist */

/* ---- where ---------------------------------------------------------------------------------- */

static rlf_result read_domain(const char *source, const char *text, io_ros2_place *out)
{
    const bool is_given = text != NULL;
    const char *environment = getenv("ROS_DOMAIN_ID");
    text = is_given ? text : environment != NULL && environment[0] != '\0' ? environment : "0";
    char *end = NULL;
    const long number = strtol(text, &end, 10);
    if (end == text || *end != '\0' || number < 0 || number > DOMAIN_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %s%.40s: give a domain from 0 to %d", source,
                        is_given ? "domain=" : "ROS_DOMAIN_ID=", text, DOMAIN_MAX);
    }
    out->domain = (uint32_t)number;
    return RLF_OK;
}

static rlf_result read_profile(const char *source, const char *text, io_ros2_place *out)
{
    const char *environment = getenv("RELIEF_ROS2_PROFILE");
    if (text == NULL) {
        text = environment != NULL && environment[0] != '\0' ? environment : "local";
    }
    if (strcmp(text, "local") == 0 || strcmp(text, "lan") == 0) {
        out->profile = text[1] == 'o' ? IO_ROS2_LOCAL : IO_ROS2_LAN;
        return RLF_OK;
    }
    if (strlen(text) < sizeof(out->file) && io_path_exists(text)) {
        out->profile = IO_ROS2_OWN;
        snprintf(out->file, sizeof(out->file), "%s", text);
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: profile=%.100s: use local, lan, or a file of Cyclone DDS's settings",
                    source, text);
}

rlf_result io_ros2_place_read(const char *source, const char *domain, const char *profile,
                              io_ros2_place *out)
{
    memset(out, 0, sizeof(*out));
    rlf_result result = read_domain(source, domain, out);
    return result == RLF_OK ? read_profile(source, profile, out) : result;
}

/* Large messages cost least on one machine, and a router or a radio drops whole datagrams: there
 * no message may be cut into IP fragments, whose remains block the receiver for 30 s. */
#define SIZES(message, fragment)                                                                   \
    "<MaxMessageSize>" message "</MaxMessageSize><FragmentSize>" fragment "</FragmentSize>"
/* Two large pictures may wait for who reads slowly, but none keeps the program from ending; more
 * than 64 MB is no message. */
#define WAITING                                                                                    \
    "<Watermarks><WhcHigh>16MB</WhcHigh><WhcHighInit>16MB</WhcHighInit></Watermarks>"              \
    "<WriterLingerDuration>50ms</WriterLingerDuration>"
#define INTERNAL                                                                                   \
    "<Internal><SocketReceiveBufferSize max=\"8MB\"/><MaxSampleSize>64MB</MaxSampleSize>" WAITING  \
    "</Internal>"
#define BEGIN "<CycloneDDS><Domain>"
#define END "</Domain></CycloneDDS>"
/* A camera that was pulled out is gone after so long. */
#define LEASE "<LeaseDuration>5s</LeaseDuration>"

static const char local_settings[] = BEGIN
    "<General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast>" SIZES(
        "65500B", "65000B") "</General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
                            "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>" LEASE
                            "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>" INTERNAL END;
static const char lan_settings[] = BEGIN
    "<General>" SIZES("1400B", "1350B") "</General><Discovery>" LEASE "</Discovery>" INTERNAL END;

const char *io_ros2_place_settings(const io_ros2_place *place, char *out, size_t size)
{
    if (place->profile != IO_ROS2_OWN) {
        return place->profile == IO_ROS2_LAN ? lan_settings : local_settings;
    }
    snprintf(out, size, "file://%s", place->file);
    return out;
}

/* ---- names ---------------------------------------------------------------------------------- */

bool io_ros2_topic_to_dds(const char *topic, char *out, size_t size)
{
    const int length = snprintf(out, size, "rt%s%s", topic[0] == '/' ? "" : "/", topic);
    return length > 3 && (size_t)length < size;
}

bool io_ros2_topic_from_dds(const char *topic, char *out, size_t size)
{
    if (strncmp(topic, "rt/", 3) != 0) {
        return false;
    }
    const int length = snprintf(out, size, "%s", topic + 2);
    return length > 1 && (size_t)length < size;
}

/* "a/msg/B" and "a::msg::dds_::B_". */
bool io_ros2_type_to_dds(const char *type, char *out, size_t size)
{
    const char *middle = strstr(type, "/msg/");
    if (middle == NULL) {
        return false;
    }
    const int length =
        snprintf(out, size, "%.*s::msg::dds_::%s_", (int)(middle - type), type, middle + 5);
    return length > 0 && (size_t)length < size;
}

bool io_ros2_type_from_dds(const char *type, char *out, size_t size)
{
    static const char middle[] = "::msg::dds_::";
    const char *at = strstr(type, middle);
    const size_t whole = strlen(type);
    if (at == NULL || type[whole - 1] != '_') {
        return false;
    }
    const char *name = at + sizeof(middle) - 1;
    const size_t left = (size_t)(type + whole - name);
    if (left < 2) {
        return false;
    }
    const int length =
        snprintf(out, size, "%.*s/msg/%.*s", (int)(at - type), type, (int)(left - 1), name);
    return length > 0 && (size_t)length < size;
}

/* ROS's interface hashes (REP 2016). */
const char *io_ros2_type_hash(const char *type)
{
    static const struct {
        const char *type, *hash;
    } known[] = {
        {"sensor_msgs/msg/Image",
         "typehash=RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47;"},
        {"sensor_msgs/msg/CameraInfo",
         "typehash=RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275;"},
        {"sensor_msgs/msg/CompressedImage",
         "typehash=RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a;"},
        {"sensor_msgs/msg/PointCloud2",
         "typehash=RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5;"},
        {"tf2_msgs/msg/TFMessage",
         "typehash=RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087;"},
        {"visualization_msgs/msg/MarkerArray",
         "typehash=RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf;"},
    };
    for (size_t i = 0; i < sizeof(known) / sizeof(known[0]); i++) {
        if (strcmp(known[i].type, type) == 0) {
            return known[i].hash;
        }
    }
    return NULL;
}
