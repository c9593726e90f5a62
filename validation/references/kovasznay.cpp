#include "validation/references/kovasznay.hpp"

#include "validation/harness/reference.hpp"

using namespace weir;
using namespace weir::validation;

REFERENCE(kovasznay) {
    const Kovasznay flow{.Re = 1 / scene.number("fluid.viscosity")};
    const real rho = scene.number("fluid.density");
    Reference ref{.source = "Kovasznay 1948 (exact)"};
    ref.vectors["velocity"] = [flow](const Vec<3>& x, real) {
        const Vec<2> u = flow.velocity({x[0], x[1]});
        return Vec<3>{u[0], u[1], 0};
    };
    ref.scalars["pressure"] = [flow, rho](const Vec<3>& x, real) { return rho * flow.pressure({x[0], x[1]}); };
    ref.up_to_a_constant = {"pressure"};
    return ref;
}
