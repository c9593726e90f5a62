// The state of particles on a device, and the passes shared by all solvers: forces and prediction, sorting, the neighbour list, XSPH and
// vorticity, reductions. The pair passes compile the same text as the processor's path (kernels/). The host keeps a copy that is updated on
// request.
#pragma once
#include "core/effects.hpp"
#include "core/passes.hpp"
#include "particles/heat/heat.hpp"
#include "particles/heat/ice.hpp"
#include "particles/opencl/device_memory.hpp"
#include "particles/state/emitters.hpp"
#include "particles/state/scheme.hpp"
#include "particles/threads/cell_sort.hpp"
#include "particles/threads/passes.hpp"

#include <memory>

namespace weir::particles {

/// Work items per group of passes over particles; number of groups in reductions.
inline constexpr std::size_t device_group = 128, device_reduction_groups = 256;

/// The kernels of a solver, and their parameters.
struct DeviceSetup {
    int device = 0;
    int kernel = 0;                  // 0: Müller's, 1: cubic, 2: Wendland
    std::vector<std::string> files;  // of kernels, beyond those of this class
    std::string defines;             // "-DWEIR_KEEP ..."
    single::PbfParams kernels{};     // parameters of PBF, XSPH and vorticity
    single::WallParams walls{};
    plain::WallParams exact_walls{};  // for solids
    real support = 0;                 // [m]
};
/// Adds the parameters of the scheme.
template <int D>
DeviceSetup with_scheme(DeviceSetup own, const Scheme& scheme, const Domain<D>& domain);

/// The effects on a device; kernels of unused effects are not compiled.
template <int D>
struct DeviceEffects {
    bool gravity = false, central_force = false, xsph = false, vorticity = false;
    Vec<D> g{};                     // [m/s^2]
    real omega = 0;                 // of the central force [1/s]
    Vec<D> centre{};                // [m]
    real smoothing = 0;             // c of XSPH
    real confinement = 0;           // epsilon of vorticity [m/s]
    std::shared_ptr<Heat<D>> heat;  // where the scene names a substance
    Emitters<D> emitters;           // and sinks
    real end = 0;                   // of the run: emitters are open until then [s]
    std::vector<EffectPlan> plans;

    DeviceEffects() = default;
    explicit DeviceEffects(const scene::Scene& scene);
};

/// Distances to solids at rest, as program text of a device (kernels/solids.cl).
template <int D>
std::string text_of(const geometry::Solids<D>& solids);

/// Whether a point lies in a sink, likewise.
template <int D>
std::string text_of(const std::vector<geometry::ShapePtr<D>>& sinks);

/// Whether a point lies in heater `which`, likewise.
template <int D>
std::string text_of(const std::vector<typename Heat<D>::Heater>& heaters);

/// Throws BadScene, with the keys, where a scene uses features that only the processor's path has.
void refuse_what_devices_lack(const scene::Scene& scene);

template <int D>
class DeviceFluid {
public:
    using Memory = backend::Memory;

    /// Opens the device and compiles; the fluid's own arrays are planned. `settle_in` allocates the memory.
    DeviceFluid(Fluid<D> start, const DeviceEffects<D>& effects, const DeviceSetup& setup);
    /// Allocates the planned arrays, including the solver's, and uploads the state. Throws BadInput where the memory does not suffice.
    void settle_in();

    /// The current state, downloaded where the device has advanced.
    const Fluid<D>& host() const;
    /// The same for writing: the device is updated before its next pass.
    Fluid<D>& change();
    real time() const { return host_.time; }
    int count() const { return device_is_old_ ? host_.count() : count_; }
    int stride() const { return stride_; }
    /// The fluid's constants; its particles may be stale.
    const Fluid<D>& setting() const { return host_; }
    const Domain<D>& domain() const { return host_.domain; }
    Domain<D>& domain() { return host_.domain; }
    const Vec<D>& gravity() const { return host_.gravity; }
    real rest_density() const { return host_.rho0; }

    /// Parameters of a solver's kernels, stored on the device.
    template <class T>
    Memory constant(const T& value) {
        Memory memory = device_->alloc(sizeof value);
        device_->upload(memory, &value, sizeof value);
        return memory;
    }
    /// Adds particles that enter in (time, time + dt], and removes those in sinks.
    void add_inflow(real dt);
    /// v += dt f with the scene's forces; x* = x + dt v.
    void predict(real dt);
    /// Advances time and moves the solids.
    void pass_time(real dt);
    /// Factor of "central_force" in dt, per distance.
    real pull(real dt) const { return dt * effects_.omega * effects_.omega; }
    /// Sorts particles by these positions (x or x*), loads them into a, finds neighbours closer than the support and nearby solids.
    void find_neighbours(const Memory& positions);
    /// After a has changed: moves particles out of solids, and computes the solids' terms there.
    void leave_solids();
    /// XSPH and vorticity, where the scene names them.
    void finish(real dt);
    /// Conduction over dt between particles at a.
    void conduct(Heat<D>& heat, real dt);
    /// After the neighbour search: the rest densities of particles that may boil.
    void expand();
    /// Frozen particles do not move: they have zero velocity and keep their position; or they move in pieces.
    void stop_frozen();
    void stop_frozen_again();
    void keep_frozen_prediction(real dt);
    void keep_frozen_positions();
    /// Updates the pieces of ice after the positions, whose displacements took dt; also after a drift of dt.
    void finish_ice_motion(real dt);
    void carry_ice(real dt);
    bool ice_moves() const { return ice_ && effects_.heat->frozen() > 0; }
    /// Counts a step. At intervals the state is reordered to the sorted order for locality. Particles beyond sides are wrapped or removed.
    void end_step();

    /// Clears an array with this many bytes per particle.
    void clear(const Memory& numbers, std::size_t bytes_per_particle);
    /// Transfers numbers of each particle to the host and back.
    template <class T>
    void read(const Memory& from, std::vector<T>& to, std::size_t each = 1) const {
        to.resize(each * static_cast<std::size_t>(count_));
        if (!to.empty()) device_->download(to.data(), from, to.size() * sizeof(T));
    }
    template <class T>
    void write(const std::vector<T>& from, const Memory& to) {
        if (!from.empty()) device_->upload(to, from.data(), from.size() * sizeof(T));
    }
    void fetch(const Memory& from, std::array<std::vector<real>, D>& to) const;
    void send(const std::array<std::vector<real>, D>& from, const Memory& to);
    /// The current state for changes on the host within a step, to be uploaded afterwards.
    Fluid<D>& borrow();
    /// Uploads the poses of solids from the host.
    void place_solids();
    /// Recomputes the solids' terms at a, after they or some particles have moved.
    void renew_terms();
    /// Runs a kernel over all particles.
    void run(std::string_view kernel, std::initializer_list<backend::Argument> arguments);
    /// Runs a kernel that writes (largest, sum) of each group to parts(), and reduces them.
    struct Reduced {
        real largest = 0, sum = 0;
    };
    Reduced reduce(std::string_view kernel, std::initializer_list<backend::Argument> arguments);
    /// Finds the largest speed [m/s]. Throws NumericalFailure naming the quantity that is not finite.
    real max_speed();
    /// The last result, or the host's where the state was changed there.
    real speed() const { return device_is_old_ ? host_.max_speed() : speed_; }
    real max_dt() const { return effects_.omega > 0 ? 0.5 / effects_.omega : infinity; }  // of the forces

    Pairs::NeighbourCounts neighbour_counts() const;
    /// Original indices of the particles in sorted order.
    std::vector<int> sorted_order() const;
    int growths() const { return growths_; }
    /// Kernel times since the last call, as passes.
    void record(Passes& passes);
    std::size_t bytes() const { return host_.bytes() + device_->allocated(); }
    const std::vector<EffectPlan>& effects() const { return effects_.plans; }
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    const backend::Device& device() const { return *device_; }
    DevicePlan& plan() { return plan_; }
    const DevicePlan& plan() const { return plan_; }

    Memory x, v, x_star, density, carried;            // state, double precision
    Memory enthalpy;                                  // where particles have heat
    Memory rests;                                     // of sorted particles that may boil: their densities relative to the liquid's
    Memory order, a, b, neighbours, list;             // sorted particles: original index, float4, their neighbours
    Memory corrections;                               // number of boundary corrections, and the largest distance
    Memory near_solid, terms, poses;                  // solids: sorted particles near one, their terms there; poses
    Memory state_params, wall_params, kernel_params;  // constants
    const Memory& parts() const { return parts_; }

private:
    void compile(const DeviceSetup& setup);
    void upload();
    void download() const;
    CellGrid cover(const Memory& positions);
    void sort(const Memory& positions, const CellGrid& grid);
    void exclusive_sums(int count, const Memory& in, const Memory& out);
    void build_list(const CellGrid& grid);
    void grow_list(int needed);
    void count_corrections();
    void reorder();
    void cross_sides();
    void take_series(const plain::WallParams& walls);
    void meet_solids();
    void append(const std::array<std::vector<real>, D>& places, const std::array<std::vector<real>, D>& velocities,
                const std::vector<real>& enthalpies);
    void feed(Heat<D>& heat, real dt);
    void exchange(Heat<D>& heat, real outside, real part);
    void find_ice();
    void predict_ice(real dt);
    void place_ice();
    bool take_out(std::string_view find_stayers);
    std::size_t most_particles() const;

    std::unique_ptr<backend::Device> device_;
    mutable Fluid<D> host_;
    mutable bool host_is_old_ = false, device_is_old_ = true;
    DevicePlan plan_;
    int count_ = 0, sorted_count_ = 0;  // particles on the device now, and at the last sort
    int stride_ = 1, room_ = 0, growths_ = 0, group_ = 1;
    bool repeats_ = false, open_ = false, solid_ = false;  // whether any axis is periodic, any side open, any solid present
    real support_ = 0;
    DeviceEffects<D> effects_;
    real speed_ = 0;
    std::uint32_t corrections_seen_ = 0;
    Memory solid_series_;
    Memory warming_, by_walls_, heat_pairs_, heat_walls_, heat_states_;
    Memory shift_, vapour_, above_;
    Memory id_, scratch_, names_, cell_, sorted_cell_, velocities_, omegas_;
    Memory start_, members_, blocks_, parts_, needed_;
    std::size_t cells_room_ = 0;
    std::vector<double> host_parts_, host_poses_;
    std::unique_ptr<Ice<D>> ice_;  // where frozen pieces move
    std::array<std::vector<real>, D> ice_places_;
    std::vector<int> ice_order_, ice_sorted_;
    std::vector<float> ice_four_;
};

}  // namespace weir::particles
