// Emitters: regions in which smoke, temperature and velocity are set to given values while they work.
#pragma once
#include "flow/effects.hpp"

namespace weir::flow {

/// All emitters of a scene as one source. Which cells and faces each covers is found once: emitters do not move.
template <int D>
class Emitters final : public MacEffect<D> {
public:
    Emitters(const scene::Scene& scene, const MacVelocity<D>& grid);
    static bool any(const scene::Scene& scene) { return scene.has("emitters") && !scene.root().tables("emitters").empty(); }
    /// The fields that the scene's emitters set.
    static FieldPlan& needs(const scene::Scene& scene, FieldPlan& plan);

    Stage stage() const override { return Stage::source; }
    void apply(MacState<D>& s, real dt) override;
    real max_dt(const MacState<D>& s) const override;

private:
    struct Set {
        std::string field;  // empty: a velocity component
        int axis = -1;
        real value = 0;
        std::vector<std::size_t> entries;
    };
    struct Emitter {
        real start = 0, end = infinity;
        std::vector<Set> sets;
    };
    std::vector<Emitter> emitters_;
    real cfl_, max_rate_ = 0;
};

}  // namespace weir::flow
