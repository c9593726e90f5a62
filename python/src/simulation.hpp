// What Python holds of a simulation: the simulation itself, which moment its fields are of, and who still looks at them.
#pragma once
#include "app/measured.hpp"
#include "output/frames.hpp"
#include "sim/simulation.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace weir::python {

/// Shared by the Python object and by every array that looks at its fields, so that an array outlives the object safely. A step would move
/// or free what arrays look at: it is refused while there are any (`leases`), as Python's own bytearray refuses to be resized.
struct State {
    State(scene::Scene scene) : simulation(std::move(scene)) {}

    Simulation simulation;
    std::uint64_t moment = 0;          // counts steps and restorations
    std::optional<FieldSet> fields{};  // of this moment, once somebody has asked
    std::atomic<int> leases{0};
    std::atomic<bool> busy{false};  // another thread of Python is in a step
    std::string edited{};           // the field whose block is open
    std::optional<output::Frames> frames{};
    std::optional<app::Measured> measured{};

    const FieldSet& shown() {
        if (!fields) fields = simulation.fields();
        return *fields;
    }
};
using StatePtr = std::shared_ptr<State>;

/// Keys of a scene and their new values as TOML text.
using Changes = std::vector<std::pair<std::string, std::string>>;
std::vector<scene::Override> overrides_of(const Changes& changes);

/// Holds the simulation for one call that changes it. Throws BufferError where arrays look at it, RuntimeError where another thread does,
/// BadInput inside the block of a field that is edited, whose end would undo the change.
class Change {
public:
    explicit Change(StatePtr state);
    ~Change();
    Change(const Change&) = delete;
    Change& operator=(const Change&) = delete;

private:
    StatePtr state_;
};

/// One component of a field without a copy, read-only: cells and faces as [x, y] or [x, y, z], particles as [i]. It keeps the simulation
/// alive, and the simulation does not step while it is.
pybind11::array component(const StatePtr& state, const std::string& set, const std::string& name, int axis);

void add_simulation(pybind11::module_& module);
void add_studies(pybind11::module_& module);

}  // namespace weir::python
