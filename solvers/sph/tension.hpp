// Surface tension as an effect: two pair passes, one for the surface normals and one for the stress (kernels/sph_pair.inl).
#pragma once
#include "particles/boundaries/solid_terms.hpp"
#include "particles/state/flow.hpp"
#include "sph/options.hpp"

namespace weir::sph {

template <int D>
class SurfaceTension final : public Effect<particles::Flow<D>> {
public:
    SurfaceTension(const particles::single::SphParams& params, const particles::single::WallParams& walls, particles::SolidTerms<D>& solids)
        : params_(params), walls_(walls), solids_(solids) {}
    Stage stage() const override { return Stage::force; }
    void needs(FieldPlan& plan) const override { plan.scratch("change of pairs"); }
    /// Reads 1 / rho from the pairs' positions, where the force pass has stored it.
    void apply(particles::Flow<D>& flow, real dt) override;
    std::size_t bytes() const override { return normal_.capacity() * sizeof(float); }

private:
    const particles::single::SphParams& params_;
    const particles::single::WallParams& walls_;
    particles::SolidTerms<D>& solids_;
    std::vector<float> normal_;
};

}  // namespace weir::sph
