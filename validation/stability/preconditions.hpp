// Preconditions of a stability limit: what makes a run hard is in the scene (liquid, pocket, gap, drop), counted as it stands.
// A limit that was measured on an empty tank is no limit.
#pragma once
#include "sim/simulation.hpp"

#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// A quantity that measures how hard a run is, and the range that it must have. Quantities: integrals, numbers of the step's report, and
/// those that are counted in cells (counted()).
struct Precondition {
    enum class When { start, most, end } when = When::start;  // before the first step; the largest of the run; at its end
    std::string quantity{};
    std::optional<real> at_least{}, at_most{};  // for a value of 1; they grow with this power of the value
    real power = 0;
    std::string why{};
};

/// The measured value of a precondition.
struct MeasuredValue {
    std::string quantity{};
    real value = 0;
};

/// Of the run as it stands, each by its name:
///   steps, fastest       steps taken; the fastest face or particle, cfl h / dt [m/s]
///   wet_cells, dry_cells cells with liquid (their centre in it, or a particle in the cell); those with neither liquid nor solid
///   bodies, pockets      connected parts of the wet and of the dry cells
///   film                 mean depth of the liquid over the floor, in cells
///   gap                  least free height over the floor, in cells
///   aspect               the longest side of a cell over the shortest
///   solid_cells          cells whose centre is inside a solid
///   solid_speed          of the fastest solid [m/s]
///   pushed, strays       free bodies that the fluid pushes; those whose centre of mass is outside the domain
///   free_bodies          how many there are
///   carried              free bodies further than a cell from where the scene puts them
///   touching             free bodies that are nearer to another than a hundredth of their size
///   lightest, heaviest   density of a free body over the fluid's
///   mass_ratio           of the densest free body to the lightest
///   viscous_number       viscosity times step over the square of a cell's side
/// No value for any other name.
std::optional<real> counted(const std::string& name, const Simulation& simulation, const StepReport& report);

/// An integral, a number of the step's report, a sum of two ("kinetic_energy+potential_energy"), or what counted() knows. Throws BadInput.
real value_of(const std::string& name, const Simulation& simulation, const StepReport& report);

/// Measures the preconditions of one run.
class Preconditions {
public:
    Preconditions(const std::vector<Precondition>& preconditions, real pushed)
        : preconditions_(&preconditions), pushed_(pushed), values_(preconditions.size(), -infinity) {}
    void start(const Simulation& simulation);
    void step(const Simulation& simulation, const StepReport& report);
    void end(const Simulation& simulation, const StepReport& report);
    std::vector<MeasuredValue> measured() const;
    /// The first precondition that does not hold, of those known by then; empty where all hold. at_start: only those of the start.
    std::string missing(bool at_start) const;

private:
    const std::vector<Precondition>* preconditions_;
    real pushed_;
    std::vector<real> values_;
};

}  // namespace weir::validation
