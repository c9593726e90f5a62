#include "mac/grid/own_planes.hpp"

#include "geometry/sides.hpp"
#include "mac/grid/state.hpp"
#include "parallel/load_balance.hpp"
#include "poisson/poisson.hpp"

namespace weir::mac {

namespace {

const poisson::Method& method_of(const scene::Scene& scene) { return poisson::method_named(scene.root().text("scheme.poisson.method")); }

}  // namespace

bool holds_own_planes(const scene::Scene& scene, const Partition& cut) {
    return !communicator().holds_whole() && could_hold_own_planes(scene, cut);
}

bool could_hold_own_planes(const scene::Scene& scene, const Partition& cut) {
    if (cut.empty()) return false;
    if (!method_of(scene).distributed_levels) return false;
    const auto shares = [&]<int D>() {
        const Lattice<D> lattice(scene);
        const geometry::Sides<D> sides(scene);
        Vec<D> weight;
        std::array<bool, D> periodic;
        for (int a = 0; a < D; ++a) {
            const real ratio = lattice.h[0] / lattice.h[a];
            weight[a] = ratio * ratio, periodic[static_cast<std::size_t>(a)] = sides.periodic(a);
        }
        return poisson::multigrid_shares<D>(lattice.cells, periodic, weight, cut);
    };
    return scene.dim() == 2 ? shares.operator()<2>() : shares.operator()<3>();
}

scene::ReplicatedWorks replicated_pressure(const scene::Scene& scene, const Partition& cut) {
    using scene::ReplicatedWork;
    if (could_hold_own_planes(scene, cut)) return {ReplicatedWork::small_pressure_levels};
    if (method_of(scene).distributed_levels) return {ReplicatedWork::pressure_levels};
    return {method_of(scene).needs_petsc ? ReplicatedWork::pressure_matrix : ReplicatedWork::pressure};
}

template <int D>
const Slab* slab_of(const scene::Scene& scene, const Partition& partition, int ghost_planes) {
    return weir::slab_of(partition, holds_own_planes(scene, partition) ? ghost_planes : 0, geometry::Sides<D>(scene).periodic(D - 1));
}

template const Slab* slab_of<2>(const scene::Scene&, const Partition&, int);
template const Slab* slab_of<3>(const scene::Scene&, const Partition&, int);

}  // namespace weir::mac
