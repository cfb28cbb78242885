// Who owns the memory that arrays show.
#include "bind.hpp"

void Owner::need_open() const
{
    if (is_closed) {
        throw py::value_error(std::string(name) + " is closed");
    }
}

void Owner::need_no_arrays(const char *action) const
{
    if (arrays > 0) {
        const std::string text = std::to_string(arrays) + " arrays still show memory of this " +
                                 name + ": delete or copy them before " + action;
        PyErr_SetString(PyExc_BufferError, text.c_str());
        throw py::error_already_set();
    }
}

Busy::Busy(Owner &owner) : owner_(owner)
{
    if (owner.is_busy.test_and_set()) {
        throw std::runtime_error(std::string("another thread uses this ") + owner.name +
                                 ": one thread at a time");
    }
}

rlf_pool *make_pool(int threads)
{
    rlf_pool *pool;
    if (rlf_pool_create(threads, &pool) == RLF_ERROR_INVALID) {
        throw py::value_error(std::string("threads: ") + rlf_error_text());
    }
    if (pool == nullptr) {
        throw std::bad_alloc();
    }
    return pool;
}

py::array view_of(const std::shared_ptr<Owner> &owner, const py::dtype &type, const void *data,
                  const std::vector<py::ssize_t> &shape, const std::vector<py::ssize_t> &strides)
{
    auto *kept = new std::shared_ptr<Owner>(owner);
    owner->arrays++;
    const py::capsule base(kept, [](void *memory) {
        auto *held = static_cast<std::shared_ptr<Owner> *>(memory);
        (*held)->arrays--;
        delete held;
    });
    py::array array(type, shape, strides, data, base);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}
