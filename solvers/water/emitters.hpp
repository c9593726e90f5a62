// Emitters of liquid: regions with a prescribed velocity, like an inflow. The pressure solve treats them as nozzles: a flux of area times
// speed through the front faces, and closed faces behind and beside. So the surrounding liquid is neither sucked in nor pushed aside.
#pragma once
#include "free_surface/frame.hpp"
#include "geometry/shape.hpp"

#include <array>
#include <vector>

namespace weir::water {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

template <int D>
struct Emitter {
    /// A face of a cell that the emitter covers, by its linear index.
    struct Face {
        std::size_t at;
        real moves;  // velocity component of the liquid inside [m/s]
        real emits;  // the part of it that is a flux for the pressure solve [m/s]
    };
    geometry::ShapePtr<D> shape;
    Vec<D> velocity{};
    real start = 0, end = infinity;
    Index<D> lo{}, hi{};             // bounds of the cells that it may cover
    std::vector<std::size_t> cells;  // that it covers, partly or wholly
    std::array<std::vector<Face>, D> faces;

    /// Returns whether it is open at any time of a step from `from` to `to`.
    bool works(real from, real to) const { return from < end && to > start; }
    /// Finds the cells and faces once: emitters do not move.
    void place(const Frame<D>& frame);
    std::size_t bytes() const {
        std::size_t total = cells.capacity() * sizeof(std::size_t);
        for (const auto& list : faces) total += list.capacity() * sizeof(Face);
        return total;
    }
};

}  // namespace weir::water
