// Models of known real things.
#include "bind.hpp"

namespace
{

struct Known {
    std::string name;
    const char *shape;
    py::object pose;
};

rlf_vec3 model_point(const rlf_shape &shape, const py::object &value)
{
    if (!py::isinstance<py::str>(value)) {
        return vector_from(value, "points: model");
    }
    const auto name = value.cast<std::string>();
    rlf_vec3 point;
    if (!rlf_known_name_point(&shape, name.c_str(), &point)) {
        throw py::value_error("points: the shape has no point \"" + name +
                              "\": use three letters of l c r, t c b and n c f, as \"ltn\"");
    }
    return point;
}

rlf_known_point point_from(const rlf_shape &shape, const py::object &value)
{
    if (!py::isinstance<py::sequence>(value) || py::len(value) != 2) {
        throw py::type_error("points: use pairs of (model, place)");
    }
    const auto pair = py::reinterpret_borrow<py::sequence>(value);
    rlf_known_point out = {};
    out.model = model_point(shape, pair[0]);
    const py::object place = pair[1];
    if (py::isinstance<py::str>(place) || !py::hasattr(place, "__len__")) {
        throw py::type_error("points: place: use a pixel (x, y), or three metres in the world");
    }
    out.has_pixel = py::len(place) == 2;
    if (!out.has_pixel) {
        out.world = vector_from(place, "points: place in the world");
        return out;
    }
    const py::object x = place[py::int_(0)], y = place[py::int_(1)];
    out.pixel[0] = number_from(x, "points: pixel");
    out.pixel[1] = number_from(y, "points: pixel");
    return out;
}

void take_points(const py::object &points, rlf_known_def &def)
{
    if (!py::isinstance<py::sequence>(points) || py::isinstance<py::str>(points)) {
        throw py::type_error("points: use a list of (model, place)");
    }
    const size_t count = py::len(points);
    if (count < RLF_KNOWN_POINTS_MIN || count > RLF_KNOWN_POINTS_MAX) {
        throw py::value_error("points: use three to six, not " + std::to_string(count));
    }
    for (const auto &point : points) {
        def.points[def.point_count++] =
            point_from(def.shape, py::reinterpret_borrow<py::object>(point));
    }
}

rlf_known_def def_from(const std::string &name, const KnownIn &more)
{
    rlf_known_def def = rlf_known_def_default();
    name_from(name, def.name);
    if (name.empty()) {
        throw py::value_error("name: use at least one byte");
    }
    if (more.pose.is_none() == more.points.is_none()) {
        throw py::value_error("set_known: give either pose or points");
    }
    def.shape = shape_from(more.shape, more.size, more.radius, more.height);
    def.refine = more.refine;
    def.collides = more.collides;
    def.restitution = more.restitution;
    def.friction = more.friction;
    if (more.points.is_none()) {
        def.T_world_model = pose_from(more.pose, "pose");
    } else {
        def.has_pose = false;
        take_points(more.points, def);
    }
    return def;
}

} // namespace

py::object set_known(rlf_pipeline *pipeline, const std::string &name, const KnownIn &more)
{
    const rlf_known_def def = def_from(name, more);
    rlf_known_fit fit = {};
    rlf_result result;
    {
        const Unlocked unlocked;
        result = rlf_pipeline_set_known(pipeline, &def, &fit);
    }
    if (check(result) == RLF_NO_FRAME) {
        throw py::value_error("points: there is no frame yet to find them in: make a step first");
    }
    return py::cast(fit);
}

py::list known_of(const rlf_pipeline *pipeline)
{
    int32_t count = 0;
    const rlf_known_def *defs = rlf_pipeline_get_known(pipeline, &count);
    py::list out;
    for (int32_t i = 0; i < count; i++) {
        const bool is_placed = defs[i].has_pose && defs[i].point_count == 0;
        out.append(Known{defs[i].name, shape_name(defs[i].shape.type),
                         is_placed ? py::object(matrix_of(defs[i].T_world_model)) : py::none()});
    }
    return out;
}

void bind_known(py::module_ &m)
{
    using F = const rlf_known_fit &;
    py::class_<rlf_known_fit>(m, "KnownFit",
                              "The pose of a known real thing, and how well it fits.")
        .def_property_readonly(
            "pose", [](F f) { return matrix_of(f.T_world_model); },
            "(4, 4): the model in the world.")
        .def_readonly("depth_count", &rlf_known_fit::depth_count, "Picks with depth.")
        .def_readonly("pick_rms", &rlf_known_fit::pick_rms,
                      "Metres between the points with depth and the model's.")
        .def_readonly("pick_rms_px", &rlf_known_fit::pick_rms_px,
                      "Pixels between the picked ones and the model's; 0 without.")
        .def_readonly("surface_count", &rlf_known_fit::surface_count,
                      "Surface points on the model; 0 = not refined.")
        .def_readonly("surface_rms", &rlf_known_fit::surface_rms,
                      "Metres from those to the model.");
    py::class_<Known>(m, "Known", "A model of a real thing, copied.")
        .def_readonly("name", &Known::name, "As it was set, or as the scene says.")
        .def_readonly("shape", &Known::shape, "As Body.shape.")
        .def_readonly("pose", &Known::pose,
                      "(4, 4): the model in the world; None = it waits for its points.");
}
