// Self-similar growth of buoyant flow in an unbounded fluid (Morton, Taylor & Turner 1956; Scorer 1957; Lee & Emmons 1961 in 2D).
// With the buoyancy F of a thermal [m^(D+1)/s^2] or the flux B of a plume [m^(D+1)/s^3] as the only parameters, lengths go like
//   thermal: (F t^2)^(1/(D+1)):  z ~ t^(2/3) in 2D, t^(1/2) in 3D;    starting plume: (B t^3)^(1/(D+1)):  z ~ t in 2D, t^(3/4) in 3D.
#include "validation/harness/reference.hpp"

#include <cmath>

using namespace weir;
using namespace weir::validation;

REFERENCE(thermal) {
    Reference ref{.source = "self-similarity: Morton, Taylor & Turner 1956; Scorer 1957 (exponents exact, factors not)"};
    ref.numbers["exponent"] = 2.0 / (scene.dim() + 1);
    return ref;
}

REFERENCE(plume) {
    Reference ref{.source = "self-similarity: Morton, Taylor & Turner 1956; Lee & Emmons 1961 (exponents exact, factors not)"};
    ref.numbers["exponent"] = 3.0 / (scene.dim() + 1);
    return ref;
}
