// Transfer of momentum between markers and faces.
//   to the faces:   u_i = Σ_p w_ip (v_p + c_p·(x_i − x_p)) / Σ_p w_ip           w: linear hat; c_p only for APIC (Jiang et al. 2015, eq. 8)
//   to the markers: pic    v_p = Σ_i w_ip u_i                                      (Harlow 1964)
//                   flip   v_p = β (v_p + Σ_i w_ip (u_i − u_i before)) + (1 − β) Σ_i w_ip u_i    (Zhu & Bridson 2005)
//                   apic   v_p = Σ_i w_ip u_i,  c_p = Σ_i ∇w_ip u_i      (Jiang et al. 2015, §5.3: face components one by one)
// FLIP is due to Brackbill & Ruppel 1986.
//
// Scattering runs over slabs of planes, even slabs first, then odd ones: no two concurrent slabs share a face. Every sum is in the order of
// the sorted markers, for any number of threads.
#pragma once
#include "free_surface/markers.hpp"

#include <array>
#include <cstdint>
#include <type_traits>

namespace weir::water {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

/// Momentum and weight scattered to one face, stored together because both are updated together.
struct FaceSum {
    real momentum = 0;
    real weight = 0;
};

template <int D>
class FaceSums {
public:
    explicit FaceSums(const Extent<D>& cells) {
        for (int a = 0; a < D; ++a) sum[static_cast<std::size_t>(a)] = Grid<FaceSum, D>(cells + e<D>(a));
    }
    FaceSums() = default;
    std::array<Grid<FaceSum, D>, D> sum;
};

/// u on every face near a marker; known[a] marks these faces (1); the others (0) are unchanged. Markers must be sorted.
template <int D>
void markers_to_faces(const Markers<D>& markers, const Frame<D>& frame, FaceSums<D>& sums, MacVelocity<D>& u,
                      std::type_identity_t<std::array<Grid<std::uint8_t, D>, D>>& known);

/// Copies u on every face within reach of markers to `to`; its other faces are unchanged. Markers must be sorted.
template <int D>
void copy_faces_near(const Markers<D>& markers, const Frame<D>& frame, const MacVelocity<D>& u, MacVelocity<D>& to);

/// The following three functions require sorted markers.
template <int D>
void pic_to_markers(const MacVelocity<D>& u, const Frame<D>& frame, Markers<D>& markers);

/// `before`: the velocity transferred from the markers in this step (copy_faces_near); on return it contains u − β u_before (scratch).
template <int D>
void flip_to_markers(const MacVelocity<D>& u, MacVelocity<D>& before, real beta, const Frame<D>& frame, Markers<D>& markers);

template <int D>
void apic_to_markers(const MacVelocity<D>& u, const Frame<D>& frame, Markers<D>& markers);

}  // namespace weir::water
