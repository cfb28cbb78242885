// The frame loop, and what a step of it gives.
#include "bind.hpp"

#include <cstring>

namespace {

struct PipelineOwner : Owner {
    std::shared_ptr<SourceOwner> source; // none when frames are pushed
    rlf_pool *pool = nullptr;
    rlf_scene scene = {};
    rlf_pipeline *pipeline = nullptr;
    rlf_rig rig = {};
    uint64_t step = 0; // counts them: a Step of an earlier one is over

    PipelineOwner() : Owner("pipeline") {}
    ~PipelineOwner() override
    {
        rlf_pipeline_destroy(&pipeline);
        rlf_scene_destroy(&scene);
        rlf_pool_destroy(&pool);
    }
};

// A call that reads the source, too: nobody may close it meanwhile.
class Use {
public:
    explicit Use(PipelineOwner &owner)
    {
        owner.need_open();
        pipeline_ = std::make_unique<Busy>(owner);
        if (owner.source != nullptr) {
            source_in(owner.source);
            source_ = std::make_unique<Busy>(*owner.source);
        }
    }

private:
    std::unique_ptr<Busy> pipeline_, source_;
};

const char *const profiles[] = {"live", "thesis", nullptr};
const char *const modes[] = {"fixed", "moving", "auto", nullptr};
const char *const origins[] = {"tracked", "source", nullptr};

struct Step {
    std::shared_ptr<PipelineOwner> owner;
    rlf_pipeline_output out;
    uint64_t step;

    const rlf_pipeline_output &now() const
    {
        owner->need_open();
        if (step != owner->step) {
            throw std::runtime_error("this step is over: the pipeline has made another one; copy "
                                     "what is to stay");
        }
        return out;
    }

    py::object image(const rlf_image_rgba8 &picture) const
    {
        if (picture.data == nullptr) {
            return py::none();
        }
        return view_of(owner, py::dtype::of<uint8_t>(), picture.data,
                       {picture.height, picture.width, 4}, {picture.stride, 4, 1});
    }
};

// Depth and colour of the caller's, for one push.
struct Pushed {
    py::array depth, color;
    std::vector<uint8_t> rgba;
    rlf_frame frame = {};
};

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

// Rows that lie in memory pixel by pixel; else a copy that does.
py::array packed_rows(const py::array &a)
{
    py::ssize_t step = a.itemsize();
    bool is_packed = a.strides(0) > 0;
    for (py::ssize_t i = a.ndim() - 1; i > 0; i--) {
        is_packed = is_packed && a.strides(i) == step;
        step *= a.shape(i);
    }
    return is_packed && a.strides(0) >= step ? a : py::array::ensure(a, py::array::c_style);
}

void take_depth(const py::object &value, double units_per_metre, const rlf_camera &camera,
                Pushed &out)
{
    if (!py::isinstance<py::array>(value)) {
        throw py::type_error("depth: use a NumPy array");
    }
    out.depth = value.cast<py::array>();
    const bool is_u16 = out.depth.dtype().is(py::dtype::of<uint16_t>());
    if (!is_u16 && !out.depth.dtype().is(py::dtype::of<float>())) {
        throw py::type_error("depth has dtype " + std::string(py::str(out.depth.dtype())) +
                             ": use uint16 (units) or float32 (metres)");
    }
    need_shape(out.depth, "depth", camera.height, camera.width, 0);
    out.depth = packed_rows(out.depth);
    out.frame.depth_stride = out.depth.strides(0);
    if (is_u16) {
        out.frame.depth_u16 = static_cast<const uint16_t *>(out.depth.data());
        out.frame.depth_units_per_metre = units_per_metre;
    } else {
        out.frame.depth_f32 = static_cast<const float *>(out.depth.data());
    }
}

void take_color(const py::object &value, const rlf_rig &rig, Pushed &out)
{
    if (value.is_none()) {
        return;
    }
    if (!rig.has_color) {
        throw py::value_error("color: this pipeline's rig has no colour camera");
    }
    if (!py::isinstance<py::array>(value)) {
        throw py::type_error("color: use a NumPy array");
    }
    out.color = value.cast<py::array>();
    if (!out.color.dtype().is(py::dtype::of<uint8_t>())) {
        throw py::type_error("color has dtype " + std::string(py::str(out.color.dtype())) +
                             ": use uint8");
    }
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
    out.frame.color = image;
}

int64_t nanoseconds(double seconds)
{
    if (!(seconds > -4e9 && seconds < 4e9)) { // as RLF_TIME_MAX_NS
        throw py::value_error("time: use seconds, at most 4e9");
    }
    return static_cast<int64_t>(seconds * 1e9 + (seconds < 0.0 ? -0.5 : 0.5));
}

class Pipeline {
public:
    Pipeline(const py::object &source, const py::object &scene, const std::string &profile,
             const std::string &camera, const std::string &poses, const py::object &gravity,
             bool render, bool hands, int threads)
        : owner_(std::make_shared<PipelineOwner>())
    {
        check(rlf_pool_create(threads, &owner_->pool));
        const auto chosen = static_cast<rlf_profile>(choice_from(profile, profiles, "profile"));
        rlf_pipeline_def def = start(source, chosen, threads);
        owner_->rig = def.reconstruct.rig;
        def.camera = static_cast<rlf_camera_mode>(choice_from(camera, modes, "camera"));
        def.poses = static_cast<rlf_pose_origin>(choice_from(poses, origins, "poses"));
        def.enable_render = render;
        def.enable_hands = hands;
        if (!scene.is_none()) {
            const auto path = py::str(scene).cast<std::string>();
            check(rlf_scene_load(path.c_str(), &owner_->scene));
            def.scene = &owner_->scene;
        }
        check(rlf_pipeline_create(&def, &owner_->pipeline));
        if (!gravity.is_none()) {
            rlf_world_set_gravity(rlf_pipeline_get_world(owner_->pipeline),
                                  vector_from(gravity, "gravity"));
        }
    }

    // The next step; None when a live camera has nothing new.
    py::object step()
    {
        return run([](rlf_pipeline *p, rlf_pipeline_output *out) {
            return rlf_pipeline_step(p, out);
        });
    }

    py::object next()
    {
        py::object made = step();
        while (made.is_none()) {
            if (PyErr_CheckSignals() != 0) {
                throw py::error_already_set();
            }
            if (owner_->source == nullptr) {
                throw py::value_error("this pipeline has no source: push its frames");
            }
            made = step();
        }
        return made;
    }

    py::object push(const py::object &depth, const py::object &color, double time,
                    double units_per_metre, const py::object &pose)
    {
        owner_->need_open();
        Pushed pushed;
        take_depth(depth, units_per_metre, owner_->rig.depth, pushed);
        take_color(color, owner_->rig, pushed);
        pushed.frame.time_ns = nanoseconds(time);
        pushed.frame.sequence = owner_->step;
        if (!pose.is_none()) {
            pushed.frame.T_world_camera = pose_from(pose, "pose");
            pushed.frame.has_pose = true;
        }
        return run([&pushed](rlf_pipeline *p, rlf_pipeline_output *out) {
            return rlf_pipeline_push(p, &pushed.frame, out);
        });
    }

    void restart()
    {
        const Use use(*owner_);
        owner_->need_no_arrays("a restart");
        check(rlf_pipeline_restart(owner_->pipeline));
        owner_->step++;
    }

    void set_view(const std::string &name)
    {
        owner_->need_open();
        const Busy busy(*owner_);
        rlf_view view;
        if (!rlf_view_parse(name.c_str(), &view)) {
            throw py::value_error("view is \"" + name + "\": see relief.view_names");
        }
        rlf_pipeline_set_view(owner_->pipeline, view);
    }

    py::object world() const
    {
        owner_->need_open();
        return world_of(owner_, rlf_pipeline_get_world(owner_->pipeline));
    }

    // Its memory goes when the last array over it does.
    void close()
    {
        const Busy busy(*owner_);
        owner_->is_closed = true;
    }

private:
    rlf_pipeline_def start(const py::object &source, rlf_profile profile, int threads)
    {
        if (py::isinstance<rlf_rig>(source)) {
            const rlf_rig rig = source.cast<rlf_rig>();
            return rlf_pipeline_def_for_rig(profile, &rig, owner_->pool);
        }
        if (py::isinstance<rlf_camera>(source)) {
            rlf_rig rig = rlf_rig_default();
            rig.depth = source.cast<rlf_camera>();
            return rlf_pipeline_def_for_rig(profile, &rig, owner_->pool);
        }
        owner_->source = py::hasattr(source, "_owner")
                             ? source.attr("_owner").cast<std::shared_ptr<SourceOwner>>()
                             : open_source(py::str(source).cast<std::string>(), threads);
        return rlf_pipeline_def_default(profile, source_in(owner_->source), owner_->pool);
    }

    template <typename Call> py::object run(Call call)
    {
        const Use use(*owner_);
        Step made = {owner_, {}, 0};
        rlf_result result;
        {
            const py::gil_scoped_release release;
            result = call(owner_->pipeline, &made.out);
        }
        if (check(result) == RLF_END) {
            throw py::stop_iteration();
        }
        if (result == RLF_NO_FRAME) {
            return py::none();
        }
        made.step = ++owner_->step;
        return py::cast(std::move(made));
    }

    std::shared_ptr<PipelineOwner> owner_;
};

py::dict times_of(const Step &s)
{
    const rlf_stage_times &t = s.now().times;
    py::dict out;
    out["capture"] = t.capture_ms;
    out["surface"] = t.surface_ms;
    out["physics"] = t.physics_ms;
    out["render"] = t.render_ms;
    return out;
}

void bind_step(py::module_ &m)
{
    using S = const Step &;
    py::class_<Step>(m, "Step", "What one frame gave. Good until the pipeline's next step.")
        .def_property_readonly("index", [](S s) { return s.now().frame_index; })
        .def_property_readonly("time", [](S s) { return s.now().time_s; },
                               "Seconds since the first frame.")
        .def_property_readonly("frame", [](S s) { return frame_copy(s.now().frame); },
                               "The frame, copied.")
        .def_property_readonly("surface",
                               [](S s) { return surface_of(s.owner, s.now().surface); })
        .def_property_readonly("bodies", [](S s) { return bodies_of(s.now().snapshot); })
        .def_property_readonly("contacts", [](S s) { return contacts_of(s.now().snapshot); })
        .def_property_readonly("events", [](S s) { return events_of(s.now().snapshot); },
                               "(\"begin\" or \"end\", body, other) of this step.")
        .def_property_readonly("camera_pose",
                               [](S s) { return matrix_of(s.now().T_world_camera); },
                               "(4, 4): the depth camera in the world.")
        .def_property_readonly("track",
                               [](S s) -> py::object {
                                   const rlf_track_result *track = s.now().track;
                                   return track == nullptr
                                              ? py::object(py::none())
                                              : py::str(rlf_track_health_name(track->health));
                               },
                               "\"good\", \"weak\" or \"lost\" of a moving camera; else None.")
        .def_property_readonly("picture", [](S s) { return s.image(s.now().render.image); },
                               "(H, W, 4) uint8, or None without rendering.")
        .def_property_readonly("matte",
                               [](S s) -> py::object {
                                   const rlf_plane_u8 &matte = s.now().render.matte;
                                   if (matte.data == nullptr) {
                                       return py::none();
                                   }
                                   return view_of(s.owner, py::dtype::of<uint8_t>(), matte.data,
                                                  {matte.height, matte.width}, {matte.stride, 1});
                               },
                               "(H, W) uint8, alpha of all that is virtual.")
        .def_property_readonly("times_ms", &times_of, "Wall time of the stages.")
        .def_property_readonly("latency_ms", [](S s) { return s.now().latency_ms; });
}

} // namespace

void bind_pipeline(py::module_ &m)
{
    bind_step(m);
    py::class_<Pipeline>(m, "Pipeline", "The frame loop: source, surface, physics, picture.")
        .def(py::init<const py::object &, const py::object &, const std::string &,
                      const std::string &, const std::string &, const py::object &, bool, bool,
                      int>(),
             py::arg("source"), py::kw_only(), py::arg("scene") = py::none(),
             py::arg("profile") = "live", py::arg("camera") = "auto", py::arg("poses") = "tracked",
             py::arg("gravity") = py::none(), py::arg("render") = true, py::arg("hands") = false,
             py::arg("threads") = 0,
             "source: a name as for open(), a Source, or a Rig or Camera whose frames are pushed. "
             "scene: the path of a scene.json.")
        .def("step", &Pipeline::step, "The next Step; None when a live camera has nothing new.")
        .def("push", &Pipeline::push, py::arg("depth"), py::arg("color") = py::none(),
             py::kw_only(), py::arg("time"), py::arg("units_per_metre") = 1000.0,
             py::arg("pose") = py::none(),
             "A step with a frame of your own: depth (H, W) uint16 or float32 metres, color (H, W, 3 "
             "or 4) uint8, time in seconds.")
        .def("restart", &Pipeline::restart, "As at the first frame.")
        .def("set_view", &Pipeline::set_view, py::arg("name"), "What the next pictures show.")
        .def_property_readonly("world", &Pipeline::world)
        .def("close", &Pipeline::close)
        .def("__iter__", [](py::object self) { return self; })
        .def("__next__", &Pipeline::next)
        .def("__enter__", [](py::object self) { return self; })
        .def("__exit__", [](Pipeline &p, const py::args &) { p.close(); });
    py::list names;
    for (int i = 0; i < RLF_VIEW_COUNT; i++) {
        names.append(rlf_view_name(static_cast<rlf_view>(i)));
    }
    m.attr("view_names") = py::tuple(names);
}
