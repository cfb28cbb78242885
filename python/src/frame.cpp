// Frames: copied for Python, and made of its arrays.
#include "bind.hpp"

#include <cstring>

namespace
{

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

py::array array_from(const py::object &value, const char *name)
{
    if (!py::isinstance<py::array>(value)) {
        throw py::type_error(std::string(name) + ": use a NumPy array");
    }
    return value.cast<py::array>();
}

void need_type(const py::array &a, const char *name, const py::dtype &type, const char *words)
{
    if (!a.dtype().equal(type)) {
        throw py::type_error(std::string(name) + " has dtype " + std::string(py::str(a.dtype())) +
                             ": use " + words);
    }
}

void need_shape(const py::array &a, const char *name, int height, int width, int channels)
{
    const bool is_flat = channels == 0;
    const bool fits = a.ndim() == (is_flat ? 2 : 3) && a.shape(0) == height &&
                      a.shape(1) == width && (is_flat || a.shape(2) == channels);
    if (!fits) {
        std::string shape = "(";
        for (py::ssize_t i = 0; i < a.ndim(); i++) {
            shape += (i > 0 ? ", " : "") + std::to_string(a.shape(i));
        }
        throw py::value_error(std::string(name) + " has shape " + shape + "): use (" +
                              std::to_string(height) + ", " + std::to_string(width) +
                              (is_flat ? ")" : ", 3) or (H, W, 4)"));
    }
}

// Rows that lie in memory pixel by pixel; else a copy of which that holds.
py::array packed_rows(const py::array &a)
{
    py::ssize_t step = a.itemsize();
    bool is_packed = a.strides(0) > 0;
    for (py::ssize_t i = a.ndim() - 1; i > 0; i--) {
        is_packed = is_packed && a.strides(i) == step;
        step *= a.shape(i);
    }
    const bool is_aligned = (a.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
    return is_aligned && is_packed && a.strides(0) >= step
               ? a
               : py::array::ensure(a, py::array::c_style);
}

} // namespace

py::object frame_copy(const rlf_frame &frame)
{
    Frame out = {};
    const rlf_camera &camera = frame.rig->depth;
    const std::vector<py::ssize_t> size = {camera.height, camera.width};
    out.depth = frame.depth_u16 != nullptr
                    ? copy_rows<uint16_t>(frame.depth_u16, frame.depth_stride, size)
                    : copy_rows<float>(frame.depth_f32, frame.depth_stride, size);
    out.color = copy_rows<uint8_t>(frame.color.data, frame.color.stride,
                                   {frame.color.height, frame.color.width, 4});
    out.confidence = copy_rows<uint8_t>(frame.confidence, frame.confidence_stride, size);
    out.pose = frame.has_pose ? py::object(matrix_of(frame.T_world_camera)) : py::none();
    out.c = frame;
    out.c.rig = nullptr;
    out.c.depth_u16 = nullptr;
    out.c.depth_f32 = nullptr;
    out.c.color = {};
    out.c.confidence = nullptr;
    return py::cast(std::move(out));
}

void take_depth(const py::object &value, double units_per_metre, const rlf_rig &rig, FrameIn &out)
{
    out.depth = array_from(value, "depth");
    const bool is_u16 = out.depth.dtype().equal(py::dtype::of<uint16_t>());
    if (!is_u16) {
        need_type(out.depth, "depth", py::dtype::of<float>(), "uint16 (units) or float32 (metres)");
    }
    need_shape(out.depth, "depth", rig.depth.height, rig.depth.width, 0);
    out.depth = packed_rows(out.depth);
    out.c.depth_stride = out.depth.strides(0);
    out.c.depth_u16 = is_u16 ? static_cast<const uint16_t *>(out.depth.data()) : nullptr;
    out.c.depth_f32 = is_u16 ? nullptr : static_cast<const float *>(out.depth.data());
    out.c.depth_units_per_metre = is_u16 ? units_per_metre : 0.0;
}

void take_color(const py::object &value, const rlf_rig &rig, FrameIn &out)
{
    if (value.is_none()) {
        return;
    }
    if (!rig.has_color) {
        throw py::value_error("color: the rig has no colour camera");
    }
    out.color = array_from(value, "color");
    need_type(out.color, "color", py::dtype::of<uint8_t>(), "uint8");
    const int width = rig.color.width, height = rig.color.height;
    const bool is_rgba = out.color.ndim() == 3 && out.color.shape(2) == 4;
    need_shape(out.color, "color", height, width, is_rgba ? 4 : 3);
    out.color = packed_rows(out.color);
    auto *from = static_cast<uint8_t *>(const_cast<void *>(out.color.data()));
    rlf_image_rgba8 image = {from, width, height, out.color.strides(0)};
    if (!is_rgba) {
        out.rgba.resize(size_t(4) * size_t(width) * size_t(height));
        for (int y = 0; y < height; y++) {
            const uint8_t *row = from + y * out.color.strides(0);
            uint8_t *to = out.rgba.data() + size_t(4) * size_t(width) * size_t(y);
            for (int x = 0; x < width; x++, row += 3, to += 4) {
                std::memcpy(to, row, 3);
                to[3] = 255;
            }
        }
        image = {out.rgba.data(), width, height, ptrdiff_t(4) * width};
    }
    out.c.color = image;
}

void take_confidence(const py::object &value, const rlf_rig &rig, FrameIn &out)
{
    if (value.is_none()) {
        return;
    }
    out.confidence = array_from(value, "confidence");
    need_type(out.confidence, "confidence", py::dtype::of<uint8_t>(), "uint8");
    need_shape(out.confidence, "confidence", rig.depth.height, rig.depth.width, 0);
    out.confidence = packed_rows(out.confidence);
    out.c.confidence = static_cast<const uint8_t *>(out.confidence.data());
    out.c.confidence_stride = out.confidence.strides(0);
}

int64_t nanoseconds(double seconds)
{
    if (!(seconds > -4e9 && seconds < 4e9)) { // as RLF_TIME_MAX_NS
        throw py::value_error("time: use seconds, at most 4e9");
    }
    return static_cast<int64_t>(seconds * 1e9 + (seconds < 0.0 ? -0.5 : 0.5));
}

void bind_frame(py::module_ &m)
{
    using F = const Frame &;
    py::class_<Frame>(m, "Frame",
                      "One picture of a source. Its arrays are its own: keep it as long "
                      "as you like.")
        .def_property_readonly(
            "sequence", [](F f) { return f.c.sequence; }, "Counts the device's frames from 0.")
        .def_property_readonly(
            "time", [](F f) { return static_cast<double>(f.c.time_ns) * 1e-9; },
            "Seconds, by the device's clock.")
        .def_readonly("depth", &Frame::depth,
                      "(H, W): uint16 in units, 0 = missing, or float32 in metres, <= 0 and NaN = "
                      "missing. Along z, not along the ray.")
        .def_property_readonly(
            "units_per_metre", [](F f) { return f.c.depth_units_per_metre; },
            "Of uint16 depth: 1000 = millimetres.")
        .def_readonly("color", &Frame::color, "(H, W, 4) uint8, red green blue alpha; or None.")
        .def_readonly("confidence", &Frame::confidence, "(H, W) uint8, 255 = sure; or None.")
        .def_readonly("pose", &Frame::pose,
                      "(4, 4): where the source says that the depth camera is; or None.");
}
