// Interactive forcing on the grid: each face that touches fluid follows the brush, weighted at the face centre. Momentum added is counted
// with the open fluid fraction of the face's volume.
#include "geometry/brush.hpp"
#include "mac/grid/effects.hpp"

namespace weir::mac {

namespace {

template <int D>
class BrushOnGrid final : public MacEffect<D> {
public:
    BrushOnGrid(std::shared_ptr<BrushForcing> forcing, Stage stage, FaceDensity<D> density)
        : brush_forcing_(std::move(forcing)), stage_(stage), density_(std::move(density)) {}
    Stage stage() const override { return stage_; }
    void apply(MacState<D>& s, real dt) override {
        const auto brush = brush_forcing_->at<D>(s.time);
        if (brush.moves()) push(s, brush, dt);
        if (auto* smoke = s.find("smoke"); smoke && (brush.kind == BrushKind::pour || brush.kind == BrushKind::drain))
            stain(s, *smoke, brush, brush.kind == BrushKind::pour ? 1 : 0, dt);
    }

private:
    /// The nodes in [lo, hi) that the brush may cover; none where hi <= lo.
    static Nodes<D> under(const Brush<D>& brush, const MacVelocity<D>& u, Nodes<D> nodes) {
        for (int d = 0; d < D; ++d) {
            const real shift = d == nodes.axis ? 0 : 0.5;
            const real from = (brush.centre[d] - brush.radius - u.origin[d]) / u.h[d] - shift;
            const real to = (brush.centre[d] + brush.radius - u.origin[d]) / u.h[d] - shift;
            const auto within = [&](real at) { return static_cast<int>(std::clamp<real>(at, nodes.lo[d], nodes.hi[d])); };
            const int lo = within(std::floor(from)), hi = within(std::ceil(to) + 1);
            nodes.lo[d] = lo, nodes.hi[d] = hi;
        }
        return nodes;
    }
    /// Open fluid fraction of a face's volume.
    static real fluid_share(const MacState<D>& s, int a, const Index<D>& I) {
        real share = 0;
        for (const int side : {-1, 0}) {
            Index<D> cell = I;
            cell[a] += side;
            if (s.sides.periodic(a)) cell[a] = (cell[a] + s.u.cells[a]) % s.u.cells[a];
            const bool inside = cell[a] >= 0 && cell[a] < s.u.cells[a];
            if (inside && s.cells(cell) != poisson::Cell::air) share += 0.5;
        }
        return s.solid.any() ? share * s.solid.open[static_cast<std::size_t>(a)](I) : share;
    }
    void push(MacState<D>& s, const Brush<D>& brush, real dt) {
        const Vec<D> most = s.u.h / dt;
        for (int a = 0; a < D; ++a) {
            const Nodes<D> faces = under(brush, s.u, free_faces(s.u, s.sides, a));
            Index<D> extent = faces.hi - faces.lo;
            for (int d = 0; d < D; ++d) extent[d] = std::max(extent[d], 0);
            const real given = sum_over(replicated(extent), [&](const Index<D>& J) -> real {
                const Index<D> I = faces.lo + J;
                const Vec<D> x = s.u.face_centre(a, I);
                const real weight = brush.weight(x), share = weight > 0 ? fluid_share(s, a, I) : 0;
                if (share == 0) return 0;
                const real change = brush_forcing_->share(weight, dt) * (brush.target(x, most)[a] - s.u[a](I));
                s.u[a](I) += change;
                return share * change * (density_ ? density_(a, I) / s.rho : 1);
            });
            brush_forcing_->impulse[a] += s.rho * s.u.cell_volume() * given;
        }
        sync_periodic(s.u, s.sides);
    }
    void stain(MacState<D>& s, Grid<real, D>& smoke, const Brush<D>& brush, real to, real dt) {
        const Nodes<D> cells = under(brush, s.u, all_cells(s.extent()));
        for_each_in(cells.lo, cells.hi, [&](const Index<D>& I) {
            const real weight = brush.weight(s.u.cell_centre(I));
            if (weight > 0) smoke(I) += brush_forcing_->share(weight, dt) * (to - smoke(I));
        });
    }

    std::shared_ptr<BrushForcing> brush_forcing_;
    Stage stage_;
    FaceDensity<D> density_;
};

}  // namespace

std::initializer_list<BrushKind> kinds_of_brush(const scene::Scene& scene) {
    return geometry::kinds_of_brush(scene.has("substance"), !scene.root().tables("bodies").empty());
}

template <int D>
std::unique_ptr<MacEffect<D>> brush_effect(std::shared_ptr<BrushForcing> forcing, Stage stage, FaceDensity<D> density) {
    return std::make_unique<BrushOnGrid<D>>(std::move(forcing), stage, std::move(density));
}

template std::unique_ptr<MacEffect<2>> brush_effect<2>(std::shared_ptr<BrushForcing>, Stage, FaceDensity<2>);
template std::unique_ptr<MacEffect<3>> brush_effect<3>(std::shared_ptr<BrushForcing>, Stage, FaceDensity<3>);

}  // namespace weir::mac
