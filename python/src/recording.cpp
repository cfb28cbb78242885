// Recordings, in the formats of `relief record`.
#include "bind.hpp"

namespace
{

const char *const codecs[] = {"rvl", "png", nullptr};
const char *const compressions[] = {"zstd", "lz4", "none", nullptr};

void need_size(const char *plane, const rlf_camera &given, const rlf_camera &asked)
{
    if (given.width != asked.width || given.height != asked.height) {
        const auto text = [](const rlf_camera &c) {
            return "(" + std::to_string(c.height) + ", " + std::to_string(c.width) + ")";
        };
        throw py::value_error("add: the step's " + std::string(plane) + " has shape " +
                              text(given) + ", the recording's " + text(asked));
    }
}

struct RecordingOwner : Owner {
    rlf_recording *recording = nullptr;
    rlf_source_info info;

    RecordingOwner() : Owner("recording") {}
    ~RecordingOwner() override
    {
        const Unlocked unlocked;
        (void)rlf_recording_close(&recording, nullptr);
    }
};

class Recording
{
  public:
    Recording(const py::object &path, const py::object &source, const std::string &codec,
              const std::string &compression, int jpeg_quality, double chunk)
        : owner_(std::make_shared<RecordingOwner>())
    {
        const std::string name = path_from(path, "path", "a path: FILE.mcap or FOLDER/");
        owner_->info = info_from(source);
        rlf_recording_def def = rlf_recording_def_default();
        def.depth_codec = static_cast<rlf_depth_codec>(choice_from(codec, codecs, "depth_codec"));
        def.compression =
            static_cast<rlf_compression>(choice_from(compression, compressions, "compression"));
        def.jpeg_quality = jpeg_quality;
        def.chunk_s = chunk;
        check(rlf_recording_open(name.c_str(), &owner_->info, &def, &owner_->recording));
    }

    void add(const py::object &what)
    {
        owner_->need_open();
        const Busy busy(*owner_);
        if (py::isinstance<Step>(what)) {
            add_step(what.cast<const Step &>());
        } else if (py::isinstance<Frame>(what)) {
            add_frame(what.cast<const Frame &>());
        } else {
            throw py::type_error("add: use a Frame or a Step");
        }
    }

    void close()
    {
        const Busy busy(*owner_);
        if (owner_->is_closed) {
            return;
        }
        owner_->is_closed = true;
        rlf_result result;
        {
            const Unlocked unlocked;
            result = rlf_recording_close(&owner_->recording, &last_);
        }
        check(result);
    }

    rlf_recording_status status() const
    {
        const Busy busy(*owner_);
        return owner_->is_closed ? last_ : rlf_recording_get_status(owner_->recording);
    }

  private:
    void write(const rlf_frame &frame, const rlf_snapshot *snapshot)
    {
        rlf_result result;
        {
            const Unlocked unlocked;
            result = rlf_recording_add(owner_->recording, &frame);
            if (result == RLF_OK && snapshot != nullptr) {
                result = rlf_recording_add_bodies(owner_->recording, frame.time_ns, snapshot);
            }
        }
        check(result);
    }

    void add_step(const Step &step)
    {
        const Busy busy(*step.owner);
        const rlf_frame &frame = step.frame();
        need_size("depth", step.owner->rig.depth, owner_->info.rig.depth);
        if (frame.color.data != nullptr) {
            need_size("color", step.owner->rig.color, owner_->info.rig.color);
        }
        const auto source = step.owner->source;
        const auto source_busy = source != nullptr ? std::make_unique<Busy>(*source) : nullptr;
        write(frame, step.now().snapshot);
    }

    void add_frame(const Frame &frame)
    {
        FrameIn in;
        in.c = frame.c;
        take_depth(frame.depth, frame.c.depth_units_per_metre, owner_->info.rig, in);
        take_color(frame.color, owner_->info.rig, in);
        take_confidence(frame.confidence, owner_->info.rig, in);
        write(in.c, nullptr);
    }

    std::shared_ptr<RecordingOwner> owner_;
    rlf_recording_status last_ = {};
};

} // namespace

void bind_recording(py::module_ &m)
{
    py::class_<Recording>(
        m, "Recording",
        "A recording that is being written: FILE.mcap, or a folder where the path "
        "ends with /. It can be read at any time. One thread at a time.")
        .def(py::init<const py::object &, const py::object &, const std::string &,
                      const std::string &, int, double>(),
             py::arg("path"), py::arg("source"), py::kw_only(), py::arg("depth_codec") = "rvl",
             py::arg("compression") = "zstd", py::arg("jpeg_quality") = 90, py::arg("chunk") = 1.0,
             "source: the Source, Pipeline, Rig or Camera whose frames are added. What is there of "
             "the same name is replaced. depth_codec: \"rvl\" or \"png\"; compression: \"zstd\", "
             "\"lz4\" or \"none\"; jpeg_quality of colour: 1 to 100, 0 = PNG; chunk: seconds "
             "between "
             "two writes.")
        .def("add", &Recording::add, py::arg("what"),
             "Writes a Frame, or a Step: its frame and, into a file, the poses of its bodies.")
        .def("close", &Recording::close, "Finishes the file; again it does nothing.")
        .def_property_readonly(
            "frames", [](const Recording &r) { return r.status().frames; },
            "Added so far; once it is closed those that can be read back.")
        .def_property_readonly(
            "bytes", [](const Recording &r) { return r.status().bytes; }, "Written so far.")
        .def("__enter__", [](py::object self) { return self; })
        .def("__exit__", [](Recording &r, const py::args &) { r.close(); });
}
