// Whether what should make a run hard is there: liquid in the tank, the pocket, the gap, the drop, each counted in the scene as it stands.
// A limit that was measured on an empty tank is no limit.
#pragma once
#include "sim/simulation.hpp"

#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// A quantity that says how hard a run is, and what it must be there. Quantities: integrals, numbers of the step's report, and those that
/// are counted in cells (counted()).
struct Proof {
    enum class When { start, most, end } when = When::start;  // before the first step; the largest of the run; at its end
    std::string quantity{};
    std::optional<real> at_least{}, at_most{};  // for a value of 1; they grow with this power of the value
    real power = 0;
    std::string why{};
};

/// A proof as it was measured.
struct Shown {
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

/// Measures the proofs of one run.
class Hardship {
public:
    Hardship(const std::vector<Proof>& proofs, real pushed) : proofs_(&proofs), pushed_(pushed), values_(proofs.size(), -infinity) {}
    void start(const Simulation& simulation);
    void step(const Simulation& simulation, const StepReport& report);
    void end(const Simulation& simulation, const StepReport& report);
    std::vector<Shown> shown() const;
    /// The first proof that does not hold, of those known by then; empty where all do. at_start: only those of the start.
    std::string missing(bool at_start) const;

private:
    const std::vector<Proof>* proofs_;
    real pushed_;
    std::vector<real> values_;
};

}  // namespace weir::validation
