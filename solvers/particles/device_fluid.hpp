// The state of particles on a device, and what every solver does with it there: forces and prediction, sorting, the neighbour list, XSPH
// and vorticity, reductions. The passes over pairs are the text that the processor's path compiles too (kernels/). The host keeps a copy
// that follows when somebody looks.
#pragma once
#include "core/effects.hpp"
#include "core/passes.hpp"
#include "particles/cell_sort.hpp"
#include "particles/device_memory.hpp"
#include "particles/emitters.hpp"
#include "particles/heat.hpp"
#include "particles/ice.hpp"
#include "particles/passes.hpp"
#include "particles/scheme.hpp"

#include <memory>

namespace weir::particles {

/// Work items of a group of passes over particles; groups that reduce.
inline constexpr std::size_t device_group = 128, device_reduction_groups = 256;

/// What a solver brings: its kernels, and the numbers that they read.
struct DeviceSetup {
    int device = 0;
    int kernel = 0;                  // 0: Müller's, 1: cubic, 2: Wendland
    std::vector<std::string> files;  // of kernels, beyond those of this class
    std::string defines;             // "-DWEIR_KEEP ..."
    single::PbfParams kernels{};     // as PBF, XSPH and vorticity read them
    single::WallParams walls{};
    plain::WallParams exact_walls{};  // as solids are read by
    real support = 0;                 // [m]
};
/// And what the scheme says of it.
template <int D>
DeviceSetup with_scheme(DeviceSetup own, const Scheme& scheme, const Domain<D>& domain);

/// The effects that act on a device; what is not named is not compiled.
template <int D>
struct DeviceEffects {
    bool gravity = false, central_force = false, xsph = false, vorticity = false;
    Vec<D> g{};                     // [m/s^2]
    real omega = 0;                 // of the central force [1/s]
    Vec<D> centre{};                // [m]
    real smoothing = 0;             // c of XSPH
    real confinement = 0;           // epsilon of vorticity [m/s]
    std::shared_ptr<Heat<D>> heat;  // where a substance is named
    Emitters<D> emitters;           // and sinks
    real end = 0;                   // of the run: until then they let in [s]
    std::vector<EffectPlan> plans;

    DeviceEffects() = default;
    explicit DeviceEffects(const scene::Scene& scene);
};

/// The distances to solids at rest as text of a device's program (kernels/solids.cl).
template <int D>
std::string text_of(const geometry::Solids<D>& solids);

/// Whether a place is in a sink, likewise.
template <int D>
std::string text_of(const std::vector<geometry::ShapePtr<D>>& sinks);

/// Whether a place is in heater number `which`, likewise.
template <int D>
std::string text_of(const std::vector<typename Heat<D>::Heater>& heaters);

/// Everything of a scene that only the processor's path has, as problems at its keys: throws BadScene if there is any.
void refuse_what_devices_lack(const scene::Scene& scene);

template <int D>
class DeviceFluid {
public:
    using Memory = backend::Memory;

    /// Opens the device and compiles; the fluid's own arrays are planned. `settle_in` takes the memory.
    DeviceFluid(Fluid<D> start, const DeviceEffects<D>& effects, const DeviceSetup& setup);
    /// Memory for the planned arrays, the solver's included, and the state into it. Throws BadInput where it does not fit.
    void settle_in();

    /// The state as it is now, brought here where the device has gone on.
    const Fluid<D>& host() const;
    /// The same to be changed: the device follows before its next pass.
    Fluid<D>& change();
    real time() const { return host_.time; }
    int count() const { return device_is_old_ ? host_.count() : count_; }
    int stride() const { return stride_; }
    /// The fluid's constants; its particles may be old.
    const Fluid<D>& setting() const { return host_; }
    const Domain<D>& domain() const { return host_.domain; }
    Domain<D>& domain() { return host_.domain; }
    const Vec<D>& gravity() const { return host_.gravity; }
    real rest_density() const { return host_.rho0; }

    /// Numbers that a solver's kernels read, kept on the device.
    template <class T>
    Memory constant(const T& value) {
        Memory memory = device_->alloc(sizeof value);
        device_->upload(memory, &value, sizeof value);
        return memory;
    }
    /// Everything that enters in (time, time + dt], and out what has reached a sink.
    void let_in(real dt);
    /// v += dt f of the scene's forces; x* = x + dt v.
    void predict(real dt);
    /// Time goes on, and solids that move with it.
    void pass_time(real dt);
    /// What "central_force" pulls in dt, over the distance.
    real pull(real dt) const { return dt * effects_.omega * effects_.omega; }
    /// Sorts particles by these positions (x or x*), loads them into a, finds neighbours closer than the support, and what solids are near.
    void find_neighbours(const Memory& positions);
    /// After a is changed: particles out of solids, and the solids' terms at the new places.
    void leave_solids();
    /// XSPH and vorticity, where the scene names them.
    void finish(real dt);
    /// Heat over dt, between particles where a has them.
    void conduct(Heat<D>& heat, real dt);
    /// After the neighbours are found: what density particles are to have, where the scene lets them boil.
    void expand();
    /// What is frozen does not move: it has no velocity, and is predicted and corrected to where it is. Or it moves in pieces.
    void hold();
    void hold_again();
    void hold_prediction(real dt);
    void hold_places();
    /// Pieces of ice after an update of positions, what moved them in dt; and by a drift of dt.
    void arrive(real dt);
    void carry_ice(real dt);
    bool ice_moves() const { return ice_ && effects_.heat->frozen() > 0; }
    /// Counts a step; the state follows the sorted order now and then, so that gathers stay near in memory; what has crossed a side is
    /// taken back or out.
    void end_step();

    /// Zeroes a number of so many bytes of each particle.
    void clear(const Memory& numbers, std::size_t bytes_per_particle);
    /// So many numbers of each particle, to the host and back.
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
    /// The state as it is now, for those who go on with it on the host within a step, and send what they have changed.
    Fluid<D>& borrow();
    /// Solids are where the host has put them.
    void place_solids();
    /// What solids add where a is, after they or some particles have moved.
    void renew_terms();
    /// A kernel over all particles.
    void run(std::string_view kernel, std::initializer_list<backend::Argument> arguments);
    /// A kernel that leaves (largest, sum) of each group in parts(), and their whole.
    struct Reduced {
        real largest = 0, sum = 0;
    };
    Reduced reduce(std::string_view kernel, std::initializer_list<backend::Argument> arguments);
    /// Finds the largest speed [m/s]. Throws NumericalFailure naming the quantity that is not finite.
    real max_speed();
    /// The one found last, or the host's where the state was changed there.
    real speed() const { return device_is_old_ ? host_.max_speed() : speed_; }
    real max_dt() const { return effects_.omega > 0 ? 0.5 / effects_.omega : infinity; }  // of the forces

    Pairs::NeighbourCounts neighbour_counts() const;
    /// State particles in sorted order.
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
    Memory enthalpy;                                  // where particles carry heat
    Memory rests;                                     // of sorted particles that may boil: their densities over the liquid's
    Memory order, a, b, neighbours, list;             // sorted particles: owners, float4, their neighbours
    Memory clamps;                                    // how often walls and solids put a particle back, and from how far
    Memory near_solid, terms, poses;                  // of solids: sorted particles near one, what they add there; where they are
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
    void count_clamps();
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
    int count_ = 0, sorted_count_ = 0;  // particles on the device; and when they were sorted last
    int stride_ = 1, room_ = 0, growths_ = 0, group_ = 1;
    bool repeats_ = false, open_ = false, solid_ = false;  // any axis; any side; any solid
    real support_ = 0;
    DeviceEffects<D> effects_;
    real speed_ = 0;
    std::uint32_t clamps_seen_ = 0;
    Memory solid_series_;
    Memory warming_, by_walls_, heat_pairs_, heat_walls_, heat_states_;
    Memory shift_, vapour_, above_;
    Memory id_, scratch_, names_, cell_, sorted_cell_, velocities_, omegas_;
    Memory start_, members_, blocks_, parts_, needed_;
    std::size_t cells_room_ = 0;
    std::vector<double> host_parts_, host_poses_;
    std::unique_ptr<Ice<D>> ice_;  // where what is frozen moves
    std::array<std::vector<real>, D> ice_places_;
    std::vector<int> ice_order_, ice_sorted_;
    std::vector<float> ice_four_;
};

}  // namespace weir::particles
