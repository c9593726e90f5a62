// A steady wave train by Stokes's expansion in e = k H/2 to fifth order, with the coefficients of Fenton 1985 (J. Waterway, Port, Coastal,
// Ocean Eng. 111, 216) for zero mean Eulerian current; with fewer terms, Stokes waves of lower order.
#pragma once
#include "waves/model.hpp"

namespace weir::waves {

struct StokesWave {
    real g = 0, depth = infinity;
    real height = 0, k = 0, phase = 0;
    Vec<2> heading{{1, 0}};
    int order = 5;
};

class Stokes final : public Model {
public:
    explicit Stokes(const StokesWave& wave);
    void set_time(real t) override { t_ = t; }
    Motion motion(real x, real z) const override;
    Vec<3> velocity(const Vec<3>& at) const override;
    real speed() const { return speed_; }  // of the crests [m/s]

private:
    real theta(real x, real z) const { return wave_.k * (wave_.heading[0] * x + wave_.heading[1] * z - speed_ * t_) + wave_.phase; }
    real height_at(real theta) const;
    Vec<3> velocity_at(real theta, real y) const;

    StokesWave wave_;
    real depth_, speed_, t_ = 0;
    std::array<real, 5> surface_{};  // of cos(j theta), j = 1 .. 5 [m]
    std::array<real, 5> flow_{};     // of cosh(j k (y + d))/cosh(j k d) cos(j theta) [m/s]
};

}  // namespace weir::waves
