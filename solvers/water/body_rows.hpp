// No-slip bodies as rows of the viscous solve of a liquid (viscosity.hpp). The faces inside a body move with it, so the strain beside them
// acts on it. A wall at a fraction θ of the distance from a face to the next one inside is closer than that face. Of the stress, which is
// the Laplacian plus the gradient of the divergence, the Laplacian is corrected for it (Gibou, Fedkiw, Cheng & Kang 2002). With J: a face's
// velocity per unit of the body's, and w: the liquid fraction of the wall,
//
//     ½ Σ_walls w (1/θ − 1) (u − J V)²/h²  added to the weak form,      M δV + ρ ΔV dt ν ∂/∂V = R:  a body's own row
//
// J is evaluated at the face itself, so liquid and body in common rotation have no strain. Momentum and angular momentum are conserved
// between body and liquid. M, R: staggered/no_slip_walls.hpp.
#pragma once
#include "staggered/no_slip_walls.hpp"
#include "staggered/state.hpp"

#include <array>
#include <vector>

namespace weir::water {

using namespace staggered;

/// All rows are divided by ρ ΔV, as the liquid's are.
template <int D>
class BodyRows {
public:
    using Faces = std::array<Grid<real, D>, D>;
    explicit BodyRows(const MacState<D>& s);

    /// Finds the cells and faces that bodies close in their present position.
    void find(const MacState<D>& s, const Grid<std::uint8_t, D>& closed);
    /// Returns whether the cell is closed by a no-slip body.
    bool closes(const Index<D>& cell) const { return closes_(cell) != 0; }
    /// Adds the wall of a body beside a face; w: its liquid fraction.
    void add_wall(const MacState<D>& s, const WallLink<D>& link, real w);
    /// Adds the walls' part to the diagonal of K; computes the diagonal of the bodies' rows.
    void add_diagonal(const MacState<D>& s, real dt_nu, Faces& diagonal);

    /// Sets the inside faces to the present velocities of the bodies.
    void carry(const MacState<D>& s, Faces& u) const;
    /// On entry r contains −dt ν K u of the liquid's and inside faces; adds that of the walls. Bodies start with their previous velocities.
    void begin(const MacState<D>& s, real dt_nu, const Faces& u, Faces& r);
    /// The bodies' part of conjugate gradients, as for the liquid: z = r/diagonal, returns r·z; p = z + β p; image = A p, returns p·image;
    /// updates V and r by α along p. `image` contains dt ν K p of inside faces.
    real precondition();
    void update_direction(const MacState<D>& s, real beta, Faces& p);
    real multiply(const MacState<D>& s, real dt_nu, const Faces& p, Faces& image);
    void advance(real alpha);
    /// Computes the friction impulses [N s], [N m s]; `image` contains dt ν K u of inside faces.
    void finish(MacState<D>& s, real dt_nu, const Faces& u, Faces& image);

    std::size_t bytes() const;

private:
    static constexpr std::size_t n = rigid::freedoms<D>;
    using Twists = std::vector<rigid::Twist<D>>;
    struct Wall {
        int axis;
        Index<D> node;
        std::size_t body;
        real stiffness;  // w (1/θ − 1)/h² [1/m²]
        rigid::Twist<D> moves;
    };
    void move_inside(const MacState<D>& s, const Twists& velocity, Faces& u) const;
    void pull(const MacState<D>& s, real dt_nu, const Faces& u, const Twists& velocity, Faces& image, Twists& bodies) const;
    bool is_free(const NoSlipBody<D>& body, std::size_t k) const { return body.coupled && !body.held[k]; }

    Grid<std::uint8_t, D> closes_;
    std::vector<Wall> walls_;
    Twists velocity_, r_, p_, z_, diagonal_;  // velocity_: the solution; z_: also the image
};

}  // namespace weir::water
