// Moving ice: a frozen particle is bonded to its frozen neighbours, and each connected set is one rigid body, moved as rigid fluid
// (Carlson, Mucha & Turk 2004). The passes of a step treat frozen particles as liquid; then each piece gets the linear and angular momentum
// of its particles. Pair forces cancel, so both are conserved inside a piece, and exchanged with the liquid without loss. The volume of
// ice: heat_state.inl.
#pragma once
#include "particles/heat/heat.hpp"
#include "rigid/body.hpp"

#include <vector>

namespace weir::particles {

/// With moving ice, initially frozen particles are on a lattice of their own, with the spacing of the solid's density, centred in each
/// frozen part of the domain.
template <int D>
void spread_ice(const scene::Scene& scene, Fluid<D>& fluid);

template <int D>
class Ice {
public:
    Ice(const Heat<D>& heat, const Domain<D>& domain);

    /// Finds the pieces of a state and sets the velocities of their particles.
    void find(Fluid<D>& fluid);
    /// The same for unchanged pieces after other changes of velocities.
    void move_as_one(Fluid<D>& fluid);
    int pieces() const { return static_cast<int>(pieces_.size()); }
    const rigid::Body<D>& body(int piece) const { return pieces_[static_cast<std::size_t>(piece)].body; }
    /// Piece of a particle of the state: -1 where it is not frozen.
    int piece_of(int i) const { return piece_of_[static_cast<std::size_t>(i)]; }
    /// Frozen to a wall; or any frozen particle while the pieces are at rest.
    bool fixed(int i) const { return piece_of(i) >= 0 && (resting_ || pieces_[static_cast<std::size_t>(piece_of(i))].fixed); }

    // The parts of a step
    /// Free motion of the pieces, with contacts at walls and solids. dt = 0: they are at rest in the whole step.
    void advance_free(real dt);
    /// After an iteration has moved particles, moved(i, place) from the position given by their pieces: moves each piece by the total.
    template <class Moved>
    void follow(Moved&& moved) {
        for (Piece& piece : pieces_) {
            if (resting_ || piece.fixed) continue;
            const auto turned = rigid::rotation<D>(piece.body.orientation);
            const auto all = sums<D + 3>(piece, [&](std::size_t m, std::array<real, D + 3>& sum) {
                const Vec<D> arm = times(turned, rest_[m]), by = moved(members_[m], piece.body.at + arm);
                const Vec<3> torque = cross(arm, by);
                for (std::size_t a = 0; a < D; ++a) sum[a] += by[static_cast<int>(a)];
                for (std::size_t a = 0; a < 3; ++a) sum[D + a] += torque[static_cast<int>(a)];
            });
            push(piece, all);
        }
    }
    /// f(i, place) for all particles of moving pieces.
    template <class F>
    void each_place(F&& f) const {
        for (const Piece& piece : pieces_) {
            if (resting_ || piece.fixed) continue;
            const auto turned = rigid::rotation<D>(piece.body.orientation);
            parallel_for(piece.begin, piece.end, [&](int m) {
                const auto at = static_cast<std::size_t>(m);
                f(members_[at], piece.body.at + times(turned, rest_[at]));
            });
        }
    }
    /// Sets final positions and velocities of the pieces: their displacement beyond free motion was a velocity times `dt`.
    void finish_motion(Fluid<D>& fluid, real dt);

    std::size_t bytes() const;

private:
    struct Piece {
        int begin = 0, end = 0;  // of members_
        bool fixed = false;
        rigid::Body<D> body;
        Vec<3> spin_momentum{};             // [kg m²/s]
        std::array<real, D + 3> impulse{};  // of this step: displacement of the centre [m], then angular momentum times time [kg m²]
        int count() const { return end - begin; }
    };
    static Vec<3> cross(const Vec<D>& a, const Vec<D>& b) {
        if constexpr (D == 2)
            return {{0, 0, a[0] * b[1] - a[1] * b[0]}};
        else
            return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
    }
    static Vec<D> times(const std::array<Vec<D>, D>& rows, const Vec<D>& v) {
        Vec<D> to;
        for (int a = 0; a < D; ++a) to[a] = dot(rows[static_cast<std::size_t>(a)], v);
        return to;
    }
    /// Sums of K numbers over the members of a piece, in blocks of fixed size.
    template <std::size_t K, class F>
    std::array<real, K> sums(const Piece& piece, F&& add) {
        constexpr int block = 1024;
        const int blocks = (piece.count() + block - 1) / block;
        if (sums_.size() < K * static_cast<std::size_t>(blocks)) sums_.resize(K * static_cast<std::size_t>(blocks));
        parallel_for(0, blocks, [&](int b) {
            std::array<real, K> sum{};
            for (int m = piece.begin + b * block; m < std::min(piece.end, piece.begin + (b + 1) * block); ++m)
                add(static_cast<std::size_t>(m), sum);
            std::copy(sum.begin(), sum.end(), sums_.begin() + static_cast<std::ptrdiff_t>(K * static_cast<std::size_t>(b)));
        });
        std::array<real, K> all{};
        for (std::size_t b = 0; b < static_cast<std::size_t>(blocks); ++b)
            for (std::size_t k = 0; k < K; ++k) all[k] += sums_[K * b + k];
        return all;
    }
    void list_frozen(const Fluid<D>& fluid);
    void join_neighbours(const Fluid<D>& fluid);
    void gather_pieces(const Fluid<D>& fluid);
    int root(int f);
    void weigh(const Fluid<D>& fluid, Piece& piece);
    void set_velocities(Fluid<D>& fluid, const Piece& piece) const;
    void push(Piece& piece, const std::array<real, D + 3>& moves);
    void move(Piece& piece, const std::array<real, D + 3>& impulse);
    void keep_in(Piece& piece);
    real leave(Piece& piece, int axis, int end);
    real leave_solids(Piece& piece);
    static Vec<3> turning(const rigid::Body<D>& body, const Vec<3>& momentum);

    const Heat<D>& heat_;
    const Domain<D>& domain_;
    real reach_, wall_reach_;  // maximum distances of bonds between particles, and to a wall [m]
    real mass_ = 0;            // of a particle [kg]
    bool resting_ = false;
    std::vector<Piece> pieces_;
    std::vector<int> members_, piece_of_;
    std::vector<Vec<D>> rest_;  // of members: relative to the centre of mass, when the piece was found [m]
    // for the search: frozen particles, their trees, and cells of the reach's width
    std::vector<int> frozen_, parent_, start_, sorted_, cell_;
    Index<D> cells_{};
    std::vector<real> sums_;
};

}  // namespace weir::particles
