// The surface of a frame: arrays over its planes.
#include "bind.hpp"

namespace
{

struct Surface {
    std::shared_ptr<Owner> owner;
    const rlf_surface *s;
    uint64_t step;

    void need_now() const
    {
        owner->need_open();
        if (step != owner->steps) {
            throw std::runtime_error("this surface is over: the pipeline has made another step; "
                                     "copy what is to stay");
        }
    }

    template <typename T> py::object plane(const T *data) const
    {
        return plane_of(owner, data, s->height, s->width);
    }

    // Three planes as one (H, W, 3) array; they lie equally far apart, so nothing is copied.
    py::object vectors(const float *x, const float *y, const float *z) const
    {
        if (x == nullptr) {
            return py::none();
        }
        const py::ssize_t size = sizeof(float);
        const py::ssize_t gap = (y - x) * size;
        if ((z - y) * size == gap) {
            return view_of(owner, py::dtype::of<float>(), x, {s->height, s->width, 3},
                           {s->width * size, size, gap});
        }
        py::array_t<float> out({s->height, s->width, 3});
        float *to = out.mutable_data();
        for (py::ssize_t i = 0; i < py::ssize_t(s->height) * s->width; i++) {
            to[3 * i] = x[i];
            to[3 * i + 1] = y[i];
            to[3 * i + 2] = z[i];
        }
        return std::move(out);
    }

    py::array_t<float> points(const float *depth) const
    {
        py::array_t<float> out({s->height, s->width, 3});
        float *to = out.mutable_data();
        const py::ssize_t count = py::ssize_t(s->height) * s->width;
        for (py::ssize_t i = 0; i < count; i++) {
            const float z = depth != nullptr ? depth[i] : 0.0f;
            to[3 * i] = z * s->ray_x[i];
            to[3 * i + 1] = z * s->ray_y[i];
            to[3 * i + 2] = z;
        }
        return out;
    }
};

const char *layer_name(const rlf_region &region)
{
    return region.layer == RLF_LAYER_FOREGROUND ? "foreground" : "background";
}

void bind_region(py::module_ &m)
{
    py::class_<rlf_region>(m, "Region", "A connected piece of the surface; metres, camera frame.")
        .def_readonly("label", &rlf_region::label, "Its value in Surface.label.")
        .def_property_readonly("layer", &layer_name, "\"foreground\" or \"background\".")
        .def_readonly("point_count", &rlf_region::point_count, "Pixels.")
        .def_property_readonly(
            "rectangle", [](const rlf_region &r) { return py::make_tuple(r.x0, r.y0, r.x1, r.y1); },
            "x0, y0, x1, y1 in pixels, x0 <= x < x1.")
        .def_property_readonly(
            "centroid", [](const rlf_region &r) { return array_of(r.centroid); }, "(3,), metres.")
        .def_property_readonly(
            "velocity", [](const rlf_region &r) { return array_of(r.linear_velocity); },
            "(3,), m/s of the centroid; 0 = still.")
        .def_property_readonly(
            "angular_velocity", [](const rlf_region &r) { return array_of(r.angular_velocity); },
            "(3,), rad/s.");
}

py::list regions_of(const Surface &surface)
{
    py::list out;
    for (int32_t i = 0; i < surface.s->region_count; i++) {
        out.append(py::cast(surface.s->regions[i]));
    }
    return out;
}

py::object find_up(const Surface &surface)
{
    rlf_vec3 up;
    const double confidence = rlf_surface_find_up(surface.s, &up);
    return py::make_tuple(array_of(up), confidence);
}

// A reading of the step that is: no other thread is in the pipeline meanwhile.
template <typename Get> auto of(Get get)
{
    return [get](const Surface &surface) {
        const Busy busy(*surface.owner);
        surface.need_now();
        return get(surface);
    };
}

using Plane = py::array_t<float, py::array::c_style | py::array::forcecast>;

const char *const methods[] = {"six_faces", "four_faces", "thesis", "inverse_depth", nullptr};

py::object compute_normals(const Plane &depth, const Plane &ray_x, const Plane &ray_y,
                           const std::string &method)
{
    const int chosen = choice_from(method, methods, "method");
    const bool fits = depth.ndim() == 2 && ray_x.ndim() == 2 && ray_y.ndim() == 2 &&
                      ray_x.size() == depth.size() && ray_y.size() == depth.size();
    if (!fits) {
        throw py::value_error("depth, ray_x, ray_y: use three planes (H, W) of one size");
    }
    const auto height = static_cast<int32_t>(depth.shape(0)), width = static_cast<int32_t>(depth.shape(1));
    py::array_t<float> out({py::ssize_t(3), depth.shape(0), depth.shape(1)});
    rlf_compute_normals(static_cast<rlf_normal_method>(chosen), true, width, height, ray_x.data(),
                        ray_y.data(), depth.data(), nullptr, out.mutable_data(0), out.mutable_data(1),
                        out.mutable_data(2));
    return out.attr("transpose")(1, 2, 0);
}

} // namespace

py::object surface_of(const std::shared_ptr<Owner> &owner, const rlf_surface *surface)
{
    return py::cast(Surface{owner, surface, owner->steps});
}

const rlf_surface *surface_in(const py::object &surface, std::shared_ptr<Owner> *out_owner)
{
    if (!py::isinstance<Surface>(surface)) {
        throw py::type_error("surface: use a Surface, as Step.surface gives it");
    }
    const auto &found = surface.cast<const Surface &>();
    found.need_now();
    *out_owner = found.owner;
    return found.s;
}

void bind_surface(py::module_ &m)
{
    bind_region(m);
    using P = const Surface &;
    py::class_<Surface>(m, "Surface",
                        "The surface of a step's frame, good until the next step. Its arrays are "
                        "read-only and show the "
                        "pipeline's memory: they may be kept, but the next step writes over them. "
                        "Metres, depth camera's frame: x right, y "
                        "down, z forward.")
        .def_property_readonly("width", of([](P p) { return p.s->width; }), "Pixels.")
        .def_property_readonly("height", of([](P p) { return p.s->height; }), "Pixels.")
        .def_property_readonly("camera", of([](P p) { return p.s->camera; }),
                               "The Camera of its pixels.")
        .def_property_readonly("depth", of([](P p) { return p.plane(p.s->depth); }),
                               "(H, W) float32, z; 0 = missing.")
        .def_property_readonly("points", of([](P p) { return p.points(p.s->depth); }),
                               "(H, W, 3) float32, made by this call; 0 where missing.")
        .def_property_readonly(
            "rays", of([](P p) {
                return py::make_tuple(p.plane(p.s->ray_x), p.plane(p.s->ray_y));
            }),
            "(x, y) of (H, W) float32: a pixel's point is depth (x, y, 1).")
        .def_property_readonly("normals", of([](P p) {
                                   return p.vectors(p.s->normal_x, p.s->normal_y, p.s->normal_z);
                               }),
                               "(H, W, 3) float32, unit, towards the camera; 0 where missing.")
        .def_property_readonly(
            "velocity",
            of([](P p) { return p.vectors(p.s->velocity_x, p.s->velocity_y, p.s->velocity_z); }),
            "(H, W, 3) float32, m/s; 0 = still; None where the profile has none.")
        .def_property_readonly("thickness", of([](P p) { return p.plane(p.s->thickness); }),
                               "(H, W) float32, solid behind depth along z; 0 = a sheet.")
        .def_property_readonly("label", of([](P p) { return p.plane(p.s->label); }),
                               "(H, W) int32, Region.label; 0 = none.")
        .def_property_readonly("reason", of([](P p) { return p.plane(p.s->reason); }),
                               "(H, W) uint8, see reason_names.")
        .def_property_readonly("foreground", of([](P p) { return p.plane(p.s->foreground); }),
                               "(H, W) uint8, 1 = moves in front of the room.")
        .def_property_readonly("background_depth",
                               of([](P p) { return p.plane(p.s->background_depth); }),
                               "(H, W) float32, the room behind what moves; 0 = unknown.")
        .def_property_readonly("background_normals", of([](P p) {
                                   return p.vectors(p.s->background_normal_x,
                                                    p.s->background_normal_y,
                                                    p.s->background_normal_z);
                               }),
                               "(H, W, 3) float32.")
        .def_property_readonly("background_thickness",
                               of([](P p) { return p.plane(p.s->background_thickness); }),
                               "(H, W) float32, solid behind background_depth; 0 = unknown.")
        .def_property_readonly("background_label", of([](P p) { return p.plane(p.s->background_label); }),
                               "(H, W) int32, as label, of the room behind what moves.")
        .def_property_readonly(
            "is_background_known",
            of([](P p) { return p.s->background_state == RLF_BACKGROUND_READY; }),
            "False while it is learned.")
        .def_property_readonly("scale_factor", of([](P p) { return p.s->scale_factor; }),
                               "Every so many pixels of the depth picture have one here.")
        .def_property_readonly("regions", of(&regions_of), "Pieces of both layers.")
        .def_property_readonly("is_blind", of([](P p) { return p.s->is_blind; }),
                               "No depth, or hardly any.")
        .def("find_up", of(&find_up),
             "(up, confidence): which way is up, and how sure, 0 to 1. Below UP_SURE it is a guess.");
    m.def("compute_normals", &compute_normals, py::arg("depth"), py::arg("ray_x"), py::arg("ray_y"),
          py::arg("method") = "inverse_depth",
          "(H, W, 3) float32 of a clean depth plane, towards the camera; 0 = none. method: "
          "\"inverse_depth\", \"thesis\", \"six_faces\" or \"four_faces\".");
    py::list names;
    for (int i = 0; i < RLF_REASON_COUNT; i++) {
        names.append(rlf_reason_name(static_cast<rlf_reason>(i)));
    }
    m.attr("reason_names") = py::tuple(names);
    m.attr("UP_SURE") = RLF_UP_SURE;
}
