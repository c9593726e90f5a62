#include "waves/basin.hpp"

#include <fftw3.h>

#include <cmath>

namespace weir::waves {

/// Cosine and sine series of values at the middles of cells (DCT-II there; DCT-III and DST-III back), one plan for each axis that may
/// carry sines: 0 none, 1 x, 2 z.
struct Basin::Plans {
    std::vector<real> values;
    fftw_plan forward = nullptr;
    std::array<fftw_plan, 3> back{};
    Plans(int nx, int nz) : values(static_cast<std::size_t>(nx) * static_cast<std::size_t>(nz)) {
        const auto plan = [&](fftw_r2r_kind x, fftw_r2r_kind z) {
            if (nz == 1) return fftw_plan_r2r_1d(nx, values.data(), values.data(), x, FFTW_ESTIMATE);
            return fftw_plan_r2r_2d(nz, nx, values.data(), values.data(), z, x, FFTW_ESTIMATE);
        };
        forward = plan(FFTW_REDFT10, FFTW_REDFT10);
        back = {plan(FFTW_REDFT01, FFTW_REDFT01), plan(FFTW_RODFT01, FFTW_REDFT01), plan(FFTW_REDFT01, FFTW_RODFT01)};
    }
    ~Plans() {
        fftw_destroy_plan(forward);
        for (fftw_plan p : back) fftw_destroy_plan(p);
    }
};

Basin::Basin(const Restoring& by, real depth, const Box& box, const std::vector<real>& heights)
    : nx_(box.nx()),
      nz_(box.nz()),
      x0_(box.origin[0]),
      z0_(box.origin[2]),
      length_(nx_ * box.spacing[0]),
      width_(nz_ * box.spacing[2]),
      depth_(depth),
      mode_(heights.size()),
      omega_(heights.size()),
      now_(heights.size()),
      rate_(heights.size()),
      plans_(std::make_unique<Plans>(box.nx(), box.nz())) {
    std::copy(heights.begin(), heights.end(), plans_->values.begin());
    fftw_execute(plans_->forward);
    const real scale = 1.0 / (nx_ * (nz_ > 1 ? nz_ : 1));
    for (int n = 0; n < nz_; ++n)
        for (int m = 0; m < nx_; ++m) {
            // FFTW's DCT-II is twice the sum over points; a mode's amplitude is twice its mean, but that of a constant
            const real halves = (m == 0 ? 0.5 : 1) * (nz_ > 1 ? (n == 0 ? 0.5 : 1) : 1);
            mode_[at(m, n)] = m + n == 0 ? 0 : halves * scale * plans_->values[at(m, n)];
            omega_[at(m, n)] = m + n == 0 ? 0 : frequency(by, std::hypot(kx(m), kz(n)), depth);
        }
    set_time(0);
}

Basin::~Basin() = default;

void Basin::set_time(real t) {
    t_ = t;
    parallel_for(0, nz_, [&](int n) {
        for (std::size_t j = at(0, n), end = at(0, n + 1); j < end; ++j) {
            now_[j] = mode_[j] * std::cos(omega_[j] * t);
            rate_[j] = -mode_[j] * omega_[j] * std::sin(omega_[j] * t);
        }
    });
}

/// DCT-III doubles every cosine but the constant one; DST-III every sine, whose first is number 1 and stands at 0.
template <class F>
void Basin::sum_of(int sine_axis, const F& coefficient, real* out, std::size_t stride) {
    auto& c = plans_->values;
    for (int n = 0; n < nz_; ++n)
        for (int m = 0; m < nx_; ++m) {
            const int sine_m = sine_axis == 1 ? m + 1 : m, sine_n = sine_axis == 2 ? n + 1 : n;
            if (sine_m >= nx_ || sine_n >= nz_) {  // the last sine, of the shortest wave, has no cosine to come from
                c[at(m, n)] = 0;
                continue;
            }
            const real whole_x = sine_axis != 1 && m == 0 ? 1 : 0.5, whole_z = nz_ == 1 || (sine_axis != 2 && n == 0) ? 1 : 0.5;
            c[at(m, n)] = sine_m + sine_n == 0 ? 0 : whole_x * whole_z * coefficient(sine_m, sine_n);
        }
    fftw_execute(plans_->back[static_cast<std::size_t>(sine_axis)]);
    for (int n = 0; n < nz_; ++n) std::copy_n(c.data() + at(0, n), nx_, out + static_cast<std::size_t>(n) * stride);
}

void Basin::fill(const Box& box, Sheet& sheet) {
    const auto stride = static_cast<std::size_t>(box.nx());
    sum_of(
        0, [&](int m, int n) { return now_[at(m, n)]; }, sheet.height.data(), stride);
    std::array<real*, 3> out{};
    for (std::size_t a = 0; a < 3; ++a)
        if (!sheet.velocity[a].empty()) out[a] = sheet.velocity[a].data();
    fill_layer(0, out, stride);
}

void Basin::fill_water(const Box& box, real level, std::array<Values, 3>& velocity) {
    const auto nx = static_cast<std::size_t>(box.nx());
    const PlaneRange layers = own_layers(box);
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
    const auto along = [&](int m, int n) { return rate_[at(m, n)] * reach(k(m, n), y, depth_).along / k(m, n); };
    if (out[0])
        sum_of(
            1, [&](int m, int n) { return -kx(m) * along(m, n); }, out[0], stride);
    if (out[1])
        sum_of(
            0, [&](int m, int n) { return rate_[at(m, n)] * reach(k(m, n), y, depth_).up; }, out[1], stride);
    if (out[2] && nz_ > 1)
        sum_of(
            2, [&](int m, int n) { return -kz(n) * along(m, n); }, out[2], stride);
}

real Basin::height(real x, real z) const {
    real sum = 0;
    for (int n = 0; n < nz_; ++n)
        for (int m = 0; m < nx_; ++m) sum += now_[at(m, n)] * std::cos(kx(m) * (x - x0_)) * std::cos(kz(n) * (z - z0_));
    return sum;
}

Vec<3> Basin::velocity(const Vec<3>& where) const {
    Vec<3> sum{};
    for (int n = 0; n < nz_; ++n)
        for (int m = 0; m < nx_; ++m) {
            if (m + n == 0) continue;
            const real k = std::hypot(kx(m), kz(n)), ax = kx(m) * (where[0] - x0_), az = kz(n) * (where[2] - z0_);
            const Reach r = reach(k, where[1], depth_);
            const real along = r.along / k * rate_[at(m, n)];
            sum += Vec<3>{{-kx(m) * along * std::sin(ax) * std::cos(az), r.up * rate_[at(m, n)] * std::cos(ax) * std::cos(az),
                           -kz(n) * along * std::cos(ax) * std::sin(az)}};
        }
    return sum;
}

std::size_t Basin::bytes() const {
    return (mode_.capacity() + omega_.capacity() + now_.capacity() + rate_.capacity() + plans_->values.capacity()) * sizeof(real);
}

}  // namespace weir::waves
