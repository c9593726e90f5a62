#include "particles/threads/threaded_solver.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace weir::particles {

namespace {

/// Load imbalance, relative to a rank's share, above which repartitioning (one message per axis) costs less than waiting.
constexpr real worth_a_new_cut = 0.03;

}  // namespace

template <int D>
ThreadedSolver<D>::ThreadedSolver(const Scheme& scheme, const scene::Scene& scene, Fluid<D>&& start)
    : HostSolver<D>(std::move(start)),
      walls_(wall_params<single::WallParams>(scheme, fluid_.domain)),
      pairs_(passes_for(scheme.backend.isa), fluid_.domain.frame()),
      solids_(fluid_.domain, wall_params<plain::WallParams>(scheme, fluid_.domain)),
      flow_{fluid_, pairs_, kernels_, {}, {}, scheme.kernel()},
      effects_(scene.solver(), {Stage::force, Stage::finish}) {
    this->emitters_ = Emitters<D>(scene, fluid_.domain);
    add_effects(scene, effects_);
    this->take_heat(scene);
    this->brush_forcing_ = geometry::make_brush(scene, geometry::kinds_of_brush(this->heat_ != nullptr, this->bodies_ != nullptr));
    if (!this->brush_forcing_) return;
    if (this->bodies_) this->bodies_->follow(this->brush_forcing_, scene);
    auto forcing = std::make_unique<BrushOnParticles<D>>(this->brush_forcing_);
    sources_ = forcing.get();
    effects_.add("hand", std::move(forcing));
}

template <int D>
void ThreadedSolver<D>::find_pairs(std::array<std::vector<real>, D>& at, real radius, std::initializer_list<std::vector<real>*> read) {
    if (!fluid_.shared) return pairs_.find(Fluid<D>::coordinates(at), fluid_.count(), radius);
    arrays_.clear();
    for (auto& axis : at) arrays_.push_back(&axis);
    arrays_.push_back(&fluid_.place);
    arrays_.insert(arrays_.end(), read.begin(), read.end());
    const std::size_t known = arrays_.size();
    fluid_.for_each_array([&](std::vector<real>& array) {
        if (std::find(arrays_.begin(), arrays_.end(), &array) == arrays_.end()) arrays_.push_back(&array);
    });
    migration_.apply(fluid_.domain.frame(), radius, D, arrays_, known);
    pairs_.find(Fluid<D>::coordinates(at), fluid_.count(), radius, migration_.held(fluid_.place));
}

template <int D>
void ThreadedSolver<D>::drop_ghosts() {
    if (fluid_.shared) fluid_.resize(migration_.own());
}

template <int D>
void ThreadedSolver<D>::add_corrections(const BoundaryCorrections& rank) {
    fluid_.corrections.add(rank.count - corrections_before_.count, rank.farthest);
}

template <int D>
void ThreadedSolver<D>::sum_up_corrections() {
    if (!fluid_.shared) return;
    const std::vector<BoundaryCorrections> each = of_ranks(fluid_.corrections);
    fluid_.corrections = corrections_before_;
    for (const BoundaryCorrections& rank : each) add_corrections(rank);
    corrections_before_ = fluid_.corrections;
}

template <int D>
typename ThreadedSolver<D>::StepEnd ThreadedSolver<D>::end_step(const SumAndMost& excess, real acceleration) {
    StepEnd end{fluid_.shared ? fluid_.fastest() : speed(), acceleration, compression_of(excess, fluid_.count())};
    if (fluid_.shared) broken_ = fluid_.broken(!std::isfinite(end.speed));
    if (++fluid_.steps % steps_between_reorders == 0) {
        fluid_.reorder(pairs_.particle_order());
        if (fluid_.shared) {
            std::iota(fluid_.place.begin(), fluid_.place.end(), static_cast<real>(migration_.before()));
            fluid_.next_place = static_cast<real>(migration_.total());
            migration_.balance(worth_a_new_cut);
        }
    }
    const int before = fluid_.count();
    fluid_.cross_sides();
    fastest_ = fluid_.count() == before ? end.speed : fluid_.fastest();
    if (fluid_.shared) reduce_over_ranks(end, excess);
    return end;
}

/// Collective check: one message per step.
template <int D>
void ThreadedSolver<D>::reduce_over_ranks(StepEnd& end, const SumAndMost& excess) {
    struct RankReport {
        SumAndMost excess;
        BoundaryCorrections corrections;
        real speed, fastest, acceleration;
        typename Fluid<D>::Quantity broken;
    };
    const std::vector<RankReport> ranks = of_ranks(RankReport{excess, fluid_.corrections, end.speed, fastest_, end.acceleration, broken_});
    fluid_.corrections = corrections_before_;
    SumAndMost all;
    for (const RankReport& rank : ranks) {
        all.add(rank.excess);
        add_corrections(rank.corrections);
        end.speed = std::max(end.speed, rank.speed), fastest_ = std::max(fastest_, rank.fastest);
        end.acceleration = std::max(end.acceleration, rank.acceleration);
        broken_ = std::max(broken_, rank.broken);
    }
    Fluid<D>::fail(broken_);
    end.compression = compression_of(all, migration_.total());
}

/// Maximum over the ranks.
template <int D>
real ThreadedSolver<D>::speed() const {
    if (!fluid_.shared) return HostSolver<D>::speed();
    if (std::isnan(fastest_)) fastest_ = detail::largest_of(of_ranks(fluid_.fastest()), communicator().ranks());
    return fastest_;
}

template <int D>
void ThreadedSolver<D>::expand() {
    if (this->ice_) {
        pairs_.fit(rest_, 1);
        pairs_.each([&](int k) { rest_[static_cast<std::size_t>(k)] = static_cast<float>(this->ice_rest(pairs_.owner(k))); });
    }
    if (!this->heat_ || !this->heat_->vapour()) return;
    const auto timed = this->passes_.time("vapour");
    if (!this->heat_->place(fluid_)) return;
    pairs_.fit(rest_, 1);
    pairs_.each([&](int k) { rest_[static_cast<std::size_t>(k)] = static_cast<float>(this->heat_->vapour()->rest(pairs_.owner(k))); });
}

template <int D>
void ThreadedSolver<D>::load_theta() {
    float* x = pairs_.a();
    pairs_.each([&](int k) {
        const int i = pairs_.owner(k);
        x[4 * k + 3] = static_cast<float>(this->heat_->theta(i, fluid_.enthalpy[static_cast<std::size_t>(i)]));
    });
}

template <int D>
HeatPass ThreadedSolver<D>::heat_pass() {
    const Heat<D>& heat = *this->heat_;
    const auto n = static_cast<std::size_t>(pairs_.size());
    if (warming_.size() < n) warming_.resize(n + n / 8);
    if (heat.held() && by_walls_.size() < n) by_walls_.resize(warming_.size());
    return {
        &heat.single_pairs(),  &heat.single_walls(), pairs_.size(), pairs_.a(), warming_.data(), heat.held() ? by_walls_.data() : nullptr,
        pairs_.list().first(), pairs_.list().rows()};
}

template <int D>
void ThreadedSolver<D>::find_density_and_heat(const PbfPass& density) {
    load_theta();
    const HeatPass job = heat_pass();
    const auto pass = pairs_.table().heat_and_density[flow_.kernel];
    pairs_.list().each_chunk([&](const ListChunk& chunk) { pass(job, density, chunk); });
    warmed_ = true;
}

template <int D>
void ThreadedSolver<D>::conduct(real dt) {
    if (!this->heat_) return;
    const auto timed = this->passes_.time("heat");
    Heat<D>& heat = *this->heat_;
    heat.feed(fluid_, dt);
    if (sources_) heat.add(sources_->warm(fluid_, heat, dt));
    const HeatPass job = heat_pass();
    const auto pass = pairs_.table().heat[flow_.kernel];
    const int parts = heat.parts(dt);
    const real part = dt / parts;
    const real outside = heat.exchanges().empty() ? 0 : heat.surroundings(fluid_.time - 0.5 * dt);
    for (int p = 0; p < parts; ++p) {
        heat.exchange(fluid_, outside, part);
        if (!std::exchange(warmed_, false)) {
            load_theta();
            pairs_.list().each_chunk([&](const ListChunk& chunk) { pass(job, chunk); });
        }
        pairs_.each([&](int k) {
            if (!pairs_.is_image(k))
                fluid_.enthalpy[static_cast<std::size_t>(pairs_.owner(k))] += part * warming_[static_cast<std::size_t>(k)];
        });
        if (heat.held())
            heat.add(fluid_.mass * part *
                     block_sum(pairs_.size(), [&](int k) { return pairs_.is_image(k) ? 0 : by_walls_[static_cast<std::size_t>(k)]; }));
    }
    heat.check(fluid_);
}

template <int D>
std::size_t ThreadedSolver<D>::bytes() const {
    return fluid_.bytes() + pairs_.bytes() + migration_.bytes() + own_bytes() + flow_.bytes() + effects_.bytes() +
           (warming_.capacity() + by_walls_.capacity()) * sizeof(real) + rest_.capacity() * sizeof(float) +
           (this->heat_ ? this->heat_->bytes() : 0) + (this->bodies_ ? this->bodies_->bytes() : 0) + (this->ice_ ? this->ice_->bytes() : 0);
}

template class ThreadedSolver<2>;
template class ThreadedSolver<3>;

}  // namespace weir::particles
