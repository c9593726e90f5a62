// The linear problem of Cauchy and Poisson in a box of water with upright walls: a surface that is let go at rest swings in its cosine
// modes, each with its own frequency (Lamb 1932, sec. 228, 257).
//
//     y(x, z, t) = sum c cos(m pi x / L) cos(n pi z / W) cos(omega t),     omega^2 = (g k + sigma k^3/rho) tanh(k d)
#pragma once
#include "waves/dispersion.hpp"
#include "waves/model.hpp"

namespace weir::waves {

class Basin final : public Model {
public:
    /// `heights`: of the surface at t = 0 over the mean level, at the sheet's points.
    Basin(const Restoring& by, real depth, const Box& box, const std::vector<real>& heights);
    ~Basin() override;
    void set_time(real t) override;
    Motion motion(real x, real z) const override { return {.moved = {{0, height(x, z), 0}}, .velocity = velocity({{x, 0, z}})}; }
    Vec<3> velocity(const Vec<3>& at) const override;
    void fill(const Box& box, Sheet& sheet) override;
    void fill_water(const Box& box, real level, std::array<Values, 3>& velocity) override;
    std::size_t bytes() const override;

private:
    struct Plans;
    real height(real x, real z) const;
    std::size_t at(int m, int n) const { return static_cast<std::size_t>(m) + static_cast<std::size_t>(n) * static_cast<std::size_t>(nx_); }
    real kx(int m) const { return pi * m / length_; }
    real kz(int n) const { return nz_ > 1 ? pi * n / width_ : 0; }
    template <class F>
    void sum_of(int sine_axis, const F& coefficient, real* out, std::size_t stride);
    void fill_layer(real y, std::array<real*, 3> out, std::size_t stride);

    int nx_, nz_;
    real x0_, z0_, length_, width_, depth_, t_ = 0;
    std::vector<real> mode_, omega_;  // amplitudes at t = 0 [m]
    std::vector<real> now_, rate_;    // amplitudes, and their rates [m/s]
    std::unique_ptr<Plans> plans_;
};

}  // namespace weir::waves
