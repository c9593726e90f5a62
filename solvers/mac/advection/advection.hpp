// Advection along characteristics: semi-Lagrangian (Stam 1999) and its two-pass MacCormack correction (Selle, Fedkiw, Kim, Liu & Rossignac
// 2008), for velocity components and cell fields.
#pragma once
#include "mac/advection/trace.hpp"
#include "mac/grid/ghosts.hpp"
#include "mac/grid/projection.hpp"
#include "parallel/grid.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace weir::mac {

enum class Scheme { semi_lagrangian, maccormack, conservative };
enum class Interpolation { linear, cubic, monotone_cubic };
/// The limiter of MacCormack for values outside the range of the nodes around the departure point (Selle et al. 2008, section 3.3).
enum class Limiter { clamp, revert, none };
enum class Flux { central, van_leer };

struct AdvectionOptions {
    Scheme scheme = Scheme::maccormack;
    Interpolation interpolation = Interpolation::linear;
    std::string trace = "rk2";
    Limiter limiter = Limiter::clamp;
    Flux flux = Flux::van_leer;  // of cell fields under `conservative`

    AdvectionOptions() = default;
    explicit AdvectionOptions(const scene::Table& scheme);
    static std::vector<scene::Key> keys();
};

/// A quantity with its ghosts, its boundary conditions, and the destination of its values.
template <int D>
struct Carried {
    const Padded<D>* source;
    const Boundary<D>* boundary;
    Grid<real, D>* q;
};

template <int D>
class CharacteristicAdvection {
public:
    explicit CharacteristicAdvection(const AdvectionOptions& options) : options_(options) {}
    /// q(I) = source(departure point of I) on `nodes`, plus explicit terms at the arrival point; source must have its ghosts filled.
    void advect(const Padded<D>& source, const Boundary<D>& boundary, const Nodes<D>& nodes, const Backtrace<D>& trace, real dt,
                Grid<real, D>& q, const PressurePush<D>* on_arrival = nullptr);
    /// The same for several quantities on the same nodes: trajectories are traced once.
    void advect(const std::vector<Carried<D>>& quantities, const Nodes<D>& nodes, const Backtrace<D>& trace, real dt,
                const PressurePush<D>* on_arrival = nullptr);
    /// In parallel: number of ghost planes that departure points reach in this step.
    void set_reach(int planes) { reach_ = planes; }
    std::size_t bytes() const;

private:
    /// Scratch of the i-th quantity.
    struct Room {
        std::array<Padded<D>, D + 1> predicted;  // q̂, one per kind of node, since their extents differ
        std::vector<real> low, high;             // of the nodes around each departure point, plane by plane
    };
    /// The arguments of one advection: quantities, nodes, trajectories, time step.
    struct Motion {
        const std::vector<Carried<D>>& quantities;
        Nodes<D> nodes;
        const Backtrace<D>& trace;
        real dt;
        const PressurePush<D>* on_arrival;
        Motion on_plane(int plane) const;
    };
    void sample(const Padded<D>& field, const Index<D>& first, int axis, const Displacement<D>& x, int count, real* out) const;
    void semi_lagrangian(const Motion& motion) const;
    void prepare(const Motion& motion, int planes_of_bounds);
    void predict(const Motion& motion, int bounds_from);
    void correct(const Motion& motion, int bounds_from) const;
    void limit(const Room& room, std::size_t at, const real* before, const real* hat, const real* returned, int count, real* out) const;
    void follow_planes(const Motion& motion);

    AdvectionOptions options_;
    int reach_ = ghost_layers;
    std::vector<Room> room_;
    std::vector<WithBoundary<D>> predicted_;  // of the last prepare()
    std::vector<Carried<D>> one_{1};
};

}  // namespace weir::mac
