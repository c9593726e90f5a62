// Transport of what tall cells carry: a stream through their ends brings in what is beyond them.
#include "tallcell/transport.hpp"

#include "support.hpp"

namespace weir::test::transport_tests {
namespace {

/// Deep water, level, whose columns all have elements of 2, 4, 8, 16, 3, 1 rows above one another.
template <int D>
struct Stack {
    Basin<D> basin;
    TallPressure<D> mesh;
    Stack() : basin(D == 2 ? Index<D>{20, 60} : cells_in_3d(), 0, 0.8, 0), mesh(basin.frame, 1, {}) {
        mesh.set_surface(basin.phi, basin.closed, basin.state, [](const Layout<D>& layout, const auto&, Knots& knots) {
            knots = Knots{};
            knots.start = PlaneStore<int>(nullptr, 0, static_cast<std::size_t>(layout.n[0]), layout.n[1] + 1, 0, 0);
            for (int c = 0; c < layout.columns(); ++c) {
                int row = 0;
                for (const int length : {2, 4, 8, 16, 3, 1, 0}) knots.row.push_back(row), knots.length.push_back(length), row += length;
                knots.start[static_cast<std::size_t>(c) + 1] = knots.count();
            }
        });
    }
    static Index<D> cells_in_3d() {
        Index<D> cells = Index<D>::constant(4);
        cells[0] = 20, cells[1] = 60;
        return cells;
    }
    /// f(index among the axis's, run, foot of the column) of all runs of an axis that have faces.
    template <class F>
    void for_each_run(int a, F&& f) const {
        for (int c = 0; c < mesh.layout().columns(); ++c) {
            auto runs = mesh.runs_up(a, c);
            if (!runs.any_faces()) continue;
            for (; runs.ahead(); runs.reaches(runs.run().row + runs.run().count)) f(runs.index(), runs.run(), mesh.layout().foot(c));
        }
    }
    /// Every component linear in each run, any from run to run, alike in all columns; `stream` of the vertical one is their mean.
    void layer(real stream, real shear) {
        for (int a = 0; a < D; ++a) {
            std::array<real, 64> of_row{};
            of_row.fill(a == 1 ? stream : 0);
            auto runs = mesh.runs_up(a, 1 + mesh.layout().n[0] * (D - 2));
            for (; runs.ahead(); runs.reaches(runs.run().row + runs.run().count)) {
                const real swing = a == 1 ? shear : 1, mean = a == 1 ? stream : 0;
                const Pair ends{mean + basin.uniform(-swing, swing), mean + basin.uniform(-swing, swing)};
                spread_rows(runs.run().row, runs.run().count, ends, [&](int row, real u) { of_row[static_cast<std::size_t>(row)] = u; });
            }
            for_each_cell(basin.state.u[a].extent(),
                          [&](const Index<D>& I) { basin.state.u[a](I) = of_row[static_cast<std::size_t>(I[1])]; });
        }
    }
};

/// Largest difference between the changes of runs, over ends of runs in water, and the moments of what rows change by when each is traced.
template <int D>
real largest_error(Stack<D>& stack, real dt) {
    const MacVelocity<D> u = stack.basin.state.u;
    real fastest = 0;
    for (int a = 0; a < D; ++a)
        for (const real v : u[a].values()) fastest = std::max(fastest, std::abs(v) / stack.basin.frame.h[a]);
    Transport<D> transport(stack.basin.frame, u, false, 3);
    transport(stack.mesh, stack.basin.phi, stack.basin.state.sides, dt, fastest, stack.basin.state.u);
    real error = 0;
    const Vec<D> h = stack.basin.frame.h;
    for (int a = 0; a < D; ++a)
        stack.for_each_run(a, [&](std::size_t index, const Run& run, Index<D> I) {
            if (run.row <= 1) return;  // walls, through which this stream would come
            const Pair by = moments(run.row, run.count, [&](int row) {
                const auto at_height = [&](int b, real y) {  // of component b, in rows of its own
                    Index<D> J = I;
                    J[1] = static_cast<int>(std::floor(y));
                    const real f = y - std::floor(y), here = u[b](J);
                    J[1] += 1;
                    return here + f * (u[b](J) - here);
                };
                const real v = a == 1 ? at_height(1, row) : at_height(1, row + 0.5);
                return at_height(a, row - dt * v / h[1]) - at_height(a, row);
            });
            const Pair& found = transport.changes()[static_cast<std::size_t>(a)][index];
            error = std::max({error, std::abs(found.minus - by.minus), std::abs(found.plus - by.plus)});
        });
    return error;
}

TEST_IN_2D_AND_3D("a stream through the ends of tall cells changes their moments as it changes those of their rows") {
    Stack<D> stack;
    for (const real stream : {1.0, -1.0, 0.0})
        for (const real steps : {0.3, 0.9, 1.6}) {  // cells that the stream moves by
            stack.layer(stream, stream == 0 ? 1 : 0);
            const real dt = steps * stack.basin.frame.h[1] / 1.0;
            if (stream == 0 && steps > 1) continue;
            // Between the rows that others reach, changes are of degree 2 in height: sums over Gauss points are exact. Round-off of sums of
            // 16 values of 1.
            EXPECT_LT(largest_error(stack, dt), 1e-13) << "stream " << stream << ", " << steps << " cells a step";
        }
}

/// u = B (x - x_m), exactly what interpolation sees of it inside the domain.
template <int D>
struct Turn {
    std::array<Vec<D>, D> rows;
    Vec<D> middle;
    real h;

    Vec<D> at(const Vec<D>& x) const {
        Vec<D> u;
        for (int a = 0; a < D; ++a) u[a] = dot(rows[static_cast<std::size_t>(a)], x - middle);
        return u;
    }
    /// The midpoint rule.
    Vec<D> moved(const Vec<D>& x, real dt) const { return x + dt * at(x + 0.5 * dt * at(x)); }
    real carried(int a, const Vec<D>& x, real dt) const { return at(moved(x, -dt))[a]; }
    /// û + (u - ũ)/2 within the samples around the point of departure.
    real corrected(int a, const Vec<D>& x, real dt) const {
        const Vec<D> from = moved(x, -dt);
        Vec<D> lower;
        for (int d = 0; d < D; ++d) {
            const real shift = d == a ? 0 : 0.5;
            lower[d] = h * (std::floor(from[d] / h - shift) + shift);
        }
        real low = at(lower)[a], high = low;
        for (int d = 0; d < D; ++d) {
            const real more = rows[static_cast<std::size_t>(a)][d] * h;
            low += std::min(more, 0.0), high += std::max(more, 0.0);
        }
        return std::clamp(at(from)[a] + 0.5 * (at(x)[a] - carried(a, moved(x, dt), dt)), low, high);
    }
};

// Interpolation has a velocity that is linear in space exactly, so that both schemes give what the midpoint rule does to it, to round-off.
// Euler's trace is off by half the square of the turn; the correction is an eighth of its fourth power. Twenty columns: eight and
// eight beside one another, which move together, and four that move one by one.
TEST_IN_2D_AND_3D("a velocity that is linear in space is carried along by the midpoint rule, and corrected by half of what comes back") {
    Index<D> cells = Index<D>::constant(12);
    cells[0] = 20, cells[1] = 24;
    constexpr real h = 0.25, dt = 0.1;
    for (const bool maccormack : {false, true}) {
        Basin<D> basin(cells, 0, 0.8, 0);
        TallPressure<D> mesh(basin.frame, 1, {});
        mesh.set_surface(basin.phi, basin.closed, basin.state, any_knots(basin, 1));
        Turn<D> turn{{}, {}, h};
        for (int a = 0; a < D; ++a) turn.middle[a] = 0.5 * h * cells[a] + 0.03 * a;
        turn.rows[0][1] = -0.7, turn.rows[1][0] = 0.7, turn.rows[0][0] = 0.2;
        if constexpr (D == 3) turn.rows[1][2] = 0.3, turn.rows[2][1] = -0.3;
        auto& u = basin.state.u;
        real fastest = 0;
        for (int a = 0; a < D; ++a)
            for_each_cell(u[a].extent(), [&](const Index<D>& I) {
                u[a](I) = turn.at(u.face_centre(a, I))[a];
                fastest = std::max(fastest, std::abs(u[a](I)) / h);
            });
        const MacVelocity<D> places = u;
        Transport<D> transport(basin.frame, u, maccormack, 3);
        transport(mesh, basin.phi, basin.state.sides, dt, fastest, u);
        int looked_at = 0;
        for (int a = 0; a < D; ++a)
            for_each_cell(u[a].extent(), [&](const Index<D>& I) {
                for (int d = 0; d < D; ++d)  // neither what is beside walls nor what is beside the surface, 19 rows up
                    if (I[d] < 3 || I[d] >= (d == 1 ? 16 : cells[d] - 2)) return;
                const Vec<D> x = places.face_centre(a, I);
                const real expected = maccormack ? turn.corrected(a, x, dt) : turn.carried(a, x, dt);
                ASSERT_NEAR(u[a](I), expected, 1e-13) << a << ' ' << I[0] << ' ' << I[1] << (maccormack ? ", corrected" : "");
                ++looked_at;
            });
        EXPECT_GT(looked_at, 300);
    }
}

TEST_IN_2D_AND_3D("water at rest on tall cells changes by nothing") {
    Stack<D> stack;
    stack.layer(0, 0);
    for (int a = 0; a < D; ++a) stack.basin.state.u[a].fill(0);
    EXPECT_EQ(largest_error(stack, 0.1), 0);
}

}  // namespace
}  // namespace weir::test::transport_tests
