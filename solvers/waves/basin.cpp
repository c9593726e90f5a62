#include "waves/basin.hpp"

#include "core/exact_sum.hpp"

#include <cmath>

namespace weir::waves {

using SinesAlong = Cosines::SinesAlong;

Basin::Basin(const Restoring& by, real level, real depth, const Box& box, Values heights)
    : nx_(box.nx()),
      nz_(box.nz()),
      x0_(box.origin[0]),
      z0_(box.origin[2]),
      length_(nx_ * box.spacing[0]),
      width_(nz_ * box.spacing[2]),
      level_(level),
      depth_(depth),
      series_(nx_, nz_, box.rows()),
      mode_(series_.analyse(heights)),
      omega_(mode_.size(), 0),
      now_(mode_.size()),
      rate_(mode_.size()) {
    const PlaneRange held = series_.held();
    parallel_for(held.begin, held.end, [&](int m) {
        for (int n = 0; n < nz_; ++n) {
            const std::size_t j = series_.at(m, n);
            if (m + n == 0)
                mode_[j] = 0;  // its value is the error of the mean
            else
                omega_[j] = frequency(by, std::hypot(kx(m), kz(n)), depth);
        }
    });
    set_time(0);
}

void Basin::set_time(real t) {
    const PlaneRange held = series_.held();
    parallel_for(held.begin, held.end, [&](int m) {
        for (std::size_t j = series_.at(m, 0), end = series_.at(m + 1, 0); j < end; ++j) {
            now_[j] = mode_[j] * std::cos(omega_[j] * t);
            rate_[j] = -mode_[j] * omega_[j] * std::sin(omega_[j] * t);
        }
    });
}

void Basin::fill(const Box& box, Sheet& sheet) {
    const auto stride = static_cast<std::size_t>(box.nx());
    series_(
        SinesAlong::none, [&](int m, int n) { return now_[series_.at(m, n)]; }, sheet.height.data(), stride);
    std::array<real*, 3> out{};
    for (std::size_t a = 0; a < 3; ++a)
        if (!sheet.velocity[a].empty()) out[a] = sheet.velocity[a].data();
    fill_layer(0, out, stride);
}

void Basin::fill_water(const Box& box, real level, std::array<Values, 3>& velocity) {
    const auto nx = static_cast<std::size_t>(box.nx());
    const PlaneRange layers = box.layers();
    for (int j = layers.begin; j < layers.end; ++j) {
        std::array<real*, 3> out{};
        for (std::size_t a = 0; a < 3; ++a)
            if (!velocity[a].empty()) out[a] = velocity[a].data() + nx * static_cast<std::size_t>(j);
        fill_layer(box.y(j) - level, out, nx * static_cast<std::size_t>(box.ny()));
    }
}

/// The potential is sum of rate cos cos cosh k(y + d) / (k sinh k d).
void Basin::fill_layer(real y, std::array<real*, 3> out, std::size_t stride) {
    const auto k = [&](int m, int n) { return std::hypot(kx(m), kz(n)); };
    const auto rate = [&](int m, int n) { return rate_[series_.at(m, n)]; };
    const auto along = [&](int m, int n) { return rate(m, n) * reach(k(m, n), y, depth_).along / k(m, n); };
    if (out[0])
        series_(
            SinesAlong::x, [&](int m, int n) { return -kx(m) * along(m, n); }, out[0], stride);
    if (out[1])
        series_(
            SinesAlong::none, [&](int m, int n) { return rate(m, n) * reach(k(m, n), y, depth_).up; }, out[1], stride);
    if (out[2] && nz_ > 1)
        series_(
            SinesAlong::z, [&](int m, int n) { return -kz(n) * along(m, n); }, out[2], stride);
}

/// add(sum, m, n) for each mode except the constant one, column by column. With distributed storage the call is collective: a rank-ordered
/// reduction.
template <class Sum, class F>
Sum Basin::sum_at(const F& add) const {
    ExactSums<Sum> sums;
    for (int m = series_.held().begin; m < series_.held().end; ++m) {
        Sum column{};
        for (int n = m == 0 ? 1 : 0; n < nz_; ++n) add(column, m, n);
        sums.add(column);
    }
    return sum_of_ranks(series_.in_parts() ? series_.columns() : OwnPlanes{}, sums).value();
}

Vec<3> Basin::velocity_of(int m, int n, const Vec<3>& at) const {
    const real k = std::hypot(kx(m), kz(n)), ax = kx(m) * (at[0] - x0_), az = kz(n) * (at[2] - z0_), rate = rate_[series_.at(m, n)];
    const Reach r = reach(k, at[1], depth_);
    const real along = r.along / k * rate;
    return {{-kx(m) * along * std::sin(ax) * std::cos(az), r.up * rate * std::cos(ax) * std::cos(az),
             -kz(n) * along * std::cos(ax) * std::sin(az)}};
}

Motion Basin::motion(real x, real z) const {
    return sum_at<Motion>([&](Motion& sum, int m, int n) {
        sum.moved[1] += now_[series_.at(m, n)] * std::cos(kx(m) * (x - x0_)) * std::cos(kz(n) * (z - z0_));
        sum.velocity += velocity_of(m, n, {{x, 0, z}});
    });
}

Vec<3> Basin::velocity(const Vec<3>& at) const {
    return sum_at<Vec<3>>([&](Vec<3>& sum, int m, int n) { sum += velocity_of(m, n, at); });
}

std::size_t Basin::bytes() const {
    return (mode_.capacity() + omega_.capacity() + now_.capacity() + rate_.capacity()) * sizeof(real) + series_.bytes();
}

}  // namespace weir::waves
