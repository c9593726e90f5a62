// The liquid's surface as a closed mesh of triangles, or in 2D as closed lines, from a level set or from particles, at any moment of a run.
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
    /// Of liquid in the domain, among the solids of a scene.
    Reconstruction(const Options& options, const scene::Scene& scene);
    /// The surface of what these fields show at time t [s]; without a triangle or a line where there is no liquid.
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
    void add_layers();
    void lay_samples();
    void fill_holes(const FieldSet& fields);
    void lay_plane();
    void make_contour();
    void smooth_by_crowding();
    void add_velocity(const FieldSet& fields);

    Options options_;
    Vec<3> lo_, hi_;  // of the domain [m]
    std::array<bool, 3> periodic_{};
    bool flat_;
    geometry::Solids<2> flat_solids_;
    geometry::Solids<3> solids_;
    Cloud cloud_;
    ParticleField field_;
    Samples samples_;
    std::vector<real> across_;  // velocity through a flat liquid: none
    SurfaceMesh mesh_;
    Passes passes_;
};

/// Where the scene names a surface, who makes it; nothing otherwise.
std::unique_ptr<Reconstruction> reconstruction_of(const scene::Scene& scene);

}  // namespace weir::reconstruction
