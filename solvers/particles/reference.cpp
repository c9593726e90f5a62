#include "particles/reference.hpp"

#include <algorithm>
#include <cmath>

namespace weir::particles {

namespace {

#define SCALAR double
#include "particles/kernels/prelude_double.h"
using plain::PbfParams;
using plain::WallParams;
#include "particles/kernels/pair.inl"

namespace muller {
#define WEIR_DENSITY(r2, p) poly6(r2, (p)->h2)
#define WEIR_SLOPE(r2, p) spiky_slope(r2, (p)->h, (p)->guard)
#include "particles/kernels/pbf_pair.inl"
#undef WEIR_DENSITY
#undef WEIR_SLOPE
}  // namespace muller
namespace spline {
#define WEIR_DENSITY(r2, p) cubic(r2, (p)->h, (p)->guard)
#define WEIR_SLOPE(r2, p) cubic_slope(r2, (p)->h, (p)->guard)
#include "particles/kernels/pbf_pair.inl"
#undef WEIR_DENSITY
#undef WEIR_SLOPE
}  // namespace spline
namespace c2 {
#define WEIR_DENSITY(r2, p) wendland(r2, (p)->h, (p)->guard)
#define WEIR_SLOPE(r2, p) wendland_slope(r2, (p)->h, (p)->guard)
#include "particles/kernels/pbf_pair.inl"
#undef WEIR_DENSITY
#undef WEIR_SLOPE
}  // namespace c2

struct Functions {
    double (*density)(double, const PbfParams*);
    double (*slope)(double, const PbfParams*);
    double (*correction)(double, double, const PbfParams*);
};
constexpr Functions functions[3] = {{muller::pbf_density, muller::pbf_slope, muller::pbf_correction_with_pressure},
                                    {spline::pbf_density, spline::pbf_slope, spline::pbf_correction_with_pressure},
                                    {c2::pbf_density, c2::pbf_slope, c2::pbf_correction_with_pressure}};

/// Walls and solids at one particle: gradient, then part.
std::array<double, 4> walls_at(const ReferencePbf& r, const Point& x, std::size_t i) {
    double part[3], pull[3], solid[4] = {0, 0, 0, 0}, out[4];
    for (int a = 0; a < 3; ++a) {
        part[a] = wall_part(x[static_cast<std::size_t>(a)], &r.walls, a);
        pull[a] = wall_pull(x[static_cast<std::size_t>(a)], &r.walls, a);
    }
    if (!r.solid.empty()) {
        std::copy(r.solid[i].begin(), r.solid[i].end(), solid);
        solid[3] = r.solid_part[i];
    }
    walls_combined(part, pull, solid, out);
    return {out[0], out[1], out[2], out[3]};
}

Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double square(const Point& d) { return d[0] * d[0] + d[1] * d[1] + d[2] * d[2]; }

/// f(j, x_i - x_j, r^2) for every neighbour.
template <class F>
void each_neighbour(const ReferencePbf& r, const std::vector<Point>& x, std::size_t i, F&& f) {
    for (const std::size_t j : r.neighbours[i]) {
        const Point d = difference(x[i], x[j]);
        f(j, d, square(d));
    }
}

}  // namespace

void ReferencePbf::find_neighbours(const std::vector<Point>& x) {
    neighbours.assign(x.size(), {});
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < x.size(); ++j)
            if (j != i && square(difference(x[i], x[j])) < p.h2) neighbours[i].push_back(j);
}

std::vector<double> ReferencePbf::densities(const std::vector<Point>& x) const {
    std::vector<double> rho(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        rho[i] = p.self + walls_at(*this, x[i], i)[3];
        each_neighbour(*this, x, i, [&](std::size_t, const Point&, double r2) { rho[i] += functions[kernel].density(r2, &p); });
    }
    return rho;
}

std::vector<double> ReferencePbf::lambdas(const std::vector<Point>& x) const {
    std::vector<double> lambda(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto wall = walls_at(*this, x[i], i);
        double rho = p.self + wall[3], neighbours2 = 0;
        Point own{wall[0], wall[1], wall[2]};
        each_neighbour(*this, x, i, [&](std::size_t, const Point& d, double r2) {
            const double slope = functions[kernel].slope(r2, &p);
            rho += functions[kernel].density(r2, &p);
            neighbours2 += slope * slope * r2;
            for (std::size_t a = 0; a < 3; ++a) own[a] += slope * d[a];
        });
        lambda[i] = muller::pbf_lambda(rho, neighbours2, own[0] * own[0] + own[1] * own[1] + own[2] * own[2], &p);
    }
    return lambda;
}

std::vector<Point> ReferencePbf::corrected(const std::vector<Point>& x, const std::vector<double>& lambda) const {
    std::vector<Point> to = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto wall = walls_at(*this, x[i], i);
        Point move{lambda[i] * wall[0], lambda[i] * wall[1], lambda[i] * wall[2]};
        each_neighbour(*this, x, i, [&](std::size_t j, const Point& d, double r2) {
            const double factor = functions[kernel].correction(r2, lambda[i] + lambda[j], &p);
            for (std::size_t a = 0; a < 3; ++a) move[a] += factor * d[a];
        });
        for (std::size_t a = 0; a < 3; ++a) to[i][a] = std::clamp(x[i][a] + p.relaxation * move[a], walls.keep_lo[a], walls.keep_hi[a]);
    }
    return to;
}

}  // namespace weir::particles
