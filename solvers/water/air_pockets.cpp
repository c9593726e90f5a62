// Connected components of air by flood fill, their volumes from the liquid volume fraction, and the carry-over of their content.
#include "water/air_pockets.hpp"

#include "parallel/plane_checkpoint.hpp"

#include <algorithm>
#include <cmath>

namespace weir::water {

using poisson::Cell;

namespace {
constexpr real thin_air = 1e-12;     // less air in a cell is round-off [cells]
constexpr real least_volume = 0.01;  // floor of a pocket's volume, relative to its cells: bounds the pressure of a vanishing pocket
}  // namespace

/// Volume of air in a cell [cells].
template <int D>
real AirPockets<D>::air_in(const Index<D>& I) const {
    if (!closed_.empty() && closed_(I)) return 0;
    const real open = surface_.open_part(I), liquid = part_ ? (*part_)(I) : open * surface_.fraction(I);
    return std::max(open - liquid, real(0));
}

/// f(neighbour, axis, end) for every face of I that is open to flow; the neighbour is I itself on a side of the domain.
template <int D>
template <class F>
void AirPockets<D>::for_each_open_face(const MacState<D>& state, const Index<D>& I, F&& f) const {
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            Index<D> face = I;
            face[a] += end;
            if (frame_.periodic(a) && face[a] == frame_.cells[a]) face[a] = 0;
            if (state.solid.any() && !(state.solid.open[static_cast<std::size_t>(a)](face) > 0)) continue;
            Index<D> J = I;
            frame_.step(J, a, end == 0 ? -1 : 1);
            f(J, a, end);
        }
}

/// Labels the component of air with the cell `seed`; returns whether it touches an open side or an emitter.
template <int D>
bool AirPockets<D>::fill(const MacState<D>& state, std::size_t seed, int label) {
    bool open = false;
    stack_.assign(1, seed);
    label_[seed] = label;
    while (!stack_.empty()) {
        const Index<D> I = frame_.index_of(stack_.back());
        stack_.pop_back();
        for_each_open_face(state, I, [&](const Index<D>& J, int a, int end) {
            if (J == I) {
                open = open || state.sides.open(a, end);
                return;
            }
            const std::size_t at = state.cells.linear(J);
            const bool in_emitter = state.cells[at] == Cell::solid && (closed_.empty() || !closed_[at]);
            open = open || in_emitter;
            if (state.cells[at] != Cell::air || label_[at] != no_air) return;
            label_[at] = label;
            stack_.push_back(at);
        });
    }
    return open;
}

/// Components in the order of their first cells; open ones get the label open_air.
template <int D>
void AirPockets<D>::label_components(const MacState<D>& state) {
    label_ = Grid<int, D>(frame_.cells, no_air);
    std::vector<int> number{open_air};  // final label of each component, from 1 on
    int pockets = 0;
    for (std::size_t i = 0; i < label_.size(); ++i)
        if (state.cells[i] == Cell::air && label_[i] == no_air) {
            const bool open = fill(state, i, static_cast<int>(number.size()));
            number.push_back(open ? open_air : ++pockets);
        }
    for (int& label : label_.values()) label = label == no_air ? no_air : number[static_cast<std::size_t>(label)];
    has_open_air_ = std::count(number.begin(), number.end(), open_air) > 1;
    pockets_.assign(static_cast<std::size_t>(pockets), Pocket{});
}

/// Number of air cells of each label within `steps` faces of a liquid cell, across liquid.
template <int D>
std::map<int, real> AirPockets<D>::air_beside(const MacState<D>& state, const Index<D>& I, int steps) const {
    std::map<int, real> beside;
    for_each_open_face(state, I, [&](const Index<D>& J, int, int) {
        if (label_(J) != no_air)
            beside[label_(J)] += 1;
        else if (steps > 1 && state.cells(J) == Cell::fluid)
            for (const auto& [label, count] : air_beside(state, J, steps - 1)) beside[label] += count;
    });
    return beside;
}

/// Number of cells of each label, from 0 on, around a closed cell.
template <int D>
static std::map<int, real> labels_around(const Frame<D>& frame, const Grid<int, D>& label, const Index<D>& I) {
    std::map<int, real> around;
    for (int a = 0; a < D; ++a)
        for (const int by : {-1, 1})
            if (Index<D> J = I; frame.step(J, a, by) && label(J) >= 0) around[label(J)] += 1;
    return around;
}

/// Volumes: the air of each air cell, and of each liquid cell at the surface and each cell that a solid closes but does not fill, shared by
/// the air beside it.
template <int D>
void AirPockets<D>::measure(const MacState<D>& state) {
    const real near = -2 * frame_.h_max();
    air_ = Grid<real, D>(frame_.cells);
    const auto add = [&](int label, real cells) {
        if (label > open_air) pockets_[static_cast<std::size_t>(label) - 1].volume += cells * frame_.cell_volume();
    };
    for (std::size_t i = 0; i < air_.size(); ++i) {
        const bool is_closed = state.cells[i] == Cell::solid;
        if (is_closed ? closed_.empty() || !closed_[i] : surface_.phi[i] < near) continue;
        const Index<D> I = frame_.index_of(i);
        const real air = is_closed ? surface_.open_part(I) : air_in(I);
        if (label_[i] != no_air) {
            air_[i] = air;
            add(label_[i], air);
            if (label_[i] > open_air) pockets_[static_cast<std::size_t>(label_[i]) - 1].capacity += capacity(I);
        } else if (air > thin_air) {
            std::map<int, real> beside = is_closed ? labels_around(frame_, label_, I) : air_beside(state, I, 1);
            if (!is_closed && beside.empty()) beside = air_beside(state, I, 2);
            real all = 0;
            for (const auto& [label, count] : beside) all += count;
            for (const auto& [label, count] : beside) add(label, air * count / all);
        }
    }
    for (Pocket& pocket : pockets_) pocket.volume = std::max(pocket.volume, least_volume * pocket.capacity * frame_.cell_volume());
}

/// Old and new air in the same cells; for an old pocket whose cells are all liquid now, in the cells beside them.
template <int D>
auto AirPockets<D>::overlaps(const MacState<D>& state, const Grid<int, D>& old_label, const Grid<real, D>& old_air,
                             std::size_t old_count) const -> Overlaps {
    Overlaps list;
    std::vector<char> found(old_count + 1, 0);
    for (std::size_t i = 0; i < old_label.size(); ++i)
        if (old_label[i] != no_air && label_[i] != no_air) {
            list[{old_label[i], label_[i]}] += old_air[i] + thin_air;
            found[static_cast<std::size_t>(old_label[i])] = 1;
        }
    if (std::count(found.begin() + 1, found.end(), 0) == 0) return list;
    for (std::size_t i = 0; i < old_label.size(); ++i)
        if (old_label[i] > open_air && !found[static_cast<std::size_t>(old_label[i])])
            for (const auto& [label, count] : air_beside(state, frame_.index_of(i), 2)) list[{old_label[i], label}] += count;
    return list;
}

/// Mean of p over the cells of each pocket [Pa].
template <int D>
std::vector<real> AirPockets<D>::mean_pressures(const Grid<real, D>& p) const {
    std::vector<real> mean(pockets_.size(), 0), cells(pockets_.size(), 0);
    for (std::size_t i = 0; i < label_.size(); ++i)
        if (label_[i] > open_air) {
            const auto k = static_cast<std::size_t>(label_[i]) - 1;
            mean[k] += p[i], cells[k] += 1;
        }
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] /= cells[k];
    return mean;
}

/// Pressures from Q. Pockets that appeared in liquid, and those that have grown from unresolved ones, have that of the last step instead,
/// and Q follows.
template <int D>
void AirPockets<D>::set_pressures(const MacState<D>& state, const std::vector<char>& appeared, const std::vector<char>& was_resolved) {
    const real least_cells = D == 2 ? 9 : 27;
    const std::vector<real> mean = mean_pressures(state.p);
    for (std::size_t k = 0; k < pockets_.size(); ++k) {
        Pocket& pocket = pockets_[k];
        pocket.resolved = pocket.capacity >= least_cells;
        const real outer = law_ ? law_->pressure + mean[k] : 0;
        const bool grown = law_ && pocket.resolved && !was_resolved[k];
        if (appeared[k] || grown) pocket.content = content_per_volume(outer) * pocket.volume;
        if (law_) pocket.pressure = std::pow(pocket.content / pocket.volume, law_->exponent);
    }
}

template <int D>
void AirPockets<D>::carry_content(const MacState<D>& state, const Grid<int, D>& old_label, const Grid<real, D>& old_air,
                                  const std::vector<Pocket>& old) {
    std::vector<real> all(old.size() + 1, 0);
    std::vector<char> known(pockets_.size(), 0), was_pocket(pockets_.size(), 0), appeared(pockets_.size(), 0);
    std::vector<char> was_resolved(pockets_.size(), 0);
    const real of_open_air = content_per_volume(law_ ? law_->pressure : 0);
    const Overlaps list = old_label.empty() ? Overlaps{} : overlaps(state, old_label, old_air, old.size());
    for (const auto& [labels, volume] : list) all[static_cast<std::size_t>(labels.first)] += volume;
    for (const auto& [labels, volume] : list) {
        const auto [from, to] = labels;
        if (to == open_air) continue;
        const auto k = static_cast<std::size_t>(to) - 1;
        known[k] = 1;
        if (from == open_air) {
            was_resolved[k] = 1;
            pockets_[k].content += of_open_air * volume * frame_.cell_volume();
            continue;
        }
        was_pocket[k] = 1;
        was_resolved[k] |= static_cast<char>(old[static_cast<std::size_t>(from) - 1].resolved);
        pockets_[k].content += old[static_cast<std::size_t>(from) - 1].content * volume / all[static_cast<std::size_t>(from)];
    }
    for (std::size_t k = 0; k < pockets_.size(); ++k) {
        if (!was_pocket[k]) pockets_[k].content = of_open_air * pockets_[k].volume, was_resolved[k] = 1;
        appeared[k] = !old_label.empty() && !known[k];
    }
    set_pressures(state, appeared, was_resolved);
}

template <int D>
void AirPockets<D>::find(const MacState<D>& state) {
    const Grid<int, D> old_label = std::move(label_);
    const Grid<real, D> old_air = std::move(air_);
    const std::vector<Pocket> old = std::move(pockets_);
    label_components(state);
    measure(state);
    carry_content(state, old_label, old_air, old);
}

template <int D>
auto AirPockets<D>::largest() const -> const Pocket* {
    const auto at =
        std::max_element(pockets_.begin(), pockets_.end(), [](const Pocket& a, const Pocket& b) { return a.volume < b.volume; });
    return at == pockets_.end() ? nullptr : &*at;
}

template <int D>
real AirPockets<D>::mean_pressure(const Grid<real, D>& p) const {
    return pockets_.empty() ? 0 : mean_pressures(p)[static_cast<std::size_t>(largest() - pockets_.data())];
}

template <int D>
real AirPockets<D>::elastic_energy() const {
    real sum = 0;
    for (const Pocket& pocket : pockets_) {
        if (!law_ || !pocket.resolved) continue;
        const real gamma = law_->exponent, p0 = law_->pressure, V = pocket.volume, V0 = pocket.content / content_per_volume(p0);
        const real stored = gamma > 1 ? (pocket.pressure * V - p0 * V0) / (gamma - 1) : p0 * V0 * std::log(V0 / V);
        sum += stored + p0 * (V - V0);
    }
    return sum;
}

template <int D>
void AirPockets<D>::save(Checkpoint& to) const {
    std::vector<real> content;
    for (const Pocket& pocket : pockets_) content.push_back(pocket.content);
    to.put("water.air_labels", label_.values());
    to.put("water.air_volumes", air_.values());
    to.put("water.air_content", content);
}

/// find() must follow: it finds the same pockets again.
template <int D>
void AirPockets<D>::restore(const Checkpoint& from) {
    label_ = Grid<int, D>(frame_.cells);
    air_ = Grid<real, D>(frame_.cells);
    from.get("water.air_labels", label_.values());
    from.get("water.air_volumes", air_.values());
    std::vector<real> content(from.held<real>("water.air_content").all);
    from.get("water.air_content", std::span<real>(content));
    pockets_.assign(content.size(), Pocket{});
    for (std::size_t k = 0; k < content.size(); ++k) pockets_[k].content = content[k];
    for (const int label : label_.values())
        if (label < no_air || label > static_cast<int>(content.size()))
            throw std::runtime_error(
                "checkpoint block \"water.air_labels\" names a pocket of air that \"water.air_content\" does not have");
}

template class AirPockets<2>;
template class AirPockets<3>;

}  // namespace weir::water
