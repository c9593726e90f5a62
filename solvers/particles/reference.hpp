// The plain double-precision path: every pair of particles, no neighbour list, no vectors. It compiles the same text of the pair physics
// as the fast path and defines what is right.
#pragma once
#include "particles/passes.hpp"

#include <array>
#include <vector>

namespace weir::particles {

using Point = std::array<double, 3>;

/// The pair physics of PBF for one kernel (0: Müller's, 1: cubic, 2: Wendland), over all pairs.
struct ReferencePbf {
    plain::PbfParams p{};
    plain::WallParams walls{};
    int kernel = 0;
    Point period{0, 0, 0};     // of axes that repeat, at least two supports; 0: the axis does not
    std::vector<Point> solid;  // gradient of the part inside solids at each particle; empty: no solids
    std::vector<double> solid_part;
    std::vector<std::vector<std::size_t>> neighbours;

    /// Lines 5-7 of algorithm 1: all pairs closer than the support at the predicted positions; kept through the iterations.
    void find_neighbours(const std::vector<Point>& x);

    std::vector<double> densities(const std::vector<Point>& x) const;
    /// What this iteration adds to lambda. multiplier: the sums so far, updated; nullptr: every iteration starts from none.
    std::vector<double> lambdas(const std::vector<Point>& x, std::vector<double>* multiplier = nullptr) const;
    /// x + correction, kept inside the walls.
    std::vector<Point> corrected(const std::vector<Point>& x, const std::vector<double>& lambda) const;
};

/// The pair physics of SPH over all pairs.
struct ReferenceSph {
    plain::SphParams p{};
    plain::WallParams walls{};
    int kernel = 0;
    Point period{0, 0, 0};
    std::vector<Point> solid;  // as for PBF
    std::vector<double> solid_part;
    bool summed = true;  // density by summation: pairs push by the gradient of its energy

    std::vector<double> densities(const std::vector<Point>& x) const;
    /// d rho / dt by continuity and diffusion.
    std::vector<double> rates(const std::vector<Point>& x, const std::vector<Point>& v, const std::vector<double>& rho, double rho0) const;
    /// By surface tension.
    std::vector<Point> tensions(const std::vector<Point>& x, const std::vector<double>& rho) const;
    std::vector<Point> accelerations(const std::vector<Point>& x, const std::vector<Point>& v, const std::vector<double>& rho,
                                     const std::vector<double>& pressure) const;
};

}  // namespace weir::particles
