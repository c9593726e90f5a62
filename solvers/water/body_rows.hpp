// The bodies that viscous liquid sticks to, as rows of its viscous solve (viscosity.hpp). The faces inside a body move as it does, so that
// what strains the liquid beside them acts on it. A wall that stands at the part θ of the way from a face to the next one inside is nearer
// than that; of the stress, which is the Laplacian and the gradient of the divergence, the former feels it (Gibou, Fedkiw, Cheng & Kang
// 2002). With J: a face's velocity by the body's, and w: the part of the wall that is liquid,
//
//     ½ Σ_walls w (1/θ − 1) (u − J V)²/h²  more in the weak form,      M δV + ρ ΔV dt ν ∂/∂V = R:  a body's own row
//
// J is taken at the face itself, so that liquid and body that turn as one are not strained: of momentum and of angular momentum a body gets
// what the liquid loses. M, R: staggered/wall_grip.hpp.
#pragma once
#include "staggered/state.hpp"
#include "staggered/wall_grip.hpp"

#include <array>
#include <vector>

namespace weir::water {

using namespace staggered;

/// All rows are over ρ ΔV, as the liquid's are.
template <int D>
class BodyRows {
public:
    using Faces = std::array<Grid<real, D>, D>;
    explicit BodyRows(const MacState<D>& s);

    /// What bodies close of the grid as they stand.
    void find(const MacState<D>& s, const Grid<std::uint8_t, D>& closed);
    /// Whether what closes the cell is a body that liquid sticks to.
    bool closes(const Index<D>& cell) const { return closes_(cell) != 0; }
    /// Beside a face the wall of a body, of which the part w is liquid.
    void add_wall(const MacState<D>& s, const WallLink<D>& link, real w);
    /// The walls' part of the diagonal of K; the diagonal of the bodies' own rows.
    void add_diagonal(const MacState<D>& s, real dt_nu, Faces& diagonal);

    /// The faces inside get the velocities that the bodies have by now.
    void carry(const MacState<D>& s, Faces& u) const;
    /// r: has −dt ν K u of the liquid's faces and of those inside; gets that of the walls. Bodies begin from their velocities of before.
    void begin(const MacState<D>& s, real dt_nu, const Faces& u, Faces& r);
    /// As of the liquid's part of conjugate gradients: z = r/diagonal, answered by r·z; p = z + β p; image = A p, answered by p·image;
    /// V and r go by α along p. `image` has dt ν K p of faces inside.
    real precondition();
    void turn(const MacState<D>& s, real beta, Faces& p);
    real multiply(const MacState<D>& s, real dt_nu, const Faces& p, Faces& image);
    void walk(real alpha);
    /// The impulses of friction [N s], [N m s]; `image` has dt ν K u of faces inside.
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
    bool is_free(const Rider<D>& rider, std::size_t k) const { return rider.sticks && !rider.held[k]; }

    Grid<std::uint8_t, D> closes_;
    std::vector<Wall> walls_;
    Twists velocity_, r_, p_, z_, diagonal_;  // velocity_: the solution; z_: the image, too
};

}  // namespace weir::water
