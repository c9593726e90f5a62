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
        for_faces(mesh, phi, sides, 2 * h, u, [&](int a, const Vec<D>& x, real) { return departed(a, x, dt); });
        return;
    }
    copy(predicted_);
    for_faces(mesh, phi, sides, (reach_ + 2) * h, predicted_, [&](int a, const Vec<D>& x, real) { return departed(a, x, dt); });
    sync_periodic(predicted_, sides);
    for_faces(mesh, phi, sides, 2 * h, u, [&](int a, const Vec<D>& x, real here) { return corrected(a, x, here, dt); });
}

/// The value from which x is reached in dt.
template <int D>
real Transport<D>::departed(int a, const Vec<D>& x, real dt) const {
    const Vec<D> from = trace(before_, frame_, x, -dt, Trace::rk2);
    return sample(before_[a], a, Stencil<D>(frame_, frame_.wrap(from)));
}

/// û + (u − ũ)/2, û the prediction and ũ what it gives when it is carried back; no more and no less than the values around the point of
/// departure (Selle et al. 2008, section 4).
template <int D>
real Transport<D>::corrected(int a, const Vec<D>& x, real here, real dt) const {
    const Stencil<D> from(frame_, frame_.wrap(trace(before_, frame_, x, -dt, Trace::rk2)));
    const Stencil<D> to(frame_, frame_.wrap(trace(before_, frame_, x, dt, Trace::rk2)));
    real low = infinity, high = -infinity;
    for_each_sample(from, a, before_[a].extent(), [&](std::ptrdiff_t i, real) {
        const real u = before_[a][static_cast<std::size_t>(i)];
        low = std::min(low, u), high = std::max(high, u);
    });
    return std::clamp(sample(before_[a], a, from) + 0.5 * (here - sample(predicted_[a], a, to)), low, high);
}

/// to = value(a, x, u(x)) on faces with φ < near beside them; inside tall cells at the Gauss points, whose change all rows share.
template <int D>
template <class Value>
void Transport<D>::for_faces(const TallPressure<D>& mesh, const Grid<real, D>& phi, const geometry::Sides<D>& sides, real near,
                             MacVelocity<D>& to, Value&& value) const {
    const Layout<D>& layout = mesh.layout();
    const int up = layout.up;
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    const auto tall = [&](int a, const Index<D>& foot, const Run& run) {
        Index<D> I = foot;
        I[up] = run.row;
        Vec<D> x = before_.face_centre(a, I);
        const real bottom = x[up];
        const auto change = [&](real row) {
            x[up] = bottom + (row - run.row) * frame_.h[up];
            const real here = sample(before_[a], a, Stencil<D>(frame_, frame_.wrap(x)));
            return value(a, x, here) - here;
        };
        const Pair both{change(run.middle() - run.spread()), change(run.middle() + run.spread())};
        spread_rows(run.row, run.count, both, [&](int row, real by) {
            I[up] = row;
            to[a](I) = before_[a](I) + by;
        });
    };
    const auto regular = [&](int a, Index<D> I, int row) {
        I[up] = row;
        if (std::min(phi(frame_.near(I, a, -1)), phi(frame_.near(I, a, 0))) < near)
            to[a](I) = value(a, before_.face_centre(a, I), before_[a](I));
    };
    for (int h = 0; h < D - 1; ++h) {
        const int a = layout.axes[at(h)];
        parallel_for(0, layout.columns(), [&](int c) {
            if (layout.lower(c, h) < 0) return;
            const Index<D> foot = layout.foot(c);
            int row = 0;
            for (const Run& run : mesh.runs(h, c)) {
                for (; row < run.row; ++row) regular(a, foot, row);
                tall(a, foot, run);
                row = run.row + run.count;
            }
            for (; row < layout.rows; ++row) regular(a, foot, row);
        });
    }
    const Knots& knots = mesh.knots();
    parallel_for(0, layout.columns(), [&](int c) {
        const Index<D> foot = layout.foot(c);
        const int last = sides.open(up, 1) ? layout.rows + 1 : layout.rows;
        int row = 1;
        for (int i = knots.start[at(c)]; i < knots.start[at(c) + 1]; ++i) {
            if (knots.length[at(i)] < 2) continue;
            const Run run{knots.row[at(i)] + 1, knots.length[at(i)], 0, 0};
            for (; row < run.row; ++row) regular(up, foot, row);
            tall(up, foot, run);
            row = run.row + run.count;
        }
        for (; row < last; ++row) regular(up, foot, row);
    });
    sync_periodic(to, sides);
}

template class Transport<2>;
template class Transport<3>;

}  // namespace weir::tallcell
