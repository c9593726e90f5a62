#include "free_surface/start.hpp"

#include "scene/names.hpp"

namespace weir::free_surface {

namespace {

/// Returns whether the shape's boundary point closest to x is a contact with a wall or a solid: the liquid ends there, but not at air.
template <int D>
bool at_contact(const geometry::Shape<D>& liquid, const geometry::Solids<D>& solids, const Frame<D>& frame, const Vec<D>& x, real d) {
    const real h = frame.h_min(), eps = 1e-4 * h, touching = 1e-6 * h;  // round-off of a distance is far below both
    Vec<D> n;
    for (int a = 0; a < D; ++a)
        n[a] = (liquid.distance(x + eps * Vec<D>::unit(a)) - liquid.distance(x - eps * Vec<D>::unit(a))) / (2 * eps);
    const Vec<D> boundary = x - d * n;
    for (int a = 0; a < D; ++a) {
        if (frame.periodic(a)) continue;
        // on the ridge between two contacts the gradient points at neither: use the wall's own distance
        const real lower = x[a] - frame.origin[a], upper = frame.h[a] * frame.cells[a] - lower;
        if (n[a] < -0.3 && std::abs(lower + d) < touching) return true;
        if (n[a] > 0.3 && std::abs(upper + d) < touching) return true;
        if (std::abs(n[a]) < 0.99) continue;  // a boundary that meets the wall at an angle does not lie on it
        if (n[a] < 0 && boundary[a] < frame.origin[a] + touching) return true;
        if (n[a] > 0 && boundary[a] > frame.origin[a] + frame.h[a] * frame.cells[a] - touching) return true;
    }
    return !solids.empty() && solids.distance(boundary) < touching && dot(solids.normal(boundary, eps), n) < -0.99;
}

/// The point at which the initial liquid is sampled: the cell's centre. A centre inside or on a solid, with the liquid's boundary on that
/// solid's surface, is moved just outside it: liquid that touches a solid fills the cut cells.
template <int D>
Vec<D> sample_point(const geometry::Shape<D>& liquid, const geometry::Solids<D>& solids, const Frame<D>& frame, const Vec<D>& x, real d) {
    const real h = frame.h_min(), eps = 1e-4 * h, touching = 1e-6 * h;
    if (solids.empty() || solids.distance(x) >= touching) return x;
    Vec<D> boundary = x, outside = x;
    for (int a = 0; a < D; ++a)
        boundary[a] -= d * (liquid.distance(x + eps * Vec<D>::unit(a)) - liquid.distance(x - eps * Vec<D>::unit(a))) / (2 * eps);
    if (std::abs(solids.distance(boundary)) > touching) return x;
    for (int step = 0; step < 8 && solids.distance(outside) < touching;
         ++step)  // in a corner of several solids each moves it a part of the way
        outside = solids.push_out(outside, 1e-3 * h, eps);
    return outside;
}

}  // namespace

template <int D>
void start_level_set(const geometry::Shape<D>& liquid, const geometry::Solids<D>& solids, const Frame<D>& frame, LevelSet<D>& surface) {
    Grid<real, D> raw(frame.cells);
    Grid<std::uint8_t, D> known(frame.cells);
    for_each_held(raw, Index<D>{}, frame.cells, [&](const Index<D>& I) {
        Vec<D> x = frame.centre(I);
        raw(I) = liquid.distance(x);
        if (std::abs(raw(I)) < surface.cap()) {
            x = sample_point(liquid, solids, frame, x, raw(I));
            raw(I) = liquid.distance(x);
        }
        known(I) = std::abs(raw(I)) < surface.cap() && !at_contact(liquid, solids, frame, x, raw(I));
        surface.phi(I) = known(I) ? raw(I) : raw(I) < 0 ? -surface.cap() : surface.cap();
    });
    const auto beside_surface = [&](const Index<D>& I) {
        for (int d = 0; d < D; ++d)
            for (const int by : {-1, 1})
                if ((raw(frame.near(I, d, by)) < 0) != (raw(I) < 0)) return true;
        return false;
    };
    // beside a contact φ is extrapolated linearly from two cells further in: exact for planes; D passes reach the corners of a tank
    Grid<std::uint8_t, D> filled = known;
    for (int pass = 0; pass < D; ++pass) {
        for_each_cell(frame.cells, [&](const Index<D>& I) {
            if (known(I) || !beside_surface(I)) return;
            real sum = 0;
            int count = 0;
            for (int d = 0; d < D; ++d)
                for (const int by : {-1, 1}) {
                    Index<D> J = I, K = I;
                    if (!frame.step(J, d, by) || !(K = J, frame.step(K, d, by)) || !known(J) || !known(K)) continue;
                    const real continued = 2 * surface.phi(J) - surface.phi(K);
                    if ((continued < 0) != (raw(I) < 0)) continue;
                    sum += continued;
                    ++count;
                }
            if (count == 0) return;
            surface.phi(I) = sum / count;
            filled(I) = 1;
        });
        refresh(surface.phi, frame.periodic(D - 1), 2);
        refresh(filled, frame.periodic(D - 1), 2);
        known = filled;
    }
    for_each_cell(frame.cells, [&](const Index<D>& I) {
        if (!known(I) && beside_surface(I)) surface.phi(I) = raw(I);
    });
    surface.redistance();
}

template <int D>
void refuse_flat_cells(const scene::Scene& scene, const Frame<D>& frame) {
    const real ratio = frame.h_max() / frame.h_min();
    if (ratio > flattest_cell * (1 + 1e-9))
        scene.refuse("grid.cells", "cells are " + scene::number_text(ratio) + " in aspect ratio; water is stable up to " +
                                       scene::number_text(flattest_cell) + " times");
}

template <int D>
void refuse_no_volume(const scene::Scene& scene, const geometry::Shape<D>& liquid, const Frame<D>& frame) {
    const real inside = sum_over(frame.cells, [&](const Index<D>& I) { return liquid.contains(frame.centre(I)) ? 1.0 : 0.0; });
    if (inside > 0) scene.refuse("liquid", "all liquid lies inside solids");
    scene.refuse("liquid", "there is no liquid in the domain, or all of it is thinner than a cell");
}

scene::Variant volume_control() {
    return {"volume_control",
            "Corrects the volume of liquid by moving the surface, at most a fiftieth of a cell per step; the integral \"volume_shift\" "
            "records the displacement.",
            {}};
}

#define WEIR_INSTANTIATE(D)                                                                                              \
    template void start_level_set(const geometry::Shape<D>&, const geometry::Solids<D>&, const Frame<D>&, LevelSet<D>&); \
    template void refuse_flat_cells(const scene::Scene&, const Frame<D>&);                                               \
    template void refuse_no_volume(const scene::Scene&, const geometry::Shape<D>&, const Frame<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::free_surface
