// Sources and their frames.
#include "bind.hpp"

#include "relief/synthetic.h"

#include <cstring>

namespace
{

std::shared_ptr<SourceOwner> open_source(const py::object &name, int threads)
{
    const std::string text = path_from(name, "source", "the name of a source, a path or a Source");
    auto owner = std::make_shared<SourceOwner>();
    owner->pool = make_pool(threads);
    rlf_result result;
    {
        const Unlocked unlocked;
        result = rlf_open_source(text.c_str(), owner->pool, &owner->source);
    }
    check(result);
    return owner;
}

class Source
{
  public:
    Source(const py::object &name, int threads) : owner(open_source(name, threads)) {}

    const rlf_source_info &info() const { return *rlf_source_get_info(source_in(owner)); }

    py::object next()
    {
        rlf_source *source = source_in(owner);
        const Busy busy(*owner);
        rlf_frame frame;
        rlf_result result;
        do { // a live camera: until there is a frame, or Ctrl-C
            {
                const Unlocked unlocked;
                result = rlf_source_next(source, &frame);
            }
            if (PyErr_CheckSignals() != 0) {
                throw py::error_already_set();
            }
        } while (check(result) == RLF_NO_FRAME);
        if (result == RLF_END) {
            throw py::stop_iteration();
        }
        owner->steps++;
        return frame_copy(frame);
    }

    void restart()
    {
        change([](rlf_source *source) { return rlf_source_restart(source); });
    }

    void seek(int64_t index)
    {
        change([index](rlf_source *source) { return rlf_source_seek(source, index); });
    }

    void close()
    {
        const Busy busy(*owner);
        owner->is_closed = true;
        const Unlocked unlocked;
        rlf_source_destroy(&owner->source);
    }

    // The scene's nearest surface to each of (N, 3) points: arrays of distances, normals, velocities
    // and labels.
    py::tuple nearest(const py::object &points, const py::object &time) const
    {
        const auto p = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(points);
        if (!p || p.ndim() != 2 || p.shape(1) != 3) {
            throw py::value_error("points: use an array (N, 3) of metres");
        }
        const py::ssize_t count = p.shape(0);
        py::array_t<double> distance(count), normal({count, py::ssize_t(3)}),
            velocity({count, py::ssize_t(3)});
        py::array_t<int32_t> label(count);
        const bool is_now = time.is_none();
        const double at = is_now ? 0.0 : number_from(time, "time");
        rlf_source *source = source_in(owner);
        const Busy busy(*owner);
        for (py::ssize_t i = 0; i < count; i++) {
            const rlf_vec3 place = {p.at(i, 0), p.at(i, 1), p.at(i, 2)};
            rlf_synthetic_hit hit = {};
            check(is_now ? rlf_synthetic_distance(source, place, &hit.distance, &hit.normal, &hit.label)
                         : rlf_synthetic_nearest(source, at, place, &hit));
            distance.mutable_at(i) = hit.distance;
            label.mutable_at(i) = hit.label;
            put(hit.normal, normal.mutable_data(i));
            put(hit.velocity, velocity.mutable_data(i));
        }
        return py::make_tuple(distance, normal, velocity, label);
    }

    // The truth of the last frame as arrays, copied; None of a source that does not know it.
    py::object truth() const
    {
        rlf_source *source = source_in(owner);
        const Busy busy(*owner);
        const rlf_truth *t = rlf_source_get_truth(source);
        if (t == nullptr) {
            return py::none();
        }
        const rlf_camera &c = info().rig.depth;
        py::dict out;
        out["depth"] = plane(t->depth, c);
        out["normals"] = vectors(t->normal_x, t->normal_y, t->normal_z, c);
        out["label"] = plane(t->label, c);
        out["foreground"] = plane(t->foreground, c);
        out["thickness"] = plane(t->thickness, c);
        out["velocity"] = vectors(t->velocity_x, t->velocity_y, t->velocity_z, c);
        out["background_depth"] = plane(t->background_depth, c);
        py::list poses;
        for (int32_t i = 0; i < t->pose_count; i++) {
            const rlf_truth_pose &pose = t->poses[i];
            poses.append(py::make_tuple(std::string(pose.name), pose.label,
                                        matrix_of(pose.T_camera_object)));
        }
        out["poses"] = poses;
        return std::move(out);
    }

    py::array_t<double> down() const
    {
        rlf_vec3 out = {};
        check(rlf_synthetic_get_down(source_in(owner), &out));
        return array_of(out);
    }

    std::shared_ptr<SourceOwner> owner;

  private:
    static void put(rlf_vec3 v, double *out)
    {
        out[0] = v.x;
        out[1] = v.y;
        out[2] = v.z;
    }

    template <typename T> static py::array_t<T> plane(const T *data, const rlf_camera &c)
    {
        return py::array_t<T>({py::ssize_t(c.height), py::ssize_t(c.width)}, data);
    }

    static py::array_t<float> vectors(const float *x, const float *y, const float *z,
                                      const rlf_camera &c)
    {
        py::array_t<float> out({py::ssize_t(3), py::ssize_t(c.height), py::ssize_t(c.width)});
        const size_t bytes = sizeof(float) * static_cast<size_t>(c.width) * static_cast<size_t>(c.height);
        const float *const planes[3] = {x, y, z};
        for (py::ssize_t k = 0; k < 3; k++) {
            std::memcpy(out.mutable_data(k), planes[k], bytes);
        }
        return py::array_t<float>(out.attr("transpose")(1, 2, 0));
    }

    template <typename Call> void change(Call call)
    {
        rlf_source *source = source_in(owner);
        const Busy busy(*owner);
        owner->steps++;
        rlf_result result;
        {
            const Unlocked unlocked;
            result = call(source);
        }
        check(result);
    }
};

// 16 bits a channel: (H, W) of depth, (H, W, 3) of colour.
py::object read_png(const py::object &path)
{
    const std::string text = path_from(path, "path", "the path of a PNG");
    uint16_t *data = nullptr;
    int32_t width, height;
    py::ssize_t channels = 3;
    if (rlf_png_read_rgb_u16(text.c_str(), &data, &width, &height) != RLF_OK) {
        channels = 1;
        check(rlf_png_read_u16(text.c_str(), &data, &width, &height));
    }
    std::vector<py::ssize_t> shape = {height, width};
    if (channels == 3) {
        shape.push_back(channels);
    }
    const py::array_t<uint16_t> out(shape, data);
    rlf_free(data);
    return out;
}

// 8 bits a channel, of a PNG or a JPEG.
py::object read_picture(const py::object &path)
{
    const std::string text = path_from(path, "path", "the path of a picture");
    rlf_image_rgba8 image = {};
    check(rlf_picture_read(text.c_str(), &image));
    const py::array_t<uint8_t> out({py::ssize_t(image.height), py::ssize_t(image.width), py::ssize_t(4)},
                                   {py::ssize_t(image.stride), py::ssize_t(4), py::ssize_t(1)}, image.data);
    rlf_free(image.data);
    return out;
}

} // namespace

SourceOwner::~SourceOwner()
{
    const Unlocked unlocked;
    rlf_source_destroy(&source);
    rlf_pool_destroy(&pool);
}

rlf_source *source_in(const std::shared_ptr<SourceOwner> &owner)
{
    owner->need_open();
    return owner->source;
}

std::shared_ptr<SourceOwner> source_from(const py::object &source, int threads)
{
    return py::isinstance<Source>(source) ? source.cast<const Source &>().owner
                                          : open_source(source, threads);
}

void bind_source(py::module_ &m)
{
    py::class_<Source>(m, "Source", "A camera or a recording; iterate it for its frames.")
        .def(py::init<const py::object &, int>(), py::arg("name"), py::arg("threads") = 1)
        .def_property_readonly(
            "name", [](const Source &s) { return std::string(s.info().name); }, "As it was opened.")
        .def_property_readonly(
            "rig", [](const Source &s) { return s.info().rig; }, "Its cameras, a Rig.")
        .def_property_readonly(
            "frame_count",
            [](const Source &s) -> py::object {
                const int64_t n = s.info().frame_count;
                return n < 0 ? py::object(py::none()) : py::cast(n);
            },
            "None = unknown or endless.")
        .def_property_readonly(
            "frames_per_second", [](const Source &s) { return s.info().frames_per_second; },
            "Nominal; 0 = unknown.")
        .def_property_readonly(
            "is_live", [](const Source &s) { return s.info().is_live; },
            "True: a camera; the newest frame wins.")
        .def_property_readonly(
            "device", [](const Source &s) { return std::string(s.info().device); },
            "Driver, model and serial number, or the format; \"\" = unknown.")
        .def("restart", &Source::restart, "The first frame is the next one again.")
        .def("seek", &Source::seek, py::arg("index"), "Makes frame `index`, from 0, the next one.")
        .def_property_readonly(
            "truth", &Source::truth,
            "What a synthetic room knows of its last frame, copied: depth, normals, label, foreground, "
            "thickness, velocity, background_depth as arrays, and poses, a list of (name, label, pose) "
            "of what moves; None of any other source.")
        .def_property_readonly("down", &Source::down,
                               "Unit vector towards a synthetic room's floor, camera frame.")
        .def("nearest", &Source::nearest, py::arg("points"), py::arg("time") = py::none(),
             "(distance, normal, velocity, label) of a synthetic room's surface nearest to each of "
             "points (N, 3), camera frame: as at its last frame, without velocity, or at `time`, seconds. "
             "Negative inside a solid.")
        .def("close", &Source::close, "Gives the camera or the file back; again it does nothing.")
        .def("__iter__", [](py::object self) { return self; })
        .def("__next__", &Source::next)
        .def("__enter__", [](py::object self) { return self; })
        .def("__exit__", [](Source &s, const py::args &) { s.close(); });
    m.def("read_png", &read_png, py::arg("path"),
          "A PNG of 16 bits a channel as uint16: (H, W) of grey, (H, W, 3) of colour.");
    m.def("read_picture", &read_picture, py::arg("path"), "A PNG or JPEG as (H, W, 4) uint8, RGBA.");
    m.def(
        "open",
        [](const py::object &name, int threads) { return std::make_unique<Source>(name, threads); },
        py::arg("name"), py::arg("threads") = 1,
        "Opens a camera, a recording or a synthetic room, as the command's SOURCE. threads 0 = one "
        "per processor.");
}
