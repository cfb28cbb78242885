// Hands, copied.
#include "bind.hpp"

namespace
{

const char *const sides[] = {"unknown", "left", "right"};

struct Hand {
    rlf_hand c;
    py::object holding;
};

py::array_t<double> tips_of(const Hand &h)
{
    py::array_t<double> out({py::ssize_t(h.c.tip_count), py::ssize_t(3)});
    for (py::ssize_t i = 0; i < h.c.tip_count; i++) {
        out.mutable_at(i, 0) = h.c.tip[i].x;
        out.mutable_at(i, 1) = h.c.tip[i].y;
        out.mutable_at(i, 2) = h.c.tip[i].z;
    }
    return out;
}

void bind_hand(py::module_ &m)
{
    using H = const Hand &;
    py::class_<Hand>(m, "Hand",
                     "A hand, copied; metres, depth camera's frame. Vectors are (3,) float64.")
        .def_property_readonly(
            "id", [](H h) { return h.c.id; },
            "The same while it is seen and through gaps of 0.3 s.")
        .def_property_readonly(
            "side", [](H h) { return sides[h.c.side]; },
            "\"left\" or \"right\", as its owner says, or \"unknown\".")
        .def_property_readonly(
            "has_tips", [](H h) { return h.c.detail == RLF_HAND_TIPS; },
            "False: too far for tips, pinch and pointing.")
        .def_property_readonly(
            "confidence", [](H h) { return h.c.confidence; }, "0 to 1 that this is a hand.")
        .def_property_readonly(
            "is_sure", [](H h) { return h.c.confidence >= RLF_HAND_SURE; },
            "False: nothing is to be done by it.")
        .def_property_readonly(
            "age", [](H h) { return static_cast<double>(h.c.age_ns) * 1e-9; },
            "Seconds since it was first seen.")
        .def_property_readonly(
            "palm", [](H h) { return array_of(h.c.palm); },
            "Centre of the palm on the seen surface.")
        .def_property_readonly(
            "palm_radius", [](H h) { return h.c.palm_radius; },
            "Of the largest disc inside, metres.")
        .def_property_readonly(
            "velocity", [](H h) { return array_of(h.c.velocity); }, "Of the palm, m/s.")
        .def_property_readonly(
            "normal", [](H h) { return array_of(h.c.normal); },
            "Of the palm's seen side: unit, to the camera.")
        .def_property_readonly(
            "direction", [](H h) { return array_of(h.c.direction); },
            "From the wrist to the fingers, unit.")
        .def_property_readonly(
            "arm_direction", [](H h) { return array_of(h.c.arm_direction); },
            "Along the forearm to the hand, unit.")
        .def_property_readonly("tips", &tips_of, "(N, 3) float64, N <= 5: the fingers' ends.")
        .def_property_readonly(
            "gesture", [](H h) { return rlf_gesture_name(h.c.gesture); },
            "\"open\", \"fist\", \"pinch\", \"point\" or \"none\".")
        .def_property_readonly(
            "pinch_point", [](H h) { return array_of(h.c.pinch_point); },
            "Where thumb and finger meet, or would.")
        .def_property_readonly(
            "pinch_width",
            [](H h) -> py::object {
                return h.c.pinch_width < 0.0 ? py::object(py::none()) : py::float_(h.c.pinch_width);
            },
            "Gap between thumb and finger, metres; None = not known.")
        .def_property_readonly(
            "point_direction", [](H h) { return array_of(h.c.point_direction); },
            "The ray of a hand that points begins at tips[0]; unit.")
        .def_readonly("holding", &Hand::holding, "The Body that it holds, or None.");
}

void bind_event(py::module_ &m)
{
    using E = const rlf_hand_event &;
    py::class_<rlf_hand_event>(m, "HandEvent", "What a hand began or ended; depth camera's frame.")
        .def_property_readonly(
            "kind", [](E e) { return rlf_hand_event_name(e.kind); },
            "\"pinch\", \"pinch_end\", \"open\", \"fist\", \"point\", "
            "\"point_end\", \"push\", \"swipe_left\", \"swipe_right\" or "
            "\"wave\".")
        .def_property_readonly(
            "hand", [](E e) { return e.hand; }, "Hand.id.")
        .def_property_readonly(
            "position", [](E e) { return array_of(e.position); },
            "Pinch point, tip of a hand that points, else the palm; metres.")
        .def_property_readonly(
            "direction", [](E e) { return array_of(e.direction); },
            "Of the ray, else of the motion or of the hand; unit.")
        .def_property_readonly(
            "velocity", [](E e) { return array_of(e.velocity); }, "Of the palm, m/s.");
}

} // namespace

py::object hands_of(const std::shared_ptr<Owner> &owner, rlf_world *world, const rlf_hands *hands)
{
    if (hands == nullptr) {
        return py::none();
    }
    py::list out;
    for (int32_t i = 0; i < hands->count; i++) {
        const uint64_t held = hands->hand[i].holding;
        const rlf_body_id id = {static_cast<uint32_t>(held), static_cast<uint32_t>(held >> 32)};
        out.append(
            Hand{hands->hand[i], held == 0 ? py::object(py::none()) : body_of(owner, world, id)});
    }
    return std::move(out);
}

py::list hand_events_of(const rlf_hands *hands)
{
    py::list out;
    for (int32_t i = 0; hands != nullptr && i < hands->event_count; i++) {
        out.append(py::cast(hands->event[i]));
    }
    return out;
}

void bind_hands(py::module_ &m)
{
    bind_hand(m);
    bind_event(m);
}
