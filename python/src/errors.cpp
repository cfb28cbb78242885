// Errors of the C library as exceptions.
#include "bind.hpp"

#include <map>

namespace
{

PyObject *base_error;
std::map<int, PyObject *> errors;

PyObject *make(py::module_ &m, const char *name, const char *doc, PyObject *builtin)
{
    const py::tuple bases = builtin == nullptr
                                ? py::make_tuple(py::handle(base_error))
                                : py::make_tuple(py::handle(base_error), py::handle(builtin));
    PyObject *made = PyErr_NewExceptionWithDoc((std::string("relief.") + name).c_str(), doc,
                                               bases.ptr(), nullptr);
    m.attr(name) = py::handle(made);
    return made;
}

// A broken contract is an error like any other: its line becomes the exception's.
bool go_on(void *, const char *, const char *, int)
{
    return false;
}

} // namespace

rlf_result check(rlf_result result)
{
    if (result >= 0) {
        return result;
    }
    if (result == RLF_ERROR_MEMORY) {
        throw std::bad_alloc();
    }
    const auto found = errors.find(result);
    PyErr_SetString(found != errors.end() ? found->second : base_error, rlf_error_text());
    throw py::error_already_set();
}

void bind_errors(py::module_ &m)
{
    base_error = PyErr_NewExceptionWithDoc("relief.Error", "Anything that Relief could not do.",
                                           PyExc_Exception, nullptr);
    m.attr("Error") = py::handle(base_error);
    errors[RLF_ERROR_INVALID] =
        make(m, "InvalidError", "A value that cannot be used.", PyExc_ValueError);
    errors[RLF_ERROR_IO] = make(
        m, "FileError", "A file or device could not be opened, read or written.", PyExc_OSError);
    errors[RLF_ERROR_FORMAT] =
        make(m, "FormatError", "A file is damaged, or not what its name says.", PyExc_ValueError);
    errors[RLF_ERROR_UNSUPPORTED] = make(
        m, "UnsupportedError", "Not in this build, or not on this machine.", PyExc_RuntimeError);
    errors[RLF_ERROR_CAPACITY] =
        make(m, "CapacityError", "More than there is room for.", PyExc_RuntimeError);
    errors[RLF_ERROR_DEVICE] =
        make(m, "DeviceError", "A camera or graphics device failed.", PyExc_RuntimeError);
    rlf_set_assert(go_on, nullptr);
}
