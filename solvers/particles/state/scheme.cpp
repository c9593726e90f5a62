#include "particles/state/scheme.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <array>

namespace weir::particles {

using scene::Key;
using scene::Type;

namespace {

constexpr std::array smoothing_names{"muller", "cubic", "wendland"};  // in the order of Smoothing

Key support_key(real usual) {
    return {.name = "support",
            .type = Type::number,
            .doc = "Support of the kernels in particle spacings.",
            .fallback = usual,
            .min = 1.2,
            .max = 4.0};
}

Key backend_key() {
    return {.name = "backend",
            .type = Type::text,
            .doc =
                "threads: the processor, with the best of its instruction sets, or one by name: threads:sse2, threads:avx2, "
                "threads:avx512. opencl: the first OpenCL device, or one by number: opencl:1 (weir list devices). reference: plain double "
                "precision over all pairs on one thread, the reference for the other backends; for at most a few thousand particles.",
            .fallback = std::string("threads")};
}

}  // namespace

void Scheme::read(const scene::Scene& scene) {
    const std::string& name = scene.text("scheme.kernel");
    for (std::size_t k = 0; k < smoothing_names.size(); ++k)
        if (name == smoothing_names[k]) smoothing = static_cast<Smoothing>(k);
    support = scene.number("scheme.support");
    backend = backend_of(scene);
}

Key scheme_key(const char* doc, const char* kernel_doc, const Scheme& usual, std::vector<Key> own) {
    Key key{.name = "scheme", .type = Type::table, .doc = doc};
    key.keys = {{.name = "kernel",
                 .type = Type::choice,
                 .doc = kernel_doc,
                 .fallback = std::string(smoothing_names[static_cast<std::size_t>(usual.smoothing)]),
                 .choices = {smoothing_names.begin(), smoothing_names.end()}},
                support_key(usual.support)};
    for (Key& k : own) key.keys.push_back(std::move(k));
    key.keys.push_back(backend_key());
    return key;
}

backend::Choice backend_of(const scene::Scene& scene) {
    try {
        return backend::parse_choice(scene.text("scheme.backend"));
    } catch (const BadInput& error) {
        scene.refuse("scheme.backend", error.what());
    }
}

namespace {

/// Rejects periods in which two images of a neighbour are within reach: the backend uses only one.
template <int D>
void check_periods(const std::string& backend, const scene::Scene& scene, std::vector<scene::Problem>& problems) {
    const Domain<D> domain(scene);
    const real shortest = 2 * scene.number("scheme.support") * domain.spacing;
    for (int a = 0; a < D; ++a)
        if (domain.sides.periodic(a) && domain.hi[a] - domain.lo[a] < shortest)
            problems.push_back(scene.problem(
                "grid.size", "the backend " + backend + " does not support periods shorter than two supports",
                "from scheme.support and the cells' size: " + std::to_string(shortest) + " m; or set scheme.backend = \"threads\""));
}

}  // namespace

void refuse_what_lacks(const std::string& backend, const scene::Scene& scene, const std::vector<std::string>& effects) {
    std::vector<scene::Problem> problems;
    std::string known;
    for (const auto& name : effects) known += (known.empty() ? "" : ", ") + name;
    if (scene.has("effects"))
        for (const auto& name : scene.root().table("effects").keys())
            if (scene.effect(name) && std::find(effects.begin(), effects.end(), name) == effects.end())
                problems.push_back(scene.problem("effects." + name, "the backend " + backend + " has no effect \"" + name + "\"",
                                                 "it has " + known + "; or set scheme.backend = \"threads\""));
    for (std::size_t i = 0; backend == "opencl" && scene.has("bodies") && i < scene.root().tables("bodies").size(); ++i)
        if (scene.root().tables("bodies")[i].text("shape") == "mesh")
            problems.push_back(scene.problem("bodies[" + std::to_string(i) + "].shape", "the backend " + backend + " has no shape \"mesh\"",
                                             "set scheme.backend = \"threads\""));
    if (scene.dim() == 2)
        check_periods<2>(backend, scene, problems);
    else
        check_periods<3>(backend, scene, problems);
    if (!problems.empty()) scene.refuse(std::move(problems));
}

template <int D>
Kernel<D> density_kernel(const Scheme& scheme, real spacing) {
    const KernelKind kinds[] = {KernelKind::poly6, KernelKind::cubic, KernelKind::wendland};
    return {kinds[scheme.kernel()], scheme.support * spacing};
}
template <int D>
Kernel<D> gradient_kernel(const Scheme& scheme, real spacing) {
    const KernelKind kinds[] = {KernelKind::spiky, KernelKind::cubic, KernelKind::wendland};
    return {kinds[scheme.kernel()], scheme.support * spacing};
}

template <int D>
ProfileFactors profile_factors(const Scheme& scheme, real spacing) {
    const Kernel<D> w = density_kernel<D>(scheme, spacing), g = gradient_kernel<D>(scheme, spacing), v(KernelKind::viscosity, w.support());
    const real h = w.support(), h3 = h * h * h, h5 = h3 * h * h, h6 = h3 * h3;
    ProfileFactors f;
    switch (scheme.smoothing) {
        case Smoothing::muller:
            f = {w.scale() / h6, -3 * g.scale() / h3, (D == 2 ? 1 : 6) * v.scale() / h3};
            break;
        case Smoothing::cubic:
            f = {2 * w.scale() / h3, -6 * g.scale() / h3, 0};
            break;
        case Smoothing::wendland:
            f = {w.scale() / h5, -20 * g.scale() / h5, 0};
            break;
    }
    if (scheme.smoothing != Smoothing::muller) f.laplacian = -2 * f.gradient;
    return f;
}

template Kernel<2> density_kernel(const Scheme&, real);
template Kernel<3> density_kernel(const Scheme&, real);
template Kernel<2> gradient_kernel(const Scheme&, real);
template Kernel<3> gradient_kernel(const Scheme&, real);
template ProfileFactors profile_factors<2>(const Scheme&, real);
template ProfileFactors profile_factors<3>(const Scheme&, real);

}  // namespace weir::particles
