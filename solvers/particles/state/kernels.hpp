// Smoothing kernels W(r) = sigma f(q) / h^D, q = r/h, with compact support h (W = 0 for r >= h), in true two- and three-dimensional forms.
// poly6, spiky, viscosity: Müller, Charypar & Gross 2003 (three dimensions; the 2D viscosity kernel is the one whose 2D Laplacian is
// linear). Cubic spline: Monaghan 1992. Wendland C2: Wendland 1995.
#pragma once
#include "core/types.hpp"

#include <string>
#include <vector>

namespace weir::particles {

enum class KernelKind { poly6, spiky, viscosity, cubic, wendland };

/// Their names in scenes, in the order of KernelKind.
const std::vector<std::string>& kernel_names();
KernelKind kernel_from_name(const std::string& name);

template <int D>
class Kernel {
public:
    Kernel(KernelKind kind, real support);

    KernelKind kind() const { return kind_; }
    real support() const { return h_; }
    /// sigma / h^D: the factor of f(q) [1/m^D].
    real scale() const { return scale_; }
    /// W(r) [1/m^D].
    real value(real r) const;
    /// dW/dr [1/m^(D+1)].
    real derivative(real r) const;
    /// The Laplacian of W for r > 0 [1/m^(D+2)].
    real laplacian(real r) const;

    /// Integral of W over the plane (2D: line) at distance s >= 0 from the centre [1/m].
    real plane(real s) const;
    /// Fraction of the kernel that lies behind the plane at distance s >= 0: 1/2 at s = 0, 0 at s = h. Its derivative is -plane(s).
    real behind(real s) const;

private:
    KernelKind kind_;
    real h_, scale_;
};

/// Volume per particle of a lattice with this spacing [m^D].
template <int D>
constexpr real cell_volume(real spacing) {
    return D == 2 ? spacing * spacing : spacing * spacing * spacing;
}

}  // namespace weir::particles
