#include "smoke/emitters.hpp"

#include <algorithm>
#include <utility>

namespace weir::smoke {

namespace {

constexpr std::array<const char*, 2> settable{"smoke", "temperature"};

/// The entries of a grid inside a shape, and whether there are any. In parallel, of the planes that this rank stores.
template <int D, class T, class Position>
std::pair<std::vector<std::size_t>, bool> covered(const geometry::Shape<D>& shape, const Grid<T, D>& grid, Position position) {
    const Index<D>& extent = grid.extent();
    std::vector<std::size_t> entries;
    bool any = false;
    for (std::size_t i = 0; i < product(extent); ++i) {
        Index<D> I;
        std::size_t rest = i;
        for (int d = 0; d < D; ++d) {
            I[d] = static_cast<int>(rest % static_cast<std::size_t>(extent[d]));
            rest /= static_cast<std::size_t>(extent[d]);
        }
        if (!shape.contains(position(I))) continue;
        any = true;
        if (grid.store().holds(I[D - 1])) entries.push_back(i);
    }
    return {std::move(entries), any};
}

/// t < moment, up to rounding of a sum of steps that ends at the moment.
bool before(real t, real moment) { return t < moment * (1 - 1e-9); }

}  // namespace

template <int D>
FieldPlan& Emitters<D>::needs(const scene::Scene& scene, FieldPlan& plan) {
    if (any(scene))
        for (const auto& table : scene.root().tables("emitters"))
            for (const char* name : settable)
                if (table.has(name)) plan.advected(name);
    return plan;
}

template <int D>
typename Emitters<D>::Emitter Emitters<D>::make(const scene::Table& table, const MacState<D>& s) {
    const MacVelocity<D>& grid = s.u;
    Emitter emitter{table.number("start"), table.number_or("end", infinity), {}};
    const auto shape = geometry::make_shape<D>(table);
    for (const char* name : settable)
        if (table.has(name)) {
            auto [entries, any] = covered(*shape, s.cells, [&](const Index<D>& I) { return grid.cell_centre(I); });
            emitter.sets.push_back({name, -1, table.number(name), std::move(entries), any});
        }
    if (!table.has("velocity")) return emitter;
    const auto velocity = table.vec<D>("velocity");
    for (int a = 0; a < D; ++a) {
        auto [entries, any] = covered(*shape, grid[a], [&](const Index<D>& I) { return grid.face_centre(a, I); });
        emitter.sets.push_back({"", a, velocity[a], std::move(entries), any});
    }
    return emitter;
}

template <int D>
std::string Emitters<D>::idle(const Emitter& emitter, const geometry::Shape<D>& shape, const MacState<D>& state) {
    if (emitter.sets.empty()) return "the emitter has no effect: give it a velocity, smoke or temperature";
    for (const auto& set : emitter.sets)
        if (!set.any && (set.axis < 0 || set.value != 0))
            return std::string("the emitter is thinner than a cell: it covers the centre of no ") + (set.axis < 0 ? "cell" : "face") +
                   (set.axis < 0 ? "" : std::string(" along ") + "xyz"[set.axis]);
    const auto [cells, any] = covered(shape, state.cells, [&](const Index<D>& I) { return state.u.cell_centre(I); });
    const bool some = std::any_of(cells.begin(), cells.end(), [&](std::size_t i) { return state.cells[i] != poisson::Cell::solid; });
    if (any && (state.own().distributed() ? communicator().largest(some) : some) == 0)
        return "the emitter lies inside solids: nothing can leave it";
    return {};
}

template <int D>
Emitters<D>::Emitters(const scene::Scene& scene, const MacState<D>& state) : cfl_(scene.number("time.cfl")) {
    const MacVelocity<D>& grid = state.u;
    for (const auto& table : scene.root().tables("emitters")) {
        emitters_.push_back(make(table, state));
        if (const auto why = idle(emitters_.back(), *geometry::make_shape<D>(table), state); !why.empty())
            scene.refuse("emitters[" + std::to_string(emitters_.size() - 1) + "]", why);
        for (const auto& set : emitters_.back().sets)
            if (set.axis >= 0) max_rate_ = std::max(max_rate_, std::abs(set.value) / grid.h[set.axis]);
    }
}

template <int D>
void Emitters<D>::apply(MacState<D>& s, real) {
    for (auto& field : s.fields) field.held.clear();
    for (const auto& emitter : emitters_) {
        if (before(s.time, emitter.start) || !before(s.time, emitter.end)) continue;
        for (const auto& set : emitter.sets)
            if (set.axis < 0) {
                auto& held = s.field(set.field).held;
                for (const std::size_t i : set.entries) held.push_back({i, set.value});
            } else {
                for (const std::size_t i : set.entries) s.u[set.axis][i] = set.value;
            }
    }
    for (auto& field : s.fields) field.enforce_sources();
}

/// No step crosses the time at which an emitter opens: its heating and forces are unknown before.
template <int D>
real Emitters<D>::max_dt(const MacState<D>& s) const {
    real limit = max_rate_ > 0 ? cfl_ / max_rate_ : infinity;
    for (const auto& emitter : emitters_)
        if (before(s.time, emitter.start)) limit = std::min(limit, emitter.start - s.time);
    return limit;
}

template class Emitters<2>;
template class Emitters<3>;

}  // namespace weir::smoke
