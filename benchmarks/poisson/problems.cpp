#include "problems.hpp"

#include "core/error.hpp"
#include "phase_shapes.hpp"
#include "poisson/matrix/system.hpp"
#include "poisson_problem.hpp"

#include <cmath>

namespace weir::bench {

namespace {

using poisson::Cell;

/// A number in [0, 1) that depends on nothing but its arguments.
real random01(std::uint64_t i, std::uint64_t salt) { return (1 + ::bench::hash11(i * 1000003 + salt)) / 2; }

template <int D, class F>
void set_inner_weights(poisson::Operator<D>& A, F&& weight) {
    for (int a = 0; a < D; ++a) {
        auto& w = A.weight[static_cast<std::size_t>(a)];
        w = Grid<real, D>(A.cells.extent() + e<D>(a), 0);
        for_each_cell<D>(w.extent(), [&](const Index<D>& I) {
            if (I[a] > 0 && I[a] < A.cells.extent()[a]) w(I) = weight(I, a, w.linear(I));
        });
    }
}

/// Walls one cell thick around rooms of 37 x 29 (x 23) cells, which fit no power of two; with slits, a one-cell gap in each wall.
template <int D>
void build_rooms(poisson::Operator<D>& A, bool slits) {
    const std::array<int, 3> room = D == 2 ? std::array<int, 3>{37, 29, 1} : std::array<int, 3>{13, 11, 17};
    for_each_cell<D>(A.cells.extent(), [&](const Index<D>& I) {
        int walls = 0;
        bool in_gap = true;
        for (int a = 0; a < D; ++a) {
            const int size = room[static_cast<std::size_t>(a)];
            if (I[a] % size == size - 1)
                ++walls;
            else
                in_gap = in_gap && I[a] % size == size / 2;
        }
        if (walls > 0 && !(slits && walls == 1 && in_gap)) A.cells(I) = Cell::solid;
    });
}

/// A third of all blocks of 5 x 5 (x 5) cells solid.
template <int D>
void build_blocks(poisson::Operator<D>& A) {
    for_each_cell<D>(A.cells.extent(), [&](const Index<D>& I) {
        std::uint64_t block = 0;
        for (int a = D - 1; a >= 0; --a) block = block * 4096 + static_cast<std::uint64_t>(I[a] / 5);
        if (random01(block, 17) < 1.0 / 3) A.cells(I) = Cell::solid;
    });
}

/// Face fractions in bands: contrast 50 over a few cells, smooth elsewhere.
template <int D>
real banded_fraction(const Index<D>& I, int a, int n) {
    real s = 1;
    for (int d = 0; d < D; ++d) s *= std::sin(2 * pi * (3 + d) * (I[d] + 0.5 * (d != a)) / n + a);
    return std::clamp(0.6 + 1.2 * s, 0.02, 1.0);
}

/// Distance [cells] to the nearest of a lattice of round solids of many sizes; negative inside.
template <int D>
real distance_to_solids(const Vec<D>& x, int n) {
    real nearest = infinity;
    const real spacing = n / 4.0;
    for (int corner = 0; corner < 1 << D; ++corner) {
        Vec<D> away;
        std::uint64_t seed = 0;
        for (int a = 0; a < D; ++a) {
            const real cell = std::floor(x[a] / spacing) + (corner >> a & 1);
            seed = seed * 64 + static_cast<std::uint64_t>(cell);
            away[a] = x[a] - cell * spacing - 0.31 * a;
        }
        nearest = std::min(nearest, norm(away) - spacing * (0.1 + 0.3 * random01(seed, 5)));
    }
    return nearest;
}

/// Open fractions of faces cut by round solids (Batty et al. 2007), as a scene with smooth obstacles has them.
template <int D>
void cut_by_solids(poisson::Operator<D>& A) {
    const int n = A.cells.extent()[0];
    const auto at = [&](const Index<D>& I, int a) {
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = I[d] + (d == a ? 0.0 : 0.5);
        return distance_to_solids<D>(x, n);
    };
    set_inner_weights(A, [&](const Index<D>& I, int a, std::size_t) { return std::clamp(0.5 + at(I, a), 0.0, 1.0); });
    for_each_cell<D>(A.cells.extent(), [&](const Index<D>& I) {
        if (at(I, -1) < -1 && A.cells(I) == Cell::fluid) A.cells(I) = Cell::solid;
    });
}

}  // namespace

template <int D>
Problem<D> make(const std::string& name, int n, real ratio) {
    const bool wavy = name.starts_with("wavy");
    const ::bench::PoissonProblem source = ::bench::make_problem(wavy, D, n);
    Problem<D> problem;
    auto& A = problem.A;
    A.cells = Grid<Cell, D>(replicated(Index<D>::constant(n)));
    for (std::size_t i = 0; i < A.cells.size(); ++i) A.cells[i] = source.fluid[i] ? Cell::fluid : Cell::air;
    problem.b = Grid<real, D>(A.cells.extent());
    std::copy(source.b.begin(), source.b.end(), problem.b.data());
    if (const auto part = liquid_parts<D>(name, n); !part.empty())
        A = two_phase_operator(part, ratio);
    else if (name == "rooms" || name == "slits")
        build_rooms(A, name == "slits");
    else if (name == "blocks")
        build_blocks(A);
    else if (name == "fractions")
        set_inner_weights(
            A, [&](const Index<D>&, int a, std::size_t i) { return std::max(1e-4, random01(i, static_cast<std::uint64_t>(a))); });
    else if (name == "magnitudes")
        set_inner_weights(
            A, [&](const Index<D>&, int a, std::size_t i) { return std::pow(10, -4 * random01(i, static_cast<std::uint64_t>(a))); });
    else if (name == "box_weights" || name == "wavy_weights")
        cut_by_solids(A);
    else if (name == "bands")
        set_inner_weights(A, [&](const Index<D>& I, int a, std::size_t) { return banded_fraction(I, a, n); });
    else if (name != "box" && name != "wavy")
        throw BadInput(
            "unknown case \"" + name +
            "\"; known: box, wavy, box_weights, wavy_weights, rooms, slits, blocks, fractions, magnitudes, bands, "
            "uniform, wave, bubble, drop, dam, drops, bubbles, film, level_film, inclined_film, ring_film, and gas_ before a film");
    for (std::size_t i = 0; i < A.cells.size(); ++i) {
        if (A.cells[i] != Cell::fluid) problem.b[i] = 0;
        problem.unknowns += A.cells[i] == Cell::fluid;
    }
    poisson::System<D> system;  // a compatible right-hand side for every program
    system.build(A);
    poisson::Vector b(system.cell.size());
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = problem.b[static_cast<std::size_t>(system.cell[i])];
    system.components.remove_means(b);
    for (std::size_t i = 0; i < b.size(); ++i) problem.b[static_cast<std::size_t>(system.cell[i])] = b[i];
    return problem;
}

template <int D>
real true_residual(const Problem<D>& problem, const Grid<real, D>& p) {
    Grid<real, D> r;
    poisson::residual(problem.A, p, problem.b, r);
    const auto square = [](const Grid<real, D>& g) { return sum_over<D>(g.extent(), [&](const Index<D>& I) { return g(I) * g(I); }); };
    return std::sqrt(square(r) / square(problem.b));
}

template Problem<2> make<2>(const std::string&, int, real);
template Problem<3> make<3>(const std::string&, int, real);
template real true_residual<2>(const Problem<2>&, const Grid<real, 2>&);
template real true_residual<3>(const Problem<3>&, const Grid<real, 3>&);

}  // namespace weir::bench
