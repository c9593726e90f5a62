// Properties of advection schemes, seen in a field that a uniform velocity carries around a periodic row.
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace advection_schemes_tests {

namespace {

using weir::real;

/// A row of n cells, 1 m long and periodic, in a flow of 1 m/s along it; `dt` in units of the time that takes a cell.
struct Row {
    int n;
    std::string scheme, tracer;
    real cells_per_step;
    std::vector<real> after(real seconds) const {
        weir::Simulation simulation(weir::scene::parse(
            fmt::format(
                "solver = \"transport\"\ndim = 2\ngrid = {{ cells = [{0}, 4], size = [1.0, {1}] }}\ntime = {{ end = {2}, dt = {3} }}\n"
                "sides = {{ x_min = \"periodic\", x_max = \"periodic\" }}\nflow = {{ name = \"constant\", value = [1.0, 0.0] }}\n"
                "initial.tracer = {{ name = \"formula\", value = \"{4}\" }}\nscheme = {{ {5} }}\n",
                n, 4.0 / n, seconds, cells_per_step / n, tracer, scheme),
            "row.toml", weir::sim::schemas()));
        simulation.run_until(seconds);
        const auto fields = simulation.fields();
        const auto row = fields.find("", "tracer")->data[0];
        return {row.begin(), row.begin() + n};
    }
};

const std::string wave = "sin(2*pi*x)";

/// Of the wave that has moved with the flow.
real amplitude(const std::vector<real>& row) {
    real s = 0, c = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const real x = 2 * std::numbers::pi * (static_cast<real>(i) + 0.5) / static_cast<real>(row.size());
        s += row[i] * std::sin(x), c += row[i] * std::cos(x);
    }
    return 2 * std::hypot(s, c) / static_cast<real>(row.size());
}

}  // namespace

/// Selle et al. 2008, section 3.3: a corrected value stays between those around its departure point. Without a bound a step overshoots by
/// some tenths.
TEST("MacCormack's clamp makes no value above or below those that there were") {
    const auto row =
        Row{32, "advection = \"maccormack\", limiter = \"clamp\"", "0.5 + 0.5*sin(2*pi*x)/max(0.001, abs(sin(2*pi*x)))", 0.4}.after(0.5);
    EXPECT_LE(*std::max_element(row.begin(), row.end()), 1 + 1e-12);
    EXPECT_GE(*std::min_element(row.begin(), row.end()), -1e-12);
    EXPECT_GT(*std::max_element(row.begin(), row.end()), 0.9);  // it is still there
}

/// Upwind fluxes have the viscosity u h/2: once around a row of 16 cells they leave exp(−(2π)²/32) = 0.29 of a wave. A limited flux of
/// second order loses some at its crests alone.
TEST("van Leer's flux keeps most of a wave that upwind fluxes wipe out") {
    EXPECT_GT(amplitude(Row{16, "advection = \"conservative\", flux = \"van_leer\"", wave, 0.2}.after(1)), 0.8);
}

/// The same in space at every step: errors in time alone, which fall by 8 where steps are halved (Wray's third order; 7.2 and more below
/// the third order's next term). First order falls by 2, second by 4.
TEST("conservative transport is of third order in time") {
    const auto with = [&](real cells_per_step) {
        return Row{16, "advection = \"conservative\", flux = \"central\"", wave, cells_per_step}.after(1);
    };
    const auto exact = with(0.02);
    const auto error = [&](real cells_per_step) {
        const auto row = with(cells_per_step);
        real most = 0;
        for (std::size_t i = 0; i < row.size(); ++i) most = std::max(most, std::abs(row[i] - exact[i]));
        return most;
    };
    const real coarse = error(0.8), fine = error(0.4);
    EXPECT_GT(coarse, 7 * fine);
    EXPECT_LT(coarse, 9 * fine);
}

}  // namespace advection_schemes_tests
