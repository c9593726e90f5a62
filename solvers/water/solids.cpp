// The liquid's velocity inside solids, where markers and the surface beside them look: continued from the liquid, without what would
// flow through the solid's surface (constrained extrapolation: Houston, Bond & Wiebe 2003; Rasmussen et al. 2004; Bridson 2015). What
// stands there before and after the pressure is made in one way, so that FLIP's difference is that of the liquid's own velocity.
#include "water/solver.hpp"

namespace weir::water {

template <int D>
void Water<D>::place_solids(real t) {
    if (!solids_.any() || (t > 0 && !solids_.moving())) return;
    solids_.place(state_, t);
    for_each_cell(frame_.cells, [&](const Index<D>& I) { closed_(I) = state_.cells(I) == poisson::Cell::solid; });
    surface_.set_closed(closed_);
    mark_near_solids(solids_.solids(), frame_, near_solid_);
    list_faces_in_solids();
}

/// Faces that are closed, or nearly so, as deep as interpolation beside a solid looks.
template <int D>
void Water<D>::list_faces_in_solids() {
    const real deepest = -3 * norm(frame_.h), eps = 1e-3 * frame_.h_min();
    const geometry::Solids<D>& solids = solids_.solids();
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto& open = state_.solid.open[at];
        in_solids_[at].clear();
        solid_faces_[at].clear();
        for (std::size_t i = 0; i < open.size(); ++i) {
            if (open[i] >= least_trusted_fraction) continue;
            const Index<D> I = index_of<D>(open.extent(), i);
            if (!frame_.periodic(a) && (I[a] == 0 || I[a] == frame_.cells[a])) continue;  // the side's own
            const Vec<D> x = state_.u.face_centre(a, I);
            if (solids.distance(x) < deepest) continue;
            in_solids_[at].push_back(I);
            solid_faces_[at].push_back({solids.normal(x, eps), solids.velocity(x), solids[solids.nearest(x)].no_slip});
        }
        if (steps_ > 0) continue;
        // Solids that move may come to cut more faces: there is room for twice as many, so that no step allocates.
        in_solids_[at].reserve(2 * in_solids_[at].size());
        solid_faces_[at].reserve(2 * solid_faces_[at].size());
    }
}

/// Markers reach over a solid's surface with their hats, but what they leave there is not the liquid's velocity.
template <int D>
void Water<D>::forget_faces_in_solids() {
    for (int a = 0; a < D; ++a)
        for (const Index<D>& I : in_solids_[static_cast<std::size_t>(a)]) known_[static_cast<std::size_t>(a)](I) = 0;
}

/// The mean of the other components' four faces around a face; 0 for those that are not known.
template <int D>
Vec<D> Water<D>::velocity_at_face(int a, const Index<D>& I) const {
    Vec<D> v;
    v[a] = state_.u[a](I);
    for (int b = 0; b < D; ++b) {
        if (b == a) continue;
        const auto& known = known_[static_cast<std::size_t>(b)];
        real sum = 0;
        int count = 0;
        for (const int along : {0, 1}) {
            real pair = 0;  // the two sides of the face are added first, so that a mirror changes nothing
            for (const int across : {-1, 0}) {
                Index<D> J = frame_.near(I, a, across);
                J[b] += along;
                if (frame_.periodic(b)) J[b] %= frame_.cells[b];
                if (known(J) != 0) pair += state_.u[b](J), ++count;
            }
            sum += pair;
        }
        if (count > 0) v[b] = sum / count;
    }
    return v;
}

/// u −= n n·(u − u_solid) where solids slip; u = u_solid where they do not, or where no liquid is near.
template <int D>
void Water<D>::constrain_velocity_in_solids() {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        auto& faces = solid_faces_[at];
        const auto& list = in_solids_[at];
        parallel_for(0, static_cast<int>(faces.size()), [&](int i) {
            SolidFace<D>& face = faces[static_cast<std::size_t>(i)];
            const Index<D>& I = list[static_cast<std::size_t>(i)];
            if (face.no_slip || known_[at](I) == 0) {
                face.value = face.velocity[a];
                return;
            }
            const Vec<D> v = velocity_at_face(a, I);
            face.value = v[a] - face.normal[a] * dot(face.normal, v - face.velocity);
        });
    }
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        for (std::size_t i = 0; i < solid_faces_[at].size(); ++i) state_.u[a](in_solids_[at][i]) = solid_faces_[at][i].value;
    }
}

#define WEIR_INSTANTIATE(D)                                 \
    template void Water<D>::place_solids(real);             \
    template void Water<D>::list_faces_in_solids();         \
    template void Water<D>::forget_faces_in_solids();       \
    template void Water<D>::constrain_velocity_in_solids(); \
    template Vec<D> Water<D>::velocity_at_face(int, const Index<D>&) const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
