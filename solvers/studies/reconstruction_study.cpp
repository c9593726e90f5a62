#include "studies/reconstruction_study.hpp"

#include "geometry/shape.hpp"
#include "reconstruction/measure.hpp"

#include <algorithm>
#include <cstdint>

namespace weir::studies {

namespace {

/// In [-1, 1), from a number: the mixing of SplitMix64 (Steele, Lea & Flood 2014), the same on every machine.
real noise(std::uint64_t i) {
    i += 0x9e3779b97f4a7c15U;
    i = (i ^ i >> 30) * 0xbf58476d1ce4e5b9U;
    i = (i ^ i >> 27) * 0x94d049bb133111ebU;
    return static_cast<real>((i ^ i >> 31) >> 11) / static_cast<real>(std::uint64_t{1} << 52) - 1;
}

}  // namespace

scene::Key ReconstructionStudy::jitter_key() {
    return {.name = "jitter",
            .type = scene::Type::number,
            .doc = "How far at most each particle is off its place on the lattice along each axis, in spacings; the same in every run.",
            .fallback = 0.0,
            .min = 0,
            .max = 0.5};
}

ReconstructionStudy::ReconstructionStudy(const scene::Scene& scene) : maker_(reconstruction::reconstruction_of(scene)) {
    const Index<3> cells = scene.index<3>("grid.cells");
    const Vec<3> origin = scene.vec<3>("grid.origin"), size = scene.vec<3>("grid.size");
    grid_.dim = 3;
    for (std::size_t a = 0; a < 3; ++a) grid_.cells[a] = cells[a], grid_.origin[a] = origin[a], grid_.spacing[a] = size[a] / cells[a];
    if (const auto [least, most] = std::minmax_element(grid_.spacing.begin(), grid_.spacing.end()); *most > *least * (1 + 1e-9))
        scene.refuse("grid.cells", "the cells are not cubes, and their width is the particles' spacing");
    const auto shapes = geometry::make_shapes<3>(scene.root().tables("liquid"));
    const real jitter = scene.number("jitter");
    std::uint64_t drawn = 0;
    for (int k = 0; k < cells[2]; ++k)
        for (int j = 0; j < cells[1]; ++j)
            for (int i = 0; i < cells[0]; ++i) {
                const std::array<int, 3> I{i, j, k};
                Vec<3> x;
                for (std::size_t a = 0; a < 3; ++a) x[a] = origin[a] + grid_.spacing[a] * (I[a] + 0.5);
                if (std::none_of(shapes.begin(), shapes.end(), [&](const auto& shape) { return shape->contains(x); })) continue;
                for (std::size_t a = 0; a < 3; ++a) x_[a].push_back(x[a] + jitter * grid_.spacing[a] * noise(drawn++));
            }
    maker_->make(fields(), 0);
}

StepReport ReconstructionStudy::step(real dt) {
    maker_->make(fields(), 0);
    time_ += dt;
    return {.dt = dt};
}

FieldSet ReconstructionStudy::fields() const {
    FieldSet set;
    set.grid = grid_;
    set.fields.push_back({"position", "m", Where::particle, particle_set_name, {x_[0], x_[1], x_[2]}});
    return set;
}

std::vector<Integral> ReconstructionStudy::integrals() const {
    const SurfaceMesh& mesh = maker_->mesh();
    return {{"particles", "1", static_cast<real>(x_[0].size())},
            {"surface_volume", "m^3", reconstruction::volume(mesh)},
            {"surface_area", "m^2", reconstruction::area(mesh)},
            {"triangles", "1", static_cast<real>(mesh.corners.size())}};
}

std::size_t ReconstructionStudy::bytes() const { return 3 * x_[0].size() * sizeof(real) + maker_->bytes(); }

}  // namespace weir::studies
