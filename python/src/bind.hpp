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

namespace py = pybind11;

// errors.cpp -------------------------------------------------------------------------------------

// Throws the Python exception of an error (< 0) with the C library's line; else returns `result`.
rlf_result check(rlf_result result);
void bind_errors(py::module_ &m);

// owner.cpp --------------------------------------------------------------------------------------

// What arrays borrow: a source or a pipeline in C. It lives until the last array that shows its
// memory is gone, also when it was closed before.
struct Owner {
    std::atomic_flag is_busy = ATOMIC_FLAG_INIT;
    bool is_closed = false;
    int arrays = 0; // that show its memory; the interpreter's lock guards it
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
class Busy {
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

// values.cpp -------------------------------------------------------------------------------------

py::array_t<double> array_of(rlf_vec3 v);
py::array_t<double> matrix_of(const rlf_pose &T);
// Three finite numbers, else ValueError that names the argument.
rlf_vec3 vector_from(const py::object &value, const char *name);
// A 4 x 4 matrix of a rotation and a translation, else ValueError that names the argument.
rlf_pose pose_from(const py::object &value, const char *name);
// One of `words` (they end with a nullptr), by its place; else ValueError that lists them.
int choice_from(const std::string &value, const char *const *words, const char *name);
void bind_values(py::module_ &m);

// source.cpp -------------------------------------------------------------------------------------

struct SourceOwner : Owner {
    rlf_pool *pool = nullptr;
    rlf_source *source = nullptr;

    SourceOwner() : Owner("source") {}
    ~SourceOwner() override
    {
        rlf_source_destroy(&source);
        rlf_pool_destroy(&pool);
    }
};

// The source in C, for the pipeline that reads it; ValueError when it is closed.
rlf_source *source_in(const std::shared_ptr<SourceOwner> &owner);
std::shared_ptr<SourceOwner> open_source(const std::string &name, int threads);
// A frame with planes of its own.
py::object frame_copy(const rlf_frame &frame);
void bind_source(py::module_ &m);

// surface.cpp, world.cpp, pipeline.cpp -----------------------------------------------------------

py::object surface_of(const std::shared_ptr<Owner> &owner, const rlf_surface *surface);
// The surface in C; TypeError when it is none, ValueError when its pipeline is closed.
const rlf_surface *surface_in(const py::object &surface);
void bind_surface(py::module_ &m);

// `get` gives the world while its owner is open.
py::object world_of(const std::shared_ptr<Owner> &owner, rlf_world *world);
py::list bodies_of(const rlf_snapshot *snapshot);
py::list contacts_of(const rlf_snapshot *snapshot);
py::list events_of(const rlf_snapshot *snapshot);
void bind_world(py::module_ &m);

void bind_pipeline(py::module_ &m);
