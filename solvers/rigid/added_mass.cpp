#include "rigid/added_mass.hpp"

#include <cmath>

namespace weir::rigid {

namespace {

/// A pair whose mass differs from the initial estimate by more than this factor is rejected: it reflects a neighbour or the pressure's
/// tolerance.
constexpr real credible = 8;

/// Part of the learned mass that is forgotten per step: old pairs belong to other positions, and many slightly inconsistent pairs would
/// make the mass singular.
constexpr real forgotten = 0.1;

}  // namespace

/// Elimination without pivoting, sufficient for a positive definite matrix.
template <int D>
Block<D> inverse_of(Block<D> m, const char* free) {
    constexpr std::size_t n = freedoms<D>;
    Block<D> inverse{};
    for (std::size_t k = 0; k < n; ++k) inverse[k][k] = free[k] ? 1 : 0;
    for (std::size_t k = 0; k < n; ++k) {
        if (!free[k]) continue;
        const real pivot = 1 / m[k][k];
        for (std::size_t l = 0; l < n; ++l) m[k][l] *= pivot, inverse[k][l] *= pivot;
        for (std::size_t i = 0; i < n; ++i) {
            if (i == k || !free[i]) continue;
            const real factor = m[i][k];
            for (std::size_t l = 0; l < n; ++l) m[i][l] -= factor * m[k][l], inverse[i][l] -= factor * inverse[k][l];
        }
    }
    for (std::size_t k = 0; k < n; ++k)  // removes the asymmetry of round-off
        for (std::size_t l = 0; l < k; ++l) inverse[k][l] = inverse[l][k] = 0.5 * (inverse[k][l] + inverse[l][k]);
    return inverse;
}

template <int D>
void AddedMass<D>::see(std::size_t body, const Block<D>& guess) {
    Known& known = known_[body];
    const bool was_wet = known.wet;
    known.wet = false;
    for (std::size_t k = 0; k < n; ++k) {
        known.scale[k] = std::sqrt(guess[k][k]);
        known.wet = known.wet || known.scale[k] > 0;
    }
    known.mass = guess;
    for (std::size_t k = 0; was_wet && k < n; ++k)
        for (std::size_t l = 0; l < n; ++l)
            known.mass[k][l] = (1 - forgotten) * known.share[k][l] * known.scale[k] * known.scale[l] + forgotten * guess[k][l];
    keep(known);
}

/// Stores the mass in units of the initial estimate. Entries of velocities without effect on the wet surface stay zero.
template <int D>
void AddedMass<D>::keep(Known& known) {
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t l = 0; l < n; ++l) {
            const real unit = known.scale[k] * known.scale[l];
            known.share[k][l] = unit > 0 ? known.mass[k][l] / unit : k == l ? 1 : 0;
        }
}

template <int D>
void AddedMass<D>::begin(const std::vector<Block<D>>& masses, const std::vector<char>& free, Mobility& mobility) const {
    mobility.resize(n * known_.size());
    for (std::size_t b = 0; b < known_.size(); ++b) {
        Block<D> whole = masses[b];
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) whole[k][l] += known_[b].mass[k][l];
        const Block<D> inverse = inverse_of<D>(whole, free.data() + b * n);
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) mobility(b * n + k, b * n + l) = inverse[k][l];
    }
}

/// m += y yᵀ/(y·s) − (m s)(m s)ᵀ/(s·m s).
template <int D>
void AddedMass<D>::improve(Known& known, const real* change, const real* impulse) {
    if (!known.wet) return;
    Twist<D> met{};
    real sy = 0, sms = 0, ss = 0, yy = 0;  // ss, yy: in units of the initial estimate
    for (std::size_t k = 0; k < n; ++k) {
        if (known.scale[k] == 0) continue;
        for (std::size_t l = 0; l < n; ++l) met[k] += known.mass[k][l] * change[l];
        const real s = change[k] * known.scale[k], y = impulse[k] / known.scale[k];
        sms += change[k] * met[k], ss += s * s, sy += s * y, yy += y * y;
    }
    if (!(sms > ss / (credible * credible)) || !(sy > ss / credible) || !(yy < sy * credible)) return;
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t l = 0; l < n; ++l) known.mass[k][l] += impulse[k] * impulse[l] / sy - met[k] * met[l] / sms;
    keep(known);
}

/// Update of the inverse H of the total mass, of all bodies together: H += ρ (1 + ρ y·Hy) s sᵀ − ρ (s (Hy)ᵀ + Hy sᵀ), ρ = 1/(y·s).
template <int D>
void AddedMass<D>::learn(const std::vector<real>& change, const std::vector<real>& impulse, const std::vector<Block<D>>& masses,
                         const std::vector<char>& free, Mobility& mobility) {
    const std::size_t size = change.size();
    seen_.assign(size, 0.0), answer_.assign(size, 0.0);
    real sy = 0, yHy = 0, added = 0;
    for (std::size_t i = 0; i < size; ++i) {
        if (!free[i]) continue;
        seen_[i] = impulse[i];
        for (std::size_t l = 0; l < n; ++l) seen_[i] += masses[i / n][i % n][l] * change[i / n * n + l];
        sy += seen_[i] * change[i], added += impulse[i] * change[i];
    }
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) answer_[i] += mobility(i, j) * seen_[j];
        yHy += seen_[i] * answer_[i];
    }
    if (added > 0 && yHy < credible * sy) {
        const real rho = 1 / sy, twice = rho * (1 + rho * yHy);
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t j = 0; j < size; ++j)
                mobility(i, j) += twice * change[i] * change[j] - rho * (change[i] * answer_[j] + answer_[i] * change[j]);
    }
    for (std::size_t b = 0; b < known_.size(); ++b) improve(known_[b], change.data() + b * n, impulse.data() + b * n);
}

template <int D>
void AddedMass<D>::learn(const Mobility& exact) {
    for (std::size_t b = 0; b < known_.size(); ++b) {
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) known_[b].mass[k][l] = exact(b * n + k, b * n + l);
        keep(known_[b]);
    }
}

template <int D>
void AddedMass<D>::save(Checkpoint& to, const std::string& name) const {
    std::vector<real> all;
    for (const Known& known : known_) {
        all.push_back(known.wet ? 1 : 0);
        for (const auto& row : known.share) all.insert(all.end(), row.begin(), row.end());
    }
    to.put(name, all);
}

template <int D>
void AddedMass<D>::restore(const Checkpoint& from, const std::string& name) {
    std::vector<real> all(known_.size() * (1 + n * n));
    from.get(name, std::span<real>(all));
    const real* at = all.data();
    for (Known& known : known_) {
        known.wet = *at++ != 0;
        for (auto& row : known.share)
            for (real& entry : row) entry = *at++;
    }
}

template Block<2> inverse_of<2>(Block<2>, const char*);
template Block<3> inverse_of<3>(Block<3>, const char*);
template class AddedMass<2>;
template class AddedMass<3>;

}  // namespace weir::rigid
