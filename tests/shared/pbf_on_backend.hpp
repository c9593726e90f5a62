// Solvers of PBF for the bodies of tests that every backend shares. A file that includes this says first, in namespace weir::test:
// `backend` (as a scene names it), `Pbf<D>` (the solver's type) and `missing()` (why this machine cannot run it; empty where it can).
#pragma once
#include "shared/needs_backend.hpp"
#include "shared/pbf_reference.hpp"

namespace weir::test {
namespace {  // every file that includes this has its own

template <int D>
std::unique_ptr<Pbf<D>> on_backend(const std::string& liquid, const std::string& scheme = "", const std::string& more = "") {
    return std::make_unique<Pbf<D>>(
        pbf_scene<D>(liquid, fmt::format("backend = \"{}\"{}{}", backend, scheme.empty() ? "" : ", ", scheme), more));
}
/// The path that every backend is compared with over several steps.
template <int D>
std::unique_ptr<pbf::PbfSolver<D>> on_sse2(const std::string& liquid, const std::string& scheme = "", const std::string& more = "") {
    return pbf_solver<D>(pbf_scene<D>(liquid, "backend = \"threads:sse2\"" + (scheme.empty() ? "" : ", " + scheme), more));
}

real integral(const Solver& solver, const std::string& name) {
    for (const auto& i : solver.integrals())
        if (i.name == name) return i.value;
    return not_applicable;
}

template <int D>
real farthest_apart(const particles::Fluid<D>& a, const particles::Fluid<D>& b) {
    real worst = 0;
    for (int i = 0; i < a.count(); ++i) worst = std::max(worst, norm(apart(a.domain, a.position(i), b.position(i))));
    return worst;
}

template <int D>
real support(const Pbf<D>& solver) {
    return solver.options().support / 8;  // spacing of the scenes: 1/8 m
}

template <int D>
const char* centred() {
    return D == 2 ? "[0.5, 0.75]" : "[0.5, 0.75, 0.5]";
}

/// Each effect, and all together.
template <int D>
std::vector<std::string> effects() {
    const std::string pull = fmt::format("effects.central_force = {{ omega = 5.0, centre = {} }}", centred<D>());
    const std::string smooth = "effects.xsph = { c = 0.2 }", whirl = "effects.vorticity = { epsilon = 0.2 }";
    const std::string apart = "effects.artificial_pressure = { k = 0.01 }";
    return {pull, smooth, whirl, apart, pull + "\n" + smooth + "\n" + whirl + "\n" + apart};
}

}  // namespace
}  // namespace weir::test

using namespace weir;
using particles::Fluid;
using test::on_backend;
