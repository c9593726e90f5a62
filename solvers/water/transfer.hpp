// Momentum between markers and faces.
//   to the faces:   u_i = Σ_p w_ip (v_p + c_p·(x_i − x_p)) / Σ_p w_ip           w: linear hat; c_p only for APIC (Jiang et al. 2015, eq. 8)
//   to the markers: pic    v_p = Σ_i w_ip u_i                                      (Harlow 1964)
//                   flip   v_p = β (v_p + Σ_i w_ip (u_i − u_i before)) + (1 − β) Σ_i w_ip u_i    (Brackbill & Ruppel 1986; Zhu & Bridson
//                   2005) apic   v_p = Σ_i w_ip u_i,  c_p = Σ_i ∇w_ip u_i               (Jiang et al. 2015, §5.3: face components one by
//                   one)
// Scattering runs over slabs of planes, even slabs first, then odd ones: no two slabs at work share a face, and the order of every sum
// is the order of the sorted markers, whatever the number of threads.
#pragma once
#include "surface/markers.hpp"

#include <array>
#include <cstdint>
#include <type_traits>

namespace weir::water {

using namespace surface;  // the words of the grid and of its free surface are the solver's own

/// Momentum and weight that markers gave to one face; both grow together, so they lie together.
struct FaceSum {
    real momentum = 0;
    real weight = 0;
};

template <int D>
class FaceSums {
public:
    explicit FaceSums(const Index<D>& cells) {
        for (int a = 0; a < D; ++a) sum[static_cast<std::size_t>(a)] = Grid<FaceSum, D>(cells + e<D>(a));
    }
    FaceSums() = default;
    std::array<Grid<FaceSum, D>, D> sum;
};

/// u on every face near a marker; known[a] says which (1) and which are left as they were (0). Markers must be sorted.
template <int D>
void markers_to_faces(const Markers<D>& markers, const Frame<D>& frame, FaceSums<D>& sums, MacVelocity<D>& u,
                      std::type_identity_t<std::array<Grid<std::uint8_t, D>, D>>& known);

/// u on every face that markers see, to `to`; its other faces are left as they were. Markers must be sorted.
template <int D>
void copy_faces_near(const Markers<D>& markers, const Frame<D>& frame, const MacVelocity<D>& u, MacVelocity<D>& to);

/// These three want markers that are sorted.
template <int D>
void pic_to_markers(const MacVelocity<D>& u, const Frame<D>& frame, Markers<D>& markers);

/// `before` is the velocity that the markers gave to the faces at this step (copy_faces_near); on return it holds u − β u_before (scratch).
template <int D>
void flip_to_markers(const MacVelocity<D>& u, MacVelocity<D>& before, real beta, const Frame<D>& frame, Markers<D>& markers);

template <int D>
void apic_to_markers(const MacVelocity<D>& u, const Frame<D>& frame, Markers<D>& markers);

}  // namespace weir::water
