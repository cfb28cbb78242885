/* `--publish`: addresses, what goes out as JSON, commands of friends and of strangers, queues. */
#include "publish/inside.h"
#include "test.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- addresses ------------------------------------------------------------------------------- */

TEST_CASE(addresses_stay_on_this_machine_unless_told)
{
    publish_list list = {0};
    assert_true(publish_take("ws:9980", &list));
    assert_string_equal(list.items[0].host, "127.0.0.1");
    assert_int_equal(list.items[0].port, 9980);
    assert_true(publish_take("osc:studio.local:9000", &list));
    assert_string_equal(list.items[1].host, "studio.local");
    assert_int_equal(list.items[1].listen_port, -1);
    assert_true(publish_take_listen("9001", &list));
    assert_string_equal(list.items[1].listen_host, "127.0.0.1");
    assert_int_equal(list.items[1].listen_port, 9001);
    assert_true(publish_take_listen("0.0.0.0:9001", &list));
    assert_string_equal(list.items[1].listen_host, "0.0.0.0");
    assert_true(publish_take_every("3", &list));
    assert_int_equal(list.items[1].every, 3);
    assert_int_equal(list.items[0].every, 1);
    assert_false(publish_take_origin("http://a", &list));
    assert_true(publish_take("ws:0.0.0.0:0", &list));
    assert_false(publish_take_listen("1", &list));
    assert_true(publish_take_origin("http://a", &list));
    assert_true(publish_take("ws:1", &list));
    assert_false(publish_take("ws:2", &list)); /* one too many */
}

TEST_CASE(what_is_no_address_is_refused)
{
    static const char *const wrong[] = {
        "",       "ws",        "ws:",       "ws:x",  "ws:-1",  "ws:65536",     "http:80", "osc:0",
        "osc::9", "osc:a b:9", "osc:::1:9", "ws:1 ", "ws:/:1", "osc:a/b:9000", "osc:1e3"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        publish_list list = {0};
        assert_false(publish_take(wrong[i], &list));
    }
    publish_list list = {0};
    char host[200];
    memset(host, 'a', sizeof host);
    memcpy(host, "osc:", 4);
    memcpy(host + sizeof host - 6, ":9000", 6);
    assert_false(publish_take(host, &list));
}

TEST_CASE(web_pages_of_others_may_not_connect)
{
    static const char *const right[] = {
        "",        "http://localhost", "http://localhost:8080", "https://127.0.0.1:1",
        "file://", "http://mine"};
    static const char *const wrong[] = {"http://localhost.evil.com",    "http://evil.com",
                                        "http://localhost:80.evil.com", "null",
                                        "http://127.0.0.1.evil.com",    "http://mine.evil"};
    for (size_t i = 0; i < 6; i++) {
        assert_true(publish_origin_is_right(right[i], "http://mine"));
        assert_false(publish_origin_is_right(wrong[i], "http://mine"));
    }
    assert_false(publish_origin_is_right("http://mine", NULL));
}

/* ---- what goes out --------------------------------------------------------------------------- */

static publish_moment moment;

static json_t *read_moment(void)
{
    publish_text text = {0};
    publish_text_begin(&text, 16);
    publish_json_moment(&text, &moment);
    assert_false(text.has_failed);
    json_t *top = json_loadb(text.data + text.before, text.length, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(top);
    publish_text_free(&text);
    return top;
}

static double number_at(const json_t *of, const char *key, size_t index)
{
    const json_t *value = json_array_get(json_object_get(of, key), index);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

TEST_CASE(a_frame_is_one_object)
{
    memset(&moment, 0, sizeof moment);
    moment.is_whole = true;
    moment.index = 7;
    moment.time_ns = INT64_C(1700000000123456789);
    moment.gravity = rlf_vec3_make(0.0, 9.81, 0.0);
    moment.T_world_camera = rlf_pose_identity();
    moment.body_count = moment.contact_count = moment.hand_count = moment.region_count = 1;
    moment.gesture_count = 1;
    snprintf(moment.bodies[0].name, RLF_NAME_MAX, "a\"b\\c\n\xc3\xa9\xff\xe2\x82");
    moment.bodies[0].T_world_body.p = rlf_vec3_make(NAN, -1.25, 1e-7);
    moment.bodies[0].velocity.x = INFINITY;
    moment.contacts[0] = (publish_contact){
        .is_begin = true, .body = "ball", .with = "hand", .hand = 3, .impulse = 0.5};
    moment.hands[0] = (rlf_hand){.id = 3, .side = RLF_HAND_LEFT, .gesture = RLF_GESTURE_FIST};
    moment.gestures[0] = (rlf_hand_event){.kind = RLF_HAND_EVENT_WAVE, .hand = 3};
    moment.regions[0] = (publish_region){.id = 5, .centroid = {1.0, 2.0, 3.0}};
    json_t *top = read_moment();
    assert_string_equal(json_string_value(json_object_get(top, "type")), "frame");
    assert_int_equal(json_integer_value(json_object_get(top, "time_ns")), moment.time_ns);
    const json_t *body = json_array_get(json_object_get(top, "bodies"), 0);
    assert_string_equal(json_string_value(json_object_get(body, "name")), "a\"b\\c?\xc3\xa9???");
    assert_true(number_at(body, "position", 0) == 0.0);
    assert_true(number_at(body, "position", 1) == -1.25);
    assert_true(number_at(body, "position", 2) == 1e-7);
    assert_true(number_at(body, "velocity", 0) == 0.0);
    const json_t *contact = json_array_get(json_object_get(top, "contacts"), 0);
    assert_int_equal(json_integer_value(json_object_get(contact, "hand")), 3);
    const json_t *hand = json_array_get(json_object_get(top, "hands"), 0);
    assert_string_equal(json_string_value(json_object_get(hand, "gesture")), "fist");
    assert_string_equal(json_string_value(json_object_get(hand, "side")), "left");
    const json_t *gesture = json_array_get(json_object_get(top, "gestures"), 0);
    assert_string_equal(json_string_value(json_object_get(gesture, "event")), "wave");
    assert_true(number_at(json_array_get(json_object_get(top, "regions"), 0), "centroid", 2) == 3);
    json_decref(top);
}

/* A scene of one ball that fell on the floor, seen by a camera that was moved and turned. */
static rlf_body_state ball;
static rlf_contact points[2];
static rlf_contact_event touch;
static rlf_region regions[PUBLISH_REGIONS + 3];
static rlf_snapshot snapshot;
static rlf_surface surface;

static rlf_pipeline_output one_touch(void)
{
    ball = (rlf_body_state){.id = {4, 2}, .name = "ball", .velocity = {1.0, 2.0, 3.0}};
    touch = (rlf_contact_event){true, {4, 2}, RLF_CONTACT_BACKGROUND, {0, 0}};
    points[0] = (rlf_contact){.body = {4, 2}, .other = RLF_CONTACT_BACKGROUND, .impulse = 1.0};
    points[1] = points[0];
    points[1].impulse = 2.0;
    points[1].point = rlf_vec3_make(0.0, 1.3, 2.0);
    snapshot = (rlf_snapshot){.bodies = &ball,
                              .body_count = 1,
                              .contacts = points,
                              .contact_count = 2,
                              .events = &touch,
                              .event_count = 1};
    for (int i = 0; i < PUBLISH_REGIONS + 3; i++) {
        regions[i] = (rlf_region){.label = i + 1,
                                  .layer = RLF_LAYER_FOREGROUND,
                                  .box = {{-1.0, -1.0, 1.0}, {1.0, 1.0, 2.0}},
                                  .centroid = {0.0, 0.0, 1.5},
                                  .linear_velocity = {0.0, 0.0, 1.0}};
    }
    regions[1].layer = RLF_LAYER_BACKGROUND;
    surface = (rlf_surface){.regions = regions, .region_count = PUBLISH_REGIONS + 3};
    rlf_pipeline_output frame = {.snapshot = &snapshot, .surface = &surface};
    frame.T_world_camera.p = rlf_vec3_make(10.0, 0.0, 0.0);
    frame.T_world_camera.q = rlf_quat_from_axis_angle(rlf_vec3_make(0.0, 1.0, 0.0), 0.5 * RLF_PI);
    return frame;
}

TEST_CASE(a_moment_is_in_the_world_frame)
{
    const rlf_pipeline_output frame = one_touch();
    assert_true(publish_moment_fill(&moment, &frame, true));
    assert_int_equal(moment.body_count, 1);
    assert_string_equal(moment.bodies[0].name, "ball");
    assert_int_equal(moment.contact_count, 1);
    assert_string_equal(moment.contacts[0].body, "ball");
    assert_string_equal(moment.contacts[0].with, "background");
    assert_true(moment.contacts[0].impulse == 2.0); /* the strongest point */
    assert_true(moment.contacts[0].point.y == 1.3);
    assert_int_equal(moment.region_count, PUBLISH_REGIONS); /* one of 67 is the background's */
    assert_int_equal(moment.left_out, 2);
    const publish_region *r = &moment.regions[1];
    assert_int_equal(r->id, 3);
    assert_float_equal(r->centroid.x, 11.5, 1e-9);
    assert_float_equal(r->velocity.x, 1.0, 1e-9);
    assert_float_equal(r->box.min.x, 11.0, 1e-9);
    assert_float_equal(r->box.max.x, 12.0, 1e-9);
    assert_float_equal(r->box.max.z, 1.0, 1e-9);
}

TEST_CASE(thinned_frames_keep_their_events)
{
    const rlf_pipeline_output frame = one_touch();
    assert_true(publish_moment_fill(&moment, &frame, false));
    assert_int_equal(moment.body_count, 0);
    json_t *top = read_moment();
    assert_string_equal(json_string_value(json_object_get(top, "type")), "events");
    assert_int_equal(json_array_size(json_object_get(top, "contacts")), 1);
    json_decref(top);
    snapshot.event_count = 0;
    assert_false(publish_moment_fill(&moment, &frame, false));
}

/* ---- commands -------------------------------------------------------------------------------- */

static publish_command command;
static char error[PUBLISH_ERROR_SIZE];

static bool read_command(const char *text)
{
    return publish_command_from_json(text, strlen(text), &command, error);
}

TEST_CASE(a_body_is_as_it_was_asked_for)
{
    assert_true(read_command("{\"type\":\"spawn\",\"shape\":\"sphere\",\"radius\":0.1,\"position\":"
                             "[1,2,3],\"velocity\":[0,-1,0.5],\"name\":\"red\",\"mass\":2,"
                             "\"restitution\":1,\"friction\":0,\"color\":[1,0,0]}"));
    assert_int_equal(command.verb, PUBLISH_SPAWN);
    assert_int_equal(command.body.shape.type, RLF_SHAPE_SPHERE);
    assert_true(command.body.shape.radius == 0.1);
    assert_true(command.body.position.z == 3.0);
    assert_true(command.body.mass == 2.0);
    assert_string_equal(command.body.name, "red");
    rlf_world *world = NULL;
    rlf_world_def def = rlf_world_def_default();
    assert_int_equal(rlf_world_create(&def, &world), RLF_OK);
    assert_int_equal(rlf_world_add_body(world, &command.body, NULL), RLF_OK);
    static const char *const others[] = {
        "{\"type\":\"spawn\"}",
        "{\"type\":\"throw\"}",
        "{\"type\":\"spawn\",\"shape\":\"capsule\",\"size\":0.2}",
        "{\"type\":\"spawn\",\"shape\":\"cylinder\",\"radius\":0.1,\"height\":0.3}",
        "{\"type\":\"spawn\",\"size\":[0.1,0.2,0.3]}",
        "{\"type\":\"spawn\",\"shape\":\"sphere\",\"size\":0.5}"};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        assert_true(read_command(others[i]));
        assert_true(command.body.mass > 0.0);
        assert_int_equal(rlf_world_add_body(world, &command.body, NULL), RLF_OK);
    }
    assert_true(command.body.shape.radius == 0.25);
    rlf_world_destroy(&world);
}

TEST_CASE(other_commands_are_read)
{
    assert_true(read_command("{\"type\":\"gravity\",\"value\":[0,1.6,0]}"));
    assert_true(command.gravity.y == 1.6);
    assert_true(read_command("{\"type\":\"record\",\"on\":true}"));
    assert_true(command.is_on);
    assert_true(read_command("{\"name\":\"rain\",\"type\":\"scene\"}"));
    assert_string_equal(command.name, "rain");
    assert_true(read_command("{\"type\":\"remove\",\"name\":\"ball\"}"));
    assert_true(read_command("{\"type\":\"clear\"}"));
    assert_true(read_command("{\"type\":\"hello\"}"));
}

TEST_CASE(hostile_commands_are_refused_with_a_line)
{
    static const struct {
        const char *text, *says;
    } wrong[] = {
        {"", "no JSON"},
        {"{", "no JSON"},
        {"{\"type\":\"spawn\",\"type\":\"spawn\"}", "no JSON"},
        {"{\"type\":\"clear\"} {}", "no JSON"},
        {"{\"type\":\"spawn\",\"position\":[NaN,0,0]}", "no JSON"},
        {"{\"type\":\"spawn\",\"position\":[1e999,0,0]}", "no JSON"},
        {"\"clear\"", "no JSON"},
        {"[]", "\"type\""},
        {"{}", "\"type\""},
        {"{\"type\":5}", "\"type\""},
        {"{\"type\":\"format_disk\"}", "use spawn"},
        {"{\"type\":\"spawn\",\"position\":[1e300,0,0]}", "position"},
        {"{\"type\":\"spawn\",\"position\":[0,0]}", "position"},
        {"{\"type\":\"spawn\",\"position\":[0,0,\"a\"]}", "position"},
        {"{\"type\":\"spawn\",\"position\":{}}", "position"},
        {"{\"type\":\"spawn\",\"velocity\":[0,0,51]}", "velocity"},
        {"{\"type\":\"spawn\",\"angular_velocity\":[0,0,1e9]}", "angular_velocity"},
        {"{\"type\":\"spawn\",\"size\":0}", "size"},
        {"{\"type\":\"spawn\",\"size\":-1}", "size"},
        {"{\"type\":\"spawn\",\"size\":[1,1,100]}", "size"},
        {"{\"type\":\"spawn\",\"shape\":\"sphere\",\"size\":[1,1,1]}", "one size"},
        {"{\"type\":\"spawn\",\"shape\":\"hull\"}", "use box"},
        {"{\"type\":\"spawn\",\"shape\":7}", "shape"},
        {"{\"type\":\"spawn\",\"shape\":\"capsule\",\"height\":0}", "size"},
        {"{\"type\":\"spawn\",\"mass\":-1}", "mass"},
        {"{\"type\":\"spawn\",\"mass\":1e9}", "mass"},
        {"{\"type\":\"spawn\",\"restitution\":1.1}", "restitution"},
        {"{\"type\":\"spawn\",\"friction\":-1}", "friction"},
        {"{\"type\":\"spawn\",\"color\":[2,0,0]}", "color"},
        {"{\"type\":\"spawn\",\"color\":\"red\"}", "color"},
        {"{\"type\":\"spawn\",\"name\":\"a\\u001b[2J\"}", "name"},
        {"{\"type\":\"spawn\",\"name\":\"0123456789012345678901234567890123456789012345678901234567"
         "890123456789\"}",
         "name"},
        {"{\"type\":\"spawn\",\"kinematic\":true}", "no key 'kinematic'"},
        {"{\"type\":\"gravity\"}", "needs 'value'"},
        {"{\"type\":\"gravity\",\"value\":[0,2000,0]}", "1000"},
        {"{\"type\":\"record\",\"on\":1}", "true or false"},
        {"{\"type\":\"remove\",\"name\":\"\"}", "name"},
        {"{\"type\":\"clear\",\"name\":\"a\"}", "no key"}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        error[0] = '\0';
        if (read_command(wrong[i].text) || strstr(error, wrong[i].says) == NULL) {
            fail_msg("%s: '%s', not '%s'", wrong[i].text, error, wrong[i].says);
        }
    }
}

TEST_CASE(deep_and_long_texts_are_refused)
{
    static char text[PUBLISH_TEXT_MAX + 2];
    memset(text, '[', PUBLISH_TEXT_MAX);
    assert_false(read_command(text));
    memset(text, ' ', PUBLISH_TEXT_MAX + 1);
    assert_false(read_command(text));
    assert_non_null(strstr(error, "4096"));
}

/* ---- queues ---------------------------------------------------------------------------------- */

TEST_CASE(the_newest_frames_win)
{
    static publish_channel c;
    memset(&c, 0, sizeof c);
    c.address.every = 1;
    rlf_pipeline_output frame = one_touch();
    assert_int_equal(publish_channel_init(&c), RLF_OK);
    for (frame.frame_index = 0; frame.frame_index < 10; frame.frame_index++) {
        publish_channel_add(&c, &frame);
    }
    const publish_moment *first = publish_channel_next(&c);
    assert_int_equal(first->index, 6);
    for (; frame.frame_index < 20; frame.frame_index++) {
        publish_channel_add(&c, &frame);
    }
    assert_int_equal(first->index, 6); /* nobody writes what is being read */
    for (int64_t index = 17; index < 20; index++) {
        assert_int_equal(publish_channel_next(&c)->index, index);
    }
    assert_null(publish_channel_next(&c));
    assert_int_equal(c.counts.dropped, 20 - 4);
    publish_channel_free(&c);
}

TEST_CASE(no_more_commands_wait_than_there_is_room_for)
{
    static publish_channel c;
    static publish_command taken[PUBLISH_COMMANDS];
    memset(&c, 0, sizeof c);
    assert_int_equal(publish_channel_init(&c), RLF_OK);
    assert_true(read_command("{\"type\":\"clear\"}"));
    for (int i = 0; i < PUBLISH_COMMANDS; i++) {
        assert_true(publish_channel_command(&c, &command, error));
    }
    assert_false(publish_channel_command(&c, &command, error));
    assert_non_null(strstr(error, "commands"));
    assert_int_equal(publish_channel_take(&c, taken), PUBLISH_COMMANDS);
    assert_int_equal(publish_channel_take(&c, taken), 0);
    publish_channel_free(&c);
}

/* ---- scenes ---------------------------------------------------------------------------------- */

TEST_CASE(scenes_are_those_beside_the_run_s)
{
    publish_scenes *s = NULL;
    assert_int_equal(publish_scenes_create(RLF_TEST_ROOT "/scenes/rain.json", &s), RLF_OK);
    const rlf_scene *found = publish_scenes_find(s, "stack.json", error);
    assert_non_null(found);
    assert_true(found->body_count > 0);
    assert_ptr_equal(publish_scenes_find(s, "stack.json", error), found);
    static const char *const wrong[] = {
        "../scenes/stack.json", "/etc/passwd",  "..",       "thesis/../x",
        "thesis/arm.json",      ".hidden.json", "no\nsuch", "%s%n"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_null(publish_scenes_find(s, wrong[i], error));
    }
    assert_null(publish_scenes_find(s, "known.json", error));
    assert_non_null(strstr(error, "known objects"));
    assert_null(publish_scenes_find(s, "none.json", error));
    publish_scenes_destroy(&s);
    assert_int_equal(publish_scenes_create(NULL, &s), RLF_OK);
    assert_null(publish_scenes_find(s, "stack.json", error));
    publish_scenes_destroy(&s);
}
