// A ball, a disc or a block of liquid: its volume, and how far a point lies inside it. Written out here, not taken from the shapes that
// scenes are filled with.
#include "validation/harness/reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace weir;
using namespace weir::validation;

namespace {

Reference ball(const Vec<3>& centre, real radius) {
    Reference ref{.source = "a ball (exact)"};
    ref.numbers["volume"] = 4 * std::numbers::pi / 3 * radius * radius * radius;
    ref.scalars["depth"] = [=](const Vec<3>& x, real) { return radius - norm(x - centre); };
    ref.scalars["from_edges"] = [](const Vec<3>&, real) { return infinity; };
    return ref;
}

Reference disc(const Vec<2>& centre, real radius) {
    Reference ref = ball({{centre[0], centre[1], 0}}, radius);
    ref.source = "a disc (exact)";
    ref.numbers["volume"] = std::numbers::pi * radius * radius;
    return ref;
}

Reference block(const Vec<3>& lo, const Vec<3>& hi) {
    Reference ref{.source = "a block (exact)"};
    const Vec<3> size = hi - lo;
    ref.numbers["volume"] = size[0] * size[1] * size[2];
    ref.scalars["depth"] = [=](const Vec<3>& x, real) {
        real nearest = infinity;
        Vec<3> out{};
        for (int a = 0; a < 3; ++a) {
            nearest = std::min({nearest, x[a] - lo[a], hi[a] - x[a]});
            out[a] = std::max({lo[a] - x[a], x[a] - hi[a], 0.0});
        }
        return nearest >= 0 ? nearest : -norm(out);
    };
    // to the second nearest of the three pairs of sides: an edge is where two of them meet
    ref.scalars["from_edges"] = [=](const Vec<3>& x, real) {
        std::array<real, 3> to;
        for (int a = 0; a < 3; ++a) to[static_cast<std::size_t>(a)] = std::min(std::abs(x[a] - lo[a]), std::abs(hi[a] - x[a]));
        std::sort(to.begin(), to.end());
        return std::hypot(to[0], to[1]);
    };
    return ref;
}

}  // namespace

REFERENCE(liquid_body) {
    const auto& list = scene.root().tables("liquid");
    if (scene.dim() == 2 && list.size() == 1 && list[0].text("shape") == "sphere")
        return disc(list[0].vec<2>("centre"), list[0].number("radius"));
    if (scene.dim() == 2) throw BadInput("the reference \"liquid_body\" in 2D is one disc of liquid");
    if (list.size() == 1 && list[0].text("shape") == "sphere") return ball(list[0].vec<3>("centre"), list[0].number("radius"));
    if (list.size() == 1 && list[0].text("shape") == "box") return block(list[0].vec<3>("min"), list[0].vec<3>("max"));
    throw BadInput("the reference \"liquid_body\" is one sphere or one box of liquid");
}
