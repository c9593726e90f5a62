#include "sim/registry.hpp"

#include "flow/solver.hpp"
#include "heightfield/solver.hpp"
#include "pbf/solver.hpp"
#include "sph/solver.hpp"
#include "studies/kinds.hpp"
#include "tallcell/solver.hpp"
#include "water/solver.hpp"
#include "waves/solver.hpp"

#include <stdexcept>

namespace weir::sim {

const std::vector<scene::SolverKind>& registry() {
    static const std::vector<scene::SolverKind> kinds = {flow::kind(),
                                                         water::kind(),
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

}  // namespace weir::sim
