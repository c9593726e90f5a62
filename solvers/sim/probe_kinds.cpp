#include "sim/probe_kinds.hpp"

#include "geometry/solids.hpp"
#include "rigid/bodies.hpp"
#include "sim/owners.hpp"
#include "sim/sampling.hpp"
#include "sim/solids_around.hpp"
#include "sim/surface.hpp"
#include "sim/wall_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace weir::sim {

namespace {

std::string column(const std::string& name, const std::string& unit) { return unit.empty() ? name : name + " [" + unit + "]"; }

std::string component_name(const std::string& field, int components, int component) {
    return components == 1 ? field : field + '_' + "xyz"[component];
}

/// The exact sum of a cell field's values.
real sum_of(const FieldSet& fields, const FieldView& view, std::size_t component) {
    ExactSum sum;
    sum.add(own_values(fields, view, component));
    return sum_of_owners(fields, view, sum).value();
}

/// Returns whether a point lies inside a solid, not on its surface.
bool is_inside(real distance, const GridView& grid) { return distance < -1e-9 * grid.spacing[0]; }

/// A grid field at fixed points; NaN where a solid covers a point.
class Points final : public ProbeKind {
public:
    Points(const FieldView& field, std::vector<Vec<3>> points, const scene::Scene& scene, std::string name)
        : field_(field), points_(std::move(points)), name_(std::move(name)), solids_(solids_around(scene)) {
        field_.data.clear();
    }
    void describe(ProbeSeries& series) const override {
        for (std::size_t i = 0; i < points_.size(); ++i)
            for (int c = 0; c < components_; ++c) {
                const std::string number = points_.size() > 1 ? '#' + std::to_string(i) : "";
                series.columns.push_back(column(component_name(field_.name, components_, c) + number, field_.unit));
                series.positions.push_back(points_[i]);
            }
    }
    std::vector<real> measure(const Solver& solver, const FieldSet& fields) const override {
        const FieldView& field = *fields.find("", field_.name);
        std::vector<real> row, answer(static_cast<std::size_t>(components_));
        std::vector<int> owners;
        for (const auto& x : points_) {
            const bool known = solver.answer(field_.name, x, answer);
            for (int c = 0; c < components_; ++c) {
                const Lattice lattice = Lattice::of(field, fields.grid, c);
                if (fields.cut) owners.push_back(owner_of(*fields.cut, plane_below(lattice, fields.grid.dim - 1, x)));
                const bool here = !fields.cut || owners.back() == communicator().rank();
                row.push_back(known  ? answer[static_cast<std::size_t>(c)]
                              : here ? sample_to_wall(field.data[static_cast<std::size_t>(c)], lattice, x)
                                     : 0);
            }
        }
        if (fields.cut) row = of_owners(row, owners);
        if (solids_) leave_out_covered(row, fields, solver.time());
        return row;
    }
    std::string remark() const override { return std::exchange(remark_, {}); }

private:
    void leave_out_covered(std::vector<real>& row, const FieldSet& fields, real t) const {
        solids_->place(fields, t);
        std::size_t covered = 0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (!is_inside(solids_->distance(points_[i]), fields.grid)) continue;
            ++covered;
            std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(i) * components_, components_, not_applicable);
        }
        if (covered == 0 || std::exchange(told_, true)) return;
        remark_ = fmt::format("{} at t = {:.4g} s: nan is written while a solid covers {}",
                              points_.size() == 1
                                  ? fmt::format("probe \"{}\" lies inside a solid", name_)
                                  : fmt::format("{} of the {} points of probe \"{}\" lie inside solids", covered, points_.size(), name_),
                              t, points_.size() == 1 ? "it" : "them");
    }

    FieldView field_;
    std::vector<Vec<3>> points_;
    std::string name_;
    std::unique_ptr<SolidsAround> solids_;  // nullptr: the scene has no solids
    mutable std::string remark_;
    mutable bool told_ = false;
    int components_ = field_.components();
};

/// On a line along an axis (by default y, the upward axis of notation.md): the height of the uppermost liquid, including drops, above the
/// domain's lower side; and the depth, the length of the line inside liquid.
class Gauge final : public ProbeKind {
public:
    Gauge(const Vec<3>& at, int axis) : at_(at), axis_(axis) {}
    void describe(ProbeSeries& series) const override {
        series.columns = {"height [m]", "depth [m]"};
        series.positions = {at_, at_};
    }
    std::vector<real> measure(const Solver& solver, const FieldSet& fields) const override {
        const real floor = fields.grid.origin[static_cast<std::size_t>(axis_)];
        if (real height = 0; axis_ == 1 && solver.answer(surface_height_name, at_, {&height, 1}))
            return {height - floor, std::max(0.0, height - floor)};
        return {highest_liquid(fields, at_, axis_) - floor, liquid_depth(fields, at_, axis_)};
    }

private:
    Vec<3> at_;
    int axis_;
};

class Front final : public ProbeKind {
public:
    Front(int axis, const scene::Scene& scene) : axis_(axis), solids_(solids_around(scene)) {}
    void describe(ProbeSeries& series) const override { series.columns = {std::string("front_") + "xyz"[axis_] + " [m]"}; }
    std::vector<real> measure(const Solver& solver, const FieldSet& fields) const override {
        if (!solids_) return {front(fields, axis_)};
        solids_->place(fields, solver.time());
        return {front(fields, axis_, [this](const Vec<3>& x) { return solids_->distance(x); })};
    }

private:
    int axis_;
    std::unique_ptr<SolidsAround> solids_;
};

/// An integral reported by the solver, or a cell field integrated over the domain.
class IntegralProbe final : public ProbeKind {
public:
    IntegralProbe(std::string name, std::vector<std::string> columns) : name_(std::move(name)), columns_(std::move(columns)) {}
    void describe(ProbeSeries& series) const override { series.columns = columns_; }
    std::vector<real> measure(const Solver& solver, const FieldSet& fields) const override {
        for (const auto& integral : solver.integrals())
            if (integral.name == name_) return {integral.value};
        std::vector<real> sums;
        const FieldView& view = *fields.find("", name_);
        for (std::size_t c = 0; c < view.data.size(); ++c) sums.push_back(sum_of(fields, view, c) * cell_volume(fields.grid));
        return sums;
    }

private:
    std::string name_;
    std::vector<std::string> columns_;
};

/// Pressure on the nearest wall or solid, at its point closest to the given position (wall_fit.hpp).
template <int D>
class WallPressure final : public ProbeKind {
public:
    WallPressure(const scene::Scene& scene, const Vec<D>& at) : solids_(scene), at_(at) {}
    void describe(ProbeSeries& series) const override {
        series.columns = {"pressure [Pa]"};
        series.positions.resize(1);
        for (int d = 0; d < D; ++d) series.positions[0][d] = at_[d];
    }
    std::vector<real> measure(const Solver& solver, const FieldSet& fields) const override {
        solids_.set_time(solver.time());
        return {wall_pressure(fields, solids_, at_)};
    }

private:
    mutable geometry::Solids<D> solids_;
    Vec<D> at_;
};

/// All quantities that a solver reports of one body.
class BodyTrack final : public ProbeKind {
public:
    BodyTrack(const FieldSet& fields, std::size_t body) : body_(body) {
        for (const auto& field : fields.fields) {
            if (field.set != rigid::body_set_name) continue;
            names_.push_back(field.name);
            for (int c = 0; c < field.components(); ++c)
                columns_.push_back(column(component_name(field.name, field.components(), c), field.unit));
        }
    }
    void describe(ProbeSeries& series) const override { series.columns = columns_; }
    std::vector<real> measure(const Solver&, const FieldSet& fields) const override {
        std::vector<real> row;
        for (const auto& name : names_)
            for (const auto& values : fields.find(rigid::body_set_name, name)->data) row.push_back(values[body_]);
        return row;
    }

private:
    std::size_t body_;
    std::vector<std::string> names_, columns_;
};

/// Checks and factories, one function per kind.
class Maker {
public:
    Maker(const scene::Scene& scene, std::size_t number, const Solver& solver)
        : scene_(scene),
          path_("probes[" + std::to_string(number) + "]"),
          table_(scene.root().tables("probes")[number]),
          solver_(solver),
          fields_(solver.fields()) {}

    std::unique_ptr<ProbeKind> make() const {
        const std::string& kind = table_.text("kind");
        if (fields_.grid.dim == 0) scene_.refuse(path_, "solver \"" + scene_.solver() + "\" has no grid to measure on");
        if (kind == "point") return point();
        if (kind == "line") return line();
        if (kind == "gauge") return surface(), gauge();
        if (kind == "front") return surface(), std::make_unique<Front>(axis(), scene_);
        if (kind == "integral") return integral();
        if (kind == "wall_pressure") return wall_pressure();
        if (kind == "body") return body();
        throw std::logic_error("probe \"" + kind + "\" is in the schema but has no maker");
    }

private:
    std::unique_ptr<ProbeKind> point() const {
        const Vec<3> at = inside("at");
        if (const auto solids = solids_around(scene_); solids && is_inside(solids->distance_to_still(at), fields_.grid))
            scene_.refuse(path_ + ".at", "the probe is inside a solid that does not move: there is no fluid to measure",
                          "a point in the fluid, or kind = \"wall_pressure\" for the pressure on the solid");
        return std::make_unique<Points>(grid_field(), std::vector{at}, scene_, table_.text("name"));
    }
    std::unique_ptr<ProbeKind> gauge() const {
        const int along = axis();
        if (along != 1 && (fields_.find("", surface_height_name) || fields_.find(column_depth_name)))
            scene_.refuse(path_ + ".axis", "solver \"" + scene_.solver() + "\" has its surface over y", "axis = \"y\"");
        return std::make_unique<Gauge>(inside("at"), along);
    }
    int axis() const {
        const int axis = static_cast<int>(table_.text("axis")[0] - 'x');
        if (axis >= fields_.grid.dim) scene_.refuse(path_ + ".axis", "a scene in 2D has no z axis", "\"x\" or \"y\"");
        return axis;
    }
    std::unique_ptr<ProbeKind> line() const {
        const Vec<3> from = inside("from"), to = inside("to");
        const auto count = table_.integer("count");
        std::vector<Vec<3>> points;
        for (std::int64_t i = 0; i < count; ++i) {
            const real s = static_cast<real>(i) / static_cast<real>(count - 1);
            points.push_back((1 - s) * from + s * to);
        }
        const auto solids = solids_around(scene_);
        if (solids && std::all_of(points.begin(), points.end(),
                                  [&](const Vec<3>& x) { return is_inside(solids->distance_to_still(x), fields_.grid); }))
            scene_.refuse(path_, "all points of the probe are inside solids that do not move: there is no fluid to measure",
                          "a line through the fluid");
        return std::make_unique<Points>(grid_field(), std::move(points), scene_, table_.text("name"));
    }
    std::unique_ptr<ProbeKind> integral() const {
        const std::string& name = table_.text("field");
        for (const auto& integral : solver_.integrals())
            if (integral.name == name) return std::make_unique<IntegralProbe>(name, std::vector{column(name, integral.unit)});
        const FieldView* field = fields_.find("", name);
        std::string known;
        for (const auto& integral : solver_.integrals()) known += integral.name + ", ";
        if (!field || field->where != Where::cell)
            scene_.refuse(path_ + ".field",
                          "solver \"" + scene_.solver() + "\" has no integral or cell field \"" + name + "\" in this scene",
                          known + known_fields({Where::cell}));
        std::vector<std::string> columns;
        for (int c = 0; c < field->components(); ++c) columns.push_back("integral of " + component_name(name, field->components(), c));
        return std::make_unique<IntegralProbe>(name, std::move(columns));
    }
    std::unique_ptr<ProbeKind> wall_pressure() const {
        const FieldView* on_grid = fields_.find("", "pressure");
        if (!(on_grid ? on_grid->where == Where::cell : fields_.find(particle_set_name, "pressure") != nullptr))
            scene_.refuse(path_ + ".kind", "solver \"" + scene_.solver() + "\" has no pressure beside walls");
        const Vec<3> at = inside("at");
        if (fields_.grid.dim == 2) return std::make_unique<WallPressure<2>>(scene_, Vec<2>{{at[0], at[1]}});
        return std::make_unique<WallPressure<3>>(scene_, at);
    }

    std::unique_ptr<ProbeKind> body() const {
        const std::string& wanted = table_.text("body");
        const auto& bodies = scene_.root().tables("bodies");
        std::string known;
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const std::string name = bodies[b].text_or("name", std::to_string(b));
            if (name == wanted) return std::make_unique<BodyTrack>(fields_, b);
            known += (known.empty() ? "" : ", ") + name;
        }
        scene_.refuse(path_ + ".body", "this scene has no body \"" + wanted + "\"", known.empty() ? "it has no bodies" : "known: " + known);
    }

    const FieldView& grid_field() const {
        const std::string& name = table_.text("field");
        const FieldView* field = fields_.find("", name);
        if (!field)
            scene_.refuse(path_ + ".field", "solver \"" + scene_.solver() + "\" has no field \"" + name + "\" in this scene",
                          "known: " + known_fields({Where::cell, Where::face}));
        return *field;
    }
    std::string known_fields(std::initializer_list<Where> where) const {
        std::string list;
        for (const auto& field : fields_.fields)
            if (std::find(where.begin(), where.end(), field.where) != where.end()) list += (list.empty() ? "" : ", ") + field.name;
        return list;
    }
    Vec<3> inside(const std::string& key) const {
        const Vec<3> x = table_.vec<3>(key);
        const GridView& grid = fields_.grid;
        for (int a = 0; a < grid.dim; ++a) {
            const real lower = grid.origin[static_cast<std::size_t>(a)], upper = upper_corner(grid)[a];
            if (x[a] < lower || x[a] > upper) scene_.refuse(path_ + '.' + key, "the probe is outside the domain");
        }
        return x;
    }
    void surface() const {
        if (!has_surface(fields_)) scene_.refuse(path_ + ".kind", "solver \"" + scene_.solver() + "\" has no free surface to measure");
    }

    const scene::Scene& scene_;
    std::string path_;
    const scene::Table& table_;
    const Solver& solver_;
    FieldSet fields_;
};

}  // namespace

std::unique_ptr<ProbeKind> make_probe(const scene::Scene& scene, std::size_t number, const Solver& solver) {
    return Maker(scene, number, solver).make();
}

}  // namespace weir::sim
