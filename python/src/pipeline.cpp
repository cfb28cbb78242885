// The frame loop.
#include "bind.hpp"

extern "C" {
#include "settings.h"
}

namespace
{

// A call that reads the source, too: nobody may close it meanwhile.
class Use
{
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

class Pipeline
{
  public:
    Pipeline(const py::object &source, const py::object &scene, const std::string &profile,
             const std::string &camera, const std::string &poses, const py::object &gravity,
             bool render, bool hands, bool grab, int threads, const py::dict &settings, int scale)
        : owner_(std::make_shared<PipelineOwner>())
    {
        owner_->pool = make_pool(threads);
        const auto chosen = static_cast<rlf_profile>(choice_from(profile, profiles, "profile"));
        const std::vector<rlf_placed_camera> cameras = cameras_from(source);
        const bool is_list = !cameras.empty();
        const py::object first = is_list ? py::str(cameras[0].source) : source;
        rlf_pipeline_def def = start(first, chosen, threads);
        owner_->rig = def.reconstruct.rig;
        def.camera = static_cast<rlf_camera_mode>(choice_from(camera, modes, "camera"));
        def.poses = static_cast<rlf_pose_origin>(choice_from(poses, origins, "poses"));
        if (scale != 0) {
            set_scale(scale, &def.reconstruct);
        }
        apply(settings, &def.reconstruct);
        if (is_list) {
            def.camera = RLF_CAMERA_FIXED;
            def.T_world_camera = cameras[0].T_world_camera;
            def.world.camera_capacity = static_cast<int32_t>(cameras.size());
        }
        def.enable_render = render;
        def.enable_hands = hands;
        def.world.enable_grab = grab;
        if (!scene.is_none()) {
            const std::string path = path_from(scene, "scene", "the path of a scene.json");
            check(rlf_scene_load(path.c_str(), &owner_->scene));
            def.scene = &owner_->scene;
        }
        const rlf_vec3 down = gravity.is_none() ? rlf_vec3{} : vector_from(gravity, "gravity");
        rlf_result result;
        {
            const Unlocked unlocked;
            result = rlf_pipeline_create(&def, &owner_->pipeline);
            for (size_t k = 1; k < cameras.size() && result == RLF_OK; k++) {
                result = join(cameras[k]);
            }
        }
        check(result);
        if (!gravity.is_none()) {
            rlf_world_set_gravity(rlf_pipeline_get_world(owner_->pipeline), down);
        }
    }

    // The next step; None when a live camera has nothing new.
    py::object step()
    {
        return run(
            [](rlf_pipeline *p, rlf_pipeline_output *out) { return rlf_pipeline_step(p, out); });
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
        auto pushed = std::make_shared<FrameIn>();
        take_depth(depth, units_per_metre, owner_->rig, *pushed);
        take_color(color, owner_->rig, *pushed);
        pushed->c.time_ns = nanoseconds(time);
        pushed->c.sequence = owner_->steps;
        if (!pose.is_none()) {
            pushed->c.T_world_camera = pose_from(pose, "pose");
            pushed->c.has_pose = true;
        }
        return run(
            [&pushed](rlf_pipeline *p, rlf_pipeline_output *out) {
                return rlf_pipeline_push(p, &pushed->c, out);
            },
            pushed);
    }

    void restart()
    {
        const Use use(*owner_);
        if (owner_->source == nullptr) {
            throw py::value_error("restart: this pipeline has no source: make another pipeline");
        }
        owner_->need_no_arrays("a restart");
        owner_->steps++;
        owner_->source->steps++;
        rlf_result result;
        {
            const Unlocked unlocked;
            result = rlf_pipeline_restart(owner_->pipeline);
        }
        check(result);
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

    void set_hands(bool is_on)
    {
        owner_->need_open();
        const Busy busy(*owner_);
        check(rlf_pipeline_set_hands(owner_->pipeline, is_on));
    }

    py::object set_known(const std::string &name, const KnownIn &more)
    {
        owner_->need_open();
        const Busy busy(*owner_);
        return ::set_known(owner_->pipeline, name, more);
    }

    py::list known() const
    {
        owner_->need_open();
        const Busy busy(*owner_);
        return known_of(owner_->pipeline);
    }

    // Functions of the caller's, called between steps, when the pipeline is free for any call.
    void listen(py::object Pipeline::*which, const py::object &function, const char *name)
    {
        owner_->need_open();
        if (!function.is_none() && PyCallable_Check(function.ptr()) == 0) {
            throw py::type_error(std::string(name) + ": use a function, or None");
        }
        this->*which = function;
    }

    // Its memory goes when the last array over it does.
    void close()
    {
        const Busy busy(*owner_);
        owner_->is_closed = true;
        on_contact = on_hand = py::none();
    }

    // The rig of its frames, and their rate.
    rlf_source_info info() const
    {
        owner_->need_open();
        if (owner_->source != nullptr) {
            return *rlf_source_get_info(source_in(owner_->source));
        }
        rlf_source_info info = {};
        info.rig = owner_->rig;
        info.frame_count = -1;
        return info;
    }

    py::object on_contact = py::none(), on_hand = py::none();

  private:
    // The same smallest region on another grid.
    static void set_scale(int scale, rlf_reconstruct_def *def)
    {
        if (scale < 1 || scale > 64) {
            throw py::value_error("scale: use a number from 1 to 64, or 0 for the profile's");
        }
        const double ratio = static_cast<double>(def->scale_factor) / scale;
        const double points = def->min_region_points * ratio * ratio;
        def->min_region_points = points < 1.0 ? 1 : static_cast<int32_t>(points + 0.5);
        def->scale_factor = scale;
    }

    // As `--set NAME=VALUE` of the command.
    static void apply(const py::dict &settings, rlf_reconstruct_def *def)
    {
        setting_list list = {};
        for (const auto &item : settings) {
            const bool is_switch = py::isinstance<py::bool_>(item.second);
            const std::string value = !is_switch                 ? py::str(item.second)
                                      : item.second.cast<bool>() ? "on"
                                                                 : "off";
            check(settings_add(&list, (std::string(py::str(item.first)) + "=" + value).c_str()));
        }
        settings_apply(&list, def);
    }

    // The cameras of a list, FILE.json; none where the source is anything else.
    static std::vector<rlf_placed_camera> cameras_from(const py::object &source)
    {
        const bool is_name = py::isinstance<py::str>(source) || py::hasattr(source, "__fspath__");
        const std::string name = is_name ? path_from(source, "source", "a name") : "";
        if (name.size() <= 5 || name.compare(name.size() - 5, 5, ".json") != 0 ||
            name.find('?') != std::string::npos) {
            return {};
        }
        std::vector<rlf_placed_camera> out(RLF_WORLD_CAMERAS_MAX);
        int32_t count = 0;
        check(rlf_cameras_load(name.c_str(), out.data(), &count));
        out.resize(static_cast<size_t>(count));
        return out;
    }

    // Opens a camera beside the first. The pipeline that reads it goes before its source.
    rlf_result join(const rlf_placed_camera &camera)
    {
        owner_->joined.push_back({});
        JoinedCamera &one = owner_->joined.back();
        const rlf_result result = rlf_open_source(camera.source, owner_->pool, &one.source);
        if (result != RLF_OK) {
            return result;
        }
        const rlf_pipeline_def def =
            rlf_pipeline_def_joining(owner_->pipeline, one.source, &camera.T_world_camera);
        return rlf_pipeline_create(&def, &one.pipeline);
    }

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
        owner_->source = source_from(source, threads);
        return rlf_pipeline_def_default(profile, source_in(owner_->source), owner_->pool);
    }

    template <typename Call>
    py::object run(Call call, const std::shared_ptr<FrameIn> &pushed = nullptr)
    {
        Step made = {owner_, {}, 0, 0, pushed};
        {
            const Use use(*owner_);
            rlf_result result;
            {
                const Unlocked unlocked;
                result = call(owner_->pipeline, &made.out);
            }
            if (check(result) == RLF_END) {
                throw py::stop_iteration();
            }
            if (result == RLF_NO_FRAME) {
                return py::none();
            }
            made.step = ++owner_->steps;
            made.given = owner_->source != nullptr ? ++owner_->source->steps : 0;
        }
        py::list contacts, hands; // before a function makes the next step
        if (!on_contact.is_none()) {
            contacts = events_of(made.out.snapshot);
        }
        if (!on_hand.is_none()) {
            hands = hand_events_of(made.out.hands);
        }
        py::object step = py::cast(std::move(made));
        for (const auto &event : contacts) {
            on_contact(*py::reinterpret_borrow<py::tuple>(event));
        }
        for (const auto &event : hands) {
            on_hand(event);
        }
        return step;
    }

    std::shared_ptr<PipelineOwner> owner_;
};

// The functions of on_contact and on_hand may hold the pipeline: the collector must know.
void let_collect(PyHeapTypeObject *heap_type)
{
    PyTypeObject *type = &heap_type->ht_type;
    type->tp_flags |= Py_TPFLAGS_HAVE_GC;
    type->tp_traverse = [](PyObject *self, visitproc visit, void *arg) {
        Py_VISIT(Py_TYPE(self));
        if (reinterpret_cast<py::detail::instance *>(self)->simple_holder_constructed) {
            const auto &p = py::cast<const Pipeline &>(py::handle(self));
            Py_VISIT(p.on_contact.ptr());
            Py_VISIT(p.on_hand.ptr());
        }
        return 0;
    };
    type->tp_clear = [](PyObject *self) {
        auto &p = py::cast<Pipeline &>(py::handle(self));
        p.on_contact = p.on_hand = py::none();
        return 0;
    };
}

} // namespace

PipelineOwner::~PipelineOwner()
{
    const Unlocked unlocked;
    for (JoinedCamera &one : joined) {
        rlf_pipeline_destroy(&one.pipeline);
    }
    rlf_pipeline_destroy(&pipeline);
    for (JoinedCamera &one : joined) {
        rlf_source_destroy(&one.source);
    }
    rlf_scene_destroy(&scene);
    rlf_pool_destroy(&pool);
}

rlf_source_info info_from(const py::object &source)
{
    if (py::isinstance<Pipeline>(source)) {
        return source.cast<const Pipeline &>().info();
    }
    rlf_source_info info = {};
    info.frame_count = -1;
    if (py::isinstance<rlf_rig>(source)) {
        info.rig = source.cast<rlf_rig>();
        return info;
    }
    if (py::isinstance<rlf_camera>(source)) {
        info.rig = rlf_rig_default();
        info.rig.depth = source.cast<rlf_camera>();
        return info;
    }
    if (py::isinstance<py::str>(source) || py::hasattr(source, "__fspath__")) {
        throw py::type_error("source: use a Source, a Pipeline, a Rig or a Camera");
    }
    return *rlf_source_get_info(source_in(source_from(source, 1)));
}

void bind_pipeline(py::module_ &m)
{
    py::class_<Pipeline>(
        m, "Pipeline",
        "The frame loop: source, surface, physics, picture. One thread at a time; any "
        "number of pipelines in threads of their own.",
        py::custom_type_setup(&let_collect))
        .def(py::init<const py::object &, const py::object &, const std::string &,
                      const std::string &, const std::string &, const py::object &, bool, bool,
                      bool, int, const py::dict &, int>(),
             py::arg("source"), py::kw_only(), py::arg("scene") = py::none(),
             py::arg("profile") = "live", py::arg("camera") = "auto", py::arg("poses") = "tracked",
             py::arg("gravity") = py::none(), py::arg("render") = true, py::arg("hands") = false,
             py::arg("grab") = false, py::arg("threads") = 0, py::arg("settings") = py::dict(),
             py::arg("scale") = 0,
             "source: a name as for open(), a Source, or a Rig or Camera whose frames are pushed; "
             "or a "
             "list of cameras, FILE.json, all of which see the world. "
             "scene: the path of a scene.json. gravity: m/s^2, world. hands: looks for them. grab: "
             "hands hold what they close on. threads 0 = one per processor. settings: of the "
             "surface in "
             "place of the profile's, as {\"hold\": False}; `relief list settings` lists them. "
             "scale: every so many pixels have a point; 0 = the profile's.")
        .def("step", &Pipeline::step, "The next Step; None when a live camera has nothing new.")
        .def("push", &Pipeline::push, py::arg("depth"), py::arg("color") = py::none(),
             py::kw_only(), py::arg("time"), py::arg("units_per_metre") = 1000.0,
             py::arg("pose") = py::none(),
             "A step with a frame of your own: depth (H, W) uint16 or float32 metres, color (H, W, "
             "3 "
             "or 4) uint8, time in seconds, pose (4, 4) of the depth camera in the world.")
        .def("restart", &Pipeline::restart,
             "As at the first frame. BufferError while arrays show memory.")
        .def("set_view", &Pipeline::set_view, py::arg("name"),
             "What the next pictures show: one of relief.view_names.")
        .def("set_hands", &Pipeline::set_hands, py::arg("is_on"),
             "Looks for hands from the next frame on, or no longer.")
        .def(
            "set_known",
            [](Pipeline &p, const std::string &name, const std::string &shape,
               const py::object &size, double radius, double height, const py::object &pose,
               const py::object &points, bool refine, bool collides, double restitution,
               double friction) {
                return p.set_known(name, {shape, size, radius, height, pose, points, refine,
                                          collides, restitution, friction});
            },
            py::arg("name"), py::arg("shape") = "box", py::arg("size") = py::none(),
            py::arg("radius") = 0.05, py::arg("height") = 0.1, py::kw_only(),
            py::arg("pose") = py::none(), py::arg("points") = py::none(), py::arg("refine") = true,
            py::arg("collides") = true, py::arg("restitution") = 0.0, py::arg("friction") = 0.5,
            "Adds a model of a real thing, or moves the one of that name: it hides and collides "
            "with "
            "its whole shape. pose: (4, 4), model in the world; or points: three to six of (model, "
            "place), model being three metres in the shape's frame or a name as \"ltn\" (left top "
            "near), place a pixel (x, y) of the last frame or three metres in the world. Gives how "
            "well the pose fits, a KnownFit.")
        .def_property_readonly("known", &Pipeline::known, "Known of each model of a real thing.")
        .def(
            "on_contact",
            [](Pipeline &p, const py::object &function) {
                p.listen(&Pipeline::on_contact, function, "on_contact");
            },
            py::arg("function"),
            "Calls function(kind, body, other) for each of Step.events, before the step is "
            "returned; None ends that. It may use the pipeline. What it raises comes out of the "
            "step, "
            "which is made all the same.")
        .def(
            "on_hand",
            [](Pipeline &p, const py::object &function) {
                p.listen(&Pipeline::on_hand, function, "on_hand");
            },
            py::arg("function"), "The same with function(event) for each of Step.hand_events.")
        .def_property_readonly("world", &Pipeline::world,
                               "Its bodies: add, move and remove them between steps.")
        .def("close", &Pipeline::close, "Its arrays stay good; nothing else does.")
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
