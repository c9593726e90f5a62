#include "studies/poisson_problem.hpp"

#include "mac/grid/diagnostics.hpp"

#include <cmath>

namespace weir::studies {

const std::vector<ManufacturedProblem>& manufactured_problems() {
    static const auto q = [](real x) { return x * x / 2 - x * x * x / 3; };  // q' vanishes at 0 and 1, q'' = 1 − 2x
    static const std::vector<ManufacturedProblem> list{
        {"N1", 2, false, [](const real* x) { return -5 * pi * pi * std::cos(pi * x[0]) * std::cos(2 * pi * x[1]); }},
        {"N2", 2, false, [](const real* x) { return (1 - 2 * x[0]) * q(x[1]) + q(x[0]) * (1 - 2 * x[1]); }},
        {"N3", 3, false,
         [](const real* x) { return -14 * pi * pi * std::cos(2 * pi * x[0]) * std::cos(pi * x[1]) * std::cos(3 * pi * x[2]); }},
        {"D1", 2, true, [](const real* x) { return -10 * pi * pi * std::sin(pi * x[0]) * std::sin(3 * pi * x[1]); }},
        {"D2", 2, true,  // p = x(1 − x) y(1 − y) eˣ
         [](const real* x) { return std::exp(x[0]) * (-x[0] * (x[0] + 3) * x[1] * (1 - x[1]) - 2 * x[0] * (1 - x[0])); }}};
    return list;
}

template <int D>
PoissonProblemSolver<D>::PoissonProblemSolver(const scene::Scene& scene) {
    const Lattice<D> lattice(scene);
    lattice_ = MacVelocity<D>(replicated(lattice.cells), lattice.h, lattice.origin);
    p_ = rhs_ = Grid<real, D>(replicated(lattice.cells));
    const PoissonChoice choice(scene.root().table("scheme.poisson"));
    solver_ = poisson::make_solver<D>(choice.method, choice.options);
    const ManufacturedProblem* problem = nullptr;
    for (const auto& known : manufactured_problems())
        if (scene.text("problem") == known.name) problem = &known;
    if (problem->dim != D)
        scene.refuse("problem", std::string("problem ") + problem->name + " needs dim = " + std::to_string(problem->dim));

    matrix_.cells = Grid<poisson::Cell, D>(replicated(lattice.cells), poisson::Cell::fluid);
    for (int a = 0; a < D; ++a) {
        const real ratio = lattice.h[0] / lattice.h[a];
        matrix_.axis_weight[a] = ratio * ratio;
        if (!problem->dirichlet) continue;
        auto& weight = matrix_.weight[static_cast<std::size_t>(a)];
        weight = Grid<real, D>(replicated(lattice.cells + e<D>(a)), 1);
        for_each_cell(weight.extent(), [&](const Index<D>& I) {
            if (I[a] == 0 || I[a] == lattice.cells[a]) weight(I) = 2;  // p = 0 at half a cell from the centre
        });
    }
    const real scale = -lattice.h[0] * lattice.h[0];
    for_each_cell(replicated(lattice.cells), [&](const Index<D>& I) { rhs_(I) = scale * problem->f(lattice_.cell_centre(I).data()); });
    solver_->setup(matrix_);
}

template <int D>
StepReport PoissonProblemSolver<D>::step(real dt) {
    const auto timed = passes_.time("project");
    p_.fill(0);
    const auto& report = solver_->solve(p_, rhs_);
    time_ += dt;
    return {.dt = dt,
            .iterations = report.iterations,
            .residual_before = report.residual_before,
            .residual_after = report.residual_after,
            .residual_max = report.residual_max / (lattice_.h[0] * lattice_.h[0])};
}

template <int D>
FieldSet PoissonProblemSolver<D>::fields() const {
    FieldSet set;
    set.grid = grid_view(lattice_);
    set.fields.push_back({"pressure", "Pa", Where::cell, "", {p_.values()}});
    return set;
}

template <int D>
void PoissonProblemSolver<D>::save(Checkpoint& to) const {
    to.put("p", p_.values());
    to.put_value("time", time_);
}

template <int D>
void PoissonProblemSolver<D>::restore(const Checkpoint& from) {
    from.get("p", p_.values());
    time_ = from.template get_value<real>("time");
}

template class PoissonProblemSolver<2>;
template class PoissonProblemSolver<3>;

}  // namespace weir::studies
