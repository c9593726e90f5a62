// The interface of every solver for the time loop, output and validation: steps, views of fields, integrals, checkpoints.
#pragma once
#include "core/brush.hpp"
#include "core/checkpoint.hpp"
#include "core/effects.hpp"
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

struct Partition;  // parallel/partition.hpp

inline constexpr real not_applicable = std::numeric_limits<real>::quiet_NaN();

/// The result of one step. NaN means that the quantity does not exist for the solver. Plain data: filling it allocates nothing.
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
    int viscous_coupling_iterations = 0;      // number of repeated coupled solves for friction and pressure
};

enum class Where { cell, face, particle };

/// A view of one quantity; valid until the next step. Cell data: one span per component, each of product(cells) values, x fastest. Face
/// data: one span per axis; span a has cells + e_a values. Particle data: one span per component, `count` values each.
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

/// Field names of the free surface. Grid solvers: a cell field, the signed distance to the surface [m], negative in the liquid. Height
/// fields (one cell along y): the surface height y [m], and the water depth where there is a bed. Also the names of the particle sets.
inline constexpr const char* level_set_name = "level_set";
inline constexpr const char* column_depth_name = "depth";
inline constexpr const char* surface_height_name = "surface";
inline constexpr const char* marker_set_name = "markers";
inline constexpr const char* particle_set_name = "particles";

/// A particle set of axis-aligned boxes: "position" is the centre of each, "size" its extent.
inline constexpr const char* box_set_name = "floats";

/// The same surface as points in space, which may also be displaced horizontally.
inline constexpr const char* surface_set_name = "surface";

/// A particle set whose points stand in rows, x fastest, and are the vertices of a surface: a line where there is one row.
struct SheetView {
    std::string set;
    std::array<int, 2> points{0, 0};
};

/// All fields of a solver. A particle set's positions are the field named "position" of that set.
struct FieldSet {
    GridView grid;
    std::vector<FieldView> fields;
    std::vector<SheetView> sheets{};
    /// Particle solvers: the hydrostatic pressure gradient rho0 g [Pa/m]; pressure is extrapolated behind walls with it.
    Vec<3> weight{};
    /// The density at which a particle fills one cell [kg/m^3].
    real rest_density = 0;
    /// Distributed storage: the partition. Each rank may then read its own planes and the adjacent ghost planes.
    const Partition* cut = nullptr;
    /// In parallel: every rank shows its part of each particle set; the parts are concatenated in rank order.
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

/// A field that may be written between two steps: the solver's own values, laid out as in FieldView. The caller must reject values that are
/// not finite or beyond [min, max] of their component.
struct EditableField {
    std::string set, name;
    std::vector<std::span<real>> data;
    std::array<real, 3> min{-infinity, -infinity, -infinity}, max{infinity, infinity, infinity};
};

/// The step beyond which a method is unstable, whatever its accuracy, and the name of the limiting mechanism.
struct StepLimit {
    real dt = infinity;  // [s]
    std::string_view why{};
};

class Solver {
public:
    virtual ~Solver() = default;
    /// Advances by dt [s]. Throws NumericalFailure; the state is then unspecified.
    virtual StepReport step(real dt) = 0;
    /// The largest step that the solver and every effect of the scene advise now [s]; infinity where nothing limits it.
    virtual real advised_dt() const = 0;
    /// The largest stable step now, for a step prescribed by a scene. It comes from the last step, so the query costs no pass.
    virtual StepLimit stable_dt() const { return {}; }
    /// A warning about using the method on the current state, in one line, with its numbers; empty where there is none.
    virtual std::string concern() const { return {}; }
    /// In parallel, fills the planes of other ranks that fields() and integrals() read: ghost planes, or all. Collective. Needed once after
    /// a step whose fields are read; const functions exchange no fields, but they may reduce values over the ranks.
    virtual void synchronize() {}
    virtual FieldSet fields() const = 0;
    /// In parallel: a scope in which fields() shows other data than all data on all ranks. The call is collective.
    class DistributedView {
    public:
        virtual ~DistributedView() = default;
    };
    /// Where particles are replicated on all ranks: each rank shows an equal part, in the order of one process.
    virtual std::unique_ptr<DistributedView> distributed_view() const { return nullptr; }
    /// In parallel: returns whether the fields have distributed storage.
    virtual bool holds_own_planes() const { return false; }
    /// The components of a field at a point, from a solver that evaluates them without a grid; false: interpolate fields().
    virtual bool answer(std::string_view /*field*/, const Vec<3>& /*at*/, std::span<real> /*values*/) const { return false; }
    /// Returns whether step() itself throws NumericalFailure where a field is not finite. Then no caller needs to check all fields after
    /// every step: they may be in device memory.
    virtual bool checks_itself() const { return false; }
    virtual std::vector<Integral> integrals() const = 0;
    /// Interactive forcing, where the scene names it and the solver supports it (effects.hand).
    virtual BrushForcing* brush() const { return nullptr; }
    /// The fields that may be written; none where the shown fields are not the solver's state.
    virtual std::vector<EditableField> editable() { return {}; }
    /// Called after such a field was written. Restores the invariants of a step: a divergence-free velocity that satisfies the boundary
    /// conditions, the liquid's volume balance. Throws BadInput for invalid values; the state is then unspecified.
    virtual void edited(const EditableField&) {}
    /// Adds particles to a set at positions in the domain [m], with velocities [m/s]. Returns false where the solver has no such set, or
    /// where another part of the scene would not take them into account. Throws BadInput as above.
    virtual bool add_particles(std::string_view /*set*/, std::span<const Vec<3>> /*at*/, std::span<const Vec<3>> /*velocity*/) {
        return false;
    }
    /// Removes the particles i of a set for which gone[i] is not 0.
    virtual bool remove_particles(std::string_view /*set*/, std::span<const unsigned char> /*gone*/) { return false; }
    /// Simulated time [s].
    virtual real time() const = 0;
    /// Saves everything that the next step depends on, exactly: restore(save()) continues bit for bit.
    virtual void save(Checkpoint& to) const = 0;
    virtual void restore(const Checkpoint& from) = 0;
    virtual const Passes& passes() const = 0;
    /// Bytes of all state and scratch memory of the solver.
    virtual std::size_t bytes() const = 0;
    /// What was built for each effect named by the scene.
    virtual std::vector<EffectPlan> effects() const { return {}; }
    /// Passes may be reset between frames, so that reports cover the interval.
    virtual Passes& passes() = 0;
};

}  // namespace weir
