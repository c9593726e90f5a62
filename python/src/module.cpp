// The module _weir: classes, functions and exceptions that the package weir is made of.
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "output/machine.hpp"
#include "python/src/simulation.hpp"

namespace py = pybind11;

namespace {

/// Exceptions of the library as those of Python, with what they know beside their text. Kinds of ValueError, ArithmeticError and OSError,
/// so that who does not know weir's may catch Python's.
void add_exceptions(py::module_& module) {
    py::register_exception<weir::BadInput>(module, "BadInput", PyExc_ValueError);
    py::register_exception<weir::OutputError>(module, "OutputError", PyExc_OSError);
    static py::exception<weir::NumericalFailure> numerical(module, "NumericalFailure", PyExc_ArithmeticError);
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const weir::NumericalFailure& failure) {
            py::object error = py::reinterpret_borrow<py::object>(numerical)(failure.what());
            error.attr("quantity") = failure.quantity;
            error.attr("step") = failure.step;
            error.attr("time") = failure.time;
            PyErr_SetObject(numerical.ptr(), error.ptr());
        }
    });
}

}  // namespace

PYBIND11_MODULE(_weir, module) {
    const auto machine = weir::output::this_machine();
    module.attr("__version__") = machine.version;
    module.attr("build") =
        machine.commit + ", " + machine.compiler + ", " + machine.build + (machine.options.empty() ? "" : ", " + machine.options);
    add_exceptions(module);
    module.def(
        "threads", [] { return weir::threads(); }, "Maximum number of threads of a step.");
    module.def(
        "set_threads",
        [](int count) {
            if (count < 0) throw weir::BadInput("a number of threads is at least 1, or 0 for all");
            weir::set_threads(count);
        },
        py::arg("count"), "Sets the number of threads; 0: all of the machine. Results do not depend on it.");
    weir::python::add_simulation(module);
    weir::python::add_studies(module);
}
