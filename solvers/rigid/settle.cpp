// Where sweeps over the rows crawl, as they do where light bodies carry heavy ones: Newton's method on the rows themselves (Alart & Curnier
// 1991). Which impulses stand at their limits is guessed from impulses and velocities as they are, the others follow from one system of
// linear equations, and the guess is made anew (primal-dual active sets: Hintermüller, Ito & Kunisch 2002). As Newton's method may go
// astray, it begins where sweeps have come to (Silcowitz-Hansen, Niebe & Erleben 2010, "Projected Gauss-Seidel subspace minimization").
#include "rigid/rows.hpp"

#include <algorithm>
#include <cmath>

namespace weir::rigid {

namespace {

/// Guesses that may fail to be better than the ones before. Systems of more rows are left to sweeps, and so is what takes more work: the
/// sum of the cubes of their rows.
constexpr int tries = 12;
constexpr std::size_t largest = 600;
constexpr double most_work = 1e8;

/// Friction has answers that hold themselves, of impulses as large as one likes: bodies that jam. What needs impulses so many times
/// stronger than those that sweeps have come to is taken for one of them: with ten times, a box among particles was thrown out of its tank.
constexpr real most_stronger = 2;

/// What holds an impulse back from a change that costs nothing, as a part of the row's response: four feet hold a table, of which three
/// say it all. What has been found does not depend on it.
constexpr real held_back = 1e-6;

/// x = A⁻¹ x by elimination with partial pivoting; false where there is none.
bool eliminate(std::vector<real>& A, std::vector<real>& x) {
    const std::size_t n = x.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (std::abs(A[i * n + k]) > std::abs(A[pivot * n + k])) pivot = i;
        if (!(std::abs(A[pivot * n + k]) > 0)) return false;
        if (pivot != k) {
            std::swap_ranges(A.begin() + static_cast<std::ptrdiff_t>(k * n), A.begin() + static_cast<std::ptrdiff_t>((k + 1) * n),
                             A.begin() + static_cast<std::ptrdiff_t>(pivot * n));
            std::swap(x[k], x[pivot]);
        }
        const real* from = A.data() + k * n;
        for (std::size_t i = k + 1; i < n; ++i) {
            real* to = A.data() + i * n;
            if (to[k] == 0) continue;
            const real factor = to[k] / from[k];
            for (std::size_t j = k + 1; j < n; ++j) to[j] -= factor * from[j];
            x[i] -= factor * x[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) x[k] -= A[k * n + j] * x[j];
        x[k] /= A[k * n + k];
    }
    return true;
}

}  // namespace

/// The largest change of a row's velocity that its impulse makes.
template <int D>
real Rows<D>::strongest(const std::vector<real>& impulses) const {
    real most = 0;
    for (std::size_t i = 0; i < list_.size(); ++i) most = std::max(most, std::abs(impulses[i]) * list_[i].response);
    return most;
}

/// The impulse that would bring the row where it is to be, all others as they are and no limit.
template <int D>
real Rows<D>::wanted(std::size_t i, const std::vector<real>& velocities) const {
    const Row<D>& row = list_[i];
    return impulse_[i] + (row.target - relative(row, velocities) - row.softness * impulse_[i]) / (row.response + row.softness);
}

/// The change of the row's velocity that its impulse still wants.
template <int D>
real Rows<D>::unrest(std::size_t i, const std::vector<real>& velocities) const {
    const Row<D>& row = list_[i];
    return row.response > 0 ? std::abs(limited(row, wanted(i, velocities)) - impulse_[i]) * row.response : 0;
}

template <int D>
real Rows<D>::unrest(const std::vector<real>& velocities) const {
    real most = 0;
    for (std::size_t i = 0; i < list_.size(); ++i) most = std::max(most, unrest(i, velocities));
    return most;
}

template <int D>
void Rows<D>::follow_impulses(std::vector<real>& velocities) const {
    velocities = free_;
    for (std::size_t i = 0; i < list_.size(); ++i)
        if (impulse_[i] != given_[i]) push(i, impulse_[i] - given_[i], velocities);
}

/// Of a row: does it reach its target, or is its impulse at a limit, of friction in proportion to what presses?
template <int D>
void Rows<D>::guess(std::size_t i, const std::vector<real>& velocities) {
    const Row<D>& row = list_[i];
    const real all = wanted(i, velocities);
    const bool reaches = row.response > 0 && limited(row, all) == all;
    state_[i] = reaches ? State::reaches : State::held;
    share_[i] = reaches || row.limit != Limit::rubs || !(row.response > 0) ? 0 : all < 0 ? -row.friction : row.friction;
}

/// Impulses at their limits, and the rows of the others.
template <int D>
void Rows<D>::hold(std::vector<real>& velocities) {
    solved_.clear();
    for (std::size_t i = 0; i < list_.size(); ++i) {
        if (state_[i] == State::reaches)
            solved_.push_back(i);
        else
            impulse_[i] = share_[i] == 0 ? 0 : share_[i] * std::max(0.0, impulse_[list_[i].normal]);
    }
    follow_impulses(velocities);
}

/// Newton's step for the rows that reach their targets. False: there is none.
template <int D>
bool Rows<D>::reach_targets(std::vector<real>& velocities) {
    constexpr std::size_t n = freedoms<D>;
    const std::size_t size = solved_.size();
    matrix_.assign(size * size, 0.0), rest_.resize(size), moved_.resize(size_);
    for (std::size_t c = 0; c < size; ++c) {
        const std::size_t j = solved_[c];
        std::copy_n(responses_.begin() + static_cast<std::ptrdiff_t>(j * size_), size_, moved_.begin());
        for (std::size_t k = j + 1; k < list_.size() && list_[k].limit == Limit::rubs && list_[k].normal == j; ++k)
            for (std::size_t v = 0; v < size_ && share_[k] != 0; ++v) moved_[v] += share_[k] * responses_[k * size_ + v];
        for (std::size_t r = 0; r < size; ++r) {
            const Row<D>& row = list_[solved_[r]];
            real sum = 0;
            for (std::size_t d = 0; d < n; ++d) {
                sum += row.sees[d] * moved_[row.body * n + d];
                if (row.other >= 0) sum += row.sees[n + d] * moved_[static_cast<std::size_t>(row.other) * n + d];
            }
            matrix_[r * size + c] = sum;
        }
        const Row<D>& row = list_[j];
        matrix_[c * size + c] += row.softness + held_back * row.response;
        rest_[c] = row.target - relative(row, velocities) - row.softness * impulse_[j];
    }
    if (!eliminate(matrix_, rest_)) return false;
    for (std::size_t c = 0; c < size; ++c) impulse_[solved_[c]] += rest_[c];
    for (std::size_t i = 0; i < list_.size(); ++i)
        if (share_[i] != 0) impulse_[i] = share_[i] * std::max(0.0, impulse_[list_[i].normal]);
    follow_impulses(velocities);
    return true;
}

/// From where the sweeps are; ends where no impulse wants a change, or where guesses do not become better.
template <int D>
bool Rows<D>::settle(std::vector<real>& velocities, real enough) {
    const real before = unrest(velocities);
    kept_ = impulse_, state_.resize(list_.size()), share_.resize(list_.size());
    for (std::size_t i = 0; i < list_.size(); ++i) guess(i, velocities);
    std::size_t fewest = list_.size() + 1;
    int patient = tries;
    for (double work = 0; work < most_work;) {
        hold(velocities);
        const auto size = static_cast<double>(solved_.size());
        work += size * size * size;
        if (solved_.size() > largest || !reach_targets(velocities)) break;
        wrong_.clear();
        for (std::size_t i = 0; i < list_.size(); ++i)
            if (!(unrest(i, velocities) <= enough)) wrong_.push_back(i);
        if (wrong_.empty()) {
            if (strongest(impulse_) <= most_stronger * strongest(kept_)) return true;
            break;
        }
        if (wrong_.size() < fewest)
            fewest = wrong_.size(), patient = tries;
        else if (--patient < 0)
            break;
        for (const std::size_t i : wrong_) guess(i, velocities);
    }
    for (std::size_t i = 0; i < list_.size(); ++i) impulse_[i] = limited(list_[i], impulse_[i]);
    follow_impulses(velocities);
    if (unrest(velocities) < before) return false;
    impulse_ = kept_;
    follow_impulses(velocities);
    return false;
}

template bool Rows<2>::settle(std::vector<real>&, real);
template bool Rows<3>::settle(std::vector<real>&, real);
template void Rows<2>::follow_impulses(std::vector<real>&) const;
template void Rows<3>::follow_impulses(std::vector<real>&) const;

}  // namespace weir::rigid
