// What a step of a pipeline gives.
#include "bind.hpp"

namespace
{

py::object image(const Step &s, const rlf_image_rgba8 &picture)
{
    if (picture.data == nullptr) {
        return py::none();
    }
    return view_of(s.owner, py::dtype::of<uint8_t>(), picture.data,
                   {picture.height, picture.width, 4}, {picture.stride, 4, 1});
}

py::object matte(const Step &s)
{
    const rlf_plane_u8 &plane = s.now().render.matte;
    if (plane.data == nullptr) {
        return py::none();
    }
    return view_of(s.owner, py::dtype::of<uint8_t>(), plane.data, {plane.height, plane.width},
                   {plane.stride, 1});
}

py::object hand_owner(const Step &s)
{
    const rlf_hands *hands = s.now().hands;
    return hands == nullptr ? py::object(py::none())
                            : plane_of(s.owner, hands->owner, hands->height, hands->width);
}

py::object track(const Step &s)
{
    const rlf_track_result *result = s.now().track;
    return result == nullptr ? py::object(py::none())
                             : py::str(rlf_track_health_name(result->health));
}

py::dict times_of(const Step &s)
{
    const rlf_stage_times &t = s.now().times;
    py::dict out;
    out["capture"] = t.capture_ms;
    out["surface"] = t.surface_ms;
    out["physics"] = t.physics_ms;
    out["render"] = t.render_ms;
    out["hands"] = t.hands_ms;
    return out;
}

// A reading: no other thread is in the pipeline meanwhile.
template <typename Get> auto of(Get get)
{
    return [get](const Step &s) {
        const Busy busy(*s.owner);
        return get(s);
    };
}

} // namespace

const rlf_pipeline_output &Step::now() const
{
    owner->need_open();
    if (step != owner->steps) {
        throw std::runtime_error("this step is over: the pipeline has made another one; copy what "
                                 "is to stay");
    }
    return out;
}

const rlf_frame &Step::frame() const
{
    const rlf_frame &frame = now().frame;
    if (owner->source != nullptr) {
        source_in(owner->source);
        if (given != owner->source->steps) {
            throw std::runtime_error("this step's frame is over: its source has given another one");
        }
    }
    return frame;
}

void bind_step(py::module_ &m)
{
    using S = const Step &;
    py::class_<Step>(m, "Step", "What one frame gave. Good until the pipeline's next step.")
        .def_property_readonly("index", of([](S s) { return s.now().frame_index; }),
                               "Counts the steps from 0.")
        .def_property_readonly("time", of([](S s) { return s.now().time_s; }),
                               "Seconds since the first frame.")
        .def_property_readonly("frame", of([](S s) { return frame_copy(s.frame()); }),
                               "The frame, copied.")
        .def_property_readonly("surface",
                               of([](S s) { return surface_of(s.owner, s.now().surface); }),
                               "What the camera sees, as arrays.")
        .def_property_readonly("bodies", of([](S s) { return bodies_of(s.now().snapshot); }),
                               "BodyState of each, copied.")
        .def_property_readonly("contacts", of([](S s) { return contacts_of(s.now().snapshot); }),
                               "Contact of each point at which bodies met something, copied.")
        .def_property_readonly("events", of([](S s) { return events_of(s.now().snapshot); }),
                               "(\"begin\" or \"end\", body, other) of this step.")
        .def_property_readonly(
            "hands", of([](S s) {
                return hands_of(s.owner, rlf_pipeline_get_world(s.owner->pipeline), s.now().hands);
            }),
            "Hand of each, copied; None when none are looked for.")
        .def_property_readonly("hand_events", of([](S s) { return hand_events_of(s.now().hands); }),
                               "HandEvent of each gesture that began or ended, copied.")
        .def_property_readonly("hand_owner", of(&hand_owner),
                               "(H, W) uint8: 1 + index in hands of the pixel's hand, 0 = none; "
                               "None when none are looked for.")
        .def_property_readonly("camera_pose",
                               of([](S s) { return matrix_of(s.now().T_world_camera); }),
                               "(4, 4): the depth camera in the world.")
        .def_property_readonly("track", of(&track),
                               "\"good\", \"weak\" or \"lost\" of a moving camera; else None.")
        .def_property_readonly("picture", of([](S s) { return image(s, s.now().render.image); }),
                               "(H, W, 4) uint8, or None without rendering.")
        .def_property_readonly("matte", of(&matte),
                               "(H, W) uint8, alpha of all that is virtual; or None.")
        .def_property_readonly("times_ms", of(&times_of), "Wall time of the stages, milliseconds.")
        .def_property_readonly(
            "latency_ms", of([](S s) { return s.now().latency_ms; }),
            "From the frame's arrival to the picture, milliseconds; 0 = unknown, "
            "as of files.");
}
