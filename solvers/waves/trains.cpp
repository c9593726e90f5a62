#include "waves/trains.hpp"

#include <cmath>

namespace weir::waves {

namespace {

/// Amplitude over depth at which a wave breaks (McCowan 1894: height 0.78 of the depth).
constexpr real breaks_at = 0.39;

}  // namespace

Motion Sines::motion(real x, real z) const {
    Motion sum;
    for (const Train& w : trains_) {
        const real angle = theta(w, x, z), c = std::cos(angle), s = std::sin(angle), speed = w.amplitude * w.omega;
        const real along = speed * reach(w.k, 0, depth_).along * c;
        sum.moved[1] += w.amplitude * c;
        sum.velocity += Vec<3>{{along * w.heading[0], speed * s, along * w.heading[1]}};
    }
    return sum;
}

Vec<3> Sines::velocity(const Vec<3>& at) const {
    Vec<3> sum{};
    for (const Train& w : trains_) {
        const real angle = theta(w, at[0], at[2]), speed = w.amplitude * w.omega;
        const Reach r = reach(w.k, at[1], depth_);
        const real along = speed * r.along * std::cos(angle);
        sum += Vec<3>{{along * w.heading[0], speed * r.up * std::sin(angle), along * w.heading[1]}};
    }
    return sum;
}

Trochoids::Trochoids(std::vector<Train> trains, real depth, Shape shape, const Restoring& by)
    : trains_(std::move(trains)), shape_(std::move(shape)), depth_(depth) {
    if (!shape_.bed.empty())
        for (const Train& w : trains_) shoaled_.emplace_back(shape_.bed, by, w.k * w.heading[0], w.k * w.heading[1], w.omega);
}

std::size_t Trochoids::bytes() const {
    std::size_t sum = trains_.capacity() * sizeof(Train);
    for (const Shoaled& s : shoaled_) sum += s.bytes();
    return sum;
}

void Trochoids::add(const Train& w, std::size_t number, real x, real y, real z, Motion& sum) const {
    Vec<2> heading = w.heading;
    real k = w.k, a = w.amplitude, h = depth_, tilt = 0, angle = w.phase - w.omega * t_;
    if (shoaled_.empty()) {
        angle += k * (heading[0] * x + heading[1] * z);
    } else {
        const Shoaled::Place p = shoaled_[number].at(x);
        const real kz = w.k * w.heading[1];
        angle += p.phase + kz * z;
        heading = {{p.kx / p.k, kz / p.k}};
        k = p.k, h = p.depth, a = std::min(a * p.growth, breaks_at * h);
        const real rises = -shape_.bed.slope(x) * heading[0];  // slope of the bed in the wave's direction
        tilt = shape_.tilt * std::asin(rises / std::hypot(1.0, rises) * std::exp(-k * h));
    }
    a *= std::exp(k * y);
    const real flat = h == infinity ? 1 : 1 / -std::expm1(-shape_.flatten * k * h);
    const real lean = shape_.lean * a, turned = angle - lean * std::cos(angle), turning = 1 + lean * std::sin(angle);
    const real c = a * std::cos(turned), s = a * std::sin(turned), ct = std::cos(tilt), st = std::sin(tilt);
    // the ellipse (-flat s, c), tilted; its derivative by `turned` is (-flat c, -s)
    const real along = -ct * flat * s - st * c, up = -st * flat * s + ct * c;
    const real along_rate = -ct * flat * c + st * s, up_rate = -st * flat * c - ct * s;
    sum.moved += Vec<3>{{along * heading[0], up, along * heading[1]}};
    const real rate = -w.omega * turning;
    sum.velocity += rate * Vec<3>{{along_rate * heading[0], up_rate, along_rate * heading[1]}};
    const real stretch = along_rate * k * turning;
    sum.xx += stretch * heading[0] * heading[0];
    sum.zz += stretch * heading[1] * heading[1];
    sum.xz += stretch * heading[0] * heading[1];
}

Motion Trochoids::motion(real x, real y, real z) const {
    Motion sum;
    for (std::size_t i = 0; i < trains_.size(); ++i) add(trains_[i], i, x, y, z, sum);
    return sum;
}

/// Finds the particle at a present position by the fixed-point iteration x0 <- X - D(x0), which contracts by the sum of the steepnesses.
Vec<3> Trochoids::velocity(const Vec<3>& at) const {
    Vec<3> rest = at;
    rest[1] = std::min(rest[1], 0.0);
    Motion m;
    for (int i = 0; i < 400; ++i) {
        m = motion(rest[0], rest[1], rest[2]);
        Vec<3> next = at - m.moved;
        next[1] = std::min(next[1], 0.0);
        const real change = norm(next - rest);
        rest = next;
        if (change <= 1e-14 * (norm(at) + norm(m.moved))) break;
    }
    return m.velocity;
}

}  // namespace weir::waves
