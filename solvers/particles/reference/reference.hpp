// The reference path in plain double precision: the neighbour search tests every pair of particles, without threads or vectors. It compiles
// the same text of the pair physics as the fast path and defines the correct result. Its steps are the backend "reference"
// (reference_solver.hpp); time grows with the square of the number of particles.
#pragma once
#include "particles/boundaries/bodies_in_liquid.hpp"
#include "particles/state/domain.hpp"

#include <array>
#include <string>
#include <vector>

namespace weir::particles {

using Point = std::array<double, 3>;  // relative to the centre of the domain; the third is 0 in 2D
using Neighbours = std::vector<std::vector<std::size_t>>;

/// The inputs of both methods' pair physics: pairs, walls and solids.
struct ReferencePairs {
    plain::WallParams walls{};
    int kernel = 0;            // 0: Müller's, 1: cubic, 2: Wendland
    Point period{0, 0, 0};     // of periodic axes, at least two supports; 0: the axis is not periodic
    std::vector<Point> solid;  // gradient of the part inside solids at each particle; empty: no solids
    std::vector<double> solid_part;
    std::vector<double> rest;  // rest densities over rho0; empty: 1
    Neighbours neighbours;

    /// Rates of specific enthalpy by conduction, and the part due to walls of fixed temperature.
    struct Warming {
        std::vector<double> rate, by_walls;
    };
    Warming warming(const std::vector<Point>& x, const std::vector<double>& theta, const plain::HeatParams& p,
                    const plain::HeatWalls& walls) const;
};

/// The pair physics of PBF over all pairs.
struct ReferencePbf : ReferencePairs {
    plain::PbfParams p{};
    double least_back = 0;

    /// Lines 5-7 of algorithm 1: all pairs closer than the support at the predicted positions; kept during the iterations.
    void find_neighbours(const std::vector<Point>& x);

    std::vector<double> densities(const std::vector<Point>& x) const;
    /// The increments of lambda in this iteration. multiplier: the sums so far, updated; nullptr: every iteration starts from zero.
    std::vector<double> lambdas(const std::vector<Point>& x, std::vector<double>* multiplier = nullptr) const;
    /// x + correction, kept inside the walls; corrections by walls of more than least_back are counted.
    std::vector<Point> corrected(const std::vector<Point>& x, const std::vector<double>& lambda,
                                 BoundaryCorrections* corrections = nullptr) const;
};

/// The pair physics of SPH over all pairs.
struct ReferenceSph : ReferencePairs {
    plain::SphParams p{};
    bool summed = true;  // density by summation: pair forces are the gradient of its energy

    /// Finds all pairs closer than the support, for the other functions.
    void find_neighbours(const std::vector<Point>& x);

    std::vector<double> densities(const std::vector<Point>& x) const;
    /// d rho / dt by continuity and diffusion.
    std::vector<double> rates(const std::vector<Point>& x, const std::vector<Point>& v, const std::vector<double>& rho, double rho0) const;
    /// Accelerations by surface tension.
    std::vector<Point> tensions(const std::vector<Point>& x, const std::vector<double>& rho) const;
    std::vector<Point> accelerations(const std::vector<Point>& x, const std::vector<Point>& v, const std::vector<double>& rho,
                                     const std::vector<double>& pressure) const;
};

template <int D>
Point point_of(const Vec<D>& v) {
    Point p{0, 0, 0};
    for (int a = 0; a < D; ++a) p[static_cast<std::size_t>(a)] = v[a];
    return p;
}
template <int D>
Vec<D> vec_of(const Point& p) {
    Vec<D> v;
    for (int a = 0; a < D; ++a) v[a] = p[static_cast<std::size_t>(a)];
    return v;
}
/// The terms of solids at each position (solid_terms.hpp); empty where the domain has none.
template <int D>
void add_solids(ReferencePairs& reference, const Domain<D>& domain, const std::vector<Point>& x);

/// Finds the coupling pairs of particles and bodies, after add_solids.
template <int D>
void meet_bodies(const ReferencePairs& reference, const Domain<D>& domain, const std::vector<Point>& x, std::vector<Meeting<D>>& to);

Pairs::NeighbourCounts counts_of(const Neighbours& neighbours);
std::size_t bytes_of(const Neighbours& neighbours);

}  // namespace weir::particles
