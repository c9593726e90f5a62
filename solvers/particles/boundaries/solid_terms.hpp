// Terms of solids at nearby particles (density maps, Koschier & Bender 2017, for surfaces flat on the scale of the support). The part of
// the kernel inside a solid at distance phi is its part behind a plane at that distance. Only particles that start the step near a solid
// are visited; distant solids cost nothing.
#pragma once
#include "particles/boundaries/bodies_in_liquid.hpp"
#include "particles/state/domain.hpp"

#include <vector>

namespace weir::particles {

/// A place in the passes' coordinates.
template <int D>
Vec<D> world_of(const Domain<D>& domain, const float* four) {
    Vec<D> x;
    for (int a = 0; a < D; ++a) x[a] = four[a] + domain.centre()[a];
    return x;
}

/// For each particle of the list, the nearest body, if any, and its term (float4, in the layout of the passes), reduced by adjacent walls.
template <int D>
void meet_bodies(const Domain<D>& domain, const plain::WallParams& walls, const std::vector<int>& near, const float* positions,
                 const float* terms, std::vector<Meeting<D>>& to);

template <int D>
class SolidTerms {
public:
    /// walls: for the two series. With an empty set of solids every call is a no-op.
    SolidTerms(const Domain<D>& domain, const plain::WallParams& walls) : domain_(domain), walls_(walls) {}
    /// Finds the particles that can reach a solid in this step.
    void mark(Pairs& pairs);
    /// The terms at these positions (float4, in the layout of the passes), or nullptr without solids.
    const float* at(const Pairs& pairs, const float* positions);
    /// The terms of the last call of at(), valid where nothing has moved since.
    const float* there() const { return domain_.solids.empty() ? nullptr : terms_.data(); }
    /// f(k, place, terms) for the particles that can reach a solid; the terms are those of the last call of at().
    template <class F>
    void each_near(const float* positions, F&& f) const {
        for (const int k : near_) f(k, world(positions + 4 * k), terms_.data() + 4 * k);
    }
    const std::vector<int>& near() const { return near_; }
    /// For each particle that can reach a solid, the nearest body, if any, and its term, reduced by adjacent walls.
    void meet(const float* positions, std::vector<Meeting<D>>& to) const {
        meet_bodies(domain_, walls_, near_, positions, terms_.data(), to);
    }
    /// Moves marked particles out of solids.
    void push_out(const Pairs& pairs, float* positions, BoundaryCorrections& corrections) const;

private:
    Vec<D> world(const float* four) const { return world_of(domain_, four); }
    const Domain<D>& domain_;
    plain::WallParams walls_;
    std::vector<int> near_;
    std::vector<unsigned char> flag_;
    std::vector<float> terms_;
};

}  // namespace weir::particles
