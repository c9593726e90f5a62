#include "sph/options.hpp"

#include "particles/heat/vapour.hpp"
#include "particles/threads/passes.hpp"

#include <algorithm>

namespace weir::sph {

using particles::Kernel;

template <int D>
void Options::read_sides(const scene::Scene& scene) {
    const geometry::Sides<D> sides(scene);
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            const auto& side = sides.side(a, end);
            const auto at = static_cast<std::size_t>(2 * a + end);
            if (side.no_slip) stick[at] = 2 * viscosity;
            for (int b = 0; b < D; ++b) slide[3 * at + static_cast<std::size_t>(b)] = side.velocity[b];
        }
}

Options::Options(const scene::Scene& scene, real fastest) : Options() {
    read(scene);
    sound = scene.root().number_or("scheme.sound_speed", fastest > 0 ? 10 * fastest : sound);
    gamma = scene.text("scheme.state") == "tait" ? scene.number("scheme.gamma") : 1;
    tension = scene.flag("scheme.tension");
    const std::string& by = scene.text("scheme.density");
    continuity = by != "summation";
    // density by summation counts both parts behind two walls that are closer than a particle, and ejects one that can move
    // move.
    facing = continuity;
    if (by == "delta") diffusion = delta_sph.diffusion, artificial = delta_sph.viscosity;
    if (scene.effect("viscosity")) viscosity = scene.number("fluid.viscosity");
    if (const auto* a = scene.effect("artificial_viscosity")) artificial = a->number("alpha");
    if (const auto* d = scene.effect("density_diffusion")) diffusion = d->number("delta");
    if (const auto* t = scene.effect("surface_tension")) sigma = t->number("sigma");
    if (diffusion > 0 && !continuity)
        scene.refuse("effects.density_diffusion", "density diffusion requires a density by its rate",
                     "set scheme.density = \"continuity\"");
    if (continuity && particles::vapour_is_named(scene))
        scene.refuse("heat.vapour", "a boiling liquid requires a summed density", "set scheme.density = \"summation\"");
    if (sigma > 0 && !tension)
        scene.refuse("effects.surface_tension", "surface tension requires negative pressure", "set scheme.tension = true");
    if (const auto* g = scene.effect("gravity")) {
        const auto list = g->numbers("g");
        for (std::size_t a = 0; a < list.size(); ++a) gravity[a] = list[a];
    }
    if (scene.dim() == 2)
        read_sides<2>(scene);
    else
        read_sides<3>(scene);
}

bool Options::wall_forces() const {
    const auto any = [](const auto& list) { return std::any_of(list.begin(), list.end(), [](real v) { return v != 0; }); };
    return any(gravity) || any(stick);
}

real Options::pressure(real rho, real rho0) const {
    const real p = gamma == 1 ? sound * sound * (rho - rho0) : sound * sound * rho0 / gamma * (std::pow(rho / rho0, gamma) - 1);
    return tension ? p : std::max<real>(0, p);
}

real Options::density(real p, real rho0) const {
    const real c2 = sound * sound;
    return gamma == 1 ? rho0 + p / c2 : rho0 * std::pow(1 + gamma * p / (c2 * rho0), 1 / gamma);
}

real Options::elastic_energy(real rho, real rho0) const {
    const real r = rho / rho0, c2 = sound * sound;
    if (r < 1 && !tension) return 0;
    if (gamma == 1) return c2 * (std::log(r) + 1 / r - 1);
    return c2 / gamma * ((std::pow(r, gamma - 1) - 1) / (gamma - 1) + 1 / r - 1);
}

/// Sets the parameters of gravity and walls.
template <class Params>
void add_surroundings(Params& p, const Options& o, real spacing, real rho0) {
    using Number = decltype(Params::h);
    const auto to_number = [](real value) { return static_cast<Number>(value); };
    real g = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        p.gravity[a] = to_number(o.gravity[a]);
        p.layers[a] = to_number(rho0 * o.gravity[a] / (o.sound * o.sound));
        g = std::hypot(g, o.gravity[a]);
    }
    p.per_depth = to_number(g > 0 ? 1 / (rho0 * g * spacing) : 0);
    p.closest = to_number(0.25 * spacing);  // half the distance of lattice particles from a wall
    std::transform(o.stick.begin(), o.stick.end(), p.stick, to_number);
    std::transform(o.slide.begin(), o.slide.end(), p.slide, to_number);
}

/// Factor of the slope h^4 - r^4 of the surface stress: its second moment along an axis becomes 1.
template <int D>
real stress_scale(real h) {
    return (D == 2 ? 8 / pi : 135 / (16 * pi)) / (std::pow(h, D + 2) * std::pow(h, 4));
}

/// Response of particles below a flat surface to a unit stress in a layer given by the colour gradient. It is the integral over the depth z
/// of that gradient (the kernel's integral over a plane at z) times the second moment of the stress's slope along the surface, over the
/// liquid only. Without the cut by the surface it would be 1/2.
template <int D>
real seen_stress(const Kernel<D>& kernel) {
    constexpr int pieces = 200;
    const real h = kernel.support();
    real seen = 0;
    for (int i = 0; i < pieces; ++i) {
        const real z = h * (i + 0.5) / pieces;
        real cut = 0;  // of the moment, over shells of radius r > z: the cap beyond the surface has half angle acos(z / r)
        for (int k = 0; k < pieces; ++k) {
            const real r = z + (h - z) * (k + 0.5) / pieces, c = z / r, angle = std::acos(c);
            const real cap = D == 2 ? angle - c * std::sqrt(1 - c * c) : pi * (2.0 / 3 - c + c * c * c / 3);
            cut += (h - z) / pieces * (std::pow(h, 4) - std::pow(r, 4)) * std::pow(r, D + 1) * cap;
        }
        seen += h / pieces * kernel.plane(z) * (1 - stress_scale<D>(h) * cut);
    }
    return seen;
}

/// The colour gradient is some 1.5 / h at a surface; disorder inside a liquid stays below this value over h.
constexpr real colour_noise = 0.05;

template <class Params, int D>
Params sph_params(const Options& o, real spacing, real rho0) {
    using Number = decltype(Params::h);
    const Kernel<D> g = particles::gradient_kernel<D>(o, spacing);
    const real h = g.support(), mass = rho0 * particles::cell_volume<D>(spacing);
    Params p{};
    particles::set_kernels<D>(p, o, spacing, mass);
    p.laplacian = static_cast<Number>(mass * particles::profile_factors<D>(o, spacing).laplacian);
    p.wall_rho = static_cast<Number>(rho0);
    p.viscosity = static_cast<Number>(o.viscosity * rho0);
    p.artificial = static_cast<Number>(o.artificial * o.sound * h / 2);
    p.soften = static_cast<Number>(0.01 * h * h / 4);
    p.diffusion = static_cast<Number>(o.diffusion * o.sound * h);
    p.tension = static_cast<Number>(o.sigma * mass * stress_scale<D>(h) / seen_stress(g));
    p.noise = static_cast<Number>(colour_noise / h);
    add_surroundings(p, o, spacing, rho0);
    return p;
}

template particles::single::SphParams sph_params<particles::single::SphParams, 2>(const Options&, real, real);
template particles::single::SphParams sph_params<particles::single::SphParams, 3>(const Options&, real, real);
template particles::plain::SphParams sph_params<particles::plain::SphParams, 2>(const Options&, real, real);
template particles::plain::SphParams sph_params<particles::plain::SphParams, 3>(const Options&, real, real);

}  // namespace weir::sph
