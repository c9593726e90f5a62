#include "water/viscosity.hpp"

#include "core/parallel.hpp"
#include "linear/conjugate_gradients.hpp"

#include <numeric>

namespace weir::water {

static constexpr int max_iterations = 1000;

template <int D>
SurfaceViscosity<D>::SurfaceViscosity(const Frame<D>& frame, const MacState<D>& state, real theta, bool solids_stick)
    : frame_(frame), sides_(&state.sides), least_theta_(theta), theta_(theta), solids_stick_(solids_stick), cell_(frame.cells) {
    for (int a = 0; a < D; ++a)
        for (Faces* faces : {&mass_, &x_, &r_, &p_, &ap_, &diagonal_, &with_pressure_})
            (*faces)[static_cast<std::size_t>(a)] = Grid<real, D>(state.u[a].extent());
    reserve_unknowns();
    for (int a = 0; a < D; ++a)
        for (int b = a + 1; b < D; ++b) edge_[static_cast<std::size_t>(a + b - 1)] = Grid<real, D>(frame.cells + e<D>(a) + e<D>(b));
}

/// ∂_b u_a + ∂_a u_b at the edge on the lower sides of cell I along a and b.
template <int D>
real SurfaceViscosity<D>::shear(const Faces& u, int a, int b, const Index<D>& I, real fixed) const {
    real sum = 0;
    for (const auto& [c, across] : {std::pair{a, b}, std::pair{b, a}}) {
        const auto& face = u[static_cast<std::size_t>(c)];
        Index<D> lower = I, upper = I;
        if (frame_.periodic(c)) lower[c] = upper[c] = I[c] % frame_.cells[c];
        const int n = frame_.cells[across];
        if (frame_.periodic(across)) {
            lower[across] = (I[across] + n - 1) % n, upper[across] = I[across] % n;
            sum += (face(upper) - face(lower)) * frame_.inv_h[across];
        } else if (I[across] == 0) {
            sum += 2 * (face(upper) - fixed * sides_->side(across, 0).velocity[c]) * frame_.inv_h[across];
        } else if (I[across] == n) {
            --lower[across];
            sum += 2 * (fixed * sides_->side(across, 1).velocity[c] - face(lower)) * frame_.inv_h[across];
        } else {
            --lower[across];
            sum += (face(upper) - face(lower)) * frame_.inv_h[across];
        }
    }
    return sum;
}

/// Returns whether the stress stencil of a face lies inside the domain, and does not include the copy of the first face on a periodic axis.
template <int D>
bool SurfaceViscosity<D>::is_inner(int a, const Index<D>& I) const {
    bool inner = true;
    for (int d = 0; d < D; ++d) inner &= I[d] >= 1 && I[d] < frame_.cells[d] - (d == a && !frame_.periodic(d) ? 0 : 1);
    return inner;
}

namespace {
/// Stride of a grid along axis d.
template <int D>
std::ptrdiff_t stride(const Grid<real, D>& grid, int d) {
    std::ptrdiff_t step = 1;
    for (int c = 0; c < d; ++c) step *= grid.extent()[c];
    return step;
}
template <int D>
const real* entry(const Grid<real, D>& grid, const Index<D>& I) {
    return grid.data() + grid.linear(I);
}
}  // namespace

/// stress_divergence where is_inner: the same sums with constant strides.
template <int D>
real SurfaceViscosity<D>::inner_stress_divergence(const Faces& u, int a, const Index<D>& I) const {
    const auto& grid = u[static_cast<std::size_t>(a)];
    const real *ua = entry(grid, I), *cell = entry(cell_, I);
    const std::ptrdiff_t along = stride(grid, a);
    real sum = 2 * frame_.inv_h[a] * frame_.inv_h[a] * (cell[-stride(cell_, a)] * (*ua - ua[-along]) - *cell * (ua[along] - *ua));
    for (int b = 0; b < D; ++b) {
        if (b == a) continue;
        const auto& weights = edge(std::min(a, b), std::max(a, b));
        const auto& other = u[static_cast<std::size_t>(b)];
        const real *lower_weight = entry(weights, I), *ub = entry(other, I), *ub_next = ub + stride(other, b);
        const std::ptrdiff_t across = stride(grid, b), back = stride(other, a);
        const real lower = (*ua - ua[-across]) * frame_.inv_h[b] + (*ub - ub[-back]) * frame_.inv_h[a];
        const real upper = (ua[across] - *ua) * frame_.inv_h[b] + (*ub_next - ub_next[-back]) * frame_.inv_h[a];
        sum += *lower_weight * lower * frame_.inv_h[b];
        sum -= lower_weight[stride(weights, b)] * upper * frame_.inv_h[b];
    }
    return sum;
}

template <int D>
real SurfaceViscosity<D>::stress_divergence(const Faces& u, int a, const Index<D>& I, real fixed) const {
    if (is_inner(a, I)) return inner_stress_divergence(u, a, I);
    const auto& ua = u[static_cast<std::size_t>(a)];
    const Index<D> below = frame_.near(I, a, -1), above = frame_.near(I, a, 0);
    Index<D> next = I + e<D>(a);
    if (frame_.periodic(a) && next[a] == frame_.cells[a]) next[a] = 0;
    real sum = 2 * frame_.inv_h[a] * frame_.inv_h[a] * (cell_(below) * (ua(I) - ua(below)) - cell_(above) * (ua(next) - ua(I)));
    for (int b = 0; b < D; ++b) {
        if (b == a) continue;
        const auto& weight = edge(std::min(a, b), std::max(a, b));
        const Index<D> upper = I + e<D>(b);
        const auto side_factor = [&](int i) { return !frame_.periodic(b) && (i == 0 || i == frame_.cells[b]) ? 2.0 : 1.0; };
        if (weight(I) > 0) sum += weight(I) * side_factor(I[b]) * shear(u, a, b, I, fixed) * frame_.inv_h[b];
        if (weight(upper) > 0) sum -= weight(upper) * side_factor(upper[b]) * shear(u, a, b, upper, fixed) * frame_.inv_h[b];
    }
    return sum;
}

/// Computes the diagonal of K.
template <int D>
real SurfaceViscosity<D>::diagonal(int a, const Index<D>& I) const {
    real sum = 2 * frame_.inv_h[a] * frame_.inv_h[a] * (cell_(frame_.near(I, a, -1)) + cell_(frame_.near(I, a, 0)));
    for (int b = 0; b < D; ++b) {
        if (b == a) continue;
        const auto& weight = edge(std::min(a, b), std::max(a, b));
        for (const Index<D>& J : {I, I + e<D>(b)}) {
            const bool side = !frame_.periodic(b) && (J[b] == 0 || J[b] == frame_.cells[b]);
            sum += weight(J) * (side ? 4 : 1) * frame_.inv_h[b] * frame_.inv_h[b];
        }
    }
    return sum;
}

/// Reserves memory for all faces of this rank's planes, so that no step allocates.
template <int D>
void SurfaceViscosity<D>::reserve_unknowns() {
    const int planes = frame_.cells[D - 1] + 1, own = frame_.own().upper(planes) - frame_.own().lower(0);
    std::size_t blocks = 0;
    for (std::size_t a = 0; a < D; ++a) {
        const auto plane = static_cast<std::size_t>(mass_[a].stride(D - 1));
        unknown_[a].reserve(plane * static_cast<std::size_t>(own));
        blocks += plane / Block::most + 1;
    }
    blocks_.reserve(blocks * static_cast<std::size_t>(own));
    block_sum_.reserve(blocks_.capacity());
}

/// Finds the unknowns. Faces in air have neither mass nor stress. Stores the diagonal of K in diagonal_.
template <int D>
void SurfaceViscosity<D>::list_unknowns() {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto& mass = mass_[at];
        for_each_cell(mass.extent(), [&](const Index<D>& I) { diagonal_[at](I) = mass(I) < 0 ? 0 : diagonal(a, I); });
        unknown_[at].clear();
    }
    blocks_.clear();
    const int planes = frame_.cells[D - 1] + 1;
    for (int k = 0; k < planes; ++k) {
        for (int a = 0; a < D && frame_.own().contains(k); ++a) {
            const auto at = static_cast<std::size_t>(a);
            const auto& mass = mass_[at];
            if (k >= mass.extent()[D - 1]) continue;
            auto& list = unknown_[at];
            const std::size_t plane = static_cast<std::size_t>(mass.stride(D - 1)), first = plane * static_cast<std::size_t>(k);
            std::size_t begin = list.size();
            for (std::size_t i = first; i < first + plane; ++i)
                if (mass[i] > 0 || diagonal_[at][i] > 0) list.push_back(index_of<D>(mass.extent(), i));
            for (; begin < list.size(); begin += Block::most) blocks_.push_back({a, begin, std::min(list.size(), begin + Block::most)});
        }
    }
    block_sum_.resize(blocks_.size());
}

/// A block lies within a plane: the same terms for any number of threads and any partition.
template <int D>
real SurfaceViscosity<D>::dot(const Faces& p, const Faces& q) const {
    parallel_for(0, static_cast<int>(blocks_.size()), [&](int i) {
        const Block& block = blocks_[static_cast<std::size_t>(i)];
        const auto a = static_cast<std::size_t>(block.axis);
        real part = 0;
        for (std::size_t k = block.begin; k < block.end; ++k) part += p[a](unknown_[a][k]) * q[a](unknown_[a][k]);
        block_sum_[static_cast<std::size_t>(i)] = part;
    });
    ExactSum sum;
    sum.add(std::span<const real>(block_sum_));
    return sum_of_ranks(frame_.own(), sum).value();
}

template <int D>
void SurfaceViscosity<D>::set_diagonal(real s) {
    for_each_unknown([&](int a, const Index<D>& I) {
        const auto at = static_cast<std::size_t>(a);
        diagonal_[at](I) = mass_[at](I) + s * diagonal_[at](I);
    });
}

/// z = r/diagonal (Jacobi) of the liquid, stored in ap_.
template <int D>
void SurfaceViscosity<D>::precondition() {
    for_each_unknown([&](int a, const Index<D>& I) {
        const auto at = static_cast<std::size_t>(a);
        ap_[at](I) = diagonal_[at](I) > 0 ? r_[at](I) / diagonal_[at](I) : 0;
    });
}

/// (M + s K) δ = r of the liquid's faces and the no-slip bodies.
template <int D>
struct SurfaceViscosity<D>::System {
    static constexpr linear::Norm norm = linear::Norm::natural;
    SurfaceViscosity& of;
    const MacState<D>& state;
    real s;

    /// z of the liquid is computed already.
    real precondition() {
        real rz = of.dot(of.r_, of.ap_);
        if (of.bodies_) rz += of.bodies_->precondition();
        return rz;
    }
    void update_direction(real beta) {
        of.for_each_unknown([&](int a, const Index<D>& I) {
            const auto at = static_cast<std::size_t>(a);
            of.p_[at](I) = of.ap_[at](I) + (beta == 0 ? 0 : beta * of.p_[at](I));
        });
        if (of.bodies_) of.bodies_->update_direction(state, beta, of.p_);
    }
    real multiply() {
        refresh_faces<D>(of.p_, of.frame_, 1);
        of.for_each_unknown([&](int a, const Index<D>& I) {
            const auto at = static_cast<std::size_t>(a);
            of.ap_[at](I) = of.mass_[at](I) * of.p_[at](I) + s * of.stress_divergence(of.p_, a, I, 0);
        });
        real of_bodies = 0;
        if (of.bodies_) {
            of.strain_inside(state, of.p_, s, 0, of.ap_);
            of_bodies = of.bodies_->multiply(state, s, of.p_, of.ap_);
        }
        return of.dot(of.p_, of.ap_) + of_bodies;
    }
    void advance(real alpha) {
        of.for_each_unknown([&](int a, const Index<D>& I) {
            const auto at = static_cast<std::size_t>(a);
            of.x_[at](I) += alpha * of.p_[at](I);
            of.r_[at](I) -= alpha * of.ap_[at](I);
            of.ap_[at](I) = of.diagonal_[at](I) > 0 ? of.r_[at](I) / of.diagonal_[at](I) : 0;
        });
        if (of.bodies_) of.bodies_->advance(alpha);
    }
};

/// Continues from x_ with residual r_.
template <int D>
void SurfaceViscosity<D>::solve(const MacState<D>& state, real dt_nu, real tolerance) {
    const real s = theta_ * dt_nu;
    precondition();
    System system{*this, state, s};
    int iterations = 0;
    linear::StopTest stop(tolerance, max_iterations, iterations);
    const linear::Outcome outcome = linear::conjugate_gradients(system, stop);
    iterations_ += iterations;
    linear::require_converged("velocity", "viscous solve", outcome, stop);
}

template <int D>
void SurfaceViscosity<D>::enforce_bodies(const MacState<D>& state) {
    bodies_ = std::make_unique<BodyRows<D>>(state);
}

/// dt ν K u on the faces inside bodies.
template <int D>
void SurfaceViscosity<D>::strain_inside(const MacState<D>& state, const Faces& u, real dt_nu, real fixed, Faces& out) const {
    const auto& inside = state.no_slip_walls->inside;
    parallel_for(0, static_cast<int>(inside.size()), [&](int i) {
        const InsideFace<D>& f = inside[static_cast<std::size_t>(i)];
        out[static_cast<std::size_t>(f.axis)](f.face) = dt_nu * stress_divergence(u, f.axis, f.face, fixed);
    });
}

/// θ for which no mode of the grid, dt ν λ ≤ 8 dt ν Σ 1/h², changes its sign.
template <int D>
void SurfaceViscosity<D>::set_theta(real dt_nu) {
    real fastest = 0;
    for (int d = 0; d < D; ++d) fastest += 8 * dt_nu * frame_.inv_h[d] * frame_.inv_h[d];
    theta_ = std::max(least_theta_, 1 - 1 / std::max(fastest, real{1}));
}

template <int D>
void SurfaceViscosity<D>::add_with_pressure(MacState<D>& state, real sign) const {
    for_each_unknown([&](int a, const Index<D>& I) { state.u[a](I) += sign * with_pressure_[static_cast<std::size_t>(a)](I); });
}

template <int D>
void SurfaceViscosity<D>::apply(MacState<D>& state, const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, real dt,
                                const MacVelocity<D>* forces, const Faces* at_surface) {
    const real dt_nu = dt * state.nu;
    iterations_ = 0;
    if (bodies_) bodies_->find(state, closed);
    refresh_faces(state.u, frame_, 1);
    set_theta(dt_nu);
    set_weights(state, surface, closed);
    list_unknowns();
    for (int a = 0; a < D; ++a)
        for (Faces* faces : {&p_, &x_, &with_pressure_}) (*faces)[static_cast<std::size_t>(a)].fill(0);
    if (forces) predict_from_pressure(state, surface, dt, *forces, at_surface);
    if (bodies_) {
        list_walls(state);
        bodies_->add_diagonal(state, dt_nu, diagonal_);
        add_with_pressure(state, 1);
        bodies_->carry(state, state.u.face);
    }
    for_each_unknown([&](int a, const Index<D>& I) {
        const auto at = static_cast<std::size_t>(a);
        r_[at](I) = -dt_nu * stress_divergence(state.u.face, a, I, 1);
        if (!bodies_) r_[at](I) += mass_[at](I) * with_pressure_[at](I);
    });
    if (bodies_) {
        strain_inside(state, state.u.face, -dt_nu, 1, r_);
        bodies_->begin(state, dt_nu, state.u.face, r_);
    }
    set_diagonal(theta_ * dt_nu);
    solve(state, dt_nu, tolerance_);
    for_each_unknown([&](int a, const Index<D>& I) { state.u[a](I) += x_[static_cast<std::size_t>(a)](I); });
    if (bodies_) {
        bodies_->carry(state, state.u.face);
        strain_inside(state, state.u.face, dt_nu, 1, ap_);
        bodies_->finish(state, dt_nu, state.u.face, ap_);
    }
    add_with_pressure(state, -1);
    sync_periodic(state.u, state.sides);
}

template <int D>
std::size_t SurfaceViscosity<D>::bytes() const {
    std::size_t total = cell_.bytes();
    for (const auto& grid : edge_) total += grid.bytes();
    for (const Faces* faces : {&mass_, &x_, &r_, &p_, &ap_, &diagonal_, &with_pressure_})
        for (const auto& grid : *faces) total += grid.bytes();
    for (const auto& list : unknown_) total += list.capacity() * sizeof(Index<D>);
    total += blocks_.capacity() * sizeof(Block) + block_sum_.capacity() * sizeof(real);
    return total + (bodies_ ? bodies_->bytes() : 0);
}

template class SurfaceViscosity<2>;
template class SurfaceViscosity<3>;

}  // namespace weir::water
