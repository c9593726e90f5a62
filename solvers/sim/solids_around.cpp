#include "sim/solids_around.hpp"

#include "rigid/bodies.hpp"

#include <vector>

namespace weir::sim {

namespace {

template <int D>
Vec<D> flat(const Vec<3>& x) {
    Vec<D> y;
    for (int a = 0; a < D; ++a) y[a] = x[a];
    return y;
}

std::vector<scene::Table> without_motion(const scene::Scene& scene) {
    std::vector<scene::Table> still;
    for (const scene::Table& table : scene.root().tables("solids"))
        if (!table.has("motion")) still.push_back(table);
    return still;
}

template <int D>
class Around final : public SolidsAround {
public:
    explicit Around(const scene::Scene& scene) : shown_(scene, false), still_(without_motion(scene)) {}
    void place(const FieldSet& fields, real t) override {
        now_ = &shown_.at(t, [&](const char* field, std::size_t component, std::size_t body) {
            return fields.find(rigid::body_set_name, field)->data[component][body];
        });
    }
    real distance(const Vec<3>& x) const override { return now_->distance(flat<D>(x)); }
    real distance_to_still(const Vec<3>& x) const override { return still_.distance(flat<D>(x)); }

private:
    rigid::ShownSolids<D> shown_;
    geometry::Solids<D> still_;
    const geometry::Solids<D>* now_ = nullptr;
};

}  // namespace

std::unique_ptr<SolidsAround> solids_around(const scene::Scene& scene) {
    if (scene.root().tables("solids").empty() && scene.root().tables("bodies").empty()) return nullptr;
    if (scene.dim() == 2) return std::make_unique<Around<2>>(scene);
    return std::make_unique<Around<3>>(scene);
}

}  // namespace weir::sim
