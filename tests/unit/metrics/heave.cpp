// Heights of a body that swings, against a reference that swings as well: on cosines, whose extrema are known.
#include "sim/registry.hpp"
#include "support/test.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <cmath>
#include <numbers>

namespace heave_tests {

using namespace weir;
using namespace weir::validation;

namespace {

constexpr real level = 2, start = 0.05;

/// 0.02 s apart over 4 s, height(t) times the height of release.
template <class F>
RunRecord swing(F&& height) {
    const char* text =
        "solver = \"mac_water\"\ndim = 2\ngrid = { cells = [8, 8], size = [4.0, 4.0] }\ntime = { end = 4.0 }\nfluid = { density = 1000.0 "
        "}\n"
        "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [4.0, 2.0] } ]\n"
        "bodies = [ { name = \"disc\", shape = \"sphere\", centre = [2.0, 2.05], radius = 0.5, density = 500.0 } ]\n"
        "probes = [ { name = \"body\", kind = \"body\", body = \"disc\" } ]\n"
        "effects = { gravity = { g = [0.0, -9.81] } }\n";
    RunRecord run;
    run.scene = std::make_shared<const scene::Scene>(scene::parse(text, "disc.toml", sim::schemas()));
    ProbeSeries probe{.name = "body", .kind = "body", .columns = {"position_y [m]"}};
    for (int i = 0; i <= 200; ++i) {
        const real t = 0.02 * i;
        probe.times.push_back(t);
        probe.values.push_back({level + start * height(t)});
    }
    run.probes.push_back(std::move(probe));
    return run;
}

/// cos(2 pi t) over its first four seconds: first extrema -1, 1, -1.
Reference reference() {
    Curve heave{.label = "exact"};
    for (int i = 0; i <= 400; ++i) heave.x.push_back(0.01 * i), heave.y.push_back(std::cos(2 * std::numbers::pi * 0.01 * i));
    return {.source = "cosine", .curves = {{"heave", heave}}, .numbers = {{"start", start}}};
}

}  // namespace

TEST("the error of the first three extrema is that of the worst of them, over the height of release") {
    const auto wave = [](real t) { return std::cos(2 * std::numbers::pi * t); };
    // samples 0.02 s apart miss an extreme by 0.01 s at most: 1 - cos(0.02 pi) = 0.002
    EXPECT_NEAR(measure("body.extrema_error", swing(wave), reference()), 0, 0.002);
    // the second trough is at 1.5 s: what has lost a fifth by then has lost it of the worst
    const auto damped = [&](real t) { return (t > 1.25 ? 0.8 : 1.0) * wave(t); };
    EXPECT_NEAR(measure("body.extrema_error", swing(damped), reference()), 0.2, 0.002);
}

TEST("a body that does not swing is wrong by the reference's largest extreme, not by no number") {
    const auto still = [](real) { return 0.5; };
    EXPECT_NEAR(measure("body.extrema_error", swing(still), reference()), 1, 1e-3);
    const auto sinks = [](real t) { return 1 - t; };  // crosses its place of rest once
    EXPECT_NEAR(measure("body.extrema_error", swing(sinks), reference()), 1, 1e-3);
}

TEST("a reference of fewer than three extrema, and a run that broke, have no error: not a number, which no bound holds") {
    Reference flat = reference();
    flat.curves["heave"].y.assign(flat.curves["heave"].x.size(), 1);
    EXPECT_TRUE(std::isnan(measure("body.extrema_error", swing([](real) { return 1.0; }), flat)));
}

}  // namespace heave_tests
