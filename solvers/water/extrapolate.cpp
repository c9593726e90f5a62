#include "water/extrapolate.hpp"

#include "core/parallel.hpp"
#include "core/scratch.hpp"

namespace weir::water {

namespace {
constexpr std::uint8_t queued = 255;
}

/// The face next to I among those along a; around a periodic axis face n is face 0.
template <int D>
bool Extrapolation<D>::step(Index<D>& I, int a, int axis, int by) const {
    const int i = I[axis] + by, n = frame_.cells[axis] + (axis == a ? 1 : 0);
    if (frame_.periodic(axis)) {
        I[axis] = ((i % frame_.cells[axis]) + frame_.cells[axis]) % frame_.cells[axis];
        return true;
    }
    if (i < 0 || i >= n) return false;
    I[axis] = i;
    return true;
}

/// A face that is unknown and has a known neighbour is of the first layer.
template <int D>
void Extrapolation<D>::join_front(Grid<std::uint8_t, D>& mark, int a, const Index<D>& face) {
    auto& m = mark(face);
    if (m != 0) return;
    for (int axis = 0; axis < D; ++axis)
        for (const int by : {-1, 1}) {
            Index<D> J = face;
            if (!step(J, a, axis, by) || mark(J) != 1) continue;
            m = queued;
            front_.push_back(face);
            return;
        }
}

/// What u changed by from the face behind J to J. The next face goes on like this (Aslam 2004: linear), as far as the second layer, which
/// is as far as cells beside the surface look. It goes on only where the flow is smooth: by the smaller of the last two changes (minmod),
/// and by at most 0.3 |u|. And it claims that liquid which comes there has accelerated by u du/dx: in a jet, whose tip only flies, that
/// claim becomes true when the tip arrives, and feeds it; so it is held to what drives a surface, gravity and tension. No wave reaches
/// that (u du/dx = (k a)² g); the front of a dam break does, and loses volume if held to a tenth of it.
template <int D>
real Extrapolation<D>::slope(const Grid<real, D>& u, const Grid<std::uint8_t, D>& mark, Index<D> J, int a, int axis, int by,
                             int layer) const {
    const real here = u(J), speed = std::abs(here), most = std::min(0.3 * speed, steepest_ * frame_.h[axis] / std::max(speed, 1e-300));
    const auto finished_behind = [&] { return step(J, a, axis, -by) && mark(J) != 0 && mark(J) <= layer; };
    if (layer > 2 || !finished_behind()) return 0;
    const real behind = u(J);
    if (!finished_behind()) return 0;
    const real last = here - behind, before = behind - u(J);
    if (last * before <= 0) return 0;
    return std::clamp(std::abs(last) < std::abs(before) ? last : before, -most, most);
}

template <int D>
real Extrapolation<D>::value(const Grid<real, D>& u, const Grid<std::uint8_t, D>& mark, const Grid<real, D>& phi, const Index<D>& I, int a,
                             int layer) const {
    const auto phi_at = [&](const Index<D>& face) { return phi(frame_.near(face, a, -1)) + phi(frame_.near(face, a, 0)); };
    const real here = phi_at(I);
    real weights = 0, sum = 0, plain = 0;
    int count = 0;
    for (int axis = 0; axis < D; ++axis) {
        real plain_axis = 0, weights_axis = 0, sum_axis = 0;  // added axis by axis, the two sides as a pair: symmetric under mirrors
        for (const int by : {-1, 1}) {
            Index<D> J = I;
            if (!step(J, a, axis, by) || mark(J) == 0 || mark(J) > layer) continue;
            const real w = std::max(0.0, here - phi_at(J)) * frame_.inv_h[axis] * frame_.inv_h[axis];
            weights_axis += w;
            sum_axis += w * (u(J) + slope(u, mark, J, a, axis, -by, layer));
            plain_axis += u(J);
            ++count;
        }
        weights += weights_axis;
        sum += sum_axis;
        plain += plain_axis;
    }
    // Inside solids, and where φ is flat, ∇φ says nothing: the plain mean of the finished neighbours.
    return weights * frame_.h_min() > 1e-9 ? sum / weights : plain / count;
}

template <int D>
void Extrapolation<D>::operator()(MacVelocity<D>& u, FaceMarks<D>& marks, const LevelSet<D>& surface, const FaceLists<D>& in_solids,
                                  int layers) {
    const std::size_t near = surface.layer_end(std::min(3, surface.layers()));
    for (int a = 0; a < D; ++a) {
        auto& mark = marks[static_cast<std::size_t>(a)];
        front_.clear();
        for (std::size_t i = 0; i < near; ++i)
            for (const int side : {0, 1}) {
                Index<D> face = surface.band()[i];
                face[a] += side;
                join_front(mark, a, face);
            }
        for (const Index<D>& face : in_solids[static_cast<std::size_t>(a)]) join_front(mark, a, face);
        for (int layer = 1; layer <= layers && !front_.empty(); ++layer) {
            const int count = static_cast<int>(front_.size());
            resize_scratch(value_, front_.size());
            parallel_for(0, count, [&](int i) {
                const auto at = static_cast<std::size_t>(i);
                value_[at] = value(u[a], mark, surface.phi, front_[at], a, layer);
            });
            for (std::size_t i = 0; i < front_.size(); ++i) {
                u[a](front_[i]) = value_[i];
                mark(front_[i]) = static_cast<std::uint8_t>(layer + 1);
            }
            next_.clear();
            if (layer < layers)
                for (const Index<D>& I : front_)
                    for (int axis = 0; axis < D; ++axis)
                        for (const int by : {-1, 1}) {
                            Index<D> J = I;
                            if (!step(J, a, axis, by) || mark(J) != 0) continue;
                            mark(J) = queued;
                            next_.push_back(J);
                        }
            front_.swap(next_);
        }
    }
}

template class Extrapolation<2>;
template class Extrapolation<3>;

}  // namespace weir::water
