// Advection along characteristics: semi-Lagrangian (Stam 1999) and MacCormack's two-pass correction of it (Selle, Fedkiw, Kim, Liu &
// Rossignac 2008), for a velocity component or a cell field alike.
#pragma once
#include "core/grid.hpp"
#include "scene/scene.hpp"
#include "staggered/ghosts.hpp"
#include "staggered/projection.hpp"
#include "staggered/trace.hpp"

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

template <int D>
class CharacteristicAdvection {
public:
    explicit CharacteristicAdvection(const AdvectionOptions& options) : options_(options) {}
    /// q(I) = source(departure point of I) on `nodes`, plus what it is given on arrival; source must have its ghosts.
    void advect(const Padded<D>& source, const Boundary<D>& boundary, const Nodes<D>& nodes, const Backtrace<D>& trace, real dt,
                Grid<real, D>& q, const PressurePush<D>* on_arrival = nullptr);
    std::size_t bytes() const;

private:
    void sample(const Padded<D>& field, const Index<D>& first, int axis, const Displacement<D>& x, int count, real* out) const;
    void semi_lagrangian(const Padded<D>& source, const Nodes<D>& nodes, const Backtrace<D>& trace, real dt, Grid<real, D>& q) const;
    Padded<D>& prepare(const Padded<D>& source, const Nodes<D>& nodes, int planes_of_bounds);
    void predict(const Padded<D>& source, const Nodes<D>& nodes, const Backtrace<D>& trace, real dt, int bounds_from);
    void correct(const Padded<D>& source, const Nodes<D>& nodes, const Backtrace<D>& trace, real dt, Grid<real, D>& q,
                 const PressurePush<D>* on_arrival, int bounds_from) const;

    void follow_planes(const Padded<D>& source, const Boundary<D>& boundary, const Nodes<D>& nodes, const Backtrace<D>& trace, real dt,
                       Grid<real, D>& q, const PressurePush<D>* on_arrival);

    AdvectionOptions options_;
    std::array<Padded<D>, D + 1> predicted_;  // q̂, one per kind of node: they differ in extent
    std::vector<real> low_, high_;            // of the nodes around each departure point, by planes
};

}  // namespace weir::staggered
