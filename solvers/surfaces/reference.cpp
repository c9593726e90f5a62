#include "surfaces/reference.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace weir::surfaces {

namespace {

/// m/rho: that of the liquid at rest, or more for isolated particles whose sum would not reach the level of the surface.
real volume_of(const std::vector<Vec<3>>& all, const Vec<3>& x) {
    real density = 0;
    for (const Vec<3>& y : all) density += bump_norm / (reach * reach * reach) * bump(dot(x - y, x - y) / (reach * reach));
    return std::max(1.0, lonely_density / density);
}

Moments moments_of(const std::vector<Vec<3>>& all, const Vec<3>& x) {
    Moments m;
    for (const Vec<3>& y : all) {
        const Vec<3> d = y - x;
        const real r = norm(d) / far_reach;
        if (r >= 1) continue;
        const real w = 1 - r * r * r;
        ++m.count, m.weight += w;
        for (std::size_t a = 0; a < 3; ++a) m.first[a] += w * d[a], m.second[a] += w * d[a] * d[a];
        m.second[3] += w * d[0] * d[1], m.second[4] += w * d[0] * d[2], m.second[5] += w * d[1] * d[2];
    }
    return m;
}

Blob round(const Vec<3>& x, real volume) {
    constexpr real g = 1 / reach;
    return {x, {g, g, g, 0, 0, 0}, {{reach, reach, reach}}, volume * bump_norm * g * g * g};
}

real squared(const Blob& blob, const Vec<3>& d) {
    const auto& g = blob.stretch;
    const Vec<3> s{
        {g[0] * d[0] + g[3] * d[1] + g[4] * d[2], g[3] * d[0] + g[1] * d[1] + g[5] * d[2], g[4] * d[0] + g[5] * d[1] + g[2] * d[2]}};
    return dot(s, s);
}

/// Points of a unit cell of the lattice over which a value is averaged.
constexpr int phases = 4;
/// Particles across and down the half space: those farther from its middle than the reach of a neighbour's neighbour do not contribute.
constexpr int half_width = 8, layers = 8;
/// Depths of a profile: the clamping range of samples, plus a margin where values are constant.
constexpr real highest = -1.5, lowest = 1.5, step = 1.0 / 32;

Profile find_profile(Method method, bool flat) {
    std::vector<Vec<3>> lattice;
    for (int k = -half_width; k <= half_width; ++k)
        for (int j = 0; j < layers; ++j)
            for (int i = -half_width; i <= half_width; ++i) lattice.push_back({{real(i), -0.5 - j, real(k)}});
    const ReferenceField field(method, std::move(lattice), flat);
    std::vector<real> values;
    for (real depth = highest; depth <= lowest; depth += step) {
        real sum = 0;
        for (int k = 0; k < phases; ++k)
            for (int i = 0; i < phases; ++i) sum += field.value({{(i + 0.5) / phases, -depth, flat ? 0 : (k + 0.5) / phases}});
        values.push_back(sum / (phases * phases));
    }
    return {highest, step, values};
}

template <Method M>
const Profile& profile_once(bool flat) {
    static const Profile profile = find_profile(M, false), of_flat = find_profile(M, true);
    return flat ? of_flat : profile;
}

}  // namespace

Profile::Profile(real first_depth, real step_of_depth, const std::vector<real>& values) {
    const auto middle = static_cast<std::size_t>(std::lround(-first_depth / step_of_depth));
    const bool rising = values[middle + 1] > values[middle];
    // from the surface outwards and inwards, as far as the values are monotone
    std::size_t first = middle, last = middle;
    while (first > 0 && std::isfinite(values[first - 1]) && (values[first] > values[first - 1]) == rising &&
           values[first] != values[first - 1])
        --first;
    while (last + 1 < values.size() && (values[last + 1] > values[last]) == rising && values[last + 1] != values[last]) ++last;
    const auto depth_of = [&](real value) {
        std::size_t i = first;
        while (i + 1 < last && (rising ? values[i + 1] < value : values[i + 1] > value)) ++i;
        return first_depth + step_of_depth * (real(i) + (value - values[i]) / (values[i + 1] - values[i]));
    };
    least_ = std::min(values[first], values[last]);
    per_step_ = steps / (std::max(values[first], values[last]) - least_);
    for (int i = 0; i <= steps; ++i) depths_[static_cast<std::size_t>(i)] = depth_of(least_ + i / per_step_);
}

ReferenceField::ReferenceField(Method method, std::vector<Vec<3>> positions, bool flat)
    : method_(method), flat_(flat), x_(std::move(positions)) {
    if (method == Method::level_set) throw std::logic_error("a level set needs no particles");
    if (method == Method::zhu_bridson) return;
    for (const Vec<3>& x : x_)
        blobs_.push_back(method == Method::anisotropic ? stretched(x, moments_of(x_, x), volume_of(x_, x)) : round(x, volume_of(x_, x)));
}

real ReferenceField::value(const Vec<3>& x) const {
    real sum = 0;
    if (method_ == Method::zhu_bridson) {
        Vec<3> off{};
        for (const Vec<3>& y : x_) {
            const real w = bump(dot(y - x, y - x) / (reach * reach));
            sum += w, off += w * (y - x);
        }
        return sum > 0 ? norm(off) / sum : infinity;
    }
    for (const Blob& blob : blobs_) sum += blob.peak * bump(squared(blob, x - blob.centre));
    return sum;
}

real ReferenceField::depth(const Vec<3>& x) const { return profile_of(method_, flat_).depth(value(x)); }

const Profile& profile_of(Method method, bool flat) {
    return method == Method::zhu_bridson   ? profile_once<Method::zhu_bridson>(flat)
           : method == Method::anisotropic ? profile_once<Method::anisotropic>(flat)
                                           : profile_once<Method::density>(flat);
}

}  // namespace weir::surfaces
