// The module `relief._relief`.
#include "bind.hpp"

namespace
{

PyObject *log_function; // None or what set_log was given; owned

void write_log(void *, rlf_log_level level, const char *line)
{
    static const char *const names[] = {"error", "warning", "info"};
    const py::gil_scoped_acquire acquire;
    if (log_function == nullptr || log_function == Py_None) {
        return;
    }
    const auto function = py::reinterpret_borrow<py::object>(log_function); // it may replace itself
    PyObject *result = PyObject_CallFunction(function.ptr(), "ss", names[level], line);
    if (result == nullptr) {
        PyErr_WriteUnraisable(function.ptr()); // the frame goes on
    }
    Py_XDECREF(result);
}

void set_log(const py::object &function)
{
    if (!function.is_none() && PyCallable_Check(function.ptr()) == 0) {
        throw py::type_error("set_log: use a function of (level, line), or None");
    }
    const auto before = py::reinterpret_steal<py::object>(log_function);
    log_function = py::object(function).release().ptr();
    rlf_set_log(function.is_none() ? nullptr : write_log, nullptr);
}

} // namespace

PYBIND11_MODULE(_relief, m)
{
    m.doc() = "Virtual things touch the real world that a depth camera sees.";
    m.attr("__version__") = std::to_string(RLF_VERSION_MAJOR) + "." +
                            std::to_string(RLF_VERSION_MINOR) + "." +
                            std::to_string(RLF_VERSION_PATCH);
    bind_errors(m);
    bind_values(m);
    bind_frame(m);
    bind_source(m);
    bind_surface(m);
    bind_world(m);
    bind_hands(m);
    bind_known(m);
    bind_step(m);
    bind_pipeline(m);
    bind_recording(m);
    m.def("set_log", &set_log, py::arg("function"),
          "Gives every log line to function(level, line), on any thread; None silences. level: "
          "\"error\", \"warning\" or \"info\". What it raises goes to sys.unraisablehook.");
    m.def("allocation_count", &rlf_alloc_count,
          "How often the library has asked for memory: after the first steps a step adds none.");
}
