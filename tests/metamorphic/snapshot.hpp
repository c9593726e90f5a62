// What a run shows after some steps, copied; its image under a transformation; and how far two of them differ.
#pragma once
#include "core/solver.hpp"
#include "metamorphic/transformation.hpp"
#include "sim/simulation.hpp"

#include <string>
#include <vector>

namespace weir::metamorphic {

struct Field {
    std::string set, name, unit;
    Where where = Where::cell;
    std::vector<std::vector<real>> data;
};

struct Snapshot {
    int dim = 0;
    real time = 0;
    std::array<int, 3> cells{1, 1, 1};
    std::array<real, 3> size{0, 0, 0}, origin{0, 0, 0};
    std::array<bool, 3> periodic{false, false, false};
    std::vector<Field> fields;
    std::vector<Integral> start, end;
    /// Scales of the scene [m, m/s, kg]: its longest side, its fastest fluid or what a fall through it reaches, its fluid.
    real length = 1, speed = 0, mass = 1;

    /// A quantity of this unit made of the scales of the scene.
    real scale_of(const std::string& unit) const;
};

/// Of a simulation that has been made and has gone on from there; `start` are its integrals before the first step.
Snapshot snapshot(const Simulation& simulation, const std::vector<Integral>& start);
/// What the transformed scene has to show.
Snapshot image(const Snapshot& of, const Transformation& by);
/// The same seen from an origin that lies `cells` further along periodic axes.
Snapshot rolled(const Snapshot& of, const std::array<int, 3>& cells);

/// The largest difference of two states and what differs.
struct Difference {
    real value = 0;
    std::string what = "nothing";
    void take(real v, const std::string& of) {
        if (!(v <= value)) value = v, what = of;
    }
};

/// Relative to the largest value of a field, or to a thousandth of the scene's scale of its unit.
Difference difference(const Snapshot& expected, const Snapshot& actual, const Transformation& by);
/// What is kept, as a change from the start: volume and mass; and what moves: energies in parts of what has moved, forces on solids and
/// speeds of bodies in parts of the largest or of the scene's scale. In another domain potential energy and forces are others.
struct Statistics {
    Difference kept, moved;
};
Statistics statistics(const Snapshot& expected, const Snapshot& actual, const Transformation& by = {}, bool same_domain = true);

}  // namespace weir::metamorphic
