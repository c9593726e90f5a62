// The linear Cauchy-Poisson problem in a box of water with vertical walls: a surface released from rest oscillates in its cosine modes,
// each with its own frequency (Lamb 1932, sec. 228, 257).
//
//     y(x, z, t) = sum c cos(m pi x / L) cos(n pi z / W) cos(omega t),     omega^2 = (g k + sigma k^3/rho) tanh(k d)
#pragma once
#include "waves/cosines.hpp"
#include "waves/dispersion.hpp"
#include "waves/model.hpp"

namespace weir::waves {

class Basin final : public Model {
public:
    /// `level`: height of the water at rest, of depth `depth`; `heights`: initial surface relative to it, at the sheet's points.
    Basin(const Restoring& by, real level, real depth, const Box& box, Values heights);
    void set_time(real t) override;
    std::optional<real> level() const override { return level_; }
    Motion motion(real x, real z) const override;
    Vec<3> velocity(const Vec<3>& at) const override;
    void fill(const Box& box, Sheet& sheet) override;
    void fill_water(const Box& box, real level, std::array<Values, 3>& velocity) override;
    std::size_t bytes() const override;

private:
    real kx(int m) const { return pi * m / length_; }
    real kz(int n) const { return nz_ > 1 ? pi * n / width_ : 0; }
    void fill_layer(real y, std::array<real*, 3> out, std::size_t stride);
    template <class Sum, class F>
    Sum sum_at(const F& add) const;
    Vec<3> velocity_of(int m, int n, const Vec<3>& at) const;

    int nx_, nz_;
    real x0_, z0_, length_, width_, level_, depth_;
    Cosines series_;
    std::vector<real> mode_, omega_;  // amplitudes at t = 0 [m]; of the stored modes
    std::vector<real> now_, rate_;    // amplitudes, and their rates [m/s]
};

}  // namespace weir::waves
