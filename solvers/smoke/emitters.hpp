// Emitters: regions in which smoke, temperature and velocity have prescribed values while they are open.
#pragma once
#include "geometry/shape.hpp"
#include "smoke/effects.hpp"

namespace weir::smoke {

/// All emitters of a scene as one source. The cells and faces of each are found once: emitters do not move.
template <int D>
class Emitters final : public MacEffect<D> {
public:
    /// Rejects emitters that prescribe nothing, are thinner than a cell or lie inside the solids of `state`.
    Emitters(const scene::Scene& scene, const MacState<D>& state);
    static bool any(const scene::Scene& scene) { return scene.has("emitters") && !scene.root().tables("emitters").empty(); }
    /// The fields that the scene's emitters prescribe.
    static FieldPlan& needs(const scene::Scene& scene, FieldPlan& plan);

    Stage stage() const override { return Stage::source; }
    void apply(MacState<D>& s, real dt) override;
    real max_dt(const MacState<D>& s) const override;

private:
    struct Set {
        std::string field;  // empty: a velocity component
        int axis = -1;
        real value = 0;
        std::vector<std::size_t> entries;  // in parallel, of the planes that this rank stores
        bool any;                          // on all ranks
    };
    struct Emitter {
        real start = 0, end = infinity;
        std::vector<Set> sets;
    };
    static Emitter make(const scene::Table& table, const MacState<D>& s);
    /// The reason why an emitter has no effect; empty where it has one.
    static std::string idle(const Emitter& emitter, const geometry::Shape<D>& shape, const MacState<D>& state);

    std::vector<Emitter> emitters_;
    real cfl_, max_rate_ = 0;
};

}  // namespace weir::smoke
