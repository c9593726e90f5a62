#include "particles/heat/vapour.hpp"

#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::particles {

using scene::Key;
using scene::Type;

namespace {

constexpr int spacings_across = 4;  // width of a column: the noise of one row is then a quarter of a spacing

template <int D>
Vec<3> place_of(const Vec<D>& at) {
    Vec<3> x{};
    for (int a = 0; a < D; ++a) x[a] = at[a];
    return x;
}

}  // namespace

bool vapour_is_named(const scene::Scene& scene) { return scene.has("heat.vapour"); }

Key vapour_key() {
    Key key{.name = "vapour",
            .type = Type::table,
            .doc =
                "Naming it lets the liquid boil and the vapour condense; without it a run stops where the liquid boils. A vapour as thin "
                "as water's (1/1600 of the liquid's density) is below the resolution of the kernel support: `run.json` and `--explain` "
                "report the ratio to the physical density.",
            .selector = "name",
            .example = "heat.vapour = \"substance\""};
    key.variants = {{"substance", "Density of the substance's vapour at its boiling point.", {}},
                    {"own",
                     "Given density.",
                     {{.name = "density",
                       .type = Type::number,
                       .doc = "Density of the vapour.",
                       .unit = "kg/m^3",
                       .required = true,
                       .min = 0,
                       .min_open = true}}}};
    return key;
}

template <int D>
Vapour<D>::Vapour(const scene::Scene& scene, const Domain<D>& domain, thermo::SubstancePtr substance, const HeatStates& states)
    : ambient_(scene), substance_(std::move(substance)), per_c_(states.per_c[1]) {
    const real p = ambient_.lowest_pressure(), rho0 = scene.number("fluid.density");
    const auto critical = substance_->critical();
    if (!(states.vapour_begin < 1e300) || (critical && !(p < critical->p)))
        scene.refuse("heat.vapour", "at " + scene::number_text(p) + " Pa " + std::string(substance_->name()) + " does not boil",
                     "vapour is below the critical pressure");
    const real boils = substance_->temperature(thermo::Boundary::saturation, p);
    const real physical = substance_->warmer_density(thermo::Boundary::saturation, boils);
    const real density = scene.text("heat.vapour.name") == "own" ? scene.number("heat.vapour.density") : physical;
    if (!(density < rho0))
        scene.refuse("heat.vapour.density", "the vapour's " + scene::number_text(density) + " kg/m^3 must be less than the liquid's",
                     "fluid.density = " + scene::number_text(rho0));
    if (std::abs(density / physical - 1) > 0.01)
        concern_ = fmt::format(
            "the vapour's density is not the physical one: {:.4g} kg/m^3, {:.3g} times {}'s {:.4g} kg/m^3 where it boils at {:.6g} Pa; "
            "mass, latent heat and temperatures are not affected",
            density, density / physical, substance_->name(), physical, p);
    params_.expansion = rho0 / density;
    set_columns(scene, domain);
    const real most = ambient_.highest_pressure() + weight_ * deepest_;
    if (critical && !(most < critical->p))
        scene.refuse("heat.vapour", "under the weight of the liquid the pressure may be " + scene::number_text(most) + " Pa",
                     std::string(substance_->name()) + " boils below " + scene::number_text(critical->p) + " Pa");
    set_shifts(ambient_.highest_pressure());
    highest_shift_ = params_.shift[WEIR_SHIFT_PIECES];
    set_shifts(ambient_.pressure(0));
}

template <int D>
void Vapour<D>::set_columns(const scene::Scene& scene, const Domain<D>& domain) {
    Vec<D> g{};
    if (const auto* e = scene.effect("gravity")) g = e->template vec<D>("g");
    int axis = 0;
    for (int a = 1; a < D; ++a)
        if (std::abs(g[a]) > std::abs(g[axis])) axis = a;
    const Index<D> n = scene.index<D>("grid.cells");
    real area = 1;
    for (int a = 0; a < 3; ++a) {
        const bool real_axis = a < D;
        params_.cells[a] = !real_axis ? 1 : a == axis ? n[a] : std::max(1, n[a] / spacings_across);
        params_.lo[a] = real_axis ? domain.lo[a] : 0;
        params_.per_cell[a] = real_axis ? params_.cells[a] / (domain.hi[a] - domain.lo[a]) : 0;
        if (real_axis && a != axis) area /= params_.per_cell[a];
    }
    params_.axis = axis;
    params_.falls = g[axis] > 0;
    params_.depth_of_one = cell_volume<D>(domain.spacing) / area;
    weight_ = scene.number("fluid.density") * std::abs(g[axis]);
    deepest_ = domain.hi[axis] - domain.lo[axis];
}

/// By the saturation line; latent heat and heat capacities stay those at the lowest pressure.
template <int D>
void Vapour<D>::set_shifts(real pressure) {
    const real boils = substance_->temperature(thermo::Boundary::saturation, ambient_.lowest_pressure());
    for (int i = 0; i <= WEIR_SHIFT_PIECES; ++i) {
        const real there = pressure + weight_ * deepest_ * i / WEIR_SHIFT_PIECES;
        params_.shift[i] = (substance_->temperature(thermo::Boundary::saturation, there) - boils) / per_c_;
    }
    params_.pieces_per_depth = WEIR_SHIFT_PIECES / deepest_;
}

template <int D>
bool Vapour<D>::set_time(real t) {
    if (!ambient_.pressure_changes()) return false;
    set_shifts(ambient_.pressure(t));
    return true;
}

template <int D>
int Vapour<D>::columns() const {
    int count = 1;
    for (int a = 0; a < 3; ++a)
        if (a != params_.axis) count *= params_.cells[a];
    return count;
}

template <int D>
bool Vapour<D>::find(const Fluid<D>& fluid, const HeatStates& states) {
    const auto h = [&](int i) { return fluid.enthalpy[static_cast<std::size_t>(i)]; };
    set_time(fluid.time);
    boils_ = fluid.count() > 0 && block_max(fluid.count(), h) > states.liquid_end;
    if (!boils_) return false;
    const auto n = static_cast<std::size_t>(fluid.count());
    if (shift_.size() < n) shift_.resize(n + n / 8), rest_.resize(shift_.size()), entry_.resize(shift_.size());
    above_.assign(static_cast<std::size_t>(columns() * (rows() + 1)), 0);
    std::vector<real>& below = shift_;  // until the shift is known
    parallel_for(0, fluid.count(), [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec<3> x = place_of(fluid.position(i));
        below[k] = vapour_below(&x[0], &params_);
        entry_[k] = vapour_column(&x[0], &params_) + vapour_cell(below[k], rows());
        __atomic_fetch_add(&above_[static_cast<std::size_t>(entry_[k] + 1)], 1, __ATOMIC_RELAXED);
    });
    parallel_for(0, columns(), [&](int column) {
        int* own = above_.data() + static_cast<std::size_t>(column) * static_cast<std::size_t>(rows() + 1);
        for (int row = 0; row < rows(); ++row) own[row + 1] += own[row];
    });
    parallel_for(0, fluid.count(), [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        const int* at = above_.data() + entry_[k];
        shift_[k] = vapour_shift(vapour_depth(below[k], vapour_cell(below[k], rows()), at[0], at[1] - at[0], &params_), &params_);
        rest_[k] = h(i) > states.liquid_end ? vapour_rest(h(i), shift_[k], &states, &params_) : 1;
    });
    return true;
}

template class Vapour<2>;
template class Vapour<3>;

}  // namespace weir::particles
