// Wave trains, each with its amplitude, wavelength, heading and phase.
//
//   Sines (Airy):         y = sum a cos(theta), theta = k . x - omega t + phase; the water below moves as linear theory says.
//   Trochoids (Gerstner): x = x0 - sum (k/|k|) r sin(theta), y = y0 + sum r cos(theta), r = a e^(k y0): each particle goes round a circle.
//                         One train in deep water is an exact solution of Euler's equations; the sum of several is not.
//   Over a bed (Fournier & Reeves 1986) the phase is an integral (bed.hpp), circles become ellipses that lie along the bed,
//                         S_x = 1/(1 - e^(-f k h)),  S_y = S_x (1 - e^(-f k h)) = 1,  sin(tilt) = sin(bed) e^(-k h),
//                         and wind leans crests forward: theta' = theta - lean y. (Their papers' factors f are not at hand: 2 makes S_x
//                         what linear theory has but for 1 + e^(-2kh).)
#pragma once
#include "waves/bed.hpp"
#include "waves/model.hpp"

#include <vector>

namespace weir::waves {

struct Train {
    real amplitude = 0, k = 0, omega = 0, phase = 0;  // k: over a bed that of deep water
    Vec<2> heading{{1, 0}};                           // unit, along x and z
};

class Sines final : public Model {
public:
    Sines(std::vector<Train> trains, real depth) : trains_(std::move(trains)), depth_(depth) {}
    void set_time(real t) override { t_ = t; }
    Motion motion(real x, real z) const override;
    Vec<3> velocity(const Vec<3>& at) const override;
    std::size_t bytes() const override { return trains_.capacity() * sizeof(Train); }

private:
    real theta(const Train& w, real x, real z) const { return w.k * (w.heading[0] * x + w.heading[1] * z) - w.omega * t_ + w.phase; }
    std::vector<Train> trains_;
    real depth_, t_ = 0;
};

class Trochoids final : public Model {
public:
    struct Shape {
        Bed bed{};
        real lean = 0;     // [1/m]
        real flatten = 2;  // f
        real tilt = 1;     // factor by which orbits follow the bed's slope
    };
    Trochoids(std::vector<Train> trains, real depth, Shape shape, const Restoring& by);
    void set_time(real t) override { t_ = t; }
    bool sideways() const override { return true; }
    Motion motion(real x, real z) const override { return motion(x, 0, z); }
    /// Of a particle with rest position below the surface, y < 0.
    Motion motion(real x, real y, real z) const;
    bool particle(const Vec<3>& rest, Motion& of) const override { return of = motion(rest[0], rest[1], rest[2]), true; }
    Vec<3> velocity(const Vec<3>& at) const override;
    std::size_t bytes() const override;

private:
    void add(const Train& w, std::size_t number, real x, real y, real z, Motion& sum) const;
    std::vector<Train> trains_;
    std::vector<Shoaled> shoaled_;  // over a bed, one per train
    Shape shape_;
    real depth_, t_ = 0;
};

}  // namespace weir::waves
