// A ROS 2 program by another maker of DDS: what Relief reads it writes, and the other way round.
//   peer camera          publishes a camera below /camera until it is killed
//   peer read COUNT      reads COUNT pairs of that camera and checks their pixels
//   peer look            reads one of each topic that a run publishes below /relief
#include "ros.h"
#include "rosPubSubTypes.h"

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;
using sensor_msgs::msg::dds_::CameraInfo_;
using sensor_msgs::msg::dds_::Image_;
using sensor_msgs::msg::dds_::PointCloud2_;
using tf2_msgs::msg::dds_::TFMessage_;
using visualization_msgs::msg::dds_::MarkerArray_;

// As tests/support/ros2_host.h has it.
static const int W = 64, H = 48, CW = 96, CH = 54;

static uint16_t depth_of(uint32_t number, int x, int y)
{
    const uint32_t hash = (number * 2654435761u + uint32_t(y * W + x)) * 2246822519u;
    return x == 0 && y == 0 ? uint16_t(number + 1) : uint16_t(500 + (hash >> 20) % 4000);
}

static uint8_t color_of(uint32_t number, int x, int y, int channel)
{
    return uint8_t(number * 7 + uint32_t(x * 3 + y * 5 + channel * 64));
}

static fast::DomainParticipant *participant;

static void start()
{
    fast::DomainParticipantQos qos;
    auto transport = std::make_shared<rtps::UDPv4TransportDescriptor>();
    transport->interfaceWhiteList.push_back("127.0.0.1");
    transport->sendBufferSize = transport->receiveBufferSize = 4 << 20;
    qos.transport().user_transports.push_back(transport);
    qos.transport().use_builtin_transports = false;
    const char *domain = std::getenv("ROS_DOMAIN_ID");
    participant = fast::DomainParticipantFactory::get_instance()->create_participant(
        domain ? std::atoi(domain) : 0, qos);
}

template <class Support> static fast::Topic *topic(const std::string &name)
{
    fast::TypeSupport type(new Support());
    type->auto_fill_type_information(false);
    type->auto_fill_type_object(false);
    type.register_type(participant);
    return participant->create_topic("rt" + name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
}

template <class Support> static fast::DataWriter *writer(const std::string &name, bool is_lasting)
{
    static fast::Publisher *publisher = participant->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
    fast::DataWriterQos qos;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind =
        is_lasting ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
    qos.history().depth = 2;
    qos.publish_mode().kind = fast::ASYNCHRONOUS_PUBLISH_MODE;
    return publisher->create_datawriter(topic<Support>(name), qos);
}

template <class Support> static fast::DataReader *reader(const std::string &name)
{
    static fast::Subscriber *subscriber =
        participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
    fast::DataReaderQos qos;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 4;
    return subscriber->create_datareader(topic<Support>(name), qos);
}

// ---- the camera

static CameraInfo_ info(int width, int height, const double k[4], const char *model,
                        std::vector<double> d, const char *frame)
{
    CameraInfo_ m;
    m.header().frame_id(frame);
    m.width(width);
    m.height(height);
    m.distortion_model(model);
    m.d(d);
    m.k({k[0], 0, k[2], 0, k[1], k[3], 0, 0, 1});
    m.r({1, 0, 0, 0, 1, 0, 0, 0, 1});
    m.p({k[0], 0, k[2], 0, 0, k[1], k[3], 0, 0, 0, 1, 0});
    return m;
}

static Image_ image(int width, int height, int step, const char *encoding, const char *frame)
{
    Image_ m;
    m.header().frame_id(frame);
    m.width(width);
    m.height(height);
    m.step(step);
    m.encoding(encoding);
    m.data().resize(size_t(step) * height);
    return m;
}

static int run_camera()
{
    auto *depth = writer<sensor_msgs::msg::dds_::Image_PubSubType>("/camera/depth/image_raw", false);
    auto *color = writer<sensor_msgs::msg::dds_::Image_PubSubType>("/camera/color/image_raw", false);
    auto *depth_info =
        writer<sensor_msgs::msg::dds_::CameraInfo_PubSubType>("/camera/depth/camera_info", false);
    auto *color_info =
        writer<sensor_msgs::msg::dds_::CameraInfo_PubSubType>("/camera/color/camera_info", false);
    auto *tf = writer<tf2_msgs::msg::dds_::TFMessage_PubSubType>("/tf_static", true);
    const double kd[4] = {61.25, 60.5, 31.125, 23.0625}, kc[4] = {80.0, 80.25, 48.5, 26.75};
    CameraInfo_ di = info(W, H, kd, "rational_polynomial",
                          {0.1, -0.02, 0.001, -0.002, 0.003, 0.05, 0.01, -0.004}, "d");
    CameraInfo_ ci = info(CW, CH, kc, "plumb_bob", {0.05, -0.1, 0.0005, 0.001, 0.02}, "c");
    Image_ dm = image(W, H, W * 2, "16UC1", "d"), cm = image(CW, CH, CW * 3, "rgb8", "c");
    TFMessage_ t;
    t.transforms().resize(1);
    t.transforms()[0].header().frame_id("c");
    t.transforms()[0].child_frame_id("d");
    auto &transform = t.transforms()[0].transform();
    transform.translation().x(0.025);
    transform.translation().y(-0.001);
    transform.translation().z(0.004);
    transform.rotation().y(0.0087262032186418);
    transform.rotation().w(0.99996192306417);
    tf->write(&t);
    auto due = std::chrono::steady_clock::now();
    for (uint32_t number = 0;; number++) {
        const int64_t stamp = 1000000000LL + int64_t(number) * 33333333;
        for (auto *header : {&di.header(), &ci.header(), &dm.header(), &cm.header()}) {
            header->stamp().sec(int32_t(stamp / 1000000000));
            header->stamp().nanosec(uint32_t(stamp % 1000000000));
        }
        for (int i = 0; i < W * H; i++) {
            const uint16_t z = depth_of(number, i % W, i / W);
            std::memcpy(&dm.data()[2 * i], &z, 2);
        }
        for (int i = 0; i < CW * CH; i++) {
            for (int k = 0; k < 3; k++) {
                cm.data()[3 * i + k] = color_of(number, i % CW, i / CW, k);
            }
        }
        depth_info->write(&di);
        color_info->write(&ci);
        depth->write(&dm);
        color->write(&cm);
        due += std::chrono::nanoseconds(33333333);
        std::this_thread::sleep_until(due);
    }
}

// ---- reading

static int fail(const char *what)
{
    std::fprintf(stderr, "peer: %s\n", what);
    return 1;
}

template <class Message> static bool take(fast::DataReader *r, Message &out)
{
    fast::SampleInfo sample;
    while (r->take_next_sample(&out, &sample) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
        if (sample.valid_data) {
            return true;
        }
    }
    return false;
}

template <class Message> static bool wait(fast::DataReader *r, Message &out)
{
    for (int i = 0; i < 1000; i++) {
        if (take(r, out)) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

static int run_reader(int count)
{
    auto *depth = reader<sensor_msgs::msg::dds_::Image_PubSubType>("/camera/depth/image_raw");
    auto *color = reader<sensor_msgs::msg::dds_::Image_PubSubType>("/camera/color/image_raw");
    auto *depth_info =
        reader<sensor_msgs::msg::dds_::CameraInfo_PubSubType>("/camera/depth/camera_info");
    CameraInfo_ di;
    if (!wait(depth_info, di) || di.k()[0] != 61.25 || di.p()[5] != 60.5 || di.d().size() != 8 ||
        di.d()[7] != -0.004 || di.distortion_model() != "rational_polynomial") {
        return fail("no CameraInfo, or another one");
    }
    uint32_t first = 0;
    for (int got = 0; got < count; got++) {
        Image_ m;
        if (!wait(depth, m) || m.encoding() != "16UC1" || m.data().size() != size_t(W * H * 2)) {
            return fail("no depth, or another one");
        }
        uint16_t z;
        std::memcpy(&z, &m.data()[0], 2);
        const uint32_t number = z - 1u;
        first = got == 0 ? number : first;
        if (number != first + uint32_t(got)) {
            return fail("a picture of depth was lost");
        }
        for (int i = 0; i < W * H; i++) {
            std::memcpy(&z, &m.data()[2 * i], 2);
            if (z != depth_of(number, i % W, i / W)) {
                return fail("a pixel of depth is another one");
            }
        }
        Image_ c;
        if (!wait(color, c) || c.encoding() != "rgb8" || c.data().size() != size_t(CW * CH * 3)) {
            return fail("no colour, or another one");
        }
        const uint32_t shade = c.data()[0];
        for (int i = 0; i < CW * CH * 3; i++) {
            const uint8_t wanted =
                uint8_t(shade + color_of(0, i / 3 % CW, i / 3 / CW, i % 3));
            if (c.data()[i] != wanted) {
                return fail("a pixel of colour is another one");
            }
        }
    }
    std::printf("peer: %d pairs are as they were\n", count);
    return 0;
}

static int run_look()
{
    auto *picture = reader<sensor_msgs::msg::dds_::Image_PubSubType>("/relief/image_raw");
    auto *mask = reader<sensor_msgs::msg::dds_::Image_PubSubType>("/relief/foreground");
    auto *points = reader<sensor_msgs::msg::dds_::PointCloud2_PubSubType>("/relief/points");
    auto *bodies = reader<visualization_msgs::msg::dds_::MarkerArray_PubSubType>("/relief/bodies");
    auto *contacts =
        reader<visualization_msgs::msg::dds_::MarkerArray_PubSubType>("/relief/contacts");
    Image_ image, foreground;
    PointCloud2_ cloud;
    MarkerArray_ body, touch;
    if (!wait(picture, image) || image.encoding() != "rgb8" ||
        image.data().size() != size_t(image.step()) * image.height()) {
        return fail("no picture");
    }
    if (!wait(mask, foreground) || foreground.encoding() != "mono8") {
        return fail("no foreground");
    }
    if (!wait(points, cloud) || cloud.fields().size() != 6 || cloud.fields()[5].name() != "normal_z" ||
        cloud.data().size() != size_t(cloud.row_step()) * cloud.height() || cloud.is_dense()) {
        return fail("no points");
    }
    if (!wait(bodies, body) || body.markers().size() < 2 || body.markers()[0].action() != 3 ||
        body.markers()[1].header().frame_id() != "relief_world" || body.markers()[1].color().a() != 1) {
        return fail("no bodies");
    }
    if (!wait(contacts, touch) || touch.markers().empty()) {
        return fail("no contacts");
    }
    std::printf("peer: a picture of %u x %u, %u x %u points, %zu markers\n", image.width(),
                image.height(), cloud.width(), cloud.height(), body.markers().size());
    return 0;
}

int main(int argc, char **argv)
{
    const std::string what = argc > 1 ? argv[1] : "";
    start();
    if (participant == nullptr) {
        return fail("no participant");
    }
    // The end of the process takes all down: a peer that is killed is part of the game.
    const int status = what == "camera" ? run_camera()
               : what == "look" ? run_look()
                                : run_reader(argc > 2 ? std::atoi(argv[2]) : 30);
    std::fflush(stdout);
    std::_Exit(status);
}
