#include "particles/reference/reference.hpp"

#include <algorithm>
#include <cmath>

namespace weir::particles {

namespace {

#define SCALAR double
#include "particles/kernels/prelude_double.h"
using plain::PbfParams;
using plain::SphParams;
using plain::WallParams;
#include "particles/kernels/pair.inl"
using plain::HeatParams;
using plain::HeatWalls;
#include "particles/kernels/heat_walls.inl"

namespace muller {
#define WEIR_DENSITY(r2, p) poly6(r2, (p)->h2)
#define WEIR_SLOPE(r2, p) spiky_slope(r2, (p)->h)
#define WEIR_LAPLACIAN(r2, p) linear_laplacian(r2, (p)->h)
#include "particles/kernels/pbf_pair.inl"

#include "particles/kernels/sph_pair.inl"

#include "particles/kernels/heat_pair.inl"
#undef WEIR_DENSITY
#undef WEIR_SLOPE
#undef WEIR_LAPLACIAN
}  // namespace muller
namespace spline {
#define WEIR_DENSITY(r2, p) cubic(r2, (p)->h)
#define WEIR_SLOPE(r2, p) cubic_slope(r2, (p)->h)
#define WEIR_LAPLACIAN(r2, p) cubic_slope(r2, (p)->h)
#include "particles/kernels/pbf_pair.inl"

#include "particles/kernels/sph_pair.inl"

#include "particles/kernels/heat_pair.inl"
#undef WEIR_DENSITY
#undef WEIR_SLOPE
#undef WEIR_LAPLACIAN
}  // namespace spline
namespace c2 {
#define WEIR_DENSITY(r2, p) wendland(r2, (p)->h)
#define WEIR_SLOPE(r2, p) wendland_slope(r2, (p)->h)
#define WEIR_LAPLACIAN(r2, p) wendland_slope(r2, (p)->h)
#include "particles/kernels/pbf_pair.inl"

#include "particles/kernels/sph_pair.inl"

#include "particles/kernels/heat_pair.inl"
#undef WEIR_DENSITY
#undef WEIR_SLOPE
#undef WEIR_LAPLACIAN
}  // namespace c2

struct Functions {
    double (*density)(double, const PbfParams*);
    double (*slope)(double, const PbfParams*);
    double (*correction)(double, double, const PbfParams*);
    double (*sph_add_density)(double, double, const SphParams*);
    double (*sph_rate)(double, double, double, const SphParams*);
    double (*sph_diffusion)(double, double, double, const SphParams*);
    double (*sph_add_artificial)(double, double, double, double, const SphParams*);
    double (*sph_push)(double, double, const SphParams*);
    double (*sph_drag)(double, double, const SphParams*);
    double (*sph_colour)(double, double, const SphParams*);
    double (*heat_flow)(double, double, const HeatParams*);
};
#define WEIR_FUNCTIONS(k)                                                                                                 \
    {                                                                                                                     \
        k::pbf_density, k::pbf_slope, k::pbf_correction_with_pressure, k::sph_add_density, k::sph_rate, k::sph_diffusion, \
            k::sph_add_artificial, k::sph_push, k::sph_drag, k::sph_colour, k::heat_flow                                  \
    }
constexpr Functions functions[3] = {WEIR_FUNCTIONS(muller), WEIR_FUNCTIONS(spline), WEIR_FUNCTIONS(c2)};

/// Walls and solids at one particle: gradient, then part.
std::array<double, 4> walls_at(const ReferencePairs& r, const Point& x, std::size_t i) {
    double part[3], lean[3], pull[3], steep[3], solid[4] = {0, 0, 0, 0}, out[4];
    for (int a = 0; a < 3; ++a) {
        const double at = x[static_cast<std::size_t>(a)];
        part[a] = wall_part(at, &r.walls, a), lean[a] = wall_lean(at, &r.walls, a);
        pull[a] = wall_pull(at, &r.walls, a), steep[a] = wall_steep(at, &r.walls, a);
    }
    if (!r.solid.empty()) {
        std::copy(r.solid[i].begin(), r.solid[i].end(), solid);
        solid[3] = r.solid_part[i];
    }
    walls_combined(part, lean, pull, steep, solid, out);
    return {out[0], out[1], out[2], out[3]};
}

double rest_of(const ReferencePairs& r, std::size_t i) { return r.rest.empty() ? 1 : r.rest[i]; }

Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
/// Distance vector to the nearest image.
Point apart(const Point& a, const Point& b, const Point& period) {
    Point d = difference(a, b);
    for (std::size_t k = 0; k < 3; ++k)
        if (period[k] > 0) d[k] -= period[k] * std::round(d[k] / period[k]);
    return d;
}
double square(const Point& d) { return d[0] * d[0] + d[1] * d[1] + d[2] * d[2]; }
double apart2(const Point& d, const SphParams& p) { return distance2(d[0], d[1], d[2], p.guard); }

Neighbours closer_than(double h2, const std::vector<Point>& x, const Point& period) {
    Neighbours neighbours(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < x.size(); ++j)
            if (j != i && square(apart(x[i], x[j], period)) < h2) neighbours[i].push_back(j);
    return neighbours;
}

/// f(j, x_i - x_j, r^2) for every neighbour.
template <class F>
void each_neighbour(const ReferencePbf& r, const std::vector<Point>& x, std::size_t i, F&& f) {
    for (const std::size_t j : r.neighbours[i]) {
        const Point d = apart(x[i], x[j], r.period);
        f(j, d, distance2(d[0], d[1], d[2], r.p.guard));
    }
}

}  // namespace

void ReferencePbf::find_neighbours(const std::vector<Point>& x) { neighbours = closer_than(p.h2, x, period); }
void ReferenceSph::find_neighbours(const std::vector<Point>& x) { neighbours = closer_than(p.h2, x, period); }

std::vector<double> ReferencePbf::densities(const std::vector<Point>& x) const {
    std::vector<double> rho(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        rho[i] = p.self + rest_of(*this, i) * walls_at(*this, x[i], i)[3];
        each_neighbour(*this, x, i, [&](std::size_t, const Point&, double r2) { rho[i] += functions[kernel].density(r2, &p); });
    }
    return rho;
}

std::vector<double> ReferencePbf::lambdas(const std::vector<Point>& x, std::vector<double>* multiplier) const {
    std::vector<double> lambda(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto wall = walls_at(*this, x[i], i);
        const double own_rest = rest_of(*this, i);
        double rho = p.self + own_rest * wall[3], neighbours2 = 0;
        Point own{own_rest * wall[0], own_rest * wall[1], own_rest * wall[2]};
        each_neighbour(*this, x, i, [&](std::size_t, const Point& d, double r2) {
            const double slope = functions[kernel].slope(r2, &p);
            rho += functions[kernel].density(r2, &p);
            neighbours2 += slope * slope * r2;
            for (std::size_t a = 0; a < 3; ++a) own[a] += slope * d[a];
        });
        const double before = multiplier ? (*multiplier)[i] : 0,
                     sum = muller::pbf_multiplier(before, rho + (1 - own_rest), neighbours2, square(own), &p);
        if (multiplier) (*multiplier)[i] = sum;
        lambda[i] = sum - before;
    }
    return lambda;
}

std::vector<Point> ReferencePbf::corrected(const std::vector<Point>& x, const std::vector<double>& lambda,
                                           BoundaryCorrections* corrections) const {
    std::vector<Point> to = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto wall = walls_at(*this, x[i], i);
        const double push = lambda[i] * rest_of(*this, i);
        Point move{push * wall[0], push * wall[1], push * wall[2]};
        each_neighbour(*this, x, i, [&](std::size_t j, const Point& d, double r2) {
            const double factor = functions[kernel].correction(r2, lambda[i] + lambda[j], &p);
            for (std::size_t a = 0; a < 3; ++a) move[a] += factor * d[a];
        });
        double back2 = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            const double free = x[i][a] + move[a];
            to[i][a] = std::clamp(free, walls.keep_lo[a], walls.keep_hi[a]);
            back2 += (to[i][a] - free) * (to[i][a] - free);
        }
        if (corrections && back2 > least_back * least_back) corrections->add(1, std::sqrt(back2));
    }
    return to;
}

std::vector<double> ReferenceSph::densities(const std::vector<Point>& x) const {
    std::vector<double> rho(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        rho[i] = p.self + p.wall_rho * rest_of(*this, i) * walls_at(*this, x[i], i)[3];
        for (const std::size_t j : neighbours[i])
            rho[i] = functions[kernel].sph_add_density(rho[i], apart2(apart(x[i], x[j], period), p), &p);
    }
    return rho;
}

std::vector<double> ReferenceSph::rates(const std::vector<Point>& x, const std::vector<Point>& v, const std::vector<double>& rho,
                                        double rho0) const {
    std::vector<double> rate(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto wall = walls_at(*this, x[i], i);
        double relative = 2 * (wall[0] * v[i][0] + wall[1] * v[i][1] + wall[2] * v[i][2]), spread = 0;
        for (const std::size_t j : neighbours[i]) {
            const Point d = apart(x[i], x[j], period), u = difference(v[i], v[j]);
            double excess = (rho[j] - rho0 * rest_of(*this, j)) - (rho[i] - rho0 * rest_of(*this, i));
            for (std::size_t b = 0; b < 3; ++b) excess += p.layers[b] * d[b];
            relative += functions[kernel].sph_rate(apart2(d, p), d[0] * u[0] + d[1] * u[1] + d[2] * u[2], 1 / rho[j], &p);
            spread += functions[kernel].sph_diffusion(apart2(d, p), excess, 1 / rho[j], &p);
        }
        rate[i] = rho[i] * relative + spread;
    }
    return rate;
}

std::vector<Point> ReferenceSph::tensions(const std::vector<Point>& x, const std::vector<double>& rho) const {
    std::vector<Point> q(x.size()), a(x.size(), Point{0, 0, 0});
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto wall = walls_at(*this, x[i], i);
        q[i] = {wall[0], wall[1], wall[2]};
        for (const std::size_t j : neighbours[i]) {
            const Point d = apart(x[i], x[j], period);
            const double f = functions[kernel].sph_colour(apart2(d, p), 1 / rho[j], &p);
            for (std::size_t b = 0; b < 3; ++b) q[i][b] += f * d[b];
        }
        const double scale = muller::sph_normal(square(q[i]), &p);
        for (double& c : q[i]) c *= scale;
    }
    for (std::size_t i = 0; i < x.size(); ++i)
        for (const std::size_t j : neighbours[i]) {
            const Point d = apart(x[i], x[j], period);
            const double f = muller::sph_tension(apart2(d, p), 1 / (rho[i] * rho[j]), &p), both = square(q[i]) + square(q[j]);
            const double own = q[i][0] * d[0] + q[i][1] * d[1] + q[i][2] * d[2], other = q[j][0] * d[0] + q[j][1] * d[1] + q[j][2] * d[2];
            for (std::size_t b = 0; b < 3; ++b) a[i][b] += f * (both * d[b] - own * q[i][b] - other * q[j][b]);
        }
    return a;
}

std::vector<Point> ReferenceSph::accelerations(const std::vector<Point>& x, const std::vector<Point>& v, const std::vector<double>& rho,
                                               const std::vector<double>& pressure) const {
    std::vector<Point> a(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto wall = walls_at(*this, x[i], i);
        muller::sph_wall_force(x[i].data(), v[i].data(), pressure[i], wall[3], &walls, &p, a[i].data());
        for (std::size_t b = 0; b < 3; ++b) a[i][b] -= 2 * pressure[i] / rho[i] * wall[b];
        for (const std::size_t j : neighbours[i]) {
            const Point d = apart(x[i], x[j], period), u = difference(v[i], v[j]);
            const double r2 = apart2(d, p), approach = d[0] * u[0] + d[1] * u[1] + d[2] * u[2];
            const double pressures = summed ? pressure[i] / (rho[i] * rho[i]) + pressure[j] / (rho[j] * rho[j])
                                            : (pressure[i] + pressure[j]) / (rho[i] * rho[j]);
            const double damped = functions[kernel].sph_add_artificial(pressures, r2, approach, 0.5 / rho[i] + 0.5 / rho[j], &p);
            const double push = functions[kernel].sph_push(r2, damped, &p);
            const double drag = functions[kernel].sph_drag(r2, 1 / (rho[i] * rho[j]), &p);
            for (std::size_t b = 0; b < 3; ++b) a[i][b] += push * d[b] - drag * u[b];
        }
    }
    return a;
}

namespace {

/// One wall, or several combined, behind which each particle has an image.
struct HeatImage {
    std::vector<int> planes;  // 2 axis, plus one for the upper wall
    bool held = false;
    double theta = 0;
};
std::vector<HeatImage> images_behind(const HeatWalls& w) {
    std::vector<HeatImage> images;
    for (int which = 1; which < 27; ++which) {
        HeatImage image;
        for (int a = 0, rest = which; a < 3; ++a, rest /= 3) {
            if (rest % 3 == 0) continue;
            const bool upper = rest % 3 == 2, held = upper ? w.hi_held[a] : w.lo_held[a];
            image.planes.push_back(2 * a + upper);
            if (held && !image.held) image.theta = upper ? w.hi_theta[a] : w.lo_theta[a];
            image.held = image.held != held;
        }
        images.push_back(image);
    }
    return images;
}
double height(const Point& x, int plane, const HeatWalls& w) {
    const int a = plane / 2;
    return heat_above(plane % 2 ? w.hi[a] - x[static_cast<std::size_t>(a)] : x[static_cast<std::size_t>(a)] - w.lo[a], &w);
}

}  // namespace

ReferencePairs::Warming ReferencePairs::warming(const std::vector<Point>& x, const std::vector<double>& theta, const HeatParams& p,
                                                const HeatWalls& w) const {
    Warming to{std::vector<double>(x.size()), std::vector<double>(x.size())};
    const auto images = images_behind(w);
    const auto behind = [&](double r2, std::size_t i, std::size_t j, const HeatImage& image) {
        for (const int plane : image.planes) r2 = heat_behind(r2, height(x[i], plane, w), height(x[j], plane, w));
        return r2;
    };
    std::vector<HeatImage> near;
    for (std::size_t i = 0; i < x.size(); ++i) {
        near.clear();
        std::copy_if(images.begin(), images.end(), std::back_inserter(near), [&](const HeatImage& image) {
            return std::all_of(image.planes.begin(), image.planes.end(), [&](int plane) { return height(x[i], plane, w) < p.h; });
        });
        for (const HeatImage& image : near)
            if (image.held) to.by_walls[i] += functions[kernel].heat_flow(behind(p.guard, i, i, image), 2 * (image.theta - theta[i]), &p);
        for (const std::size_t j : neighbours[i]) {
            const Point d = apart(x[i], x[j], period);
            const double r2 = distance2(d[0], d[1], d[2], p.guard), rise = theta[j] - theta[i];
            to.rate[i] += functions[kernel].heat_flow(r2, rise, &p);
            for (const HeatImage& image : near)
                (image.held ? to.by_walls : to.rate)[i] +=
                    functions[kernel].heat_flow(behind(r2, i, j, image), image.held ? 2 * image.theta - theta[j] - theta[i] : rise, &p);
        }
        to.rate[i] += to.by_walls[i];
    }
    return to;
}

template <int D>
void add_solids(ReferencePairs& reference, const Domain<D>& domain, const std::vector<Point>& x) {
    if (domain.solids.empty()) return;
    const auto& walls = reference.walls;
    reference.solid.assign(x.size(), Point{0, 0, 0});
    reference.solid_part.assign(x.size(), 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Vec<D> at = domain.centre() + vec_of<D>(x[i]);
        const real phi = std::max<real>(0, domain.solids.distance(at));
        if (phi * walls.inv_h >= 1) continue;
        const Vec<D> n = domain.solids.normal(at, 1e-3 * domain.spacing);
        for (std::size_t a = 0; a < D; ++a) reference.solid[i][a] = -wall_series(phi, walls.slope, walls.inv_h) * n[static_cast<int>(a)];
        reference.solid_part[i] = wall_series(phi, walls.fraction, walls.inv_h);
    }
}

template <int D>
void meet_bodies(const ReferencePairs& reference, const Domain<D>& domain, const std::vector<Point>& x, std::vector<Meeting<D>>& to) {
    to.clear();
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Vec<D> at = domain.centre() + vec_of<D>(x[i]);
        if (reference.solid_part[i] == 0 || domain.solids.nearest(at) < domain.first_body()) continue;
        Meeting<D> m;
        m.particle = static_cast<int>(i), m.body = static_cast<std::ptrdiff_t>(domain.solids.nearest(at) - domain.first_body());
        m.at = at;
        double part[3], lean[3];
        for (int a = 0; a < 3; ++a) {
            const double place = x[i][static_cast<std::size_t>(a)];
            part[a] = wall_part(place, &reference.walls, a), lean[a] = wall_lean(place, &reference.walls, a);
        }
        m.open = walls_leave(part, lean, reference.solid[i].data());
        m.pull = m.open * vec_of<D>(reference.solid[i]), m.part = m.open * reference.solid_part[i];
        to.push_back(m);
    }
}

Pairs::NeighbourCounts counts_of(const Neighbours& neighbours) {
    std::size_t sum = 0, most = 0;
    for (const auto& list : neighbours) sum += list.size(), most = std::max(most, list.size());
    return {neighbours.empty() ? 0 : static_cast<real>(sum) / static_cast<real>(neighbours.size()), static_cast<real>(most)};
}

std::size_t bytes_of(const Neighbours& neighbours) {
    std::size_t sum = neighbours.capacity() * sizeof(Neighbours::value_type);
    for (const auto& list : neighbours) sum += list.capacity() * sizeof(std::size_t);
    return sum;
}

template void meet_bodies(const ReferencePairs&, const Domain<2>&, const std::vector<Point>&, std::vector<Meeting<2>>&);
template void meet_bodies(const ReferencePairs&, const Domain<3>&, const std::vector<Point>&, std::vector<Meeting<3>>&);
template void add_solids(ReferencePairs&, const Domain<2>&, const std::vector<Point>&);
template void add_solids(ReferencePairs&, const Domain<3>&, const std::vector<Point>&);

}  // namespace weir::particles
