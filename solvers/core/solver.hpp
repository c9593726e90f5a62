// What the time loop, the output and the validation see of any solver: steps, views of fields, integrals, checkpoints.
#pragma once
#include "core/checkpoint.hpp"
#include "core/effects.hpp"
#include "core/hand.hpp"
#include "core/passes.hpp"
#include "core/types.hpp"

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weir {

struct Cut;  // core/halo.hpp

inline constexpr real not_applicable = std::numeric_limits<real>::quiet_NaN();

/// What one step answers. NaN means that the quantity does not exist for the solver. Plain data: filling it allocates nothing.
struct StepReport {
    real dt = 0;                              // [s]
    real cfl = not_applicable;                // dt max(|u|/h)
    real max_divergence = not_applicable;     // max |div u| over fluid cells after the step [1/s]
    int iterations = 0;                       // of the pressure (or constraint) solve
    real residual_before = not_applicable;    // relative to the right-hand side (l2)
    real residual_after = not_applicable;     // true residual, recomputed; relative (l2)
    real residual_max = not_applicable;       // true residual, max norm, in units of the right-hand side (so dt/rho times it bounds div u)
    real density_error = not_applicable;      // particle solvers: mean compression
    real max_density_error = not_applicable;  // particle solvers: max compression
    int viscous_iterations = 0;               // of the solve for the friction of a liquid with a free surface
    int viscous_turns = 0;                    // how often friction and pressure were solved for once more
};

enum class Where { cell, face, particle };

/// A view of one quantity; valid until the next step. Cell data: one span a component, each of product(cells) values, x fastest.
/// Face data: one span an axis; span a has cells + e_a values. Particle data: one span a component, `count` values each.
struct FieldView {
    std::string name;
    std::string unit;
    Where where = Where::cell;
    std::string set;  // particle sets by name: "markers", "particles"; empty for grids
    std::vector<std::span<const real>> data;
    int components() const { return static_cast<int>(data.size()); }
};

/// Geometry of the grid on which cell and face fields live. Axis 2 has one cell and size 0 in 2D.
struct GridView {
    int dim = 0;  // 0: this solver has no grid
    std::array<int, 3> cells{1, 1, 1};
    std::array<real, 3> origin{0, 0, 0};   // lower corner of the domain [m]
    std::array<real, 3> spacing{0, 0, 0};  // [m]
};

/// The names by which solvers show their free surface: a cell field, signed distance to it [m], negative in the liquid; or on a grid of one
/// cell along y the surface's y [m], with the water's depth where it ends at a bed; and the particle sets of grid and of particle solvers.
inline constexpr const char* level_set_name = "level_set";
inline constexpr const char* column_depth_name = "depth";
inline constexpr const char* surface_height_name = "surface";
inline constexpr const char* marker_set_name = "markers";
inline constexpr const char* particle_set_name = "particles";

/// A particle set of boxes along the axes: "position" is the middle of each, "size" its extent.
inline constexpr const char* box_set_name = "floats";

/// The same surface as points in space, which may have moved sideways too.
inline constexpr const char* surface_set_name = "surface";

/// A particle set whose points stand in rows, x fastest, and are the corners of a surface: a line where there is one row.
struct SheetView {
    std::string set;
    std::array<int, 2> points{0, 0};
};

/// Everything a solver shows. A particle set's positions are the field named "position" of that set.
struct FieldSet {
    GridView grid;
    std::vector<FieldView> fields;
    std::vector<SheetView> sheets{};
    /// Of particle solvers: the pressure's gradient in liquid at rest, rho0 g [Pa/m], as it goes on behind their walls.
    Vec<3> weight{};
    /// The density at which a particle takes up a cell [kg/m^3].
    real rest_density = 0;
    /// Over ranks that hold their own planes alone: where they are cut. Each rank may then read its own planes and those beside them.
    const Cut* cut = nullptr;
    /// Over ranks: of every particle set each rank shows its part, which follow each other in the order of the ranks.
    bool particles_in_parts = false;
    const FieldView* find(std::string_view name) const {
        for (const auto& f : fields)
            if (f.name == name) return &f;
        return nullptr;
    }
    const FieldView* find(std::string_view set, std::string_view name) const {
        for (const auto& f : fields)
            if (f.set == set && f.name == name) return &f;
        return nullptr;
    }
};

/// A named integral or extremum over the whole domain: "kinetic_energy" [J per metre of depth in 2D], "mass", "volume", ...
struct Integral {
    std::string name;
    std::string unit;
    real value = 0;
};

/// A field that may be written between two steps: the solver's own numbers, as FieldView lays them out. Values beyond [min, max] of their
/// component are refused by whoever writes, as are those that are not finite.
struct EditableField {
    std::string set, name;
    std::vector<std::span<real>> data;
    std::array<real, 3> min{-infinity, -infinity, -infinity}, max{infinity, infinity, infinity};
};

/// The step beyond which a method breaks, whatever its accuracy, and what it is that breaks.
struct StepLimit {
    real dt = infinity;  // [s]
    std::string_view why{};
};

class Solver {
public:
    virtual ~Solver() = default;
    /// Advances by dt [s]. Throws NumericalFailure, leaving whatever state it reached.
    virtual StepReport step(real dt) = 0;
    /// The largest step that the solver and every effect in the scene advise now [s]; infinity where nothing limits.
    virtual real advised_dt() const = 0;
    /// The largest step that is stable now, for a step that a scene prescribes; known from the last step, so that asking costs no pass.
    virtual StepLimit stable_dt() const { return {}; }
    /// What is wrong with using the method on the state of the moment, in one line, with its numbers; empty where nothing is.
    virtual std::string concern() const { return {}; }
    virtual FieldSet fields() const = 0;
    /// Over ranks, for as long as it lives, fields() show something else than all to all. All ranks ask for it together.
    class Brought {
    public:
        virtual ~Brought() = default;
    };
    /// Where ranks share particles: of these each its part, as many as any other, in the order of one process.
    virtual std::unique_ptr<Brought> show_in_parts() const { return nullptr; }
    /// Over ranks: does each hold its own planes alone?
    virtual bool holds_own_planes() const { return false; }
    /// The components of a field at a point, from a solver that knows them without a grid; false: take them from fields().
    virtual bool answer(std::string_view /*field*/, const Vec<3>& /*at*/, std::span<real> /*values*/) const { return false; }
    /// Whether step() itself throws NumericalFailure where a field is no longer finite, so that nobody needs to look at all fields after
    /// every step: they may be far away, on a device.
    virtual bool checks_itself() const { return false; }
    virtual std::vector<Integral> integrals() const = 0;
    /// The hand that pushes the fluid, where the scene names it and the solver has it (effects.hand).
    virtual Hand* hand() const { return nullptr; }
    /// The fields that may be written; none where what is shown is no state of its own.
    virtual std::vector<EditableField> editable() { return {}; }
    /// After such a field was written: makes good what every step leaves behind (a velocity without divergence that meets walls, the
    /// liquid's ledger). Throws BadInput where what is written cannot be; then the state is whatever it has become.
    virtual void edited(const EditableField&) {}
    /// New particles of a set at places inside the domain [m] with their velocities [m/s]; false: this solver has no such set, or another
    /// part of the scene would not know of them. Throws BadInput as above.
    virtual bool add_particles(std::string_view /*set*/, std::span<const Vec<3>> /*at*/, std::span<const Vec<3>> /*velocity*/) {
        return false;
    }
    /// Takes out the particles i of a set for which gone[i] is not 0.
    virtual bool remove_particles(std::string_view /*set*/, std::span<const unsigned char> /*gone*/) { return false; }
    /// Simulated time [s].
    virtual real time() const = 0;
    /// Everything the next step depends on, exactly: restore(save()) continues bit for bit.
    virtual void save(Checkpoint& to) const = 0;
    virtual void restore(const Checkpoint& from) = 0;
    virtual const Passes& passes() const = 0;
    /// Bytes of all state and scratch that the solver holds.
    virtual std::size_t bytes() const = 0;
    /// What was built for each effect that the scene names.
    virtual std::vector<EffectPlan> effects() const { return {}; }
    /// Passes may be reset between frames, so that reports speak of the interval.
    virtual Passes& passes() = 0;
};

}  // namespace weir
