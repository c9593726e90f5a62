#include "tallcell/transport.hpp"

namespace weir::tallcell {

template <int D>
Transport<D>::Transport(const Frame<D>& frame, const MacVelocity<D>& u, bool maccormack, int reach)
    : frame_(frame), maccormack_(maccormack), reach_(reach), before_(u) {
    if (maccormack) predicted_ = u;
}

template <int D>
void Transport<D>::operator()(const TallPressure<D>& mesh, const Grid<real, D>& phi, const geometry::Sides<D>& sides, real dt,
                              MacVelocity<D>& u) {
    const auto copy = [&](MacVelocity<D>& to) {
        for (int a = 0; a < D; ++a) {
            const std::size_t planes = static_cast<std::size_t>(u[a].extent()[D - 1]), plane = u[a].size() / planes;
            parallel_for(0, static_cast<int>(planes), [&](int k) {
                const std::size_t first = static_cast<std::size_t>(k) * plane;
                std::copy_n(u[a].data() + first, plane, to[a].data() + first);
            });
        }
    };
    copy(before_);
    const real h = frame_.h_max();
    if (!maccormack_) {
        for_faces(mesh, phi, sides, dt, 2 * h, u, [&](int a, const Vec<D>& s, real) { return departed(a, s, dt); });
        return;
    }
    copy(predicted_);
    for_faces(mesh, phi, sides, dt, (reach_ + 2) * h, predicted_, [&](int a, const Vec<D>& s, real) { return departed(a, s, dt); });
    for_faces(mesh, phi, sides, dt, 2 * h, u, [&](int a, const Vec<D>& s, real here) { return corrected(a, s, here, dt); });
}

namespace {

/// A point in cells from the domain's lower corner; between which samples it lies, and whether all of them are inside the domain.
template <int D>
struct Inside {
    std::array<int, D> face, centre;
    std::array<real, D> face_part, centre_part;
    bool all = true;

    Inside(const Frame<D>& frame, const Vec<D>& s) {
        for (int d = 0; d < D; ++d) {
            const auto at = static_cast<std::size_t>(d);
            all = all && s[d] >= 1 && s[d] < frame.cells[d] - 1;
            face[at] = static_cast<int>(s[d]);
            face_part[at] = s[d] - face[at];
            centre[at] = static_cast<int>(s[d] - 0.5);
            centre_part[at] = s[d] - 0.5 - centre[at];
        }
    }
    /// The 2^D samples around the point: f(first of a pair along x, weight along x, ...) in the order of sample().
    template <class Combine>
    real along(const Grid<real, D>& u, int a, Combine&& combine) const {
        std::array<real, D> f;
        const real* at = u.data();
        for (int d = 0; d < D; ++d) {
            const auto i = static_cast<std::size_t>(d);
            f[i] = d == a ? face_part[i] : centre_part[i];
            at += (d == a ? face[i] : centre[i]) * u.stride(d);
        }
        const std::ptrdiff_t sy = u.stride(1);
        const auto plane = [&](const real* q) { return combine(combine(q[0], q[1], f[0]), combine(q[sy], q[sy + 1], f[0]), f[1]); };
        if constexpr (D == 2) {
            return plane(at);
        } else {
            return combine(plane(at), plane(at + u.stride(2)), f[2]);
        }
    }
    real value(const Grid<real, D>& u, int a) const {
        return along(u, a, [](real lower, real upper, real f) { return lower + f * (upper - lower); });
    }
    real least(const Grid<real, D>& u, int a) const {
        return along(u, a, [](real lower, real upper, real) { return std::min(lower, upper); });
    }
    real most(const Grid<real, D>& u, int a) const {
        return along(u, a, [](real lower, real upper, real) { return std::max(lower, upper); });
    }
};

}  // namespace

/// As sample() of frame.hpp anywhere; fast where all samples around the point are inside the domain.
template <int D>
real Transport<D>::at_point(const Grid<real, D>& u, int a, const Vec<D>& s) const {
    const Inside<D> inside(frame_, s);
    return inside.all ? inside.value(u, a) : sample(u, a, stencil(s));
}

template <int D>
Stencil<D> Transport<D>::stencil(const Vec<D>& s) const {
    Vec<D> x;
    for (int d = 0; d < D; ++d) x[d] = frame_.origin[d] + s[d] * frame_.h[d];
    return Stencil<D>(frame_, frame_.wrap(x));
}

/// Where a point at s [cells], at which the velocity is `here` [cells/s], is dt later: the midpoint rule.
template <int D>
Vec<D> Transport<D>::moved(const Vec<D>& s, const Vec<D>& here, real dt) const {
    const Vec<D> middle = s + (0.5 * dt) * here;
    const Inside<D> inside(frame_, middle);
    Vec<D> k;
    if (inside.all) {
        for (int b = 0; b < D; ++b) k[b] = inside.value(before_[b], b) * frame_.inv_h[b];
    } else {
        const Stencil<D> around = stencil(middle);
        for (int b = 0; b < D; ++b) k[b] = sample(before_[b], b, around) * frame_.inv_h[b];
    }
    return s + dt * k;
}

template <int D>
Vec<D> Transport<D>::speed(const Vec<D>& s) const {
    Vec<D> k;
    for (int b = 0; b < D; ++b) k[b] = at_point(before_[b], b, s) * frame_.inv_h[b];
    return k;
}

/// The value from which s is reached in dt.
template <int D>
real Transport<D>::departed(int a, const Vec<D>& s, real dt) const {
    return at_point(before_[a], a, moved(s, speed(s), -dt));
}

/// û + (u − ũ)/2, û the prediction and ũ what it gives when it is carried back; no more and no less than the values around the point of
/// departure (Selle et al. 2008, section 4).
template <int D>
real Transport<D>::corrected(int a, const Vec<D>& s, real here, real dt) const {
    const Vec<D> k = speed(s), from = moved(s, k, -dt);
    const real back = at_point(predicted_[a], a, moved(s, k, dt));
    const Inside<D> inside(frame_, from);
    real value, low = infinity, high = -infinity;
    if (inside.all) {
        value = inside.value(before_[a], a), low = inside.least(before_[a], a), high = inside.most(before_[a], a);
    } else {
        const Stencil<D> around = stencil(from);
        for_each_sample(around, a, before_[a].extent(), [&](std::ptrdiff_t i, real) {
            const real u = before_[a][static_cast<std::size_t>(i)];
            low = std::min(low, u), high = std::max(high, u);
        });
        value = sample(before_[a], a, around);
    }
    return std::clamp(value + 0.5 * (here - back), low, high);
}

/// to = value(a, s, u(s)) on faces with φ < near beside them. Inside tall cells: at the Gauss points, by plain semi-Lagrangian advection,
/// and all rows share their change. Eight columns go up together, since what stands beside one another stands together in memory.
template <int D>
template <class Value>
void Transport<D>::for_faces(const TallPressure<D>& mesh, const Grid<real, D>& phi, const geometry::Sides<D>& sides, real dt, real near,
                             MacVelocity<D>& to, Value&& value) const {
    const Layout<D>& layout = mesh.layout();
    const int up = layout.up;
    const auto centre = [&](int a, const Index<D>& I) {
        Vec<D> s;
        for (int d = 0; d < D; ++d) s[d] = I[d] + (d == a ? 0.0 : 0.5);
        return s;
    };
    const auto tall = [&](int a, Index<D> I, const Run& run) {
        I[up] = run.row;
        Vec<D> s = centre(a, I);
        const real bottom = s[up];
        const auto change = [&](real row) {
            s[up] = bottom + (row - run.row);
            return departed(a, s, dt) - at_point(before_[a], a, s);
        };
        const Pair both{change(run.middle() - run.spread()), change(run.middle() + run.spread())};
        const std::size_t first = to[a].linear(I), stride = static_cast<std::size_t>(to[a].stride(up));
        spread_rows(0, run.count, both, [&](int row, real by) {
            const std::size_t face = first + static_cast<std::size_t>(row) * stride;
            to[a][face] = before_[a][face] + by;
        });
    };
    const auto regular = [&](int a, Index<D> I, int row) {
        I[up] = row;
        if (std::min(phi(frame_.near(I, a, -1)), phi(frame_.near(I, a, 0))) < near) to[a](I) = value(a, centre(a, I), before_[a](I));
    };
    constexpr int together = 8;
    const int blocks = (layout.columns() + together - 1) / together;
    for (int a = 0; a < D; ++a) {
        const int first = a == up ? 1 : 0, last = a == up && sides.open(up, 1) ? layout.rows + 1 : layout.rows;
        parallel_for(0, blocks, [&](int block) {
            const int begin = block * together, end = std::min(layout.columns(), begin + together);
            std::array<typename TallPressure<D>::RunsUp, together> runs;
            for (int c = begin; c < end; ++c) runs[static_cast<std::size_t>(c - begin)] = mesh.runs_up(a, c);
            for (int row = first; row < last; ++row)
                for (int c = begin; c < end; ++c) {
                    auto& next = runs[static_cast<std::size_t>(c - begin)];
                    if (!next.any_faces()) continue;
                    if (!next.reaches(row))
                        regular(a, layout.foot(c), row);
                    else if (next.run().row == row)
                        tall(a, layout.foot(c), next.run());
                }
        });
    }
    sync_periodic(to, sides);
}

template class Transport<2>;
template class Transport<3>;

}  // namespace weir::tallcell
