// Self-similar growth of buoyant flow in an unbounded fluid (Morton, Taylor & Turner 1956; Scorer 1957; Lee & Emmons 1961 in 2D).
// With the buoyancy F of a thermal [m^(D+1)/s^2] or the flux B of a plume [m^(D+1)/s^3] as the only parameters, lengths go like
//   thermal: (F t^2)^(1/(D+1)):  z ~ t^(2/3) in 2D, t^(1/2) in 3D;    starting plume: (B t^3)^(1/(D+1)):  z ~ t in 2D, t^(3/4) in 3D.
// A thermal that leaves rest as a disk (ball) in unbounded inviscid fluid accelerates as a whole by g' (D - 1)/D: the pressure that
// solves lap p = d(rho g')/dy inside a ball is linear there and takes the fraction 1/D of the buoyancy.
#include "validation/harness/reference.hpp"

#include <cmath>

using namespace weir;
using namespace weir::validation;

namespace {

/// Height above the floor from which self-similar growth is counted.
real above_floor(const scene::Scene& scene, real height) { return scene.root().numbers("grid.origin").at(1) + height; }

}  // namespace

// The thermal is a hot ball of fluid at rest: initial.temperature = { name = "ball", ... }.
REFERENCE(thermal) {
    const scene::Table& ball = scene.root().table("initial.temperature");
    const scene::Table* buoyancy = scene.effect("buoyancy");
    const real excess = buoyancy->number("beta") * (ball.number("value") - buoyancy->number("ambient"));
    const int D = scene.dim();
    Reference ref{.source = "self-similarity: Morton, Taylor & Turner 1956; Scorer 1957 (exponents exact, factors not)"};
    ref.numbers = {{"exponent", 2.0 / (D + 1)},
                   {"radius", ball.number("radius")},
                   {"acceleration", excess * (D - 1) / D},
                   {"origin", ball.numbers("centre").at(1)}};
    return ref;
}

// The source is the scene's first emitter.
REFERENCE(plume) {
    const scene::Table& source = scene.root().tables("emitters").at(0);
    Reference ref{.source = "self-similarity: Morton, Taylor & Turner 1956; Lee & Emmons 1961 (exponents exact, factors not)"};
    ref.numbers = {{"exponent", 1},  // of the length (F t^2)^(1/(D+1)), whatever the history of the heat F
                   {"origin", source.has("max") ? source.numbers("max").at(1) : above_floor(scene, 0)}};
    return ref;
}
