// The pressure equation on fluid cells of any geometry, with solvers selected by name.
//
//     (A p)(I) = Σ_faces w_f (p(I) − p(N)) = b(I)      for each fluid cell I; N is its neighbour across face f
//
// w_f ≥ 0 is the face weight (fraction open to flow × anisotropy; θ⁻¹ at a ghost-fluid surface, Gibou et al. 2002; Batty et al. 2007).
// A neighbour in air, or beyond a side of the domain whose face weight is not zero, is p = 0; a neighbour that is solid has w_f = 0.
// h² is scaled out: b = −h² ∇·u ρ/dt for a projection. Connected components without any air neighbour are singular: each gets a
// compatible right-hand side (its mean removed) and a zero-mean solution.
#pragma once
#include "core/types.hpp"
#include "parallel/grid.hpp"
#include "poisson/matrix/low_rank.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace weir::poisson {

enum class Cell : std::uint8_t { solid = 0, fluid = 1, air = 2 };

/// The matrix, as data. Faces between two non-fluid cells are ignored; faces of solid cells are closed for any weight.
template <int D>
struct Operator {
    Grid<Cell, D> cells;
    /// weight[a] has cells.extent() + e<D>(a) entries; entry I is the face on the lower side of cell I along a. All D empty: every face
    /// between non-solid cells has axis_weight[a], and domain sides are closed (the fast path, which uses flags only).
    std::array<Grid<real, D>, D> weight;
    /// Multiplies every face weight along an axis: (h/h_a)² for anisotropic cells.
    Vec<D> axis_weight = Vec<D>::constant(1);
    /// 1 in cells of the lighter of two phases, whose face weights are larger by the ratio of the densities; empty: one phase. The matrix
    /// does not depend on it: multigrid chooses its coarse unknowns by it.
    Grid<std::uint8_t, D> light;
    /// The first and the last cell along a periodic axis are neighbours; the face between them is entry 0 (entry n is ignored).
    std::array<bool, D> periodic{};
};

/// The result of a solve.
struct Report {
    int iterations = 0;
    bool converged = false;
    real residual_before = 0;  // ‖b − A p₀‖₂ / ‖b‖₂ with the compatible b; p₀ is the guess, or zero where its residual is smaller
    real residual_after = 0;    // the same for the solution, recomputed in double precision
    real residual_max = 0;      // ‖b − A p‖_∞, absolute
    std::vector<real> history;  // relative residual after each iteration, as computed by it; empty unless requested
    double setup_seconds = 0;   // of the last setup()
    double solve_seconds = 0;
    std::size_t bytes = 0;  // of the solver after setup, without the caller's p, b and Operator
    int components = 0;     // closed (singular) components of fluid
};

struct Options {
    real tolerance = 1e-8;  // on ‖b − A p‖₂ / ‖b‖₂
    int max_iterations = 1000;
    bool fixed_iterations = false;  // run exactly max_iterations and accept the result (as games do)
    bool record_history = false;
};

/// One method. Usage: setup() when cells or weights changed, then solve() any number of times.
template <int D>
class Solver {
public:
    virtual ~Solver() = default;
    virtual void setup(const Operator<D>& A) = 0;
    /// Solves A p = b. On entry p is the initial guess, which is replaced by zero if its residual is larger. Cells that are not fluid are
    /// set to 0, and b is not read there. Throws NumericalFailure("pressure", ...) when the tolerance is missed after max_iterations
    /// (unless fixed_iterations) or when the residual is not finite. The reference stays valid until the next call; after the first, a
    /// solve with an unchanged structure allocates nothing.
    virtual const Report& solve(Grid<real, D>& p, const Grid<real, D>& b) = 0;
    /// Solves (A + Σ U C Uᵀ) p = b by the iterations for A, each slightly more expensive; b is restored afterwards. nullptr: this method or
    /// problem is not supported, or did not converge; p is then a guess.
    virtual const Report* solve(Grid<real, D>&, Grid<real, D>&, const LowRank&) { return nullptr; }
    /// Sets the relative residual at which later solves may stop. Methods without a tolerance ignore it.
    virtual void set_tolerance(real) {}
    virtual std::size_t bytes() const = 0;
    /// In parallel (parallel/communicator.hpp): returns whether solve() works on each rank's own planes of b and p. Otherwise it requires
    /// them whole, on all ranks.
    virtual bool shares_planes() const { return false; }
};

/// A method of the registry: its makers, and what callers decide by.
struct Method {
    std::string name;
    std::string doc;
    std::unique_ptr<Solver<2>> (*make_2d)(const Options&);
    std::unique_ptr<Solver<3>> (*make_3d)(const Options&);
    bool iterative = true;            // its error can be studied against its iteration count
    bool whole_box_only = false;      // requires every cell fluid, uniform weights and closed sides (dct)
    bool needs_petsc = false;         // see has_petsc()
    bool distributed_levels = false;  // in parallel (MPI) ranks share the planes of its levels: see multigrid_shares()
};

/// multigrid, cg_mic0, cg_jacobi, cg, eigen_iccg, cholmod, red_black, jacobi, dct, and PETSc's petsc_gamg, petsc_boomeramg, petsc_icc:
/// always in this order, for any build of weir.
const std::vector<Method>& methods();
/// Throws BadInput for an unknown name, listing the known ones.
const Method& method_named(std::string_view name);
/// Returns whether PETSc's methods are available. Loads its library at the first call.
bool has_petsc();

/// Throws BadInput for an unknown name, listing the known ones, and for PETSc's methods where weir was built without it.
template <int D>
std::unique_ptr<Solver<D>> make_solver(std::string_view method, const Options& options);

/// In parallel: returns whether "multigrid" distributes the planes of such a grid with this partition, for any cell flags.
template <int D>
bool multigrid_shares(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, const Partition& cut);
/// The same for an operator's grids: whether solve() of the method works on each rank's own planes. Otherwise A, p and b must be whole.
template <int D>
bool shares_planes(const Method& method, const Operator<D>& A) {
    const OwnPlanes& own = A.cells.own();
    return method.distributed_levels && own.distributed() &&
           multigrid_shares<D>(A.cells.extent(), A.periodic, A.axis_weight, own.partition());
}

/// r = b − A p in double precision on fluid cells, zero elsewhere; b is used without removing its mean.
template <int D>
void residual(const Operator<D>& A, const Grid<real, D>& p, const Grid<real, D>& b, Grid<real, D>& r);

}  // namespace weir::poisson
