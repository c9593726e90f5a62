#include "studies/reconstruction_study.hpp"

#include "geometry/shape.hpp"
#include "surfaces/measure.hpp"

#include <algorithm>
#include <cstdint>

namespace weir::studies {

namespace {

/// In [-1, 1), from a counter: the mixing function of SplitMix64 (Steele, Lea & Flood 2014), the same on every machine.
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
            .doc = "Maximum displacement of each particle from its lattice position along each axis, in spacings; the same in every run.",
            .fallback = 0.0,
            .min = 0,
            .max = 0.5};
}

ReconstructionStudy::ReconstructionStudy(const scene::Scene& scene) : maker_(surfaces::reconstruction_of(scene)) {
    scene.dim() == 2 ? fill<2>(scene) : fill<3>(scene);
    maker_->make(fields(), 0);
}

template <int D>
void ReconstructionStudy::fill(const scene::Scene& scene) {
    const Index<D> cells = scene.index<D>("grid.cells");
    const Vec<D> origin = scene.vec<D>("grid.origin"), size = scene.vec<D>("grid.size");
    grid_.dim = D;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        grid_.cells[at] = cells[a], grid_.origin[at] = origin[a], grid_.spacing[at] = size[a] / cells[a];
    }
    const auto [least, most] = std::minmax_element(grid_.spacing.begin(), grid_.spacing.begin() + D);
    if (*most > *least * (1 + 1e-9)) scene.refuse("grid.cells", "the cells are not cubes, and their width is the particles' spacing");
    const auto shapes = geometry::make_shapes<D>(scene.root().tables("liquid"));
    const real jitter = scene.number("jitter");
    std::uint64_t drawn = 0;
    for (int k = 0; k < grid_.cells[2]; ++k)
        for (int j = 0; j < cells[1]; ++j)
            for (int i = 0; i < cells[0]; ++i) {
                const std::array<int, 3> I{i, j, k};
                Vec<D> x;
                for (int a = 0; a < D; ++a) {
                    const auto at = static_cast<std::size_t>(a);
                    x[a] = origin[a] + grid_.spacing[at] * (I[at] + 0.5);
                }
                if (std::none_of(shapes.begin(), shapes.end(), [&](const auto& shape) { return shape->contains(x); })) continue;
                for (int a = 0; a < D; ++a) {
                    const auto at = static_cast<std::size_t>(a);
                    x_[at].push_back(x[a] + jitter * grid_.spacing[at] * noise(drawn++));
                }
            }
}

StepReport ReconstructionStudy::step(real dt) {
    maker_->make(fields(), 0);
    time_ += dt;
    return {.dt = dt};
}

FieldSet ReconstructionStudy::fields() const {
    FieldSet set;
    set.grid = grid_;
    FieldView position{"position", "m", Where::particle, particle_set_name, {}};
    for (std::size_t a = 0; a < static_cast<std::size_t>(grid_.dim); ++a) position.data.push_back(x_[a]);
    set.fields.push_back(std::move(position));
    return set;
}

std::vector<Integral> ReconstructionStudy::integrals() const {
    const SurfaceMesh& mesh = maker_->mesh();
    const bool flat = grid_.dim == 2;  // area and length, for lines
    return {{"particles", "1", static_cast<real>(x_[0].size())},
            {"surface_volume", flat ? "m^2" : "m^3", surfaces::volume(mesh)},
            {"surface_area", flat ? "m" : "m^2", surfaces::area(mesh)},
            {flat ? "lines" : "triangles", "1", static_cast<real>(mesh.corners.size() + mesh.lines.size())}};
}

std::size_t ReconstructionStudy::bytes() const {
    return static_cast<std::size_t>(grid_.dim) * x_[0].size() * sizeof(real) + maker_->bytes();
}

}  // namespace weir::studies
