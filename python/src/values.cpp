// Vectors, poses, words and cameras.
#include "bind.hpp"

#include <cmath>
#include <cstring>

namespace
{

constexpr double rotation_tolerance = 1e-4; // of a column's length and of the angles between them

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

Doubles numbers_from(const py::object &value, const char *name, std::vector<py::ssize_t> shape,
                     const char *words)
{
    const auto array = Doubles::ensure(value);
    bool fits = array && array.ndim() == static_cast<py::ssize_t>(shape.size());
    for (size_t i = 0; fits && i < shape.size(); i++) {
        fits = array.shape(static_cast<py::ssize_t>(i)) == shape[i];
    }
    PyErr_Clear();
    for (py::ssize_t i = 0; fits && i < array.size(); i++) {
        fits = std::isfinite(array.data()[i]);
    }
    if (!fits) {
        throw py::value_error(std::string(name) + ": use " + words);
    }
    return array;
}

const char *const models[] = {"none", "plumb_bob", "rational_polynomial", nullptr};

rlf_camera make_camera(int width, int height, double fx, double fy, double cx, double cy,
                       const std::string &model, const std::vector<double> &distortion)
{
    rlf_camera camera = {};
    camera.width = width;
    camera.height = height;
    camera.fx = fx;
    camera.fy = fy;
    camera.cx = cx;
    camera.cy = cy;
    camera.distortion_model =
        static_cast<rlf_distortion_model>(choice_from(model, models, "distortion_model"));
    if (distortion.size() > 8) {
        throw py::value_error("distortion: use at most 8 numbers, k1 k2 p1 p2 k3 k4 k5 k6");
    }
    std::copy(distortion.begin(), distortion.end(), camera.distortion);
    check(rlf_camera_check(&camera, "Camera"));
    return camera;
}

rlf_rig make_rig(const rlf_camera &depth, const py::object &color, const py::object &transform,
                 std::pair<double, double> range, const py::object &noise)
{
    rlf_rig rig = rlf_rig_default();
    rig.depth = depth;
    if (!color.is_none()) {
        if (!py::isinstance<rlf_camera>(color)) {
            throw py::type_error("color: use a Camera, or None");
        }
        rig.color = color.cast<rlf_camera>();
        rig.has_color = true;
    }
    if (!transform.is_none()) {
        rig.T_color_depth = pose_from(transform, "color_from_depth");
    }
    if (!(range.first >= 0.0 && range.first < range.second && std::isfinite(range.second))) {
        throw py::value_error("depth_range: use (nearest, farthest) in metres, 0 <= nearest < "
                              "farthest");
    }
    rig.depth_min_m = range.first;
    rig.depth_max_m = range.second;
    if (!noise.is_none()) {
        const rlf_vec3 c = vector_from(noise, "noise");
        rig.noise = {c.x, c.y, c.z};
    }
    return rig;
}

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;

py::array_t<double> project(const rlf_camera &camera, const Points &points)
{
    if (points.ndim() != 2 || points.shape(1) != 3) {
        throw py::value_error("points: use an array (N, 3) of metres");
    }
    py::array_t<double> out({points.shape(0), py::ssize_t(2)});
    for (py::ssize_t i = 0; i < points.shape(0); i++) {
        double *pixel = out.mutable_data(i);
        if (!rlf_camera_project(&camera, {points.at(i, 0), points.at(i, 1), points.at(i, 2)}, pixel,
                                pixel + 1)) {
            pixel[0] = pixel[1] = NAN;
        }
    }
    return out;
}

void bind_camera(py::module_ &m)
{
    py::class_<rlf_camera>(m, "Camera", "A pinhole camera with lens distortion; lengths in pixels.")
        .def(py::init(&make_camera), py::arg("width"), py::arg("height"), py::arg("fx"),
             py::arg("fy"), py::arg("cx"), py::arg("cy"), py::arg("distortion_model") = "none",
             py::arg("distortion") = std::vector<double>())
        .def_readonly("width", &rlf_camera::width, "Pixels.")
        .def_readonly("height", &rlf_camera::height, "Pixels.")
        .def_readonly("fx", &rlf_camera::fx, "Focal length along x, pixels.")
        .def_readonly("fy", &rlf_camera::fy, "Focal length along y, pixels.")
        .def_readonly("cx", &rlf_camera::cx,
                      "Principal point, pixels; (0, 0) = centre of the first one.")
        .def_readonly("cy", &rlf_camera::cy, "The same along y.")
        .def("project", &project, py::arg("points"),
             "(N, 2) pixels of points (N, 3), camera frame; NaN behind it.")
        .def_property_readonly(
            "distortion_model", [](const rlf_camera &c) { return models[c.distortion_model]; },
            "\"none\", \"plumb_bob\" or \"rational_polynomial\", as OpenCV and ROS have them.")
        .def_property_readonly(
            "distortion",
            [](const rlf_camera &c) { return std::vector<double>(c.distortion, c.distortion + 8); },
            "k1 k2 p1 p2 k3 k4 k5 k6.")
        .def("__repr__", [](const rlf_camera &c) {
            return "<relief.Camera " + std::to_string(c.width) + " x " + std::to_string(c.height) +
                   ">";
        });
}

} // namespace

py::array_t<double> array_of(rlf_vec3 v)
{
    const double values[3] = {v.x, v.y, v.z};
    return py::array_t<double>(3, values);
}

py::array_t<double> matrix_of(const rlf_pose &T)
{
    const rlf_mat4 matrix = rlf_mat4_from_pose(&T);
    return py::array_t<double>({4, 4}, &matrix.m[0][0]);
}

rlf_vec3 vector_from(const py::object &value, const char *name)
{
    const Doubles a = numbers_from(value, name, {3}, "three finite numbers");
    return {a.data()[0], a.data()[1], a.data()[2]};
}

double number_from(const py::handle &value, const char *name)
{
    const double number = PyFloat_AsDouble(value.ptr());
    if (number == -1.0 && PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        throw py::type_error(std::string(name) + ": use a number");
    }
    return number;
}

std::string path_from(const py::object &value, const char *name, const char *kinds)
{
    const auto path = py::reinterpret_steal<py::object>(PyOS_FSPath(value.ptr()));
    if (!path || !PyUnicode_Check(path.ptr())) {
        PyErr_Clear();
        throw py::type_error(std::string(name) + ": use " + kinds);
    }
    const auto text = path.cast<std::string>();
    if (text.find('\0') != std::string::npos) {
        throw py::value_error(std::string(name) + ": holds a zero byte");
    }
    return text;
}

rlf_pose pose_from(const py::object &value, const char *name)
{
    const char *const words = "a 4 x 4 matrix of a rotation and a translation";
    const Doubles a = numbers_from(value, name, {4, 4}, words);
    rlf_mat3 r = {};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            r.m[i][k] = a.at(i, k);
        }
    }
    bool is_rotation = a.at(3, 0) == 0.0 && a.at(3, 1) == 0.0 && a.at(3, 2) == 0.0;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k <= i; k++) {
            double dot = 0.0;
            for (int c = 0; c < 3; c++) {
                dot += r.m[c][i] * r.m[c][k];
            }
            is_rotation = is_rotation && std::fabs(dot - (i == k ? 1.0 : 0.0)) < rotation_tolerance;
        }
    }
    const rlf_vec3 x = {r.m[0][0], r.m[1][0], r.m[2][0]}, y = {r.m[0][1], r.m[1][1], r.m[2][1]};
    const rlf_vec3 z = {r.m[0][2], r.m[1][2], r.m[2][2]};
    if (!is_rotation || rlf_dot(rlf_cross(x, y), z) < 0.0) {
        throw py::value_error(std::string(name) + ": use " + words);
    }
    return {{a.at(0, 3), a.at(1, 3), a.at(2, 3)}, rlf_quat_from_mat3(&r)};
}

int choice_from(const std::string &value, const char *const *words, const char *name)
{
    std::string all;
    for (int i = 0; words[i] != nullptr; i++) {
        if (value == words[i]) {
            return i;
        }
        all += (i > 0 ? ", " : "") + std::string(words[i]);
    }
    throw py::value_error(std::string(name) + " is \"" + value + "\": use one of " + all);
}

void bind_values(py::module_ &m)
{
    bind_camera(m);
    py::class_<rlf_rig>(
        m, "Rig",
        "The cameras of a sensor: depth, colour where there is one, the pose between them "
        "(p_color = color_from_depth p_depth), the range in metres and the noise of "
        "depth, sigma(z) = c0 + c1 z + c2 z^2 metres.")
        .def(py::init(&make_rig), py::arg("depth"), py::arg("color") = py::none(),
             py::arg("color_from_depth") = py::none(),
             py::arg("depth_range") = std::make_pair(0.1, 8.0), py::arg("noise") = py::none())
        .def_readonly("depth", &rlf_rig::depth, "Camera of the depth pictures.")
        .def_property_readonly(
            "color",
            [](const rlf_rig &r) -> py::object {
                return r.has_color ? py::cast(r.color) : py::none();
            },
            "Camera of the colour pictures, or None.")
        .def_property_readonly(
            "color_from_depth", [](const rlf_rig &r) { return matrix_of(r.T_color_depth); },
            "(4, 4): p_color = color_from_depth p_depth, metres.")
        .def_property_readonly(
            "depth_range",
            [](const rlf_rig &r) { return py::make_tuple(r.depth_min_m, r.depth_max_m); },
            "(nearest, farthest) that the sensor measures, metres.")
        .def_property_readonly(
            "noise",
            [](const rlf_rig &r) { return py::make_tuple(r.noise.c0, r.noise.c1, r.noise.c2); },
            "(c0, c1, c2) of depth's standard deviation c0 + c1 z + c2 z^2, metres.");
}
