/* `--publish osc:`: packets as other programs make them and read them, whole and broken. */
#include "publish/inside.h"
#include "test.h"

#include <lo/lo.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What came out of a packet. */
static publish_command last;
static char last_error[PUBLISH_ERROR_SIZE];
static int good, bad;

static void note(void *context, publish_command *command, const char *error)
{
    (void)context;
    last = *command;
    good += error == NULL;
    bad += error != NULL;
    strncpy(last_error, error != NULL ? error : "", sizeof last_error - 1);
}

static void read_packet(const void *bytes, size_t size)
{
    good = bad = 0;
    publish_commands_from_osc(bytes, size, note, NULL);
}

static void read_message(const char *path, lo_message message)
{
    size_t size = 0;
    void *bytes = lo_message_serialise(message, path, NULL, &size);
    lo_message_free(message);
    read_packet(bytes, size);
    free(bytes);
}

static lo_message message_of(const char *types, const char *text, const float *numbers)
{
    lo_message m = lo_message_new();
    for (const char *t = types; *t != '\0'; t++) {
        if (*t == 's') {
            lo_message_add_string(m, text);
        } else if (*t == 'i') {
            lo_message_add_int32(m, (int32_t)*numbers++);
        } else {
            lo_message_add_float(m, *numbers++);
        }
    }
    return m;
}

TEST_CASE(commands_are_read)
{
    const float n[8] = {0.25f, 0.5f, 0.0f, 2.0f, 1.0f, 0.0f, -1.0f};
    read_message("/relief/spawn", message_of("sffff", "sphere", n));
    assert_int_equal(good, 1);
    assert_true(last.body.shape.radius == 0.125);
    assert_true(last.body.position.x == 0.5 && last.body.position.z == 2.0);
    read_message("/relief/spawn", message_of("sfiiifffs", "box", n));
    assert_int_equal(good, 1);
    assert_true(last.body.velocity.z == -1.0);
    assert_string_equal(last.body.name, "box");
    read_message("/relief/throw", message_of("sf", "capsule", n));
    assert_int_equal(good, 1);
    assert_true(last.body.velocity.z > 0.0);
    read_message("/relief/gravity", message_of("fff", "", n));
    assert_true(good == 1 && last.gravity.y == 0.5);
    read_message("/relief/record", message_of("i", "", n + 4));
    assert_true(good == 1 && last.verb == PUBLISH_RECORD && last.is_on);
    read_message("/relief/scene", message_of("s", "rain", n));
    assert_string_equal(last.name, "rain");
    read_message("/relief/clear", message_of("", "", n));
    assert_int_equal(good, 1);
}

TEST_CASE(hostile_packets_are_refused)
{
    const float n[12] = {0.25f, NAN, 0.0f, 2.0f, 1.0f, 0.0f, INFINITY};
    static const struct {
        const char *path, *types, *text;
    } wrong[] = {{"/relief/spawn", "sffff", "sphere"}, /* NaN */
                 {"/relief/spawn", "sfff", "sphere"},
                 {"/relief/spawn", "ffff", ""},
                 {"/relief/spawn", "sfffffffffff", "box"},
                 {"/relief/spawn", "sssffff", "box"},
                 {"/relief/spawn", "sffff", "%n%n%n"},
                 {"/relief/spawn", "sfffffff", "box"},
                 {"/relief/gravity", "fff", ""},
                 {"/relief/gravity", "s", "down"},
                 {"/relief/remove", "", ""},
                 {"/relief/remove", "s", ""},
                 {"/relief/clear", "i", ""},
                 {"/relief/", "", ""},
                 {"/other", "", ""}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        read_message(wrong[i].path, message_of(wrong[i].types, wrong[i].text, n));
        assert_int_equal(good, 0);
        assert_int_equal(bad, 1);
        assert_true(last_error[0] != '\0');
    }
    lo_message blob = lo_message_new();
    lo_blob bytes = lo_blob_new(4, "abc");
    lo_message_add_blob(blob, bytes);
    lo_blob_free(bytes);
    read_message("/relief/clear", blob);
    assert_int_equal(bad, 1);
}

TEST_CASE(half_a_packet_is_none)
{
    const float n[4] = {0.25f, 0.5f, 0.0f, 2.0f};
    size_t size = 0;
    lo_message message = message_of("sffff", "sphere", n);
    char *bytes = lo_message_serialise(message, "/relief/spawn", NULL, &size);
    for (size_t cut = 0; cut < size; cut++) {
        char *half = malloc(cut + 1); /* so that reading beyond it is seen */
        memcpy(half, bytes, cut);
        read_packet(half, cut);
        assert_int_equal(good, 0);
        free(half);
    }
    free(bytes);
    lo_message_free(message);
    static const char huge[PUBLISH_TEXT_MAX + 1];
    read_packet(huge, sizeof huge);
    assert_true(good == 0 && bad == 1);
}

TEST_CASE(a_bundle_is_its_messages)
{
    const lo_timetag in_a_year = {0xffffffffu, 0};
    lo_bundle bundle = lo_bundle_new(in_a_year);
    lo_bundle_add_message(bundle, "/relief/clear", message_of("", "", NULL));
    lo_bundle_add_message(bundle, "/relief/none", message_of("", "", NULL));
    lo_bundle_add_message(bundle, "/relief/hello", message_of("", "", NULL));
    size_t size = 0;
    char *bytes = lo_bundle_serialise(bundle, NULL, &size);
    read_packet(bytes, size);
    assert_true(good == 2 && bad == 1); /* now, whatever its time says */
    bytes[16] = 0x7f;                   /* an element of 2 GB */
    read_packet(bytes, size);
    assert_true(good == 0 && bad == 1);
    free(bytes);
    lo_bundle_free_recursive(bundle);
}

/* ---- what goes out --------------------------------------------------------------------------- */

static publish_moment moment;
static size_t packets, largest, messages;

static void take_packet(void *context, const void *packet, size_t size)
{
    (void)context;
    packets++;
    largest = size > largest ? size : largest;
    char bytes[PUBLISH_PACKET];
    assert_true(size <= sizeof bytes);
    memcpy(bytes, packet, size);
    assert_memory_equal(bytes, "#bundle", 8);
    for (size_t at = 16; at < size;) {
        const unsigned char *b = (const unsigned char *)bytes + at;
        const size_t length = (size_t)b[2] << 8 | b[3];
        lo_message m = lo_message_deserialise(bytes + at + 4, length, NULL);
        assert_non_null(m);
        const char *types = lo_message_get_types(m);
        for (int i = 0; i < lo_message_get_argc(m); i++) {
            float number = 0.0f; /* copied: it may lie anywhere */
            if (types[i] == 'f') {
                memcpy(&number, lo_message_get_argv(m)[i], sizeof number);
            }
            assert_true(isfinite(number));
        }
        lo_message_free(m);
        messages++;
        at += 4 + length;
    }
}

TEST_CASE(frames_fit_packets)
{
    memset(&moment, 0, sizeof moment);
    moment.is_whole = true;
    moment.body_count = PUBLISH_BODIES;
    moment.contact_count = PUBLISH_CONTACTS;
    moment.region_count = PUBLISH_REGIONS;
    moment.hand_count = RLF_HANDS_MAX;
    moment.gesture_count = RLF_HAND_EVENTS_MAX;
    for (int i = 0; i < PUBLISH_BODIES; i++) {
        memset(moment.bodies[i].name, 'n', RLF_NAME_MAX - 1);
        moment.bodies[i].velocity.x = NAN;
    }
    for (int i = 0; i < PUBLISH_CONTACTS; i++) {
        memset(moment.contacts[i].body, 'n', RLF_NAME_MAX - 1);
        memset(moment.contacts[i].other, 'n', RLF_NAME_MAX - 1);
        moment.contacts[i].with = "foreground";
    }
    publish_osc_moment(&moment, take_packet, NULL);
    assert_int_equal(messages, 1 + PUBLISH_BODIES + PUBLISH_CONTACTS + PUBLISH_REGIONS +
                                   RLF_HANDS_MAX + RLF_HAND_EVENTS_MAX);
    assert_true(packets > 100 && largest > PUBLISH_PACKET / 2);
}
