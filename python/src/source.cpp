// Sources and their frames.
#include "bind.hpp"

#include <cstring>

namespace {

// A frame's own copy: it may be kept.
struct Frame {
    uint64_t sequence;
    double time;
    py::object depth, color, confidence, pose;
    double units_per_metre;
};

template <typename T>
py::object copy_rows(const void *data, ptrdiff_t stride, std::vector<py::ssize_t> shape)
{
    if (data == nullptr) {
        return py::none();
    }
    py::array_t<T> array(shape);
    const size_t row = static_cast<size_t>(array.nbytes() / shape[0]);
    for (py::ssize_t y = 0; y < shape[0]; y++) {
        std::memcpy(reinterpret_cast<char *>(array.mutable_data()) + static_cast<size_t>(y) * row,
                    static_cast<const char *>(data) + y * stride, row);
    }
    return std::move(array);
}

class Source {
public:
    Source(const std::string &name, int threads) : owner(open_source(name, threads)) {}

    const rlf_source_info &info() const { return *rlf_source_get_info(source_in(owner)); }

    py::object next()
    {
        rlf_source *source = source_in(owner);
        const Busy busy(*owner);
        rlf_frame frame;
        rlf_result result;
        do { // a live camera: until there is a frame, or Ctrl-C
            {
                const py::gil_scoped_release release;
                result = rlf_source_next(source, &frame);
            }
            if (PyErr_CheckSignals() != 0) {
                throw py::error_already_set();
            }
        } while (check(result) == RLF_NO_FRAME);
        if (result == RLF_END) {
            throw py::stop_iteration();
        }
        return frame_copy(frame);
    }

    void restart()
    {
        rlf_source *source = source_in(owner);
        const Busy busy(*owner);
        check(rlf_source_restart(source));
    }

    void seek(int64_t index)
    {
        rlf_source *source = source_in(owner);
        const Busy busy(*owner);
        check(rlf_source_seek(source, index));
    }

    void close()
    {
        const Busy busy(*owner);
        owner->is_closed = true;
        rlf_source_destroy(&owner->source);
    }

    std::shared_ptr<SourceOwner> owner;
};

void bind_frame(py::module_ &m)
{
    py::class_<Frame>(m, "Frame", "One picture of a source. Its arrays are its own: keep it as long "
                                  "as you like.")
        .def_readonly("sequence", &Frame::sequence, "Counts the device's frames from 0.")
        .def_readonly("time", &Frame::time, "Seconds, by the device's clock.")
        .def_readonly("depth", &Frame::depth,
                      "(H, W): uint16 in units, 0 = missing, or float32 in metres, <= 0 and NaN = "
                      "missing. Along z, not along the ray.")
        .def_readonly("units_per_metre", &Frame::units_per_metre, "Of uint16 depth.")
        .def_readonly("color", &Frame::color, "(H, W, 4) uint8, red green blue alpha; or None.")
        .def_readonly("confidence", &Frame::confidence, "(H, W) uint8, 255 = sure; or None.")
        .def_readonly("pose", &Frame::pose,
                      "(4, 4): where the source says that the depth camera is; or None.");
}

} // namespace

std::shared_ptr<SourceOwner> open_source(const std::string &name, int threads)
{
    auto owner = std::make_shared<SourceOwner>();
    const py::gil_scoped_release release;
    rlf_result result = rlf_pool_create(threads, &owner->pool);
    if (result == RLF_OK) {
        result = rlf_open_source(name.c_str(), owner->pool, &owner->source);
    }
    const py::gil_scoped_acquire acquire;
    check(result);
    return owner;
}

rlf_source *source_in(const std::shared_ptr<SourceOwner> &owner)
{
    owner->need_open();
    return owner->source;
}

py::object frame_copy(const rlf_frame &frame)
{
    Frame out = {};
    const rlf_camera &camera = frame.rig->depth;
    const std::vector<py::ssize_t> size = {camera.height, camera.width};
    out.sequence = frame.sequence;
    out.time = static_cast<double>(frame.time_ns) * 1e-9;
    out.units_per_metre = frame.depth_units_per_metre;
    out.depth = frame.depth_u16 != nullptr
                    ? copy_rows<uint16_t>(frame.depth_u16, frame.depth_stride, size)
                    : copy_rows<float>(frame.depth_f32, frame.depth_stride, size);
    out.color = copy_rows<uint8_t>(frame.color.data, frame.color.stride,
                                   {frame.color.height, frame.color.width, 4});
    out.confidence = copy_rows<uint8_t>(frame.confidence, frame.confidence_stride, size);
    out.pose = frame.has_pose ? py::object(matrix_of(frame.T_world_camera)) : py::none();
    return py::cast(std::move(out));
}

void bind_source(py::module_ &m)
{
    bind_frame(m);
    py::class_<SourceOwner, std::shared_ptr<SourceOwner>>(m, "_SourceOwner");
    py::class_<Source>(m, "Source", "A camera or a recording; iterate it for its frames.")
        .def(py::init<const std::string &, int>(), py::arg("name"), py::arg("threads") = 1)
        .def_property_readonly("_owner", [](const Source &s) { return s.owner; })
        .def_property_readonly("name", [](const Source &s) { return std::string(s.info().name); })
        .def_property_readonly("rig", [](const Source &s) { return s.info().rig; })
        .def_property_readonly("frame_count",
                               [](const Source &s) -> py::object {
                                   const int64_t n = s.info().frame_count;
                                   return n < 0 ? py::object(py::none()) : py::cast(n);
                               },
                               "None = unknown or endless.")
        .def_property_readonly("frames_per_second",
                               [](const Source &s) { return s.info().frames_per_second; },
                               "Nominal; 0 = unknown.")
        .def_property_readonly("is_live", [](const Source &s) { return s.info().is_live; })
        .def_property_readonly("device",
                               [](const Source &s) { return std::string(s.info().device); })
        .def("restart", &Source::restart, "The first frame is the next one again.")
        .def("seek", &Source::seek, py::arg("index"), "Makes frame `index`, from 0, the next one.")
        .def("close", &Source::close)
        .def("__iter__", [](py::object self) { return self; })
        .def("__next__", &Source::next)
        .def("__enter__", [](py::object self) { return self; })
        .def("__exit__", [](Source &s, const py::args &) { s.close(); });
    m.def(
        "open",
        [](const std::string &name, int threads) { return std::make_unique<Source>(name, threads); },
        py::arg("name"), py::arg("threads") = 1,
        "Opens a camera, a recording or a synthetic room, as the command's SOURCE. threads 0 = one "
        "per processor.");
}
