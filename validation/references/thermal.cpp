// Self-similar growth of buoyant flow in an unbounded fluid (Morton, Taylor & Turner 1956; Scorer 1957; Lee & Emmons 1961 in 2D).
// With the buoyancy F of a thermal [m^(D+1)/s^2] as the only parameter, lengths go like (F t^2)^(1/(D+1)): z ~ t^(2/3) in 2D, t^(1/2) in
// 3D. A thermal that leaves rest as a disk (ball) in unbounded inviscid fluid accelerates as a whole by g' (D - 1)/D: the pressure that
// solves lap p = d(rho g')/dy inside a ball is linear there and takes the fraction 1/D of the buoyancy.
#include "validation/harness/fitting.hpp"
#include "validation/harness/reference.hpp"

#include <cmath>

using namespace weir;
using namespace weir::validation;

// The thermal is a hot ball of fluid at rest: initial.temperature = { name = "ball", ... }.
REFERENCE(thermal) {
    const scene::Table& ball = scene.root().table("initial.temperature");
    const scene::Table& buoyancy = needed_effect(scene, "buoyancy");
    const real excess = buoyancy.number("beta") * (ball.number("value") - buoyancy.number("ambient"));
    const int D = scene.dim();
    Reference ref{.source = "self-similarity: Morton, Taylor & Turner 1956; Scorer 1957 (exponents exact, factors not)"};
    ref.numbers = {{"exponent", 2.0 / (D + 1)},
                   {"radius", ball.number("radius")},
                   {"acceleration", excess * (D - 1) / D},
                   {"origin", ball.numbers("centre").at(1)}};
    return ref;
}

// A source at the floor feeds a plume; its front is counted from the floor.
REFERENCE(plume) {
    Reference ref{.source = "self-similarity of starting plumes: Turner 1962; Lee & Emmons 1961 in 2D (exponent exact, factor not)"};
    ref.numbers = {{"exponent", 1}, {"origin", scene.root().numbers("grid.origin").at(1)}};
    return ref;
}
