// What a window shows of a moment: plain numbers, copied from a solver between two steps, so that it may step on while they are drawn.
#pragma once
#include "app/view/water.hpp"
#include "sim/simulation.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace weir::live {

struct Snapshot {
    real time = 0;  // [s]
    std::int64_t steps = 0;
    StepReport report;
    double factor = 0;                                   // simulated over real time
    double step_ms = 0, transfer_ms = 0;                 // of the last step; of the last snapshot
    std::vector<std::pair<std::string, double>> passes;  // ms a step, the longest first
    bool paused = false;
    std::string message;
    bool has_brush = false;
    std::array<bool, brush_kinds.size()> brush_can{};
    std::array<real, 2> temperatures{infinity, -infinity};  // the coldest and the warmest, where there is any [K]

    std::string field;                // what colours show
    std::vector<std::string> fields;  // that could
    std::vector<float> points;        // of particles, x y z [m]
    std::vector<float> of_points;     // the field there; empty: it has none there
    std::array<int, 3> cells{0, 0, 0};
    std::vector<float> of_cells;                                   // the field in cells, x fastest; empty: nothing of the grid is shown
    std::map<std::string, std::vector<std::vector<real>>> bodies;  // fields of the set of bodies: their poses
    view::Columns columns;                                         // nx = 0: none
    view::Level level;                                             // where it alone tells where the liquid is; empty phi: none
    std::array<int, 2> sheet{0, 0};                                // points in rows that are the corners of a surface; 0: they are not
    std::vector<view::FloatingBox> boxes;

    /// Whether cells are shown as they are: neither columns nor a liquid that a level set bounds.
    bool grid_shown() const { return !of_cells.empty() && columns.nx == 0 && level.phi.empty(); }
};

/// Fields by which a solver's state can be coloured; "speed" stands for a velocity.
std::vector<std::string> field_names(const FieldSet& fields);
/// Points and values of the field; whatever does not have it is shown plain.
void take_fields(const FieldSet& fields, const std::string& field, Snapshot& into);

/// Of what has a temperature.
std::array<real, 2> temperatures_of(const FieldSet& fields);

}  // namespace weir::live
