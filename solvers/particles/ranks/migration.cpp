#include "particles/ranks/migration.hpp"

#include "core/error.hpp"

#include <limits>
#include <numeric>

namespace weir::particles {

namespace {

/// The cells of a point's periodic images, as made by Pairs.
struct Images {
    const Frame& frame;
    const CellSort& cells;
    std::array<real, 3> band{};  // 0: the axis is not periodic

    Images(const Frame& f, const CellSort& c, const Box& box, real radius) : frame(f), cells(c) {
        for (std::size_t a = 0; a < 3; ++a) band[a] = f.period[a] > 0 ? f.band(a, box, radius) : 0;
    }
    bool below(std::size_t a, real x) const { return band[a] > 0 && x < frame.lo[a] + band[a]; }
    bool above(std::size_t a, real x) const { return band[a] > 0 && x > frame.lo[a] + frame.period[a] - band[a]; }
    void list(const std::array<real, 3>& x, std::vector<int>& to) const {
        to.clear();
        std::array<std::array<real, 3>, 3> shifts{};
        std::array<int, 3> count{1, 1, 1};
        for (std::size_t a = 0; a < 3; ++a) {
            if (below(a, x[a])) shifts[a][static_cast<std::size_t>(count[a]++)] = frame.period[a];
            if (above(a, x[a])) shifts[a][static_cast<std::size_t>(count[a]++)] = -frame.period[a];
        }
        for (int k = 0; k < count[2]; ++k)
            for (int j = 0; j < count[1]; ++j)
                for (int i = 0; i < count[0]; ++i) {
                    if (i + j + k == 0) continue;
                    const std::array<int, 3> which{i, j, k};
                    std::array<real, 3> at = x;
                    for (std::size_t a = 0; a < 3; ++a)
                        if (which[a] > 0) at[a] += shifts[a][static_cast<std::size_t>(which[a])];
                    to.push_back(cells.cell_at(at));
                }
    }
};

}  // namespace

/// Reduces box and number of particles over all ranks.
void Migration::meet(const Coordinates& x, int count) {
    struct Own {
        Box box;
        int count;
        bool finite;
    } own{{}, count, true};
    own.box = cells_.box(x, count, own.finite);
    const std::vector<Own> all = of_ranks(own);
    box_ = {}, total_ = 0, counts_.clear();
    for (const Own& rank : all) {
        if (!rank.finite) throw NumericalFailure("position", "a particle's position is not finite");
        counts_.push_back(rank.count);
        if (rank.count == 0) continue;
        for (std::size_t a = 0; a < 3; ++a) {
            box_.lo[a] = total_ > 0 ? std::min(box_.lo[a], rank.box.lo[a]) : rank.box.lo[a];
            box_.hi[a] = total_ > 0 ? std::max(box_.hi[a], rank.box.hi[a]) : rank.box.hi[a];
        }
        total_ += rank.count;
    }
}

/// Finds the first cell of each rank such that lower cells contain the shares of all ranks before it. Its digits are found one after
/// another, the slowest axis first: from global counts per plane, then per row of that plane, then per cell of that row.
void Migration::choose_cut_points(const CellGrid& grid) {
    const auto cuts = static_cast<std::size_t>(communicator().ranks()) - 1;
    std::vector<int> chosen(cuts, 0), before(cuts, 0);  // leading digits, and number of particles in cells before them
    std::vector<std::array<real, 3>> points(cuts, grid.origin);
    int behind = grid.cells[0] * grid.cells[1] * grid.cells[2];  // cells with the same leading digits
    for (std::size_t a = 3; a-- > 0;) {
        const int digits = grid.cells[a], width = behind / digits;
        if (digits == 1) continue;
        std::vector<int> counts(cuts * static_cast<std::size_t>(digits), 0);
        for (const int c : cell_)
            for (std::size_t r = 0; r < cuts; ++r)
                if (c / behind == chosen[r]) ++counts[r * static_cast<std::size_t>(digits) + static_cast<std::size_t>(c / width % digits)];
        const std::vector<int> all = of_all_ranks(counts);
        for (std::size_t r = 0; r < cuts; ++r) {
            const auto target =
                static_cast<int>(static_cast<std::int64_t>(total_) * static_cast<std::int64_t>(r + 1) / communicator().ranks());
            int digit = 0;
            for (;; ++digit) {
                int here = 0;
                for (std::size_t q = 0; q <= cuts; ++q)
                    here += all[(q * cuts + r) * static_cast<std::size_t>(digits) + static_cast<std::size_t>(digit)];
                if (before[r] + here > target || digit + 1 == digits) break;
                before[r] += here;
            }
            chosen[r] = chosen[r] * digits + digit;
            points[r][a] += (digit + 0.5) / grid.per_cell;
        }
        behind = width;
    }
    cut_points_ = std::move(points);
}

void Migration::find_cut(const CellGrid& grid) {
    if (cut_points_.empty()) choose_cut_points(grid);
    std::vector<int> at{0};
    const int all = grid.cells[0] * grid.cells[1] * grid.cells[2];
    for (std::array<real, 3> point : cut_points_) {
        for (std::size_t a = 0; a < 3; ++a) point[a] = std::max(point[a], grid.origin[a]);  // the liquid may have left that region
        at.push_back(std::clamp(cells_.cell_at(point), at.back(), all));
    }
    at.push_back(all);
    cut_ = CellCut(std::move(at), grid.cells);
}

void Migration::find_holders(const Coordinates& x, int count, const Frame& frame, real radius) {
    const int self = communicator().rank();
    const Images images(frame, cells_, box_, radius);
    exchange_.clear();
    gone_.clear();
    int first = cut_.begin(self), last = cut_.end(self);  // own cells that no other rank reads
    for (int r = 0; r < cut_.ranks(); ++r) {
        if (r == self || cut_.begin(r) == cut_.end(r)) continue;
        if (r < self) first = std::max(first, cut_.end(r) + cut_.far);
        if (r > self) last = std::min(last, cut_.begin(r) - cut_.far);
    }
    for (int i = 0; i < count; ++i) {
        const int cell = cell_[static_cast<std::size_t>(i)];
        bool repeats = false;
        for (std::size_t a = 0; a < 3; ++a)
            repeats = repeats || (images.band[a] > 0 && (images.below(a, x[a][i]) || images.above(a, x[a][i])));
        if (cell >= first && cell < last && !repeats) continue;
        image_cells_.clear();
        if (repeats) images.list({x[0][i], x[1][i], x[2] ? x[2][i] : 0}, image_cells_);
        const int owner = cut_.owner(cell);
        if (owner != self) exchange_.migrate(owner, i), gone_.push_back(i);
        for (int r = 0; r < cut_.ranks(); ++r) {
            if (r == owner) continue;
            const auto read = [&](int c) { return cut_.reads(r, c); };
            if (read(cell) || std::any_of(image_cells_.begin(), image_cells_.end(), read)) exchange_.copy_as_ghost(r, i);
        }
    }
}

/// Moves the last particles to the entries of those that have left.
void Migration::rearrange(const ParticleExchange::Arrays& arrays, std::size_t read) {
    const std::size_t stay = arrays[0]->size() - gone_.size(), own = stay + static_cast<std::size_t>(exchange_.migrated()),
                      all = own + static_cast<std::size_t>(exchange_.ghosts());
    for (auto* array : arrays) {
        for (auto i = gone_.rbegin(); i != gone_.rend(); ++i) (*array)[static_cast<std::size_t>(*i)] = array->back(), array->pop_back();
        if (array->capacity() < all) array->reserve(all + all / 16);
        array->resize(all);
    }
    exchange_.unpack_migrated(arrays, stay);
    exchange_.unpack_ghosts(arrays, read, own);
    if (!communicator().poisons()) return;
    for (std::size_t a = read; a < arrays.size(); ++a)
        std::fill(arrays[a]->begin() + static_cast<std::ptrdiff_t>(own), arrays[a]->end(), std::numeric_limits<real>::quiet_NaN());
}

void Migration::apply(const Frame& frame, real radius, int dim, const ParticleExchange::Arrays& arrays, std::size_t read) {
    Coordinates x{nullptr, nullptr, nullptr};
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) x[a] = arrays[a]->data();
    const int count = static_cast<int>(arrays[0]->size());
    meet(x, count);
    const CellGrid grid = frame.cover(box_, total_, radius);
    cells_.cover(grid);
    cells_.list_cells(x, count, cell_);
    find_cut(grid);
    find_holders(x, count, frame, radius);
    exchange_.run(arrays, read);
    rearrange(arrays, read);
    for (int r = 0; r < cut_.ranks(); ++r) counts_[static_cast<std::size_t>(r)] += exchange_.gain(r);
}

int Migration::before() const { return std::accumulate(counts_.begin(), counts_.begin() + communicator().rank(), 0); }

void Migration::balance(real most) {
    constexpr real few = 32;  // particles: fewer cost less than a message
    for (const int count : counts_)
        if (count > (1 + most) * total_ / static_cast<real>(counts_.size()) + few) recut();
}

std::size_t Migration::bytes() const { return cells_.bytes() + cell_.capacity() * sizeof(int) + exchange_.bytes(); }

}  // namespace weir::particles
