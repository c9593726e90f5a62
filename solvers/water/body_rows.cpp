#include "water/body_rows.hpp"

#include <algorithm>

namespace weir::water {

template <int D>
BodyRows<D>::BodyRows(const MacState<D>& s) : closes_(s.extent()) {
    for (Twists* list : {&velocity_, &r_, &p_, &z_, &diagonal_}) list->resize(s.no_slip_walls->bodies.size());
}

template <int D>
void BodyRows<D>::find(const MacState<D>& s, const Grid<std::uint8_t, D>& closed) {
    walls_.clear();
    closes_.fill(0);
    for (std::size_t b = 0; b < velocity_.size(); ++b) velocity_[b] = s.no_slip_walls->bodies[b].velocity;
    for (const InsideFace<D>& f : s.no_slip_walls->inside)
        for (const Index<D>& cell : {f.face - e<D>(f.axis), f.face})
            if (closes_.contains(cell) && closed(cell)) closes_(cell) = 1;
}

template <int D>
void BodyRows<D>::add_wall(const MacState<D>& s, const WallLink<D>& link, real w) {
    const real h = s.u.h[link.across], stiffness = w * (link.nearer - 1) / (h * h);
    if (stiffness > 0) walls_.push_back({link.axis, link.node, link.body, stiffness, link.there});
}

/// Scale of a row's diagonal from the faces inside bodies: about that of the walls, for the distance of the next faces.
template <int D>
void BodyRows<D>::add_diagonal(const MacState<D>& s, real dt_nu, Faces& diagonal) {
    const real unit = s.rho * s.u.cell_volume();
    for (std::size_t b = 0; b < diagonal_.size(); ++b)
        for (std::size_t k = 0; k < n; ++k)
            diagonal_[b][k] = is_free(s.no_slip_walls->bodies[b], k) ? s.no_slip_walls->bodies[b].mass[k][k] / unit : 1;
    for (const WallLink<D>& link : s.no_slip_walls->links) {
        const real h = s.u.h[link.across];
        for (std::size_t k = 0; k < n; ++k)
            if (is_free(s.no_slip_walls->bodies[link.body], k)) diagonal_[link.body][k] += dt_nu / (h * h) * link.there[k] * link.there[k];
    }
    for (const Wall& wall : walls_) {
        diagonal[static_cast<std::size_t>(wall.axis)](wall.node) += wall.stiffness;
        for (std::size_t k = 0; k < n; ++k)
            if (is_free(s.no_slip_walls->bodies[wall.body], k))
                diagonal_[wall.body][k] += dt_nu * wall.stiffness * wall.moves[k] * wall.moves[k];
    }
}

template <int D>
void BodyRows<D>::move_inside(const MacState<D>& s, const Twists& velocity, Faces& u) const {
    for (const InsideFace<D>& f : s.no_slip_walls->inside)
        u[static_cast<std::size_t>(f.axis)](f.face) = NoSlipWalls<D>::along(f.moves, velocity[f.body]);
}

template <int D>
void BodyRows<D>::carry(const MacState<D>& s, Faces& u) const {
    move_inside(s, velocity_, u);
}

/// Adds dt ν K u of the walls to the image, and that of walls and inside faces to the bodies' rows.
template <int D>
void BodyRows<D>::pull(const MacState<D>& s, real dt_nu, const Faces& u, const Twists& velocity, Faces& image, Twists& bodies) const {
    for (const Wall& wall : walls_) {
        const auto a = static_cast<std::size_t>(wall.axis);
        const real strained = dt_nu * wall.stiffness * (u[a](wall.node) - NoSlipWalls<D>::along(wall.moves, velocity[wall.body]));
        image[a](wall.node) += strained;
        for (std::size_t k = 0; k < n; ++k) bodies[wall.body][k] -= strained * wall.moves[k];
    }
    for (const InsideFace<D>& f : s.no_slip_walls->inside) {
        const real strained = image[static_cast<std::size_t>(f.axis)](f.face);
        for (std::size_t k = 0; k < n; ++k) bodies[f.body][k] += strained * f.moves[k];
    }
}

template <int D>
void BodyRows<D>::begin(const MacState<D>& s, real dt_nu, const Faces& u, Faces& r) {
    const real unit = s.rho * s.u.cell_volume();
    for (std::size_t b = 0; b < r_.size(); ++b) {
        p_[b] = {};
        for (std::size_t k = 0; k < n; ++k) r_[b][k] = s.no_slip_walls->bodies[b].drive[k] / unit;
    }
    pull(s, -dt_nu, u, velocity_, r, r_);
    for (std::size_t b = 0; b < r_.size(); ++b)
        for (std::size_t k = 0; k < n; ++k)
            if (!is_free(s.no_slip_walls->bodies[b], k)) r_[b][k] = 0;
}

template <int D>
real BodyRows<D>::precondition() {
    real sum = 0;
    for (std::size_t b = 0; b < z_.size(); ++b)
        for (std::size_t k = 0; k < n; ++k) {
            z_[b][k] = r_[b][k] / diagonal_[b][k];
            sum += r_[b][k] * z_[b][k];
        }
    return sum;
}

template <int D>
void BodyRows<D>::update_direction(const MacState<D>& s, real beta, Faces& p) {
    for (std::size_t b = 0; b < p_.size(); ++b)
        for (std::size_t k = 0; k < n; ++k) p_[b][k] = z_[b][k] + beta * p_[b][k];
    move_inside(s, p_, p);
}

template <int D>
real BodyRows<D>::multiply(const MacState<D>& s, real dt_nu, const Faces& p, Faces& image) {
    const real unit = s.rho * s.u.cell_volume();
    for (std::size_t b = 0; b < z_.size(); ++b) {
        z_[b] = s.no_slip_walls->bodies[b].with_mass(p_[b]);
        for (real& q : z_[b]) q /= unit;
    }
    pull(s, dt_nu, p, p_, image, z_);
    real sum = 0;
    for (std::size_t b = 0; b < z_.size(); ++b)
        for (std::size_t k = 0; k < n; ++k) {
            if (!is_free(s.no_slip_walls->bodies[b], k)) z_[b][k] = p_[b][k];
            sum += p_[b][k] * z_[b][k];
        }
    return sum;
}

template <int D>
void BodyRows<D>::advance(real alpha) {
    for (std::size_t b = 0; b < r_.size(); ++b)
        for (std::size_t k = 0; k < n; ++k) {
            r_[b][k] -= alpha * z_[b][k];
            velocity_[b][k] += alpha * p_[b][k];
        }
}

template <int D>
void BodyRows<D>::finish(MacState<D>& s, real dt_nu, const Faces& u, Faces& image) {
    const real unit = s.rho * s.u.cell_volume();
    std::fill(z_.begin(), z_.end(), rigid::Twist<D>{});
    pull(s, dt_nu, u, velocity_, image, z_);
    for (std::size_t b = 0; b < z_.size(); ++b)
        for (std::size_t k = 0; k < n; ++k) s.no_slip_walls->bodies[b].impulse[k] = -unit * z_[b][k];
}

template <int D>
std::size_t BodyRows<D>::bytes() const {
    return closes_.size() + walls_.capacity() * sizeof(Wall) + 5 * r_.size() * sizeof(rigid::Twist<D>);
}

template class BodyRows<2>;
template class BodyRows<3>;

}  // namespace weir::water
