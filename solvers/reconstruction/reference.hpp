// What the three reconstructions from particles are, in double precision and by sums over all particles: the definition that the fast one
// is compared with, and that knows where each puts the surface of a liquid at rest.
#pragma once
#include "core/types.hpp"
#include "reconstruction/kernel.hpp"
#include "reconstruction/options.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace weir::reconstruction {

/// What a field is below and above a plane: how its value tells the depth. The plane is the surface of a half space filled by a cubic
/// lattice, half a spacing above its uppermost layer; the value is the mean over the plane.
class Profile {
public:
    /// Of values at equal steps of depth, from the first, that never turn back.
    Profile(real first_depth, real step, const std::vector<real>& values);
    /// Below the surface [spacings]; the outermost known one beyond.
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
    /// Positions in particle spacings; of a flat liquid in all layers.
    ReferenceField(Method method, std::vector<Vec<3>> positions, bool flat = false);
    /// zhu_bridson: the distance to the weighted mean (infinite where no particle is in reach); otherwise the sum of kernels.
    real value(const Vec<3>& x) const;
    /// How far x lies inside, as Samples::depth: where a plane surface would have the value of x.
    real depth(const Vec<3>& x) const;

private:
    Method method_;
    bool flat_;
    std::vector<Vec<3>> x_;
    std::vector<Blob> blobs_;
};

/// Found by sums, once. A flat liquid is a slice, through its particles, of one that goes on for ever: the same layer again at each
/// spacing.
const Profile& profile_of(Method method, bool flat);

}  // namespace weir::reconstruction
