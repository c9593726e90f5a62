#include "two_phase/solids.hpp"

#include "core/parallel.hpp"

namespace weir::two_phase {

namespace {

constexpr real least_fraction = 1e-6;  // the plane of a cell with less of one phase has an uncertain normal

}  // namespace

template <int D>
ContinuedFractions<D>::ContinuedFractions(const MacState<D>& state, const Around<D>& around) {
    Grid<std::uint8_t, D> layer(state.extent());  // 0: not reached
    for_each_cell(layer.extent(), [&](const Index<D>& I) { layer(I) = is_open(state, I) ? 1 : 0; });
    const auto plane = static_cast<std::size_t>(layer.stride(D - 1));
    const std::size_t first = static_cast<std::size_t>(layer.own().lower(0)) * plane,
                      last = static_cast<std::size_t>(layer.own().upper(layer.extent()[D - 1])) * plane;
    for (std::size_t number = 0; number < layers_.size(); ++number) {
        const auto source = static_cast<std::uint8_t>(number + 1);
        refresh(layer, around.repeats());
        for (std::size_t at = first; at < last; ++at) {
            if (layer[at] != 0) continue;
            Closed closed{index_of<D>(layer.extent(), at), 0};
            for (int k = 0; k < block_cells<D>; ++k)
                if (layer(around(closed.cell + block_offset<D>(k))) == source) closed.sources |= std::uint32_t{1} << k;
            if (closed.sources != 0) layers_[number].push_back(closed);
        }
        for (const Closed& closed : layers_[number]) layer(closed.cell) = static_cast<std::uint8_t>(source + 1);
    }
}

/// The mean over mixed sources of the fraction below their planes, with weights f (1 − f). Without one, the mean of the sources.
template <int D>
real ContinuedFractions<D>::value(const Padded<D>& f, const Closed& closed) {
    const Strides<D> stride = strides_of(f);
    real below = 0, weights = 0, sum = 0;
    int count = 0;
    for (int k = 0; k < block_cells<D>; ++k) {
        if ((closed.sources >> k & 1) == 0) continue;
        const Index<D> by = block_offset<D>(k), J = closed.cell + by;
        ++count;
        sum += f(J);
        if (f(J) < least_fraction || f(J) > 1 - least_fraction) continue;
        const Plane<D> plane = plane_at<D>(f.at(J), stride);
        const real weight = f(J) * (1 - f(J));
        weights += weight;
        below += weight * volume_below(plane.m, plane.alpha + dot(plane.m, to_vec(by)));
    }
    return weights > 0 ? below / weights : sum / count;
}

template <int D>
void ContinuedFractions<D>::extend(const FractionGhosts<D>& ghosts, Padded<D>& padded, Grid<real, D>& f) const {
    for (const auto& layer : layers_) {
        if (layer.empty() && !f.own().distributed()) continue;  // the exchange is collective
        parallel_for(0, static_cast<int>(layer.size()), [&](int i) {
            const Closed& closed = layer[static_cast<std::size_t>(i)];
            f(closed.cell) = value(padded, closed);
        });
        ghosts.fill_all(padded, f);
    }
}

template <int D>
std::size_t ContinuedFractions<D>::bytes() const {
    return (layers_[0].capacity() + layers_[1].capacity()) * sizeof(Closed);
}

template <int D>
void find_open_flow(MacState<D>& s, SolidPlacement<D>& solids, const std::array<Boundary<D>, D>& mirrored, PaddedVelocity<D>& flow) {
    solids.extend_velocity(s);
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto& open = s.solid.open[at];
        fill_ghosts(s.before[a], mirrored[at]);
        for_each_cell(open.extent(), [&](const Index<D>& I) {
            flow[a](I) = open(I) * s.before[a](I);
            if (open(I) == 0) s.u[a](I) = s.before[a](I);
        });
        fill_ghosts(flow[a], mirrored[at]);
    }
}

#define WEIR_INSTANTIATE(D)               \
    template class ContinuedFractions<D>; \
    template void find_open_flow<D>(MacState<D>&, SolidPlacement<D>&, const std::array<Boundary<D>, D>&, PaddedVelocity<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::two_phase
