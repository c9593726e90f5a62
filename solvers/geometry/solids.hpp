// The solids of a scene at a time: distance, velocity, and the open fraction of each cell face.
#pragma once
#include "core/types.hpp"
#include "geometry/motion.hpp"
#include "geometry/shape.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace weir::geometry {

template <int D>
struct Solid {
    ShapePtr<D> shape;
    Motion<D> motion;
    bool no_slip = false;
    bool free = false;  // its pose is set from outside (place)
};

/// A bounding ball of a solid; infinite where none is known.
template <int D>
struct Ball {
    Vec<D> middle{};
    real radius = infinity;
};

/// An axis-aligned region of space.
template <int D>
struct Region {
    Vec<D> min, max;
};

/// All solids; set_time() moves them, and all queries refer to that time.
template <int D>
class Solids {
public:
    Solids() = default;
    /// From the scene's list "solids"; empty where it has none. Periodic sides repeat them like the fluid: each solid has an image one
    /// period further along each periodic axis, and a solid that leaves through one side enters through the other.
    explicit Solids(const scene::Scene& scene);
    /// From a list, without sides.
    explicit Solids(const std::vector<scene::Table>& tables);

    bool empty() const { return solids_.empty(); }
    /// The solids of the list, then their images, then the free ones.
    std::size_t count() const { return solids_.size(); }
    /// Index in the scene's list of solid i, or of the solid that it is an image of.
    std::size_t in_list(std::size_t i) const { return i < images_.size() ? images_[i].of : i; }
    /// Returns whether any solid moves; otherwise fractions never change.
    bool moving() const;
    void set_time(real t);
    /// Adds a solid moved from outside: its pose is the last one set, at any time. `ball`: bounding ball at its initial position.
    void add_free(ShapePtr<D> shape, bool no_slip, const Ball<D>& ball = {});
    void place(std::size_t solid, const Pose<D>& pose);
    /// Bounding ball of the solid at its present position.
    const Ball<D>& ball(std::size_t solid) const { return balls_[solid]; }
    const Solid<D>& operator[](std::size_t i) const { return solids_[i]; }

    /// Signed distance to the nearest solid [m], negative inside; +infinity without solids.
    real distance(const Vec<D>& x) const;
    real distance(std::size_t solid, const Vec<D>& x) const { return solids_[solid].shape->distance(poses_[solid].to_rest(x)); }
    /// The solid with the nearest surface (deepest inside wins); there must be at least one.
    std::size_t nearest(const Vec<D>& x) const;
    /// The solids that may be nearer than `than` to some point of a region, in order. Where one of them is that near, the following queries
    /// restricted to them give the result for all solids.
    void find_near(const Region<D>& where, real than, std::vector<std::size_t>& near) const;
    /// Upper bound of the gradient of their distances.
    real steepest(std::span<const std::size_t> of) const;
    /// The smaller of the distance and `most`.
    real distance(const Vec<D>& x, std::span<const std::size_t> of, real most = infinity) const;
    std::size_t nearest(const Vec<D>& x, std::span<const std::size_t> of) const;
    Vec<D> velocity(const Vec<D>& x, std::span<const std::size_t> of) const { return poses_[nearest(x, of)].velocity_at(x); }
    Vec<D> normal(const Vec<D>& x, real eps, std::span<const std::size_t> of) const;
    /// Velocity of the nearest solid's material at x [m/s].
    Vec<D> velocity(const Vec<D>& x) const { return poses_[nearest(x)].velocity_at(x); }
    /// Outward unit normal of the distance field, by central differences over ± eps [m].
    Vec<D> normal(const Vec<D>& x, real eps) const;
    /// x, or the closest point at distance `margin` outside when x is closer than that (two Newton steps along the gradient).
    Vec<D> push_out(const Vec<D>& x, real margin, real eps) const;
    Vec<D> push_out(const Vec<D>& x, real margin, real eps, std::span<const std::size_t> of) const;
    const Pose<D>& pose(std::size_t solid) const { return poses_[solid]; }

private:
    /// The solid of an image, and its displacement in periods.
    struct Image {
        std::size_t of = 0;
        Index<D> periods{};
    };
    bool may_be_nearer(std::size_t solid, const Vec<D>& x, real than) const;
    void repeat(const scene::Scene& scene);
    bool reaches(const Region<D>& domain, const Solid<D>& solid, const Index<D>& periods) const;
    Pose<D> placed(const Image& image, real t) const;

    std::vector<Solid<D>> solids_;
    std::vector<Pose<D>> poses_;
    std::vector<Ball<D>> balls_;   // at present positions
    std::vector<Vec<D>> middles_;  // of the balls, at initial positions
    std::vector<Image> images_;    // of each solid of the list, each itself first; empty without periodic sides
    Vec<D> origin_{}, period_{};   // 0 along axes that are not periodic [m]
};

/// Fraction of a segment where a linear function of the end values is positive (outside the solid), in [0, 1].
real fraction_positive(real a, real b);
/// Fraction of a square where the solid is not, from the signed distances at its corners in order (0,0) (1,0) (1,1) (0,1), by marching
/// squares with linear edges (Ng, Min & Gibou 2009). The saddle is resolved by the mean.
real fraction_positive(const std::array<real, 4>& corner);

/// Relative to a cell's edge: a solid's surface closer to a corner passes through it. Round-off of a distance is far below.
inline constexpr real touching = 1e-6;

/// A corner's distance d for its face. A distance of zero is ambiguous: a solid may lie on the face, or touch it at the corner alone. Then
/// the distance at a small offset along the face decides whether the corner is just inside or just outside.
template <int D, class Distance>
real distance_for_face(real d, const Distance& distance, const Vec<D>& corner, const Vec<D>& centre, real h_min) {
    if (std::abs(d) > touching * h_min) return d;
    return distance(corner + 1e-3 * (centre - corner)) > touching * h_min ? 0.0 : -std::numeric_limits<real>::min();
}

/// Corners of the face on the lower side along `axis` of the cell whose lower corner is x, in order around it.
template <int D>
std::array<Vec<D>, 1 << (D - 1)> face_corners(const Vec<D>& x, const Vec<D>& h, int axis) {
    const int b = (axis + 1) % D;
    const Vec<D> eb = h[b] * Vec<D>::unit(b);
    if constexpr (D == 2) {
        return {x, x + eb};
    } else {
        const int c = (axis + 2) % D;
        const Vec<D> ec = h[c] * Vec<D>::unit(c);
        return {x, x + eb, x + eb + ec, x + ec};
    }
}

/// Open fraction of a face; `at`: the distances at its corners, in order around it.
template <int D, class Distance>
real open_fraction(const Distance& distance, std::array<real, 1 << (D - 1)> at, const Vec<D>& x, const Vec<D>& h, int axis) {
    const auto corner = face_corners<D>(x, h, axis);
    Vec<D> centre{};
    for (const Vec<D>& c : corner) centre = centre + (1.0 / static_cast<real>(corner.size())) * c;
    const real h_min = *std::min_element(h.begin(), h.end());
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = distance_for_face<D>(at[i], distance, corner[i], centre, h_min);
    if constexpr (D == 2)
        return fraction_positive(at[0], at[1]);
    else
        return fraction_positive(at);
}
/// For the face on the lower side along `axis` of the cell whose lower corner is x.
template <int D, class Distance>
real open_fraction(const Distance& distance, const Vec<D>& x, const Vec<D>& h, int axis) {
    const auto corner = face_corners<D>(x, h, axis);
    std::array<real, 1 << (D - 1)> at;
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = distance(corner[i]);
    return open_fraction<D>(distance, at, x, h, axis);
}

}  // namespace weir::geometry
