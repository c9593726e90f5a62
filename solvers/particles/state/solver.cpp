#include "particles/state/solver.hpp"

#include "core/error.hpp"
#include "geometry/brush.hpp"

#include <algorithm>

namespace weir::particles {

template <int D>
SumAndMost excess_of(const Fluid<D>& fluid, real rest_density, const Vapour<D>* vapour) {
    const auto excess = [&](int i) {
        const real rest = vapour ? rest_density * vapour->rest(i) : rest_density;
        return std::max<real>(0, fluid.density[static_cast<std::size_t>(i)] / rest - 1);
    };
    return whole_sum_and_max(fluid.count(), excess);
}

template <int D>
Compression compression_of(const Fluid<D>& fluid, real rest_density, const Vapour<D>* vapour) {
    return compression_of(excess_of(fluid, rest_density, vapour), fluid.count());
}

template <int D>
FieldSet ParticleSolver<D>::fields() const {
    FieldSet set;
    set.particles_in_parts = in_parts_;
    const Fluid<D>& fluid = state();
    fluid.show(set);
    show(fluid, set);
    if (heat_) heat_->show(fluid, set);
    if (bodies_) bodies_->bodies().show(set);
    return set;
}

template <int D>
std::vector<Integral> ParticleSolver<D>::integrals() const {
    auto list = state().integrals();
    const auto neighbours = neighbour_counts();
    list.push_back({"mean_neighbours", "1", neighbours.mean});
    list.push_back({"max_neighbours", "1", neighbours.most});
    if (const BrushForcing* forcing = this->brush()) geometry::sum_up(*forcing, D, list);
    if (heat_) heat_->place(state());
    sum_up(list);
    if (heat_) heat_->sum_up(state(), list);
    if (bodies_) {
        const auto more = bodies_->bodies().integrals(bodies_->gravity());
        list.insert(list.end(), more.begin(), more.end());
    }
    return list;
}

template <int D>
void ParticleSolver<D>::save(Checkpoint& to) const {
    save_state(to);
    save_more(to);
    if (heat_) heat_->save(to);
    if (bodies_) bodies_->save(to);
}
template <int D>
void ParticleSolver<D>::restore(const Checkpoint& from) {
    restore_state(from);
    restore_more(from);
    if (heat_) heat_->restore(from);
}

/// Each rank has its part.
template <int D>
class HostSolver<D>::DistributedView final : public Solver::DistributedView {
public:
    explicit DistributedView(const HostSolver& solver) : solver_(solver) {
        solver_.whole_ = std::make_unique<Fluid<D>>();
        solver.fluid_.deal(*solver_.whole_);
        solver_.in_parts_ = true;
    }
    ~DistributedView() override { solver_.whole_.reset(), solver_.in_parts_ = false; }
    DistributedView(const DistributedView&) = delete;
    DistributedView& operator=(const DistributedView&) = delete;

private:
    const HostSolver& solver_;
};

template <int D>
std::unique_ptr<Solver::DistributedView> HostSolver<D>::distributed_view() const {
    return fluid_.shared ? std::make_unique<DistributedView>(*this) : nullptr;
}

template <int D>
const Fluid<D>& HostSolver<D>::whole() const {
    if (!whole_) {
        auto all = std::make_unique<Fluid<D>>();
        fluid_.gather(*all);
        whole_ = std::move(all);
    }
    return *whole_;
}

template <int D>
void HostSolver<D>::save_state(Checkpoint& to) const {
    fluid_.save(to);
    emitters_.save(to);
    if (brush_forcing_) brush_forcing_->save(to);
    to.put_value(std::string(this->method()) + ".speed", speed_);
}
template <int D>
void HostSolver<D>::restore_state(const Checkpoint& from) {
    fluid_.restore(from);
    emitters_.restore(from);
    if (brush_forcing_ && from.has("hand")) brush_forcing_->restore(from);
    if (this->bodies_) this->bodies_->restore(from, fluid_.domain);
    const std::string key = std::string(this->method()) + ".speed";
    speed_ = from.has(key) ? from.get_value<real>(key) : not_applicable;  // devices do not store it
}

template <int D>
void HostSolver<D>::take_heat(const scene::Scene& scene) {
    if (!fluid_.warm) return;
    this->heat_ = std::make_shared<Heat<D>>(scene, fluid_.domain);
    this->heat_->count_frozen(fluid_);
    if (this->heat_->free()) this->ice_ = std::make_unique<Ice<D>>(*this->heat_, fluid_.domain);
}

template <int D>
void HostSolver<D>::stop_frozen() {
    if (!this->heat_ || this->heat_->count_frozen(fluid_) == 0) return;
    if (this->ice_) return this->ice_->find(fluid_);
    stop_frozen_again();
}

template <int D>
void HostSolver<D>::stop_frozen_again() {
    if (!this->heat_ || this->heat_->frozen() == 0) return;
    if (this->ice_) return this->ice_->move_as_one(fluid_);
    parallel_for(0, fluid_.count(), [&](int i) {
        if (held(i)) Fluid<D>::put(fluid_.v, i, Vec<D>{});
    });
}

namespace {

template <int D>
void refuse_outside(const Fluid<D>& fluid, int first) {
    for (int i = first; i < fluid.count(); ++i)
        if (fluid.domain.outside(fluid.position(i)))
            throw BadInput("particle " + std::to_string(i - first) + " would lie beyond a wall or inside a solid");
}

}  // namespace

/// Neighbours and densities are recomputed in every step: nothing else must be updated.
template <int D>
std::vector<EditableField> ParticleSolver<D>::editable() {
    Fluid<D>& fluid = writable();
    EditableField position{particle_set_name, "position", {}}, velocity{particle_set_name, "velocity", {}};
    for (std::size_t a = 0; a < D; ++a) position.data.emplace_back(fluid.x[a]), velocity.data.emplace_back(fluid.v[a]);
    for (int a = 0; a < D; ++a)
        position.min[static_cast<std::size_t>(a)] = fluid.domain.lo[a], position.max[static_cast<std::size_t>(a)] = fluid.domain.hi[a];
    return {std::move(position), std::move(velocity)};
}

/// Clears the solver's numbers of a moved particle.
template <int D>
void ParticleSolver<D>::edited(const EditableField& field) {
    Fluid<D>& fluid = writable();
    if (field.name == "position") {
        refuse_outside(fluid, 0);
        std::fill(fluid.carried.begin(), fluid.carried.end(), 0.0);
    }
    written();
}

template <int D>
bool ParticleSolver<D>::add_particles(std::string_view set, std::span<const Vec<3>> at, std::span<const Vec<3>> velocity) {
    Fluid<D>& fluid = writable();
    if (set != particle_set_name || fluid.warm) return false;
    const int before = fluid.count();
    for (std::size_t i = 0; i < at.size(); ++i) {
        Vec<D> x, u;
        for (int a = 0; a < D; ++a) x[a] = at[i][a], u[a] = velocity[i][a];
        fluid.add(x, u);
    }
    refuse_outside(fluid, before);
    written();
    return true;
}

template <int D>
bool ParticleSolver<D>::remove_particles(std::string_view set, std::span<const unsigned char> gone) {
    if (set != particle_set_name) return false;
    writable().remove_if([&](int i) { return gone[static_cast<std::size_t>(i)] != 0; });
    return true;
}

template SumAndMost excess_of(const Fluid<2>&, real, const Vapour<2>*);
template SumAndMost excess_of(const Fluid<3>&, real, const Vapour<3>*);
template Compression compression_of(const Fluid<2>&, real, const Vapour<2>*);
template Compression compression_of(const Fluid<3>&, real, const Vapour<3>*);
template class ParticleSolver<2>;
template class ParticleSolver<3>;
template class HostSolver<2>;
template class HostSolver<3>;

}  // namespace weir::particles
