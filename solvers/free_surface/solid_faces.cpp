#include "free_surface/solid_faces.hpp"

#include <algorithm>

namespace weir::free_surface {

/// Keeps the faces outside all updated boxes.
template <int D>
void FacesInSolids<D>::forget_changed(const std::vector<CellBox<D>>& changed, int a) {
    auto& faces = faces_[static_cast<std::size_t>(a)];
    auto& solid = solid_[static_cast<std::size_t>(a)];
    if (changed.empty()) return;
    CellBox<D> all = changed.front();
    for (const CellBox<D>& box : changed)
        for (int d = 0; d < D; ++d) all.lo[d] = std::min(all.lo[d], box.lo[d]), all.hi[d] = std::max(all.hi[d], box.hi[d]);
    all = all.faces(a);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (all.holds(faces[i]) &&
            std::any_of(changed.begin(), changed.end(), [&](const CellBox<D>& box) { return box.faces(a).holds(faces[i]); }))
            continue;
        faces[kept] = faces[i], solid[kept] = solid[i];
        ++kept;
    }
    faces.resize(kept), solid.resize(kept);
}

template <int D>
void FacesInSolids<D>::find(const SolidPlacement<D>& placement, const MacState<D>& state, const Frame<D>& frame, bool room) {
    const geometry::Solids<D>& solids = placement.solids();
    const auto& changed = placement.changed();
    const real deepest = -3 * norm(frame.h), eps = 1e-3 * frame.h_min();
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto& open = state.solid.open[at];
        forget_changed(changed, a);
        for (std::size_t box = 0; box < changed.size(); ++box) {
            const auto near = placement.near(box);
            const auto see = [&](const Index<D>& I) {
                if (!frame.periodic(a) && (I[a] == 0 || I[a] == frame.cells[a])) return;  // a face of the domain's side
                for (std::size_t other = 0; other < box; ++other)
                    if (changed[other].faces(a).holds(I)) return;  // found in that box
                const Vec<D> x = state.u.face_centre(a, I);
                const std::size_t nearest = solids.nearest(x, near);
                const real distance = solids.distance(nearest, x);
                if (distance < deepest) return;
                // no solid farther than this is the nearest within eps of x
                const bool alone = std::none_of(near.begin(), near.end(), [&](std::size_t other) {
                    const geometry::Ball<D>& ball = solids.ball(other);
                    return other != nearest && norm(x - ball.middle) - ball.radius < distance + 4 * eps;
                });
                const auto of = alone ? std::span<const std::size_t>(&nearest, 1) : near;
                faces_[at].push_back(I);
                solid_[at].push_back({solids.normal(x, eps, of), solids.pose(nearest).velocity_at(x), nearest, solids[nearest].no_slip});
            };
            changed[box].faces(a).rows([&](Index<D> I, int count) {
                if (!state.u[a].store().holds(I[D - 1])) return;
                const real* part = &open(I);
                for (int i = 0; i < count; ++i, ++I[0])
                    if (part[i] < least_trusted_fraction) see(I);
            });
        }
        closed_[at].clear();
        for (const Index<D>& I : faces_[at])
            if (open(I) == 0) closed_[at].push_back(I);
        if (!room) continue;
        for (auto* list : {&faces_[at], &closed_[at]}) list->reserve(2 * faces_[at].size());
        solid_[at].reserve(2 * solid_[at].size());
    }
    any_ = sum_of_ranks(frame.own(), std::any_of(faces_.begin(), faces_.end(), [](const auto& list) { return !list.empty(); })) > 0;
}

template <int D>
void FacesInSolids<D>::see_velocities(const geometry::Solids<D>& solids, const MacState<D>& state) {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        for (std::size_t i = 0; i < solid_[at].size(); ++i) {
            SolidFace& face = solid_[at][i];
            if (solids[face.solid].free) face.velocity = solids.pose(face.solid).velocity_at(state.u.face_centre(a, faces_[at][i]));
        }
    }
}

template <int D>
void FacesInSolids<D>::forget(FaceMarks<D>& known) const {
    for (int a = 0; a < D; ++a)
        for (const Index<D>& I : faces_[static_cast<std::size_t>(a)]) known[static_cast<std::size_t>(a)](I) = 0;
}

namespace {

/// The mean of each other component's four faces around a face; 0 for unknown faces.
template <int D>
Vec<D> velocity_at_face(const MacVelocity<D>& u, const FaceMarks<D>& marks, const Frame<D>& frame, int a, const Index<D>& I) {
    Vec<D> v{};
    v[a] = u[a](I);
    for (int b = 0; b < D; ++b) {
        if (b == a) continue;
        const auto& known = marks[static_cast<std::size_t>(b)];
        real sum = 0;
        int count = 0;
        for (const int along : {0, 1}) {
            real pair = 0;  // the two sides of the face are added first: mirror symmetric
            for (const int across : {-1, 0}) {
                Index<D> J = frame.near(I, a, across);
                J[b] += along;
                if (frame.periodic(b)) J[b] %= frame.cells[b];
                if (known(J) != 0) pair += u[b](J), ++count;
            }
            sum += pair;
        }
        if (count > 0) v[b] = sum / count;
    }
    return v;
}

}  // namespace

/// In parallel, each rank handles the faces of its own planes.
template <int D>
void FacesInSolids<D>::constrain(MacVelocity<D>& u, const FaceMarks<D>& known, const Frame<D>& frame) {
    if (any_) refresh_faces(u, frame, 1);
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        parallel_for(0, static_cast<int>(solid_[at].size()), [&](int i) {
            SolidFace& face = solid_[at][static_cast<std::size_t>(i)];
            const Index<D>& I = faces_[at][static_cast<std::size_t>(i)];
            if (!frame.own().contains(I[D - 1])) return;
            if (face.no_slip || known[at](I) == 0) {
                face.value = face.velocity[a];
                return;
            }
            const Vec<D> v = velocity_at_face<D>(u, known, frame, a, I);
            face.value = v[a] - face.normal[a] * dot(face.normal, v - face.velocity);
        });
    }
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        for (std::size_t i = 0; i < solid_[at].size(); ++i)
            if (frame.own().contains(faces_[at][i][D - 1])) u[a](faces_[at][i]) = solid_[at][i].value;
    }
}

template <int D>
std::size_t FacesInSolids<D>::bytes() const {
    std::size_t total = 0;
    for (const auto& faces : solid_) total += faces.size() * (sizeof(SolidFace) + sizeof(Index<D>));
    for (const auto& faces : closed_) total += faces.size() * sizeof(Index<D>);
    return total;
}

template class FacesInSolids<2>;
template class FacesInSolids<3>;

}  // namespace weir::free_surface
