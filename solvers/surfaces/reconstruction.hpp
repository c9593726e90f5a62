// The liquid's surface as a closed mesh of triangles, or in 2D as closed lines, from a level set or from particles, at any time of a run.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "core/surface_mesh.hpp"
#include "geometry/solids.hpp"
#include "scene/scene.hpp"
#include "surfaces/cloud.hpp"
#include "surfaces/options.hpp"
#include "surfaces/particle_field.hpp"
#include "surfaces/piece.hpp"
#include "surfaces/samples.hpp"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace weir::surfaces {

class Reconstruction {
public:
    /// For liquid in the domain and among the solids of a scene.
    Reconstruction(const Options& options, const scene::Scene& scene);
    /// The surface of these fields at time t [s]; empty where there is no liquid.
    const SurfaceMesh& make(const FieldSet& fields, real t);
    /// The same, collective, each rank its part: points and triangles or lines are concatenated in rank order.
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
    void lay_samples(const CloudExtent& all);
    void fill_holes(const FieldSet& fields);
    void lay_plane();
    void make_contour();
    void smooth_by_crowding();
    void add_velocity(const FieldSet& fields);

    // In parallel (ranks.cpp)
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
    Partition cut_;  // of the lattice's planes, in parallel
    Cloud cloud_;
    Components velocity_;         // of the cloud's particles, if any
    ReceivedParticles received_;  // in parallel, the storage of these
    ParticleField field_;
    Samples samples_;
    std::vector<real> across_;  // velocity normal to the plane of a 2D liquid: zero
    Piece piece_;
    SurfaceMesh mesh_;
    Passes passes_;
};

/// The reconstruction of a scene's surface; nullptr where the scene names none.
std::unique_ptr<Reconstruction> reconstruction_of(const scene::Scene& scene);

}  // namespace weir::surfaces
