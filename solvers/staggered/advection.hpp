// Advection along characteristics: semi-Lagrangian (Stam 1999) and MacCormack's two-pass correction of it (Selle, Fedkiw, Kim, Liu &
// Rossignac 2008), for a velocity component or a cell field alike.
#pragma once
#include "core/grid.hpp"
#include "scene/scene.hpp"
#include "staggered/ghosts.hpp"
#include "staggered/projection.hpp"
#include "staggered/trace.hpp"

#include <vector>

namespace weir::staggered {

enum class Scheme { semi_lagrangian, maccormack, conservative };
enum class Interpolation { linear, cubic, monotone_cubic };
/// What MacCormack does with a value outside the nodes that surround the departure point (Selle et al. 2008, section 3.3).
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

/// A quantity with its ghosts and its conditions on the sides, and where it goes.
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
    /// q(I) = source(departure point of I) on `nodes`, plus what it is given on arrival; source must have its ghosts.
    void advect(const Padded<D>& source, const Boundary<D>& boundary, const Nodes<D>& nodes, const Backtrace<D>& trace, real dt,
                Grid<real, D>& q, const PressurePush<D>* on_arrival = nullptr);
    /// The same of several quantities on the same nodes: their paths are followed once.
    void advect(const std::vector<Carried<D>>& quantities, const Nodes<D>& nodes, const Backtrace<D>& trace, real dt,
                const PressurePush<D>* on_arrival = nullptr);
    std::size_t bytes() const;

private:
    /// Of what is carried as the i-th of several.
    struct Room {
        std::array<Padded<D>, D + 1> predicted;  // q̂, one per kind of node: they differ in extent
        std::vector<real> low, high;             // of the nodes around each departure point, by planes
    };
    /// What moves how far in which time.
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
    std::vector<Room> room_;
    std::vector<WithBoundary<D>> predicted_;  // of the last prepare()
    std::vector<Carried<D>> one_{1};
};

}  // namespace weir::staggered
