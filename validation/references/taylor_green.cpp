#include "validation/references/taylor_green.hpp"

#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

namespace weir::validation {
namespace {

/// Viscosity acts in a scene only where its effect is named.
real acting_viscosity(const scene::Scene& scene) { return scene.effect("viscosity") ? scene.number("fluid.viscosity") : 0; }

}  // namespace
}  // namespace weir::validation

using namespace weir;
using namespace weir::validation;

REFERENCE(taylor_green) {
    const TaylorGreen flow{.U = scene.root().number_or("initial.velocity.speed", 1),
                           .k = scene.root().number_or("initial.velocity.wavenumber", 1),
                           .nu = acting_viscosity(scene),
                           .rho = scene.number("fluid.density")};
    Reference ref{.source = "Taylor & Green 1937 (exact)"};
    ref.vectors["velocity"] = [flow](const Vec<3>& x, real t) {
        const Vec<2> u = flow.velocity({x[0], x[1]}, t);
        return Vec<3>{u[0], u[1], 0};
    };
    ref.scalars["pressure"] = [flow](const Vec<3>& x, real t) { return flow.pressure({x[0], x[1]}, t); };
    ref.up_to_a_constant = {"pressure"};
    return ref;
}

// The 3D vortex at Re = 1600: a history, not a formula. Time in units of 1/(k U), energy and dissipation per unit of mass.
REFERENCE(taylor_green_3d) {
    const Table dns = read_table(data / "tgv3d_Re1600_spectral512.csv");
    Reference ref{.source = "pseudo-spectral DNS with 512^3 modes, van Rees et al. 2011 (Int. Workshop on High-Order CFD Methods, C3.5)"};
    ref.curves["kinetic_energy"] = dns.curve("t", "kinetic_energy", "spectral DNS, 512^3");
    ref.curves["dissipation"] = dns.curve("t", "minus_dKdt", "spectral DNS, 512^3");
    const Curve& eps = ref.curves["dissipation"];
    std::size_t peak = 0;
    for (std::size_t i = 0; i < eps.size(); ++i)
        if (eps.y[i] > eps.y[peak]) peak = i;
    ref.numbers = {{"peak_dissipation", eps.y[peak]}, {"peak_time", eps.x[peak]}};
    return ref;
}
