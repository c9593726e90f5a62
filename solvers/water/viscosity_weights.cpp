// Liquid fractions of cells, faces and edges for the viscosity, and no-slip boundaries.
#include "water/viscosity.hpp"

namespace weir::water {

using geometry::SideKind;

/// The liquid fraction of the box around an edge on the lower sides of cell I; 0 beside free-slip boundaries, where no shear acts. Of its
/// four cells, those closed by bodies count as wet as their neighbours, and those beyond a side as half of the edge's fraction.
template <int D>
real SurfaceViscosity<D>::edge_weight(int a, int b, const Index<D>& I, const Grid<std::uint8_t, D>& closed) const {
    real sum = 0;
    int cells = 0, in_bodies = 0;
    for (const int da : {-1, 0})
        for (const int db : {-1, 0}) {
            Index<D> J = I;
            bool inside = true;
            for (const auto& [axis, by] : {std::pair{a, da}, std::pair{b, db}}) {
                const int i = I[axis] + by;
                if ((i >= 0 && i < frame_.cells[axis]) || frame_.periodic(axis)) {
                    J[axis] = (i + frame_.cells[axis]) % frame_.cells[axis];
                    continue;
                }
                inside = false;
                const auto& side = sides_->side(axis, i < 0 ? 0 : 1);
                if (side.kind != SideKind::moving_wall && !(side.kind == SideKind::wall && side.no_slip)) return 0;
            }
            if (!inside) continue;
            ++cells;
            if (bodies_ && bodies_->closes(J)) {
                ++in_bodies;
                continue;
            }
            if (!solids_stick_ && !closed.empty() && closed(J)) return 0;
            sum += cell_(J);
        }
    if (in_bodies > 0 && in_bodies < cells) sum *= static_cast<real>(cells) / (cells - in_bodies);
    return 0.25 * sum;
}

template <int D>
void SurfaceViscosity<D>::set_weights(const MacState<D>& state, const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed) {
    for_each_cell(frame_.cells, [&](const Index<D>& I) { cell_(I) = !closed.empty() && closed(I) ? 0 : surface.fraction(I); });
    refresh(cell_, frame_.periodic(D - 1), 2);
    for (int a = 0; a < D; ++a)
        for (int b = a + 1; b < D; ++b) {
            auto& weight = edge_[static_cast<std::size_t>(a + b - 1)];
            // the next rank's first edges border on this rank's last faces
            for_each_cell(weight.extent().wider(1), [&](const Index<D>& I) { weight(I) = edge_weight(a, b, I, closed); });
        }
    for (int a = 0; a < D; ++a) {
        auto& mass = mass_[static_cast<std::size_t>(a)];
        for_each_cell(mass.extent(), [&](const Index<D>& I) {
            const bool on_side = !frame_.periodic(a) && (I[a] == 0 || I[a] == frame_.cells[a]);
            const bool copy = frame_.periodic(a) && I[a] == frame_.cells[a];
            const bool shut = state.solid.any() && state.solid.open[static_cast<std::size_t>(a)](I) == 0;
            mass(I) = on_side || copy || shut ? -1 : 0.5 * (cell_(frame_.near(I, a, -1)) + cell_(frame_.near(I, a, 0)));
        });
    }
    if (bodies_)
        for (const InsideFace<D>& f : state.no_slip_walls->inside) mass_[static_cast<std::size_t>(f.axis)](f.face) = -1;
}

/// The walls of bodies beside unknown faces: their liquid fraction is that of the edge, or cell, between the face and the one inside.
template <int D>
void SurfaceViscosity<D>::list_walls(const MacState<D>& state) {
    for (const WallLink<D>& link : state.no_slip_walls->links) {
        if (mass_[static_cast<std::size_t>(link.axis)](link.node) < 0) continue;
        const bool above = link.beyond[link.across] > link.node[link.across];
        const int a = link.axis, b = link.across;
        const real w = a == b ? cell_(frame_.near(link.node, a, above ? 0 : -1))
                              : edge(std::min(a, b), std::max(a, b))(above ? link.beyond : link.node);
        bodies_->add_wall(state, link, w);
    }
}

#define WEIR_INSTANTIATE(D)                                                                                               \
    template real SurfaceViscosity<D>::edge_weight(int, int, const Index<D>&, const Grid<std::uint8_t, D>&) const;        \
    template void SurfaceViscosity<D>::set_weights(const MacState<D>&, const LevelSet<D>&, const Grid<std::uint8_t, D>&); \
    template void SurfaceViscosity<D>::list_walls(const MacState<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
