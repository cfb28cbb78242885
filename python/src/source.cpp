// Sources and their frames.
#include "bind.hpp"

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

    std::shared_ptr<SourceOwner> owner;

  private:
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
        .def("close", &Source::close, "Gives the camera or the file back; again it does nothing.")
        .def("__iter__", [](py::object self) { return self; })
        .def("__next__", &Source::next)
        .def("__enter__", [](py::object self) { return self; })
        .def("__exit__", [](Source &s, const py::args &) { s.close(); });
    m.def(
        "open",
        [](const py::object &name, int threads) { return std::make_unique<Source>(name, threads); },
        py::arg("name"), py::arg("threads") = 1,
        "Opens a camera, a recording or a synthetic room, as the command's SOURCE. threads 0 = one "
        "per processor.");
}
