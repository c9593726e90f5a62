// A closed surface of triangles as a region of space: its distance from a grid sampled once, when the file is read, and its mass by the
// divergence theorem, exact.
#pragma once
#include "geometry/mesh/triangles.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace weir::geometry {

class Mesh {
public:
    /// `resolution`: cells of the distance grid along the longest side. Throws BadInput, prefixed with `name`, where the triangles bound no
    /// region, or overlap.
    Mesh(Triangles triangles, int resolution, const std::string& name);

    const Triangles& triangles() const { return triangles_; }
    const Vec<3>& min() const { return min_; }
    const Vec<3>& max() const { return max_; }
    /// Signed distance: linear between grid nodes, whose values are exact near the surface; outside the grid a lower bound.
    real distance(const Vec<3>& x) const;

    /// Of unit density. second[a][b] = ∫ (x − centre)_a (x − centre)_b.
    real volume() const { return volume_; }
    const Vec<3>& centre() const { return centre_; }
    const std::array<Vec<3>, 3>& second() const { return second_; }
    std::size_t bytes() const;

private:
    void weigh();
    friend class MeshSampler;

    Triangles triangles_;
    Vec<3> min_{}, max_{};
    real volume_ = 0;
    Vec<3> centre_{};
    std::array<Vec<3>, 3> second_{};
    // the distance grid
    Vec<3> origin_{};
    real h_ = 0;
    Index<3> nodes_{};
    std::vector<float> phi_;
};

/// A mesh in its position in a scene: x = at + scale R y, y in the file's unit.
struct PosedMesh {
    std::shared_ptr<const Mesh> mesh;
    real scale = 1;
    Vec<3> at{};
    std::array<Vec<3>, 3> rotation{Vec<3>::unit(0), Vec<3>::unit(1), Vec<3>::unit(2)};  // rows of R
    Vec<3> to_scene(const Vec<3>& y) const;
    Vec<3> to_file(const Vec<3>& x) const;
};

/// The mesh of a table of the shape "mesh". A file that is named several times is read once.
PosedMesh make_mesh(const scene::Table& table);

/// Throws BadScene, at the key of the file, where it cannot be read or bounds no region.
void require_meshes(const scene::Scene& scene);

/// Rewrites the paths of all mesh files in a table, including nested ones, relative to another folder: for a scene that is written there.
void name_meshes_from(const std::filesystem::path& folder, scene::Table& table);

}  // namespace weir::geometry
