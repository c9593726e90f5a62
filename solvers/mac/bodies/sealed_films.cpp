// Films between a body and a wall or another solid that are too thin for the grid: their cells are closed. What a body drives out of them
// escapes to the open cells around each film, in equal parts, and their pressure acts in it: a film leaves and enters freely. Otherwise a
// body that touches a wall would feel the pressure of one side alone, and in a closed tank that is known up to a constant only.
#include "mac/bodies/bodies_in_flow.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac {

using poisson::Cell;

namespace {

/// Sealed cells in their order, and those that a film has been made of.
struct SealedCells {
    std::vector<std::size_t> cells;
    std::vector<char> seen;
    /// Returns whether a cell is sealed and was not taken before.
    bool take(std::size_t cell) {
        const auto at = std::lower_bound(cells.begin(), cells.end(), cell);
        if (at == cells.end() || *at != cell) return false;
        char& was = seen[static_cast<std::size_t>(at - cells.begin())];
        return was ? false : (was = 1, true);
    }
};

/// Sealed cells that are connected, and the open cells around them.
struct Film {
    std::vector<std::size_t> cells, rim;
};

template <int D>
Film film_of(const MacState<D>& s, SealedCells& sealed, std::size_t first) {
    Film film{{first}, {}};
    for (std::size_t i = 0; i < film.cells.size(); ++i) {
        const Index<D> I = index_of<D>(s.extent(), film.cells[i]);
        for (int a = 0; a < D; ++a)
            for (const int way : {-1, 1}) {
                Index<D> J = I;
                J[a] += way;
                if (J[a] < 0 || J[a] >= s.u.cells[a]) continue;
                const std::size_t cell = s.cells.linear(J);
                if (s.cells[cell] == Cell::fluid) film.rim.push_back(cell);
                if (sealed.take(cell)) film.cells.push_back(cell);
            }
    }
    std::sort(film.rim.begin(), film.rim.end());
    film.rim.erase(std::unique(film.rim.begin(), film.rim.end()), film.rim.end());
    return film;
}

}  // namespace

/// Returns whether a closed cell lies between the body and something else: it has a face on a wall, or one that another solid closes.
template <int D>
bool BodiesInFlow<D>::is_sealed(const MacState<D>& s, const geometry::Solids<D>& solids, std::size_t own, const Index<D>& I) const {
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const Index<D> F = end == 0 ? I : I + e<D>(a);
            const bool on_side = F[a] == 0 || F[a] == s.u.cells[a];
            if (on_side && !s.sides.open(a, end)) return true;
            if (near_.size() > 1 && solids.nearest(s.u.face_centre(a, F), near_) != own) return true;
        }
    return false;
}

/// What solids other than bodies drive out of a closed cell [m^D/s].
template <int D>
real BodiesInFlow<D>::driven_by_solids(const MacState<D>& s, const geometry::Solids<D>& solids, const Index<D>& I) const {
    real sum = 0;
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const Index<D> F = end == 0 ? I : I + e<D>(a);
            const real v = s.solid.velocity[static_cast<std::size_t>(a)](F);
            const bool on_side = F[a] == 0 || F[a] == s.u.cells[a];
            if (v == 0 || on_side || solids.nearest(s.u.face_centre(a, F), near_) >= solids.count() - bodies_.count()) continue;
            sum += (end == 0 ? -1 : 1) * (1 - s.solid.open[static_cast<std::size_t>(a)](F)) * v * cell_ / h_[a];
        }
    return sum;
}

template <int D>
void BodiesInFlow<D>::open_films(const MacState<D>& s, const geometry::Solids<D>& solids, std::size_t body) {
    const auto before = [](const Sealed& x, std::size_t cell) { return x.cell < cell; };
    std::stable_sort(sealed_.begin(), sealed_.end(), [](const Sealed& x, const Sealed& y) { return x.cell < y.cell; });
    SealedCells sealed;
    for (const Sealed& x : sealed_)
        if (sealed.cells.empty() || sealed.cells.back() != x.cell) sealed.cells.push_back(x.cell);
    sealed.seen.assign(sealed.cells.size(), 0);
    for (const std::size_t first : sealed.cells) {
        if (!sealed.take(first)) continue;
        const Film film = film_of(s, sealed, first);
        rigid::Twist<D> out{};
        real by_solids = 0;
        for (const std::size_t cell : film.cells) {
            for (auto at = std::lower_bound(sealed_.begin(), sealed_.end(), cell, before); at != sealed_.end() && at->cell == cell; ++at)
                for (std::size_t k = 0; k < n; ++k) out[k] += at->out[k];
            by_solids += driven_by_solids(s, solids, index_of<D>(s.extent(), cell));
        }
        const auto parts = static_cast<real>(film.rim.size());
        for (const std::size_t cell : film.rim) {
            Cut& c = cut(cell, body);
            for (std::size_t k = 0; k < n; ++k) c.out[k] += out[k] / parts, c.out_of_films[k] += out[k] / parts;
            c.out_by_solids += by_solids / parts;
        }
    }
}

/// The divergence of the grid does not have what leaves films.
template <int D>
void BodiesInFlow<D>::add_films(const MacState<D>& s, real dt, Grid<real, D>& b) const {
    const real scale = h2_ * s.rho / (dt * cell_);
    for (std::size_t i = 0; i < bodies_.count(); ++i)
        for (const Cut& c : cuts_[i]) {
            if (c.out_by_solids != 0) b[c.cell] -= scale * c.out_by_solids;
            for (std::size_t k = 0; k < n; ++k)
                if (c.out_of_films[k] != 0) b[c.cell] -= scale * c.out_of_films[k] * bodies_[i].velocity[k];
        }
}

template <int D>
real BodiesInFlow<D>::flux_in_films() const {
    real sum = 0;
    for (std::size_t i = 0; i < bodies_.count(); ++i)
        for (const Cut& c : cuts_[i]) {
            sum += std::abs(c.out_by_solids);
            for (std::size_t k = 0; k < n; ++k) sum += std::abs(c.out_of_films[k] * bodies_[i].velocity[k]);
        }
    return sum;
}

#define WEIR_INSTANTIATE(D)                                                                                                       \
    template bool BodiesInFlow<D>::is_sealed(const MacState<D>&, const geometry::Solids<D>&, std::size_t, const Index<D>&) const; \
    template void BodiesInFlow<D>::open_films(const MacState<D>&, const geometry::Solids<D>&, std::size_t);                       \
    template void BodiesInFlow<D>::add_films(const MacState<D>&, real, Grid<real, D>&) const;                                     \
    template real BodiesInFlow<D>::flux_in_films() const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac
