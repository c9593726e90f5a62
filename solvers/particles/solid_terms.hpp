// What solids add at the particles near them (density maps, Koschier & Bender 2017, for surfaces flat on the scale of the support): the
// kernel's part inside a solid at distance phi is its part behind a plane at that distance. Only particles that start the step near a
// solid are visited, and solids far away cost nothing.
#pragma once
#include "particles/bodies_in_liquid.hpp"
#include "particles/domain.hpp"

#include <vector>

namespace weir::particles {

template <int D>
class SolidTerms {
public:
    /// walls: for the two series. Empty domains of solids make every call a no-op.
    SolidTerms(const Domain<D>& domain, const plain::WallParams& walls) : domain_(domain), walls_(walls) {}
    /// Finds the particles that can meet a solid in this step.
    void mark(Pairs& pairs);
    /// The terms at these positions (float4, as the passes read them), or nullptr without solids.
    const float* at(const Pairs& pairs, const float* positions);
    /// f(k, place, terms) for the particles that can meet a solid; the terms are those of the last call of at().
    template <class F>
    void each_near(const float* positions, F&& f) const {
        for (const int k : near_) f(k, world(positions + 4 * k), terms_.data() + 4 * k);
    }
    /// Of each particle that can meet a solid, the body next to it, if one is, and its term as walls beside it let the particle see it.
    void meet(const float* positions, std::vector<Meeting<D>>& to) const;
    /// Moves marked particles out of solids.
    void push_out(const Pairs& pairs, float* positions, Clamps& clamps) const;

private:
    Vec<D> world(const float* four) const {
        Vec<D> x;
        for (int a = 0; a < D; ++a) x[a] = four[a] + domain_.centre()[a];
        return x;
    }
    const Domain<D>& domain_;
    plain::WallParams walls_;
    std::vector<int> near_;
    std::vector<unsigned char> flag_;
    std::vector<float> terms_;
};

}  // namespace weir::particles
