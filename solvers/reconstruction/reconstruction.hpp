// The liquid's surface as a closed mesh of triangles, from a level set or from particles, at any moment of a run.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "core/surface_mesh.hpp"
#include "geometry/solids.hpp"
#include "reconstruction/options.hpp"
#include "reconstruction/particle_field.hpp"
#include "reconstruction/samples.hpp"
#include "scene/scene.hpp"

#include <array>
#include <memory>

namespace weir::reconstruction {

class Reconstruction {
public:
    /// Of liquid in the domain, among the solids of a scene in 3D.
    Reconstruction(const Options& options, const scene::Scene& scene);
    /// The surface of what these fields show at time t [s]; without a triangle where there is no liquid.
    const SurfaceMesh& make(const FieldSet& fields, real t);

    const SurfaceMesh& mesh() const { return mesh_; }
    const Samples& samples() const { return samples_; }
    const Passes& passes() const { return passes_; }
    Passes& passes() { return passes_; }
    std::size_t bytes() const;

private:
    void from_level_set(const FieldSet& fields);
    void from_particles(const FieldSet& fields);
    void gather(const FieldView& position, real spacing);
    void add_images(std::size_t axis);
    void lay_samples();
    void make_contour(real t);
    void smooth_by_crowding();
    void add_velocity(const FieldSet& fields);

    Options options_;
    Vec<3> lo_, hi_;  // of the domain [m]
    std::array<bool, 3> periodic_{};
    geometry::Solids<3> solids_;
    Cloud cloud_;
    ParticleField field_;
    Samples samples_;
    SurfaceMesh mesh_;
    Passes passes_;
};

/// Where the scene names a surface, who makes it; nothing otherwise.
std::unique_ptr<Reconstruction> reconstruction_of(const scene::Scene& scene);

}  // namespace weir::reconstruction
