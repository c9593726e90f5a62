#include "validation/harness/band.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

constexpr real least_order = 0.5, order_margin = 0.5;      // of the observed order that counts as asymptotic
constexpr real asymptotic_factor = 1.5, other_factor = 2;  // F
constexpr real least_observed = -4, most_observed = 12;    // range of p

/// Inner product over the product of the sizes: 1 or -1 for one sample.
real alignment(const std::vector<real>& f1, const std::vector<real>& f2, const std::vector<real>& f3) {
    real dot = 0, one = 0, two = 0;
    for (std::size_t i = 0; i < f1.size(); ++i) {
        const real d21 = f1[i] - f2[i], d32 = f2[i] - f3[i];
        dot += d21 * d32, one += d21 * d21, two += d32 * d32;
    }
    return one == 0 || two == 0 ? 0 : dot / std::sqrt(one * two);
}

}  // namespace

real distance(const std::vector<real>& f, const std::vector<real>& g) {
    real sum = 0;
    for (std::size_t i = 0; i < f.size(); ++i) sum += (f[i] - g.at(i)) * (f[i] - g.at(i));
    return f.empty() ? 0 : std::sqrt(sum / static_cast<real>(f.size()));
}

real size_of(const std::vector<real>& f) { return distance(f, std::vector<real>(f.size(), 0)); }

real observed_order(real a, real b, real h1, real h2, real h3) {
    if (a == 0 || b == 0) return a == b ? 0 : a == 0 ? most_observed : least_observed;
    const real fine = std::log(h2 / h1), coarse = std::log(h3 / h2);
    // log of the ratio of both differences of h^p; (e^x - 1)/x keeps it smooth at p = 0
    const auto growth = [](real x) { return x == 0 ? 1 : std::expm1(x) / x; };
    const auto ratio = [&](real p) { return p * fine + std::log(coarse / fine * growth(p * coarse) / growth(p * fine)); };
    const real wanted = std::log(b / a);
    real low = least_observed, high = most_observed;
    if (ratio(low) >= wanted) return low;
    if (ratio(high) <= wanted) return high;
    for (int i = 0; i < 80; ++i) {  // the ratio grows with p
        const real middle = 0.5 * (low + high);
        (ratio(middle) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

Band band(const std::vector<GridValue>& grids, real formal_order) {
    if (grids.size() < 3) throw BadInput("an uncertainty requires three grids");
    const auto& [h1, f1] = grids[grids.size() - 1];
    const auto& [h2, f2] = grids[grids.size() - 2];
    const auto& [h3, f3] = grids[grids.size() - 3];
    const real a = distance(f1, f2), b = distance(f2, f3), c = alignment(f1, f2, f3);
    Band result;
    if (a == 0 && b == 0) {
        result.convergence = Convergence::equal, result.order = result.observed_order = formal_order;
        return result;
    }
    const real p = result.observed_order = observed_order(a, b, h1, h2, h3);
    const real q = result.order = c > 0 ? std::clamp(p, least_order, formal_order) : std::min(real(1), formal_order);
    const bool asymptotic = c > 0.5 && p >= least_order && p <= formal_order + order_margin;
    const real most = std::max(a / (std::pow(h2, q) - std::pow(h1, q)), b / (std::pow(h3, q) - std::pow(h2, q)));
    result.width = (asymptotic ? asymptotic_factor : other_factor) * most * std::pow(h1, q);
    result.convergence = asymptotic         ? Convergence::asymptotic
                         : c <= 0           ? Convergence::oscillating
                         : p > formal_order ? Convergence::faster
                                            : Convergence::slow;
    return result;
}

std::vector<real> error_bounds(const std::vector<GridValue>& grids, real width) {
    std::vector<real> bounds;
    for (const GridValue& g : grids) bounds.push_back(distance(g.value, grids.back().value) + width);
    return bounds;
}

real formal_order(std::string_view solver, std::string_view advection) {
    if (solver == "mac" || solver == "transport") return advection == "semi_lagrangian" ? 1 : 2;
    if (solver == "waves" || solver == "poisson") return 2;
    return solver == "heightfield" ? 1.5 : 1;
}

std::string_view words_of(Convergence convergence) {
    switch (convergence) {
        case Convergence::asymptotic:
            return "asymptotic";
        case Convergence::faster:
            return "converges faster than its order";
        case Convergence::slow:
            return "differences do not shrink";
        case Convergence::oscillating:
            return "oscillates";
        case Convergence::equal:
            return "grids do not differ";
    }
    return "";
}

}  // namespace weir::validation
