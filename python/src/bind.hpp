// What the parts of the module share: errors, arrays over memory of Relief, and who owns it.
#pragma once

#include "relief/relief.h"
#include "relief/io.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

namespace py = pybind11;

// errors.cpp -------------------------------------------------------------------------------------

// Throws the Python exception of an error (< 0) with the C library's line; else returns `result`.
rlf_result check(rlf_result result);
void bind_errors(py::module_ &m);

// owner.cpp --------------------------------------------------------------------------------------

// Lets other threads of the interpreter run. What waits for threads of the C library must do so:
// they may log, and a log function of Python's needs the interpreter. Nothing where this thread
// does not hold it.
class Unlocked
{
  public:
    Unlocked() : state_(PyGILState_Check() != 0 ? PyEval_SaveThread() : nullptr) {}
    ~Unlocked()
    {
        if (state_ != nullptr) {
            PyEval_RestoreThread(state_);
        }
    }
    Unlocked(const Unlocked &) = delete;
    Unlocked &operator=(const Unlocked &) = delete;

  private:
    PyThreadState *state_;
};

// What arrays borrow: a source or a pipeline in C. It lives until the last array that shows its
// memory is gone, also when it was closed before.
struct Owner {
    std::atomic_flag is_busy = ATOMIC_FLAG_INIT;
    bool is_closed = false;
    int arrays = 0;     // that show its memory; the interpreter's lock guards it
    uint64_t steps = 0; // counts them: what shows an earlier one is over
    const char *name;

    explicit Owner(const char *what) : name(what) {}
    Owner(const Owner &) = delete;
    Owner &operator=(const Owner &) = delete;
    virtual ~Owner() = default;

    // ValueError when it was closed.
    void need_open() const;
    // BufferError while arrays show memory that `action` would give back.
    void need_no_arrays(const char *action) const;
};

// Holds an owner for one call that other threads must not disturb; RuntimeError when one is in it.
class Busy
{
  public:
    explicit Busy(Owner &owner);
    ~Busy() { owner_.is_busy.clear(); }
    Busy(const Busy &) = delete;
    Busy &operator=(const Busy &) = delete;

  private:
    Owner &owner_;
};

// A read-only array over memory of an owner; nothing is copied. Strides in bytes.
py::array view_of(const std::shared_ptr<Owner> &owner, const py::dtype &type, const void *data,
                  const std::vector<py::ssize_t> &shape, const std::vector<py::ssize_t> &strides);

template <typename T>
py::object plane_of(const std::shared_ptr<Owner> &owner, const T *data, int height, int width)
{
    if (data == nullptr) {
        return py::none();
    }
    const py::ssize_t size = sizeof(T);
    return view_of(owner, py::dtype::of<T>(), data, {height, width}, {width * size, size});
}

// A pool of so many threads; ValueError that names `threads`.
rlf_pool *make_pool(int threads);

// values.cpp -------------------------------------------------------------------------------------

py::array_t<double> array_of(rlf_vec3 v);
py::array_t<double> matrix_of(const rlf_pose &T);
// Three finite numbers, else ValueError that names the argument.
rlf_vec3 vector_from(const py::object &value, const char *name);
// A number, else TypeError that names the argument.
double number_from(const py::handle &value, const char *name);
// The text of a str or of a path; else TypeError: `name`, and which kinds are allowed.
std::string path_from(const py::object &value, const char *name, const char *kinds);
// A 4 x 4 matrix of a rotation and a translation, else ValueError that names the argument.
rlf_pose pose_from(const py::object &value, const char *name);
// One of `words` (they end with a nullptr), by its place; else ValueError that lists them.
int choice_from(const std::string &value, const char *const *words, const char *name);
void bind_values(py::module_ &m);

// frame.cpp --------------------------------------------------------------------------------------

// A frame with planes of its own: it may be kept.
struct Frame {
    rlf_frame c; // all but the planes and the rig
    py::object depth, color, confidence, pose;
};

// Arrays of the caller's as a frame in C, good while this lives.
struct FrameIn {
    py::array depth, color, confidence;
    std::vector<uint8_t> rgba;
    rlf_frame c = {};
};

py::object frame_copy(const rlf_frame &frame);
// Depth, colour (or None) and confidence (or None); errors name the array and what it should be.
void take_depth(const py::object &value, double units_per_metre, const rlf_rig &rig, FrameIn &out);
void take_color(const py::object &value, const rlf_rig &rig, FrameIn &out);
void take_confidence(const py::object &value, const rlf_rig &rig, FrameIn &out);
int64_t nanoseconds(double seconds);
void bind_frame(py::module_ &m);

// source.cpp -------------------------------------------------------------------------------------

struct SourceOwner : Owner {
    rlf_pool *pool = nullptr;
    rlf_source *source = nullptr;

    SourceOwner() : Owner("source") {}
    ~SourceOwner() override;
};

// The source in C, for the pipeline that reads it; ValueError when it is closed.
rlf_source *source_in(const std::shared_ptr<SourceOwner> &owner);
// A Source, or the name of one.
std::shared_ptr<SourceOwner> source_from(const py::object &source, int threads);
void bind_source(py::module_ &m);

// surface.cpp, world.cpp, pipeline.cpp -----------------------------------------------------------

py::object surface_of(const std::shared_ptr<Owner> &owner, const rlf_surface *surface);
// The surface in C, and who owns it; TypeError when it is none, ValueError when its pipeline is
// closed, RuntimeError when that has made another step.
const rlf_surface *surface_in(const py::object &surface, std::shared_ptr<Owner> *out_owner);
void bind_surface(py::module_ &m);

py::object world_of(const std::shared_ptr<Owner> &owner, rlf_world *world);
py::object body_of(const std::shared_ptr<Owner> &owner, rlf_world *world, rlf_body_id id);
// box, sphere, capsule, cylinder, by its words; errors name them.
rlf_shape shape_from(const std::string &shape, const py::object &size, double radius,
                     double height);
const char *shape_name(rlf_shape_type type);
// At most 63 bytes, else ValueError.
void name_from(const std::string &name, char out[RLF_NAME_MAX]);
py::list bodies_of(const rlf_snapshot *snapshot);
py::list contacts_of(const rlf_snapshot *snapshot);
py::list events_of(const rlf_snapshot *snapshot);
void bind_world(py::module_ &m);

// hands.cpp, known.cpp ---------------------------------------------------------------------------

py::object hands_of(const std::shared_ptr<Owner> &owner, rlf_world *world, const rlf_hands *hands);
py::list hand_events_of(const rlf_hands *hands);
void bind_hands(py::module_ &m);

struct KnownIn {
    std::string shape;
    py::object size;
    double radius, height;
    py::object pose, points;
    bool refine, collides;
    double restitution, friction;
};

py::object set_known(rlf_pipeline *pipeline, const std::string &name, const KnownIn &more);
py::list known_of(const rlf_pipeline *pipeline);
void bind_known(py::module_ &m);

// step.cpp, pipeline.cpp, recording.cpp ----------------------------------------------------------

struct JoinedCamera {
    rlf_source *source;
    rlf_pipeline *pipeline;
};

struct PipelineOwner : Owner {
    std::shared_ptr<SourceOwner> source; // none when frames are pushed
    std::vector<JoinedCamera> joined;    // other cameras of a list
    rlf_pool *pool = nullptr;
    rlf_scene scene = {};
    rlf_pipeline *pipeline = nullptr;
    rlf_rig rig = {};

    PipelineOwner() : Owner("pipeline") {}
    ~PipelineOwner() override;
};

struct Step {
    std::shared_ptr<PipelineOwner> owner;
    rlf_pipeline_output out;
    uint64_t step, given;            // Owner::steps of the pipeline and of its source
    std::shared_ptr<FrameIn> pushed; // the planes of out.frame, or none

    // RuntimeError when the pipeline has made another step.
    const rlf_pipeline_output &now() const;
    // Its frame in C, while the source has not gone on.
    const rlf_frame &frame() const;
};

void bind_step(py::module_ &m);
// The rig of what a recording is made of; TypeError when it is none.
rlf_source_info info_from(const py::object &source);
void bind_pipeline(py::module_ &m);
void bind_recording(py::module_ &m);
