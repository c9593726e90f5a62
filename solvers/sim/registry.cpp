#include "sim/registry.hpp"

#include "heightfield/solver.hpp"
#include "parallel/load_balance.hpp"
#include "pbf/solver.hpp"
#include "scene/names.hpp"
#include "sim/shares.hpp"
#include "smoke/solver.hpp"
#include "sph/solver.hpp"
#include "studies/kinds.hpp"
#include "tallcell/solver.hpp"
#include "two_phase/solver.hpp"
#include "water/solver.hpp"
#include "waves/solver.hpp"

#include <stdexcept>

namespace weir::sim {

const std::vector<scene::SolverKind>& registry() {
    static const std::vector<scene::SolverKind> kinds = {smoke::kind(),
                                                         water::kind(),
                                                         two_phase::kind(),
                                                         studies::transport_kind(),
                                                         studies::poisson_kind(),
                                                         pbf::kind(),
                                                         sph::kind(),
                                                         tallcell::kind(),
                                                         heightfield::kind(),
                                                         waves::kind(),
                                                         studies::phase_diagram_kind(),
                                                         studies::reconstruction_kind(),
                                                         studies::closed_vessel_kind()};
    return kinds;
}

const std::vector<scene::SolverSchema>& schemas() {
    static const std::vector<scene::SolverSchema> list = scene::schemas_of(registry());
    return list;
}

const scene::SolverKind& kind_named(std::string_view name, const std::vector<scene::SolverKind>& kinds) {
    for (const auto& kind : kinds)
        if (kind.schema.name == name) return kind;
    throw std::logic_error("no solver is registered as \"" + std::string(name) + "\"");
}

namespace {
int planes_of(const scene::Scene& scene) { return static_cast<int>(scene.root().numbers("grid.cells").back()); }
}  // namespace

void require_ranks(const scene::Scene& scene, int ranks, const std::vector<scene::SolverKind>& kinds) {
    if (ranks == 1) return;
    const auto& kind = kind_named(scene.solver(), kinds);
    if (!kind.parallel.check) {
        std::string able;
        for (const auto& other : kinds)
            if (other.parallel.check) able += (able.empty() ? "" : ", ") + scene::quote(other.schema.name);
        scene.refuse(
            "solver",
            "solver " + scene::quote(scene.solver()) + " runs in one process only, and the number of ranks is " + std::to_string(ranks),
            "solvers that run in parallel: " + able);
    }
    kind.parallel.check(scene);
    const int planes = planes_of(scene);
    if (kind.parallel.shared == scene::Shared::by_planes && planes < ranks &&
        !(kind.parallel.partition && kind.parallel.partition(scene, ranks).empty()))
        scene.refuse("grid.cells",
                     std::to_string(planes) + " planes of cells along " + (scene.dim() == 2 ? "y" : "z") + " cannot be partitioned over " +
                         std::to_string(ranks) + " ranks",
                     "at most " + std::to_string(planes));
}

Partition equal_shares(const scene::Scene& scene, int ranks, const scene::SolverKind& kind) {
    if (ranks == 1 || kind.parallel.shared == scene::Shared::by_particles) return {};
    return kind.parallel.partition ? kind.parallel.partition(scene, ranks) : equal_partition(planes_of(scene), ranks);
}

Shares shares_of(const scene::Scene& scene, int ranks, const scene::SolverKind& kind) {
    Shares shares{.shared = kind.parallel.shared};
    if (ranks == 1 || shares.shared == scene::Shared::by_particles) return shares;
    if (kind.parallel.work_of_planes && !kind.parallel.partition)
        shares.cut = load_balanced_partition(kind.parallel.work_of_planes(scene, nullptr), ranks);
    else
        shares.cut = equal_shares(scene, ranks, kind);
    if (shares.cut.empty())
        shares.replicated_work = {scene::ReplicatedWork::everything};
    else if (kind.parallel.replicated_work)
        shares.replicated_work = kind.parallel.replicated_work(scene, shares.cut);
    return shares;
}

Shares shares_of(const scene::Scene& scene, int ranks, const std::vector<scene::SolverKind>& kinds) {
    return shares_of(scene, ranks, kind_named(scene.solver(), kinds));
}

}  // namespace weir::sim
