// What rays meet of a scene's solids and bodies: those given by triangles as triangles (where the build can), all others by sphere tracing
// (Hart 1996).
#pragma once
#include "app/picture/rays.hpp"
#include "app/picture/view.hpp"
#include "geometry/solids.hpp"

#include <memory>

namespace weir::picture {

class SolidRays {
public:
    SolidRays(const View& view, const Box& domain);
    struct Hit {
        real distance = infinity;
        Vec<3> normal{};
        Colour colour{};  // of triangles that have one
        bool coloured = false;
        bool body = false;
        explicit operator bool() const { return distance < infinity; }
    };
    /// The first on the ray before `limit`.
    Hit first(const Ray& ray, real limit) const;

private:
    void add_triangles(const geometry::PosedMesh& mesh, const geometry::Pose<3>& pose, bool body);
    real round_distance(const Vec<3>& x, std::size_t* which = nullptr) const;

    Box domain_;
    real size_;  // of the domain
    geometry::Solids<3> solids_;
    std::size_t bodies_ = 0;                // the first of them among the solids
    std::vector<std::size_t> round_;        // those that are not triangles
    SurfaceMesh mesh_;                      // of all others
    std::vector<Colour> colours_;           // of its points
    std::vector<char> coloured_, of_body_;  // of its triangles
    std::unique_ptr<MeshRays> rays_;
};

}  // namespace weir::picture
