// An emitter anywhere pours its flux, and nothing moves faster than a jet: in the open, at the floor with and without a pool, in a corner,
// half inside a solid. Where its faces were not prescribed to the pressure, FLIP added the difference up step by step, to 57 m/s.
#include "support.hpp"

#include <cmath>

namespace emitters_tests {

using namespace weir;
using namespace weir::test;

namespace {

constexpr real speed = 3, g = 9.81, wide = 0.2, deep = 0.1;

/// Pours upwards with `speed` from a box `wide` and `deep` whose lower corner is at (x, y[, x]), into a unit box.
template <int D>
std::string fountain(const std::string& transfer, real x, real y, const std::string& more) {
    const auto number = [](real v) { return fmt::format("{:.17g}", v); };
    return fmt::format(
        "solver = \"mac_water\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime = {{ end = 5.0 }}\nfluid = {{ density = 1000.0 }}\n"
        "emitters = [ {{ shape = \"box\", min = {}, max = {}, velocity = {} }} ]\neffects = {{ gravity = {{ g = {} }} }}\n"
        "scheme = {{ transfer = \"{}\" }}\n{}",
        D, D == 2 ? "[40, 40]" : "[20, 20, 20]", list({"1.0", "1.0", "1.0"}, D), list({number(x), number(y), number(x)}, D),
        list({number(x + wide), number(y + deep), number(x + wide)}, D), list({"0.0", "3.0", "0.0"}, D), list({"0.0", "-9.81", "0.0"}, D),
        transfer, more);
}

template <int D>
std::string pool(real depth) {
    return "liquid = [ { shape = \"box\", min = " + list({"0.0", "0.0", "0.0"}, D) +
           ", max = " + list({"1.0", fmt::format("{}", depth), "1.0"}, D) + " } ]\n";
}

/// Largest speed of the liquid's faces, in the first 0.1 s and afterwards, and what the balance of volume says at the end.
struct Poured {
    real at_start = 0, fastest = 0, volume = 0;
};
template <int D>
Poured run(const std::string& text, real end) {
    water::Water<D> water(water_scene(text));
    Poured poured;
    while (water.time() < end) {
        const real dt = std::min(water.advised_dt(), end - water.time());
        const auto report = water.step(dt);
        real& fastest = water.time() < 0.1 ? poured.at_start : poured.fastest;
        fastest = std::max(fastest, report.cfl / dt * water.state().u.h[0]);
    }
    poured.volume = integral(water, "volume_target");
    return poured;
}

}  // namespace

TEST_IN_2D_AND_3D("an emitter pours its flux and no liquid outruns the rising jet, wherever it stands and whatever carries the momentum") {
    struct Setting {
        const char* what;
        real x, y, depth;
        std::string more;
    };
    const std::vector<Setting> settings = {{"open", 0.4, 0.3, 0, ""},
                                           {"floor", 0.4, 0, 0, ""},
                                           {"shallow pool", 0.4, 0, 0.05, ""},
                                           {"deep pool", 0.4, 0, 0.2, ""},
                                           {"corner", 0, 0, 0, ""},
                                           {"between faces of cells", 0.41, 0.013, 0, ""},
                                           {"beside a solid", 0.4, 0, 0,
                                            "solids = [ { shape = \"box\", min = " + list({"0.0", "0.0", "0.0"}, D) +
                                                ", max = " + list({"0.4", "0.15", "1.0"}, D) + " } ]\n"}};
    // At 0.3 s the jet is at its top; what falls back strikes the floor from 0.55 s on, and splashes faster than it fell.
    const real end = 0.3, section = std::pow(wide, D - 1);
    // A jet leaves with `speed` and has fallen by y + deep when it is back at the floor; what splashes is faster by up to two fifths: 1.27
    // of the jet's in two of 56 runs, where liquid that the level set did not show joins it. At the start a film thinner than a cell lies
    // on the nozzle, and what pushes it from one step to the next presses it out at its edge.
    for (const Setting& s : settings)
        for (const std::string transfer : {"grid", "pic", "flip", "apic"}) {
            const Poured poured = run<D>(fountain<D>(transfer, s.x, s.y, s.more + (s.depth > 0 ? pool<D>(s.depth) : "")), end);
            const real jet = std::sqrt(speed * speed + 2 * g * (s.y + deep)), inside_pool = std::clamp(s.depth - s.y, 0.0, deep);
            const real expected = s.depth + section * (deep - inside_pool + speed * end);
            EXPECT_LE(poured.fastest, 1.4 * jet) << s.what << ' ' << transfer;
            EXPECT_GE(poured.fastest, 0.95 * speed) << s.what << ' ' << transfer;
            EXPECT_LE(poured.at_start, 1.5 * jet) << s.what << ' ' << transfer;
            EXPECT_NEAR(poured.volume, expected, 0.01 * expected) << s.what << ' ' << transfer;
        }
}

namespace {

/// Mean pressure on the emitter's upper faces, from the two cells above each: linear through them.
template <int D>
real pressure_at_nozzle(const water::Water<D>& water, real x, real top) {
    const auto& state = water.state();
    const real h = state.u.h[1];
    Index<D> lo, hi;
    for (int a = 0; a < D; ++a) lo[a] = static_cast<int>(std::lround(x / h)), hi[a] = lo[a] + static_cast<int>(std::lround(wide / h));
    lo[1] = static_cast<int>(std::lround(top / h)), hi[1] = lo[1] + 1;
    real sum = 0;
    for (Index<D> I = lo; I[D - 1] < hi[D - 1];) {
        sum += 1.5 * state.p(I) - 0.5 * state.p(I + e<D>(1));
        for (int a = 0; a < D; ++a) {
            if (++I[a] < hi[a] || a == D - 1) break;
            I[a] = lo[a];
        }
    }
    real faces = 1;
    for (int a = 0; a < D; ++a) faces *= hi[a] - lo[a];
    return sum / faces;
}

/// The largest ratio of the energy in the tank to what was there and the source has given: the motion and the height of what it holds and
/// pours, and the work of the pressure that it pours against. Where a pool wets the source's sides, those drag it along: markers and faces
/// are interpolated over a cell, so that half a cell beside them has their speed and carries rho v^2 h/2 away from each metre of their
/// edge, which v times that force keeps up. The share beyond 1 without that falls as h.
template <int D>
std::pair<real, real> largest_share(const std::string& transfer, real x, real y, real depth, real end) {
    constexpr real rho = 1000;
    const std::string liquid = depth > 0 ? pool<D>(depth) : "";
    water::Water<D> water(water_scene(fountain<D>(transfer, x, y, liquid), {{"effects.volume_control", "{}"}}));
    const real top = y + deep, flux = std::pow(wide, D - 1) * speed;
    const real newly = std::pow(wide, D - 1) * (deep - std::clamp(depth - y, 0.0, deep));  // of its volume was air
    real given = integral(water, "potential_energy") + rho * std::pow(wide, D - 1) * deep * 0.5 * speed * speed +
                 rho * newly * g * (top - 0.5 * newly / std::pow(wide, D - 1));
    std::pair<real, real> worst{0, 0};
    while (water.time() < end) {
        const real dt = std::min(water.advised_dt(), end - water.time());
        water.step(dt);
        given += dt * flux * (rho * (0.5 * speed * speed + g * top) + pressure_at_nozzle(water, x, top));
        if (depth > 0) given += dt * rho * speed * speed * speed * 0.5 * water.state().u.h[0] * (D == 2 ? 2 : 4 * wide);
        const real share = (integral(water, "kinetic_energy") + integral(water, "potential_energy")) / given;
        if (share > worst.first) worst = {share, water.time()};
    }
    return worst;
}

}  // namespace

// With its volume controlled, that is known to a thousandth of what was poured, and an energy with it (without, the level set of a splash
// gains up to a fifth, and its height with that); what is left is the pressure's line through two cells, and forces that act for a next
// step as long as this one, which swings as the jet breaks (1.2% measured). 2% is the bar for water that breaks up.
TEST_IN_2D_AND_3D("a tank holds no more energy than its source gave, with every transfer, also when the fountain falls back and splashes") {
    for (const std::string transfer : {"grid", "pic", "flip", "apic"})
        for (const auto& [what, x, y, depth] : std::vector<std::tuple<const char*, real, real, real>>{{"open", 0.4, 0.3, 0},
                                                                                                      {"floor", 0.4, 0, 0},
                                                                                                      {"corner", 0, 0, 0},
                                                                                                      {"shallow pool", 0.4, 0, 0.05},
                                                                                                      {"deep pool", 0.4, 0, 0.2}}) {
            const auto [share, when] = largest_share<D>(transfer, x, y, depth, 0.7);
            EXPECT_LE(share, 1.02) << what << ' ' << transfer << " at " << when;
        }
}

TEST_IN_2D_AND_3D("emitters that can give nothing are refused") {
    const auto refusal = [](const std::string& text) -> std::string {
        try {
            water::Water<D> water(water_scene(text));
        } catch (const BadInput& bad) {
            return bad.what();
        }
        return "accepted";
    };
    EXPECT_NE(refusal(fountain<D>("flip", 2.0, 0.0, "")).find("lies outside the domain"), std::string::npos);
    const std::string block =
        "solids = [ { shape = \"box\", min = " + list({"0.3", "0.0", "0.3"}, D) + ", max = " + list({"0.7", "0.4", "0.7"}, D) + " } ]\n";
    EXPECT_NE(refusal(fountain<D>("flip", 0.4, 0.1, block)).find("lies inside solids"), std::string::npos);
}

}  // namespace emitters_tests
