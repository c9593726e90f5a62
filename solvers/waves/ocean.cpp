#include "waves/ocean.hpp"

#include "core/exact_sum.hpp"
#include "waves/random.hpp"

#include <cmath>

namespace weir::waves {

namespace {

constexpr Complex i{0, 1};

/// Gauss-Legendre points of a cell along one axis: many near the origin, where the spectrum varies within a cell, few far from it.
struct Rule {
    int points;
    std::array<real, 12> x, weight;  // on [-1/2, 1/2]
};
Rule rule(int n) {
    Rule r{n, {}, {}};
    for (int j = 0; j < n; ++j) {
        real x = std::cos(pi * (j + 0.75) / (n + 0.5)), slope = 0;
        for (int turn = 0; turn < 50; ++turn) {  // Newton on the Legendre polynomial
            real p = 1, before = 0;
            for (int d = 1; d <= n; ++d) {
                const real next = ((2 * d - 1) * x * p - (d - 1) * before) / d;
                before = p, p = next;
            }
            slope = n * (x * p - before) / (x * x - 1);
            const real change = p / slope;
            x -= change;
            if (std::abs(change) < 1e-15) break;
        }
        const auto at = static_cast<std::size_t>(j);
        r.x[at] = 0.5 * x;
        r.weight[at] = 1 / ((1 - x * x) * slope * slope);
    }
    return r;
}

const Rule& rule_for(int distance) {
    static const Rule near = rule(12), middle = rule(6), far = rule(3);
    return distance < 8 ? near : distance < 32 ? middle : far;
}

}  // namespace

Ocean::Ocean(const Sea& sea, const Box& box)
    : sea_(sea),
      plane_(Synthesis::held_plane(box.nx(), box.nz(), box.rows())),
      dkx_(2 * pi / (box.nx() * box.spacing[0])),
      dkz_(box.dim == 3 ? 2 * pi / (box.nz() * box.spacing[2]) : 0),
      first_x_(box.x(0)),
      first_z_(box.z(0)),
      forth_(plane_.size()),
      back_(plane_.size()),
      height_(plane_.size()),
      moving_(plane_.size()),
      omega_(plane_.size(), 0),
      synthesis_(plane_, box.rows()) {
    if (sea.spectrum.depth < infinity) along_.assign(plane_.size(), 0);
    if (sideways()) {
        xx_ = Values(box.of_sheet());
        if (box.dim == 3) zz_ = Values(box.of_sheet()), xz_ = Values(box.of_sheet());
    }
    set_amplitudes();
    set_time(0);
}

Ocean::Wave Ocean::wave(int m, int n) const {
    const real kx = m * dkx_, kz = plane_.signed_n(n) * dkz_;
    return {kx, kz, std::sqrt(kx * kx + kz * kz)};
}

/// The spectrum integrated over the wave's cell, with the density E(k) D(theta) / k in the plane, or E(k) on a line.
real Ocean::variance_of(int m, int n) const {
    const Rule& r = rule_for(std::max(std::abs(m), std::abs(n)));
    const Spectrum& s = sea_.spectrum;
    real sum = 0;
    if (plane_.nz == 1 && dkz_ == 0) {
        if ((m > 0) != (std::cos(sea_.heading) > 0)) return 0;
        for (std::size_t a = 0; a < static_cast<std::size_t>(r.points); ++a)
            sum += r.weight[a] * s.of_wavenumber((std::abs(m) + r.x[a]) * dkx_);
        return sum * dkx_;
    }
    static thread_local real last_s = -1;
    static thread_local Spreading spreading(1);
    if (last_s != sea_.spread) spreading = Spreading(sea_.spread), last_s = sea_.spread;
    for (std::size_t a = 0; a < static_cast<std::size_t>(r.points); ++a)
        for (std::size_t b = 0; b < static_cast<std::size_t>(r.points); ++b) {
            const real kx = (m + r.x[a]) * dkx_, kz = (n + r.x[b]) * dkz_, k = std::hypot(kx, kz);
            if (k > 0) sum += r.weight[a] * r.weight[b] * s.of_wavenumber(k) * spreading(std::atan2(kz, kx) - sea_.heading) / k;
        }
    return sum * dkx_ * dkz_;
}

/// The half plane stores one half of each wave at k, and the conjugate half belongs to -k, so that the sum is real. Phases refer to the
/// scene's origin: a finer grid has the same sea with additional waves.
void Ocean::set_amplitudes() {
    const auto half = [&](int m, int n) {  // signed
        const Wave w{m * dkx_, n * dkz_, std::hypot(m * dkx_, n * dkz_)};
        if (sea_.shortest > 0 && w.k * sea_.shortest > 2 * pi) return Complex{};
        real amplitude = std::sqrt(2 * variance_of(m, n));
        if (sea_.gaussian) amplitude *= std::sqrt(-std::log(uniform(sea_.seed, m, n, 1)));
        const real phase = 2 * pi * uniform(sea_.seed, m, n, 0) + w.kx * first_x_ + w.kz * first_z_;
        return 0.5 * amplitude * std::exp(i * phase);
    };
    parallel_for(plane_.held.begin, plane_.held.end, [&](int m) {
        for (int n = 0; n < plane_.nz; ++n) {
            const std::size_t at = plane_.at(m, n);
            const Wave w = wave(m, n);
            if (w.k == 0 || (plane_.nx > 1 && 2 * m == plane_.nx) || (plane_.nz > 1 && 2 * n == plane_.nz)) continue;
            forth_[at] = half(m, plane_.signed_n(n));
            back_[at] = std::conj(half(-m, -plane_.signed_n(n)));
            omega_[at] = frequency(sea_.spectrum.by, w.k, sea_.spectrum.depth);
            if (!along_.empty()) along_[at] = reach(w.k, 0, sea_.spectrum.depth).along;
        }
    });
    const OwnPlanes mine = plane_.whole() ? OwnPlanes{} : synthesis_.columns();
    const real variance = 2 * plane_sum(mine, plane_.columns(), [&](int m) {  // a^2/2 = 2 |a/2|^2
                              real sum = 0;
                              for (int n = 0; n < plane_.nz; ++n)
                                  // the column m = 0 contains both k and -k, every other column only one of them
                                  sum += (m == 0 ? 0.5 : 1.0) * (std::norm(forth_[plane_.at(m, n)]) + std::norm(back_[plane_.at(m, n)]));
                              return sum;
                          });
    carried_ = variance / sea_.spectrum.variance();
}

void Ocean::set_time(real t) {
    t_ = t;
    turned_ = synthesis_.own_columns();
    advance_phases(turned_.begin, turned_.end);
}

void Ocean::advance_phases(int begin, int end) const {
    const real t = t_;
    parallel_for(begin, end, [&](int m) {
        for (std::size_t at = plane_.at(m, 0), last = plane_.at(m + 1, 0); at < last; ++at) {
            const Complex turn{std::cos(omega_[at] * t), -std::sin(omega_[at] * t)};
            const Complex f = forth_[at] * turn, b = back_[at] * std::conj(turn);
            height_[at] = f + b;
            moving_[at] = f - b;
        }
    });
}

/// A point value needs every wave: a rank that stores all of them advances also the others' waves.
void Ocean::turn_all() const {
    if (turned_ == PlaneRange{0, plane_.columns()}) return;
    advance_phases(0, turned_.begin);
    advance_phases(turned_.end, plane_.columns());
    turned_ = {0, plane_.columns()};
}

template <class F>
void Ocean::sum_of(const F& factor, const std::vector<Complex>& waves, real* out, std::size_t stride) {
    synthesis_(
        [&](int m, Complex* column) {
            std::size_t at = plane_.at(m, 0);
            for (int n = 0; n < plane_.nz; ++n, ++at) {
                const Wave w = wave(m, n);
                column[n] = w.k > 0 ? factor(w, at) * waves[at] : Complex{};
            }
        },
        out, stride);
}

void Ocean::fill(const Box& box, Sheet& sheet) {
    const real c = sea_.choppiness;
    const auto stride = static_cast<std::size_t>(plane_.nx);
    const auto sum = [&](const auto& factor, const std::vector<Complex>& waves, Values& out) {
        if (!out.empty()) sum_of(factor, waves, out.data(), stride);
    };
    sum([](const Wave&, std::size_t) { return 1.0; }, height_, sheet.height);
    sum([&](const Wave& w, std::size_t at) { return i * (c * coth(at) * w.kx / w.k); }, height_, sheet.moved_x);
    sum([&](const Wave& w, std::size_t at) { return i * (c * coth(at) * w.kz / w.k); }, height_, sheet.moved_z);
    sum([&](const Wave& w, std::size_t at) { return -c * coth(at) * w.kx * w.kx / w.k; }, height_, xx_);
    sum([&](const Wave& w, std::size_t at) { return -c * coth(at) * w.kz * w.kz / w.k; }, height_, zz_);
    sum([&](const Wave& w, std::size_t at) { return -c * coth(at) * w.kx * w.kz / w.k; }, height_, xz_);
    if (!sheet.jacobian.empty())
        for_own_rows(box, [&](int k) {
            for (std::size_t at = static_cast<std::size_t>(k) * stride, end = at + stride; at < end; ++at) {
                const Motion one{.xx = xx_[at], .zz = zz_.empty() ? 0 : zz_[at], .xz = xz_.empty() ? 0 : xz_[at]};
                sheet.jacobian[at] = one.jacobian();
            }
        });
    sum([&](const Wave& w, std::size_t at) { return omega_[at] * coth(at) * w.kx / w.k; }, moving_, sheet.velocity[0]);
    sum([&](const Wave&, std::size_t at) { return -i * omega_[at]; }, moving_, sheet.velocity[1]);
    sum([&](const Wave& w, std::size_t at) { return omega_[at] * coth(at) * w.kz / w.k; }, moving_, sheet.velocity[2]);
}

void Ocean::fill_water(const Box& box, real level, std::array<Values, 3>& out) {
    const real d = sea_.spectrum.depth;
    const auto nx = static_cast<std::size_t>(box.nx()), stride = nx * static_cast<std::size_t>(box.ny());
    const PlaneRange layers = box.layers();
    for (int j = layers.begin; j < layers.end; ++j) {
        const real y = box.y(j) - level;
        const std::size_t from = nx * static_cast<std::size_t>(j);
        sum_of([&](const Wave& w, std::size_t at) { return omega_[at] * reach(w.k, y, d).along * w.kx / w.k; }, moving_,
               out[0].data() + from, stride);
        sum_of([&](const Wave& w, std::size_t at) { return -i * (omega_[at] * reach(w.k, y, d).up); }, moving_, out[1].data() + from,
               stride);
        if (!out[2].empty())
            sum_of([&](const Wave& w, std::size_t at) { return omega_[at] * reach(w.k, y, d).along * w.kz / w.k; }, moving_,
                   out[2].data() + from, stride);
    }
}

/// add(sum, wave, index, e^(i k . x), doubled where the half plane contains only one of k and -k) for each wave, in order: the real part of
/// the sum is the field at (x, z): the exact sum of those of the columns. With distributed storage the call is collective.
template <class Sum, class F>
Sum Ocean::sum_at(real x, real z, const F& add) const {
    std::vector<Complex> along_z(static_cast<std::size_t>(plane_.nz));
    for (int n = 0; n < plane_.nz; ++n) along_z[static_cast<std::size_t>(n)] = std::exp(i * (plane_.signed_n(n) * dkz_ * (z - first_z_)));
    if (plane_.whole()) turn_all();
    ExactSums<Sum> sums;
    for (int m = plane_.held.begin; m < plane_.held.end; ++m) {
        const Complex along_x = (m == 0 ? 1.0 : 2.0) * std::exp(i * (m * dkx_ * (x - first_x_)));
        Sum column{};
        for (int n = 0; n < plane_.nz; ++n)
            if (const Wave w = wave(m, n); w.k > 0) add(column, w, plane_.at(m, n), along_x * along_z[static_cast<std::size_t>(n)]);
        sums.add(column);
    }
    return sum_of_ranks(plane_.whole() ? OwnPlanes{} : synthesis_.columns(), sums).value();
}

Motion Ocean::motion(real x, real z) const {
    const real c = sea_.choppiness;
    return sum_at<Motion>(x, z, [&](Motion& sum, const Wave& w, std::size_t at, const Complex& turn) {
        const Complex h = height_[at] * turn, v = moving_[at] * turn;
        const real ex = w.kx / w.k, ez = w.kz / w.k, sideways = c * coth(at);
        sum.moved += Vec<3>{{-sideways * ex * h.imag(), h.real(), -sideways * ez * h.imag()}};
        sum.velocity += omega_[at] * Vec<3>{{coth(at) * ex * v.real(), v.imag(), coth(at) * ez * v.real()}};
        const real stretch = -sideways * w.k * h.real();
        sum.xx += stretch * ex * ex;
        sum.zz += stretch * ez * ez;
        sum.xz += stretch * ex * ez;
    });
}

Vec<3> Ocean::velocity(const Vec<3>& at) const {
    return sum_at<Vec<3>>(at[0], at[2], [&](Vec<3>& sum, const Wave& w, std::size_t a, const Complex& turn) {
        const Complex v = omega_[a] * moving_[a] * turn;
        const Reach r = reach(w.k, at[1], sea_.spectrum.depth);
        sum += Vec<3>{{r.along * w.kx / w.k * v.real(), r.up * v.imag(), r.along * w.kz / w.k * v.real()}};
    });
}

std::size_t Ocean::bytes() const {
    const std::size_t waves = forth_.capacity() + back_.capacity() + height_.capacity() + moving_.capacity();
    return waves * sizeof(Complex) + (omega_.capacity() + along_.capacity()) * sizeof(real) + xx_.bytes() + zz_.bytes() + xz_.bytes() +
           synthesis_.bytes();
}

}  // namespace weir::waves
