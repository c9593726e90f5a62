// Emitters of liquid: regions whose velocity is prescribed, as that of an inflow is. The pressure sees a nozzle: through the faces in
// front, area times speed flows out; behind and beside them it is closed, so that what surrounds it is neither sucked in nor pushed aside.
#pragma once
#include "geometry/shape.hpp"
#include "surface/frame.hpp"

#include <array>
#include <vector>

namespace weir::water {

using namespace surface;  // the words of the grid and of its free surface are the solver's own

template <int D>
struct Emitter {
    /// A face of a cell that the emitter covers, by its place in memory.
    struct Face {
        std::size_t at;
        real moves;  // velocity component with which liquid inside moves [m/s]
        real pours;  // that part of it which the pressure sees flow through the face [m/s]
    };
    geometry::ShapePtr<D> shape;
    Vec<D> velocity{};
    real start = 0, end = infinity;
    Index<D> lo{}, hi{};             // the cells that it can reach
    std::vector<std::size_t> cells;  // that it covers, in part or whole
    std::array<std::vector<Face>, D> faces;

    /// Whether it pours at some time of a step from `from` to `to`.
    bool works(real from, real to) const { return from < end && to > start; }
    /// Finds the cells and faces: emitters do not move.
    void place(const Frame<D>& frame);
    std::size_t bytes() const {
        std::size_t total = cells.capacity() * sizeof(std::size_t);
        for (const auto& list : faces) total += list.capacity() * sizeof(Face);
        return total;
    }
};

}  // namespace weir::water
