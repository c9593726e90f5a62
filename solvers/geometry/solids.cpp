#include "geometry/solids.hpp"

#include <algorithm>
#include <cmath>

namespace weir::geometry {

namespace {

/// Outward unit normal of a distance, by central differences.
template <int D, class Distance>
Vec<D> slope_of(const Vec<D>& x, real eps, const Distance& distance) {
    Vec<D> n;
    for (int a = 0; a < D; ++a) {
        const Vec<D> step = eps * Vec<D>::unit(a);
        n[a] = distance(x + step) - distance(x - step);
    }
    const real length = norm(n);
    return length > 0 ? n / length : Vec<D>::unit(D - 1);
}

}  // namespace

template <int D>
Solids<D>::Solids(const std::vector<scene::Table>& tables) {
    for (const auto& table : tables) {
        Solid<D> solid;
        solid.shape = make_shape<D>(table);
        if (table.has("motion")) solid.motion = Motion<D>::make(table.table("motion"), solid.shape->centre());
        solid.no_slip = table.text_or("slip", "free") == "no";
        solids_.push_back(std::move(solid));
    }
    poses_.resize(solids_.size()), balls_.resize(solids_.size()), middles_.resize(solids_.size());
    set_time(0);
}

template <int D>
Solids<D>::Solids(const scene::Scene& scene) : Solids(scene.root().tables("solids")) {
    repeat(scene);
    set_time(0);
}

/// Images that never reach the domain are omitted: for a fixed solid, where its distance shows this.
template <int D>
void Solids<D>::repeat(const scene::Scene& scene) {
    if (empty() || !scene.has("grid.periodic")) return;
    const Vec<D> size = scene.vec<D>("grid.size");
    const Region<D> domain{scene.vec<D>("grid.origin"), scene.vec<D>("grid.origin") + size};
    std::size_t all = 1;                                                 // images at −1, 0 and +1 periods along each periodic axis
    for (const std::string& axis : scene.root().texts("grid.periodic"))  // includes the sides' kinds
        if (const int a = axis[0] - 'x'; a < D) period_[a] = size[a], all *= 3;
    if (all == 1) return;
    origin_ = domain.min;
    const std::size_t listed = count();
    for (std::size_t i = 0; i < listed; ++i) images_.push_back({i, {}});
    for (std::size_t i = 0; i < listed; ++i)
        for (std::size_t which = 1; which < all; ++which) {
            Image image{i, {}};
            std::size_t rest = which;
            for (int a = 0; a < D; ++a)
                if (period_[a] > 0) image.periods[a] = rest % 3 == 2 ? -1 : static_cast<int>(rest % 3), rest /= 3;
            if (!solids_[i].motion.moves() && !reaches(domain, solids_[i], image.periods)) continue;
            images_.push_back(image);
            solids_.push_back(Solid<D>(solids_[i]));
        }
    poses_.resize(count()), balls_.resize(count()), middles_.resize(count());
}

template <int D>
bool Solids<D>::reaches(const Region<D>& domain, const Solid<D>& solid, const Index<D>& periods) const {
    Vec<D> middle = 0.5 * (domain.min + domain.max);
    for (int a = 0; a < D; ++a) middle[a] -= periods[a] * period_[a];
    return solid.shape->distance(middle) < solid.shape->steepest() * 0.5 * norm(domain.max - domain.min);
}

/// A solid is kept where the centre of its shape is in the domain, with its images relative to that.
template <int D>
Pose<D> Solids<D>::placed(const Image& image, real t) const {
    const Solid<D>& solid = solids_[image.of];
    Pose<D> pose = solid.motion.pose(t);
    const Vec<D> middle = pose.to_world(solid.shape->centre());
    for (int a = 0; a < D; ++a) {
        if (!(period_[a] > 0)) continue;
        const real left = solid.motion.moves() ? std::floor((middle[a] - origin_[a]) / period_[a]) : 0;
        if (const real shift = image.periods[a] - left; shift != 0) pose.offset[a] += shift * period_[a];
    }
    return pose;
}

template <int D>
void Solids<D>::add_free(ShapePtr<D> shape, bool no_slip, const Ball<D>& ball) {
    Solid<D> solid;
    solid.shape = std::move(shape);
    solid.no_slip = no_slip;
    solid.free = true;
    solids_.push_back(std::move(solid));
    poses_.emplace_back();
    balls_.push_back({ball.middle, ball.radius * (1 + 1e-12)});
    middles_.push_back(ball.middle);
}

template <int D>
void Solids<D>::place(std::size_t solid, const Pose<D>& pose) {
    poses_[solid] = pose;
    balls_[solid].middle = pose.to_world(middles_[solid]);
}

/// Lower bound of a ball's distance: that of its centre minus its radius.
template <int D>
bool Solids<D>::may_be_nearer(std::size_t solid, const Vec<D>& x, real than) const {
    const real reach = than + balls_[solid].radius;
    if (reach == infinity) return true;
    const Vec<D> r = x - balls_[solid].middle;
    return reach > 0 && dot(r, r) < reach * reach;
}

template <int D>
bool Solids<D>::moving() const {
    return std::any_of(solids_.begin(), solids_.end(), [](const Solid<D>& s) { return s.free || s.motion.moves(); });
}

template <int D>
void Solids<D>::set_time(real t) {
    for (std::size_t i = 0; i < solids_.size(); ++i)
        if (!solids_[i].free) poses_[i] = i < images_.size() ? placed(images_[i], t) : solids_[i].motion.pose(t);
}

template <int D>
real Solids<D>::distance(const Vec<D>& x) const {
    real d = infinity;
    for (std::size_t i = 0; i < solids_.size(); ++i)
        if (may_be_nearer(i, x, d)) d = std::min(d, distance(i, x));
    return d;
}

template <int D>
std::size_t Solids<D>::nearest(const Vec<D>& x) const {
    std::size_t best = 0;
    real d = infinity;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
        if (!may_be_nearer(i, x, d)) continue;
        if (const real di = distance(i, x); di < d) d = di, best = i;
    }
    return best;
}

template <int D>
Vec<D> Solids<D>::normal(const Vec<D>& x, real eps) const {
    return slope_of(x, eps, [&](const Vec<D>& y) { return distance(y); });
}

template <int D>
void Solids<D>::find_near(const Region<D>& where, real than, std::vector<std::size_t>& near) const {
    near.clear();
    const Vec<D> middle = 0.5 * (where.min + where.max);
    const real half = 0.5 * norm(where.max - where.min);
    for (std::size_t i = 0; i < solids_.size(); ++i) {
        const Ball<D>& ball = balls_[i];
        real least = 0;
        if (ball.radius < infinity) {
            Vec<D> away;
            for (int d = 0; d < D; ++d) away[d] = std::max({0.0, where.min[d] - ball.middle[d], ball.middle[d] - where.max[d]});
            least = norm(away) - ball.radius;
        } else {
            least = distance(i, middle) - solids_[i].shape->steepest() * half;
        }
        if (!(least >= than)) near.push_back(i);
    }
}

template <int D>
real Solids<D>::steepest(std::span<const std::size_t> of) const {
    real most = 1;
    for (const std::size_t i : of) most = std::max(most, solids_[i].shape->steepest());
    return most;
}

template <int D>
real Solids<D>::distance(const Vec<D>& x, std::span<const std::size_t> of, real most) const {
    real d = most;
    for (const std::size_t i : of)
        if (may_be_nearer(i, x, d)) d = std::min(d, distance(i, x));
    return d;
}

template <int D>
std::size_t Solids<D>::nearest(const Vec<D>& x, std::span<const std::size_t> of) const {
    if (of.size() == 1) return of.front();
    std::size_t best = 0;
    real d = infinity;
    for (const std::size_t i : of) {
        if (!may_be_nearer(i, x, d)) continue;
        if (const real di = distance(i, x); di < d) d = di, best = i;
    }
    return best;
}

template <int D>
Vec<D> Solids<D>::normal(const Vec<D>& x, real eps, std::span<const std::size_t> of) const {
    return slope_of(x, eps, [&](const Vec<D>& y) { return distance(y, of); });
}

namespace {
/// Moves x out of `distance` by `margin`, along `normal`: two Newton steps.
template <int D, class Distance, class Normal>
Vec<D> pushed_out(Vec<D> x, real margin, Distance&& distance, Normal&& normal) {
    for (int newton = 0; newton < 2; ++newton) {
        const real d = distance(x);
        if (d >= margin) break;
        x += (margin - d) * normal(x);
    }
    return x;
}
}  // namespace

template <int D>
Vec<D> Solids<D>::push_out(const Vec<D>& x, real margin, real eps) const {
    return pushed_out(
        x, margin, [&](const Vec<D>& y) { return distance(y); }, [&](const Vec<D>& y) { return normal(y, eps); });
}

template <int D>
Vec<D> Solids<D>::push_out(const Vec<D>& x, real margin, real eps, std::span<const std::size_t> of) const {
    return pushed_out(
        x, margin, [&](const Vec<D>& y) { return distance(y, of, margin); }, [&](const Vec<D>& y) { return normal(y, eps, of); });
}

real fraction_positive(real a, real b) {
    if (a >= 0 && b >= 0) return 1;
    if (a < 0 && b < 0) return 0;
    return a >= 0 ? a / (a - b) : b / (b - a);
}

namespace {

/// Area cut off a unit square at corner `at` by the zero crossings on its two edges; crossing_to(a, b) is measured from a.
real corner_area(const std::array<real, 4>& v, std::size_t at) {
    const real here = v[at], next = v[(at + 1) % 4], before = v[(at + 3) % 4];
    return 0.5 * (here / (here - next)) * (here / (here - before));
}

}  // namespace

real fraction_positive(const std::array<real, 4>& v) {
    std::array<bool, 4> in{};
    int count = 0;
    for (std::size_t i = 0; i < 4; ++i) count += in[i] = v[i] < 0;
    if (count == 0) return 1;
    if (count == 4) return 0;
    const auto find = [&](bool inside) { return static_cast<std::size_t>(std::find(in.begin(), in.end(), inside) - in.begin()); };
    if (count == 1) return 1 - corner_area(v, find(true));
    if (count == 3) return corner_area(v, find(false));
    if (in[0] == in[2]) {  // saddle: two opposite corners inside
        const bool middle_inside = v[0] + v[1] + v[2] + v[3] < 0;
        const std::size_t odd = in[0] == middle_inside ? 1 : 0;  // corners that are cut off separately
        const real cut = corner_area(v, odd) + corner_area(v, odd + 2);
        return middle_inside ? cut : 1 - cut;
    }
    std::size_t first = 0;  // inside corners are first and first + 1; the cut runs between the two edges across
    while (!(in[first] && in[(first + 1) % 4])) ++first;
    const real near = fraction_positive(v[first], v[(first + 3) % 4]), far = fraction_positive(v[(first + 1) % 4], v[(first + 2) % 4]);
    return 0.5 * (near + far);
}

template class Solids<2>;
template class Solids<3>;

}  // namespace weir::geometry
