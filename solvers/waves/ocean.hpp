// A wind sea on a periodic tile: every wave that the tile resolves, with the variance of the spectrum in its cell of the wavenumber plane
// and a random phase, summed by FFT (Mastin, Watterberg & Mareda 1987; Tessendorf 2001).
//
//     h(x, t) = sum a cos(k . x - omega(k) t + phase),   a^2/2 = integral of E(k) D(theta)/k over the cell
// D(x, t) = -choppiness sum (k/|k|) coth(k d) a sin(...): for 1 the horizontal part of the linear orbits
#pragma once
#include "waves/fourier.hpp"
#include "waves/model.hpp"
#include "waves/spectra.hpp"

#include <cstdint>

namespace weir::waves {

struct Sea {
    Spectrum spectrum;
    real heading = 0;  // of the wind, from x towards z [rad]
    real spread = 1;   // s
    real choppiness = 0;
    real shortest = 0;  // shorter waves are omitted [m]
    std::uint64_t seed = 1;
    bool gaussian = false;  // amplitudes are random too, with the same mean square
};

class Ocean final : public Model {
public:
    Ocean(const Sea& sea, const Box& box);
    void set_time(real t) override;
    bool sideways() const override { return sea_.choppiness > 0; }
    Motion motion(real x, real z) const override;
    Vec<3> velocity(const Vec<3>& at) const override;
    void fill(const Box& box, Sheet& sheet) override;
    void fill_water(const Box& box, real level, std::array<Values, 3>& velocity) override;
    std::size_t bytes() const override;
    real carried() const override { return carried_; }

private:
    struct Wave {
        real kx, kz, k;
    };
    Wave wave(int m, int n) const;
    real variance_of(int m, int n) const;  // of the wave with these signed indices
    void set_amplitudes();
    void advance_phases(int begin, int end) const;  // advances columns of waves to the present time
    void turn_all() const;
    real coth(std::size_t at) const { return along_.empty() ? 1 : along_[at]; }
    template <class F>
    void sum_of(const F& factor, const std::vector<Complex>& waves, real* out, std::size_t stride);
    template <class Sum, class F>
    Sum sum_at(real x, real z, const F& add) const;

    Sea sea_;
    HalfPlane plane_;
    real dkx_, dkz_, first_x_, first_z_, carried_ = 1;
    std::vector<Complex> forth_, back_;             // of the waves k and -k at t = 0
    mutable std::vector<Complex> height_, moving_;  // now: their sum, and their difference, which gives velocities
    real t_ = 0;
    /// The columns with present values: in parallel this rank's, until a rank that stores all needs a point value.
    mutable PlaneRange turned_{0, 0};
    std::vector<real> omega_, along_;  // along_: coth(k d), where the sea has a bed
    Values xx_, zz_, xz_;              // derivatives of the horizontal displacement; scratch
    Synthesis synthesis_;
};

}  // namespace weir::waves
