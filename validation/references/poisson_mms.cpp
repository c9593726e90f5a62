#include "validation/references/poisson_mms.hpp"

#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

namespace weir::validation {
namespace {

using X = Vec<3>;

real q(real x) { return x * x / 2 - x * x * x / 3; }  // q' = 0 at 0 and 1
real q2(real x) { return 1 - 2 * x; }                 // q''

real n1(const X& x) { return std::cos(pi * x[0]) * std::cos(2 * pi * x[1]); }
real n1_f(const X& x) { return -5 * pi * pi * n1(x); }
real n2(const X& x) { return q(x[0]) * q(x[1]); }
real n2_f(const X& x) { return q2(x[0]) * q(x[1]) + q(x[0]) * q2(x[1]); }
real n3(const X& x) { return std::cos(2 * pi * x[0]) * std::cos(pi * x[1]) * std::cos(3 * pi * x[2]); }
real n3_f(const X& x) { return -14 * pi * pi * n3(x); }
real d1(const X& x) { return std::sin(pi * x[0]) * std::sin(3 * pi * x[1]); }
real d1_f(const X& x) { return -10 * pi * pi * d1(x); }
real d2(const X& x) { return x[0] * (1 - x[0]) * x[1] * (1 - x[1]) * std::exp(x[0]); }
real d2_f(const X& x) {
    const real y = x[1] * (1 - x[1]);
    return (-x[0] * (x[0] + 3) * y - 2 * x[0] * (1 - x[0])) * std::exp(x[0]);  // (x(1-x)e^x)'' = -x(x+3)e^x
}

}  // namespace

const std::vector<PoissonProblem>& poisson_problems() {
    static const std::vector<PoissonProblem> all = {
        {"N1", "N1_2D_cos(pi x)cos(2pi y)", 2, false, n1, n1_f},
        {"N2", "N2_2D_poly", 2, false, n2, n2_f},
        {"N3", "N3_3D_cos(2pi x)cos(pi y)cos(3pi z)", 3, false, n3, n3_f},
        {"D1", "D1_2D_sin(pi x)sin(3pi y)", 2, true, d1, d1_f},
        {"D2", "D2_2D_x(1-x)y(1-y)exp(x)", 2, true, d2, d2_f},
    };
    return all;
}

const PoissonProblem& poisson_problem(const std::string& name) {
    for (const auto& problem : poisson_problems())
        if (problem.name == name) return problem;
    throw BadInput("unknown manufactured Poisson problem \"" + name + "\"; known: N1, N2, N3, D1, D2");
}

}  // namespace weir::validation

using namespace weir;
using namespace weir::validation;

// The table's rows for this problem are numbers "rms.<N>" and "max.<N>": errors of the exactly solved difference equations.
REFERENCE(poisson_mms) {
    const PoissonProblem& problem = poisson_problem(scene.text("problem"));
    Reference ref{.source = "manufactured; discrete errors by direct transform (cases/poisson_mms/data)"};
    ref.scalars["pressure"] = [p = problem.p](const Vec<3>& x, real) { return p(x); };
    if (!problem.dirichlet) ref.up_to_a_constant = {"pressure"};
    const Table table = read_table(data / "poisson_mms_discrete_errors.csv").where("case", problem.table);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        ref.numbers["rms." + table.text(i, "N")] = table.number(i, "rms_error");
        ref.numbers["max." + table.text(i, "N")] = table.number(i, "max_error");
    }
    return ref;
}
