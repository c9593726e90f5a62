// The liquid's surface as a closed mesh of triangles, or in 2D as closed lines, from a level set or from particles, at any moment of a run.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "core/surface_mesh.hpp"
#include "geometry/solids.hpp"
#include "reconstruction/cloud.hpp"
#include "reconstruction/options.hpp"
#include "reconstruction/particle_field.hpp"
#include "reconstruction/piece.hpp"
#include "reconstruction/samples.hpp"
#include "scene/scene.hpp"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace weir::reconstruction {

class Reconstruction {
public:
    /// Of liquid in the domain, among the solids of a scene.
    Reconstruction(const Options& options, const scene::Scene& scene);
    /// The surface of what these fields show at time t [s]; without a triangle or a line where there is no liquid.
    const SurfaceMesh& make(const FieldSet& fields, real t);
    /// The same by all ranks together, each its part: points and triangles or lines follow each other in their order.
    const SurfaceMesh& make_part(const FieldSet& fields, real t);

    const SurfaceMesh& mesh() const { return mesh_; }
    const Samples& samples() const { return samples_; }
    const Passes& passes() const { return passes_; }
    Passes& passes() { return passes_; }
    std::size_t bytes() const;

private:
    const SurfaceMesh& make_from(const FieldSet& fields, real t);
    void from_level_set(const FieldSet& fields);
    void from_particles(const FieldSet& fields);
    void take_particles(const FieldSet& fields, const FieldView& position);
    void lay_samples(const Extent& all);
    void fill_holes(const FieldSet& fields);
    void lay_plane();
    void make_contour();
    void smooth_by_crowding();
    void add_velocity(const FieldSet& fields);

    // Over ranks (ranks.cpp)
    void cut_by_planes(const FieldSet& fields);
    void cut_by_particles(const Components& position);
    void share_particles(const Components& position);
    PlaneStore<real> with_planes_beside(const FieldSet& fields, const FieldView& field) const;
    void add_velocity_elsewhere(const std::function<Vec<3>(const Vec<3>&)>& velocity_at);
    void keep_own_part();

    real band() const;

    Options options_;
    Domain domain_;
    geometry::Solids<2> flat_solids_;
    geometry::Solids<3> solids_;
    bool in_parts_ = false;
    Cut cut_;  // of the lattice's planes, over ranks
    Cloud cloud_;
    Components velocity_;  // of the cloud's particles, where they have one
    Brought brought_;      // over ranks, what these are of
    ParticleField field_;
    Samples samples_;
    std::vector<real> across_;  // velocity through a flat liquid: none
    Piece piece_;
    SurfaceMesh mesh_;
    Passes passes_;
};

/// Where the scene names a surface, who makes it; nothing otherwise.
std::unique_ptr<Reconstruction> reconstruction_of(const scene::Scene& scene);

}  // namespace weir::reconstruction
