// Where rays meet a mesh of triangles: Embree (Wald et al. 2014), where the build has it.
#pragma once
#include "app/picture/volume.hpp"
#include "core/surface_mesh.hpp"

#include <memory>

namespace weir::picture {

/// Whether this build can (Embree was found when it was configured).
bool can_trace_meshes();

class MeshRays {
public:
    /// Throws BadInput where the build has no Embree. The mesh must stay where it is.
    explicit MeshRays(const SurfaceMesh& mesh);
    ~MeshRays();
    struct Hit {
        real distance = infinity;
        int triangle = -1;
        real u = 0, v = 0;  // weights of the second and third corner
        explicit operator bool() const { return triangle >= 0; }
    };
    /// The first triangle on the ray beyond `from`.
    Hit first(const Ray& ray, real from = 0) const;
    /// A value of the points, at a hit.
    template <class T>
    T at(const Hit& hit, const std::vector<T>& values) const {
        const auto& c = mesh_.corners[static_cast<std::size_t>(hit.triangle)];
        return (1 - hit.u - hit.v) * values[static_cast<std::size_t>(c[0])] + hit.u * values[static_cast<std::size_t>(c[1])] +
               hit.v * values[static_cast<std::size_t>(c[2])];
    }
    /// Of the triangle itself, outwards.
    Vec<3> flat_normal(const Hit& hit) const;

private:
    struct Tree;
    const SurfaceMesh& mesh_;
    std::unique_ptr<Tree> tree_;
};

}  // namespace weir::picture
