// Solvers of SPH for the bodies of tests that every backend shares. A file that includes this says first, in namespace weir::test:
// `backend` (as a scene names it), `Sph<D>` (the solver's type) and `missing()` (why this machine cannot run it; empty where it can).
#pragma once
#include "shared/needs_backend.hpp"
#include "shared/sph_reference.hpp"

namespace weir::test {
namespace {  // every file that includes this has its own

const std::string usual = "support = 2.0, sound_speed = 10, ";
constexpr real h = 0.25;  // support of two spacings of 1/8 m

template <int D>
std::unique_ptr<Sph<D>> on_backend(const std::string& scheme, const std::string& effects = "") {
    return std::make_unique<Sph<D>>(sph_scene<D>(fmt::format("backend = \"{}\", {}{}", backend, usual, scheme), effects));
}
/// The path that every backend is compared with over several steps.
template <int D>
std::unique_ptr<sph::SphSolver<D>> on_sse2(const std::string& scheme, const std::string& effects = "") {
    return std::make_unique<sph::SphSolver<D>>(sph_scene<D>("backend = \"threads:sse2\", " + usual + scheme, effects));
}

real integral(const Solver& solver, const std::string& name) {
    for (const auto& i : solver.integrals())
        if (i.name == name) return i.value;
    return not_applicable;
}

template <int D>
real farthest_apart(const Fluid<D>& a, const Fluid<D>& b) {
    real worst = 0;
    for (int i = 0; i < a.count(); ++i) worst = std::max(worst, norm(apart(a.domain, a.position(i), b.position(i))));
    return worst;
}

/// Scheme and effects; what is left out changes the result.
template <int D>
std::vector<Physics> named_effects() {
    return {{"density = \"summation\", state = \"tait\"", ""},
            {"density = \"summation\"", "effects.rest_density = { times = [0, 0.01], values = [1000, 900] }"},
            {"density = \"summation\"", D == 2 ? "effects.central_force = { omega = 20.0, centre = [0.5, 0.5] }"
                                               : "effects.central_force = { omega = 20.0, centre = [0.5, 0.5, 0.5] }"},
            {"density = \"summation\"", "effects.xsph = { c = 0.3 }"},
            {"density = \"summation\"", "effects.vorticity = { epsilon = 1.0 }"}};
}

}  // namespace
}  // namespace weir::test

using namespace weir;
using particles::Fluid;
using test::on_backend;
using test::Physics;
