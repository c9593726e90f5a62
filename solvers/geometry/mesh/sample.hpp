// Computes a mesh's distance grid.
#pragma once
#include "geometry/mesh/mesh.hpp"

#include <cstdint>

namespace weir::geometry {

class MeshSampler {
public:
    static void sample(Mesh& mesh, int resolution, const std::string& name);

private:
    /// Nodes around the bounding box, and nodes around a triangle with exact distances.
    static constexpr int margin = 2, exact = 2;

    explicit MeshSampler(Mesh& mesh);
    std::size_t linear(const Index<3>& I) const {
        return (static_cast<std::size_t>(I[2]) * static_cast<std::size_t>(n_[1]) + static_cast<std::size_t>(I[1])) *
                   static_cast<std::size_t>(n_[0]) +
               static_cast<std::size_t>(I[0]);
    }
    Vec<3> node(const Index<3>& I) const { return mesh_.origin_ + mesh_.h_ * to_vec(I); }
    real squared_to(std::int32_t triangle, const Vec<3>& x) const;
    void offer(std::int32_t triangle, const Index<3>& I);
    void near_triangles();
    void carry_outwards();
    void find_inside(const std::string& name);

    Mesh& mesh_;
    Index<3> n_;
    std::vector<std::int32_t> closest_;
    std::vector<real> squared_;
};

}  // namespace weir::geometry
