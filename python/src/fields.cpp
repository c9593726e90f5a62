// Fields as NumPy arrays without a copy, and how an array keeps what it looks at.
#include "python/src/simulation.hpp"

#include <fmt/format.h>

namespace py = pybind11;

namespace weir::python {

namespace {

/// Shape of a component, x first; strides are those of x fastest.
std::vector<py::ssize_t> shape_of(const FieldSet& all, const FieldView& field, int axis) {
    const auto count = static_cast<py::ssize_t>(field.data[static_cast<std::size_t>(axis)].size());
    if (field.where == Where::particle) return {count};
    std::vector<py::ssize_t> shape;
    py::ssize_t cells = 1;
    for (int d = 0; d < all.grid.dim; ++d) {
        shape.push_back(all.grid.cells[static_cast<std::size_t>(d)] + (field.where == Where::face && d == axis ? 1 : 0));
        cells *= shape.back();
    }
    if (cells != count) return {count};  // a list that is on no grid
    return shape;
}

std::vector<py::ssize_t> strides_of(const std::vector<py::ssize_t>& shape) {
    std::vector<py::ssize_t> strides;
    py::ssize_t stride = sizeof(real);
    for (const py::ssize_t n : shape) strides.push_back(stride), stride *= n;
    return strides;
}

}  // namespace

Change::Change(StatePtr state) : state_(std::move(state)) {
    if (!state_->edited.empty())
        throw BadInput(
            fmt::format("\"{}\" is being edited: the simulation steps and changes after the block, not inside it", state_->edited));
    if (state_->busy.exchange(true)) throw std::runtime_error("the simulation is stepping in another thread");
    if (const int arrays = state_->leases; arrays > 0) {
        state_->busy = false;
        PyErr_SetString(
            PyExc_BufferError,
            fmt::format(
                "{} array{} the current fields, which a step invalidates: copy the data to keep (numpy.array(...)), and delete the array",
                arrays, arrays == 1 ? " still references" : "s still reference")
                .c_str());
        throw py::error_already_set();
    }
    ++state_->moment;
    state_->fields.reset();
}

Change::~Change() { state_->busy = false; }

py::array component(const StatePtr& state, const std::string& set, const std::string& name, int axis) {
    if (state->busy) throw std::runtime_error("the simulation is stepping in another thread");
    const FieldSet& all = state->shown();
    const FieldView* field = all.find(set, name);
    if (!field || axis < 0 || axis >= field->components()) throw py::key_error(name);
    struct Lease {
        explicit Lease(StatePtr of) : state(std::move(of)) { ++state->leases; }
        ~Lease() { --state->leases; }
        StatePtr state;
    };
    const py::capsule owner(new Lease(state), [](void* lease) { delete static_cast<Lease*>(lease); });
    const auto shape = shape_of(all, *field, axis);
    py::array array(py::dtype::of<real>(), shape, strides_of(shape), field->data[static_cast<std::size_t>(axis)].data(), owner);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

}  // namespace weir::python
