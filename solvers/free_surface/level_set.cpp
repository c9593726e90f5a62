// The level set between its steps: construction, particle correction, volume control, checkpoints.
#include "free_surface/level_set.hpp"

#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "free_surface/marker_lanes.hpp"
#include "parallel/plane_checkpoint.hpp"

#include <cstring>

namespace weir::free_surface {

/// Relative to a cell's width: a marker closer to the surface may be on either side of it.
constexpr real sure_side = 0.1;

template <int D>
LevelSet<D>::LevelSet(const Frame<D>& frame, int reach)
    : phi(frame.cells),
      frame_(frame),
      layers_(reach + 4),
      reach_(reach),
      diagonal_(norm(frame.h)),
      layer_(frame.cells),
      inside_(frame.cells) {
    phi.fill(cap());
    layer_start_.assign(static_cast<std::size_t>(layers_) + 1, 0);
}

template <int D>
void LevelSet<D>::find_own() {
    if (!frame_.own().distributed()) return;
    own_.clear();
    for (std::size_t i = 0; i < band_.size(); ++i)
        if (frame_.own().contains(band_[i][D - 1])) own_.push_back(static_cast<int>(i));
}

template <int D>
bool LevelSet<D>::look(const Index<D>& I, int reach, Around<D>& to) const {
    if (!sees_walls(I)) return false;
    walls_.look(closed_, phi, I, reach, to);
    return true;
}

template <int D>
real LevelSet<D>::at(const Vec<D>& x) const {
    const Index<D> I = frame_.cell_of(x);
    Around<D> around;
    if (!look(I, 1, around)) return sample_cells(phi, Stencil<D>(frame_, x));
    Vec<D> d = x - frame_.centre(I);
    for (int a = 0; a < D; ++a) d[a] = std::clamp<real>(d[a] * frame_.inv_h[a], -1, 1);
    return around.linear(d);
}

template <int D>
bool LevelSet<D>::passes(const Index<D>& I, int axis, int by) const {
    Index<D> J = I;
    return sees_walls(I) ? walls_.passes(closed_, I, axis, by, J) : frame_.step(J, axis, by);
}

template <int D>
std::size_t LevelSet<D>::correct_with_particles(const Markers<D>& markers, const Grid<real, D>* part) {
    const real h = frame_.h_min();
    const real radius = (D == 2 ? 0.28 : 0.31) * h;  // sphere of a marker's volume: (V_marker / V_unit sphere)^(1/D) at 2^D per cell
    const real margin = sure_side * h;               // Enright et al. 2002: closer to the surface the side is uncertain
    refill_scratch<std::uint8_t>(escaped_, markers.count(), 0);
    const auto [first, last] = markers.own(frame_);
    const auto find_escaped = [&](const Index<D>& I, std::size_t begin, std::size_t end) {
        if (phi(I) < -diagonal_ || walls_.is_between(I)) return;  // inside a wall a marker has no side
        CellNodes<D> nodes;
        Around<D> around;
        if (look(I, 1, around))
            nodes.look_at(around);
        else
            nodes.look_at(phi, frame_, I);
        for (std::size_t p = begin; p < end; p += marker_lanes) {
            const int count = static_cast<int>(std::min<std::size_t>(marker_lanes, end - p));
            const Hats<D, false> hats(from_centre(frame_, I, load_positions(markers, p, count)));
            const Lanes distance = nodes.template at<-1>(hats);
            for (int l = 0; l < count; ++l) escaped_[p + static_cast<std::size_t>(l)] = distance[l] > margin;
        }
    };
    markers.for_each_held_cell(frame_, find_escaped);  // the spheres of ghost markers reach this rank's cells
    if (!frame_.cubic()) for_each_escaped([&](std::size_t p) { escaped_[p] = escaped_across(markers.position(p)); });
    std::size_t count = 0;
    for_each_escaped([&, begin = first, end = last](std::size_t p) {
        if (p >= begin && p < end) ++count;
        if (part && (*part)(frame_.cell_of(markers.position(p))) < 0.5 / Markers<D>::per_cell) return;
        join_sphere(markers.position(p), radius);
    });
    return count;
}

/// f(p) for each escaped marker, in order.
template <int D>
template <class F>
void LevelSet<D>::for_each_escaped(F&& f) const {
    const std::uint8_t *first = escaped_.data(), *end = first + escaped_.size();
    for (auto* at = first; at < end; ++at) {
        at = static_cast<const std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)));
        if (!at) return;
        f(static_cast<std::size_t>(at - first));
    }
}

template <int D>
std::size_t LevelSet<D>::count_airborne(const Markers<D>& markers) const {
    std::size_t count = 0;
    const auto [first, last] = markers.own(frame_);
    for_each_escaped([&, begin = first, end = last](std::size_t p) {
        if (p >= begin && p < end) count += at(markers.position(p)) > 0;
    });
    return count;
}

template <int D>
bool LevelSet<D>::escaped_across(const Vec<D>& x) const {
    return at(x) > sure_side * width_at(frame_.cell_of(x));
}

template <int D>
void LevelSet<D>::join_sphere(const Vec<D>& x, real radius) {
    const Index<D> I = frame_.cell_of(x);
    Around<D> around;
    const bool beside_wall = look(I, 1, around);
    for (int corner = 0; corner < (D == 2 ? 9 : 27); ++corner) {
        Index<D> J = I, unwrapped = I;
        bool inside = !beside_wall || around.reached[static_cast<std::size_t>(corner)] != 0;
        for (int d = 0, rest = corner; d < D; ++d, rest /= 3) {
            const int by = rest % 3 - 1;
            unwrapped[d] += by;
            inside &= by == 0 || frame_.step(J, d, by);
        }
        if (inside) phi(J) = std::min(phi(J), norm(frame_.centre(unwrapped) - x) - radius);
    }
}

template <int D>
void LevelSet<D>::dilate(real shift) {
    parallel_for(0, static_cast<int>(band_.size()), [&](int i) {
        const Index<D>& I = band_[static_cast<std::size_t>(i)];
        if (phi.store().holds(I[D - 1])) phi(I) -= shift;
    });
}

template <int D>
real LevelSet<D>::regain(real missing) {
    const real surface = area();
    if (surface == 0) return 0;
    const real most = 0.02 * frame_.h_min(), shift = std::clamp(missing / surface, -most, most);
    dilate(shift);
    return shift;
}

/// With the layers: the set of cells in the band is part of the state; their order follows from the cells beside the surface.
template <int D>
void LevelSet<D>::save(Checkpoint& to) const {
    put_planes(to, "surface.phi", phi);
    put_planes(to, "surface.layer", layer_);
}

template <int D>
void LevelSet<D>::restore(const Checkpoint& from) {
    get_planes(from, "surface.phi", phi);
    get_planes(from, "surface.layer", layer_);
    find_near();
    refresh(phi, frame_.periodic(D - 1), layers_);
    refresh(layer_, frame_.periodic(D - 1), wide());
    collect_surface();
    const auto plane = static_cast<std::size_t>(layer_.stride(D - 1));
    for (std::size_t i = 0; i < layer_.size(); ++i)
        if (is_near(static_cast<int>(i / plane)) && layer_[i] > 1) layer_[i] = 0;  // join_layers() finds them again
    join_layers();
    find_inside();
}

template <int D>
std::size_t LevelSet<D>::bytes() const {
    return phi.bytes() + layer_.bytes() + inside_.bytes() + closed_.bytes() + skin_of_ranks_.bytes() + walls_.bytes() + open_part_.bytes() +
           (band_.capacity() + skin_.capacity()) * sizeof(Index<D>) + value_.capacity() * sizeof(real) + escaped_.capacity() +
           own_.capacity() * sizeof(int);
}

template class LevelSet<2>;
template class LevelSet<3>;

}  // namespace weir::free_surface
