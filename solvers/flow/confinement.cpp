// Vorticity confinement: gives back to vortices what the advection scheme takes (Steinhoff & Underhill 1994; Fedkiw, Stam & Jensen 2001).
#include "flow/effects.hpp"

namespace weir::flow {

namespace {

/// f = ε h (N × ω),  ω = ∇ × u,  N = ∇|ω| / |∇|ω||     Fedkiw, Stam & Jensen 2001, eq. 9-11. Here h is the smallest cell size.
template <int D>
struct Confinement final : MacEffect<D> {
    real epsilon;
    std::array<std::string, 3> force{"confinement_x", "confinement_y", "confinement_z"};
    Confinement(const scene::Table& table, const scene::Scene&) : epsilon(table.number("epsilon")) {}
    Stage stage() const override { return Stage::force; }
    void needs(FieldPlan& plan) const override {
        plan.scratch("vorticity_magnitude");
        for (int a = 0; a < D; ++a) plan.scratch(force[static_cast<std::size_t>(a)]);
    }
    void apply(MacState<D>& s, real dt) override {
        auto& magnitude = s.scratch_field("vorticity_magnitude");
        for_each_cell(s.extent(), [&](const Index<D>& I) {
            const auto w = vorticity(s, I);
            magnitude(I) = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        });
        std::array<Grid<real, D>*, D> f;
        for (std::size_t a = 0; a < D; ++a) f[a] = &s.scratch_field(force[a]);
        const real strength = epsilon * *std::min_element(s.u.h.begin(), s.u.h.end());
        for_each_cell(s.extent(), [&](const Index<D>& I) {
            const auto n = towards_vortex(s, magnitude, I), w = vorticity(s, I);
            const std::array<real, 3> cross{n[1] * w[2] - n[2] * w[1], n[2] * w[0] - n[0] * w[2], n[0] * w[1] - n[1] * w[0]};
            for (std::size_t a = 0; a < D; ++a) (*f[a])(I) = s.cells(I) == poisson::Cell::fluid ? strength * cross[a] : 0;
        });
        for (int a = 0; a < D; ++a)
            for_each_inner_face(s.u, a, [&](const Index<D>& I) { s.u[a](I) += dt * at_face(*f[static_cast<std::size_t>(a)], I, a); });
    }

private:
    /// ω at a cell's centre by central differences of the velocity at the centres around it; 2D has only the third component.
    static std::array<real, 3> vorticity(const MacState<D>& s, const Index<D>& I) {
        const auto centre = [&](int a, const Index<D>& J) { return 0.5 * (s.before[a](J) + s.before[a](J + e<D>(a))); };
        const auto slope = [&](int a, int b) { return (centre(a, I + e<D>(b)) - centre(a, I - e<D>(b))) / (2 * s.u.h[b]); };
        if constexpr (D == 2)
            return {0, 0, slope(1, 0) - slope(0, 1)};
        else
            return {slope(2, 1) - slope(1, 2), slope(0, 2) - slope(2, 0), slope(1, 0) - slope(0, 1)};
    }
    /// ∇|ω| / |∇|ω||, one-sided at the sides of the domain; 0 where the gradient is.
    static std::array<real, 3> towards_vortex(const MacState<D>& s, const Grid<real, D>& magnitude, const Index<D>& I) {
        std::array<real, 3> n{};
        for (int a = 0; a < D; ++a) {
            Index<D> lo = I, hi = I;
            lo[a] = std::max(I[a] - 1, 0);
            hi[a] = std::min(I[a] + 1, s.extent()[a] - 1);
            n[static_cast<std::size_t>(a)] = hi[a] > lo[a] ? (magnitude(hi) - magnitude(lo)) / ((hi[a] - lo[a]) * s.u.h[a]) : 0;
        }
        const real length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (real& component : n) component = length > 0 ? component / length : 0;
        return n;
    }
};

}  // namespace

EffectKind confinement() {
    return effect_kind<Confinement>(
        {"confinement",
         "Vorticity confinement: pushes fluid around its vortices (Fedkiw et al. 2001). Adds energy; not for accuracy studies.",
         {{.name = "epsilon", .type = scene::Type::number, .doc = "Strength.", .required = true, .min = 0}},
         {"epsilon"}});
}

}  // namespace weir::flow
