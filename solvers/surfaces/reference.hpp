// The definition of the three particle reconstructions, in double precision with sums over all particles: the reference for the fast one.
// It also determines the surface level of a liquid at rest.
#pragma once
#include "core/types.hpp"
#include "surfaces/kernel.hpp"
#include "surfaces/options.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace weir::surfaces {

/// A field as a function of the depth below a plane surface: maps its value to a depth. The plane is the surface of a half space filled by
/// a cubic lattice, half a spacing above its uppermost layer; values are averaged over the plane.
class Profile {
public:
    /// From values at equal steps of depth, starting at the first; they must be monotone.
    Profile(real first_depth, real step, const std::vector<real>& values);
    /// Depth below the surface [spacings]; clamped to the outermost known values.
    template <class T>
    T depth(T value) const {
        const T at = std::min(std::max((value - static_cast<T>(least_)) * static_cast<T>(per_step_), T(0)), static_cast<T>(steps));
        const int i = std::min(static_cast<int>(at), steps - 1);
        const T part = at - static_cast<T>(i);
        return (1 - part) * static_cast<T>(depths_[static_cast<std::size_t>(i)]) +
               part * static_cast<T>(depths_[static_cast<std::size_t>(i) + 1]);
    }

private:
    static constexpr int steps = 512;
    real least_ = 0, per_step_ = 1;
    std::array<real, steps + 1> depths_{};
};

class ReferenceField {
public:
    /// Positions in particle spacings; for a 2D liquid in all layers.
    ReferenceField(Method method, std::vector<Vec<3>> positions, bool flat = false);
    /// zhu_bridson: the distance to the weighted mean (infinite without particles within reach); otherwise the sum of kernels.
    real value(const Vec<3>& x) const;
    /// Depth of x inside the liquid, as in Samples::depth: the depth at which a plane surface would have the value of x.
    real depth(const Vec<3>& x) const;

private:
    Method method_;
    bool flat_;
    std::vector<Vec<3>> x_;
    std::vector<Blob> blobs_;
};

/// Computed once. A 2D liquid is a slice, through its particles, of an infinite one: the same layer at each spacing.
const Profile& profile_of(Method method, bool flat);

}  // namespace weir::surfaces
