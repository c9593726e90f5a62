#include "studies/phase_diagram.hpp"

#include "core/error.hpp"
#include "thermo/scene_substance.hpp"

namespace weir::studies {

using namespace thermo;

namespace {

constexpr int line_points = 201;
constexpr real unknown = -1;  // a state outside the range of the formulas

/// The pressure of the phase boundary at T; 0 outside its range.
real pressure_at(const Substance& s, Boundary boundary, real T) {
    if (!s.has(boundary)) return 0;
    const auto [lo, hi] = s.ends(boundary);
    return T > 0 && T >= lo && T <= hi ? s.pressure(boundary, T) : 0;
}

}  // namespace

scene::Key PhaseDiagram::samples_key() {
    using scene::Type;
    const auto list = [](const char* name, const char* unit) {
        return scene::Key{.name = name,
                          .type = Type::numbers,
                          .doc = "Temperatures of the samples.",
                          .unit = unit,
                          .fallback = std::vector<double>{},
                          .min = 0,
                          .min_open = true};
    };
    return {.name = "samples",
            .type = Type::table,
            .doc = "Pairs of temperature and pressure at which the properties of the substance are computed.",
            .keys = {list("temperature", "K"), list("pressure", "Pa")}};
}

PhaseDiagram::PhaseDiagram(const scene::Scene& scene) {
    const auto substance = thermo::substance_of(scene);
    const Index<2> cells = scene.index<2>("grid.cells");
    const Vec<2> origin = scene.vec<2>("grid.origin"), size = scene.vec<2>("grid.size");
    grid_ = {.dim = 2,
             .cells = {cells[0], cells[1], 1},
             .origin = {origin[0], origin[1], 0},
             .spacing = {size[0] / cells[0], size[1] / cells[1], 0}};
    fill_plane(*substance);
    for (const auto boundary : {Boundary::sublimation, Boundary::melting, Boundary::saturation})
        if (substance->has(boundary)) add_line(*substance, boundary);
    add_samples(scene, *substance);
}

void PhaseDiagram::fill_plane(const Substance& substance) {
    const auto count = static_cast<std::size_t>(grid_.cells[0]) * static_cast<std::size_t>(grid_.cells[1]);
    plane_ = {{"state", "", std::vector<real>(count, unknown)}, {"enthalpy", "J/kg", std::vector<real>(count, 0)}};
    for (int j = 0; j < grid_.cells[1]; ++j) {
        const real p = std::pow(10, grid_.origin[1] + grid_.spacing[1] * (j + 0.5));
        for (int i = 0; i < grid_.cells[0]; ++i) {
            const real T = grid_.origin[0] + grid_.spacing[0] * (i + 0.5);
            const bool reached = T > 0 && T >= substance.lowest().T && p <= substance.highest().p;
            if (!reached) continue;
            const auto at = static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.cells[0]) + static_cast<std::size_t>(i);
            plane_[0].values[at] = static_cast<real>(substance.state({T, p}));
            plane_[1].values[at] = substance.heat_curve(p).enthalpy(T);
        }
    }
}

/// Within the plane's range.
void PhaseDiagram::add_line(const Substance& substance, Boundary boundary) {
    PointSet line{name_of(boundary), {}, {}, {}};
    auto [lo, hi] = substance.ends(boundary);
    lo = std::max({lo, grid_.origin[0], std::numeric_limits<real>::min()});
    hi = std::min(hi, grid_.origin[0] + grid_.spacing[0] * grid_.cells[0]);
    const real bottom = grid_.origin[1], top = bottom + grid_.spacing[1] * grid_.cells[1];
    for (int i = 0; i < line_points && lo <= hi; ++i) {
        const real T = lo + (hi - lo) * i / (line_points - 1), log_p = std::log10(substance.pressure(boundary, T));
        if (!(log_p >= bottom && log_p <= top)) continue;
        line.T.push_back(T), line.log_p.push_back(log_p);
    }
    sets_.push_back(std::move(line));
}

void PhaseDiagram::add_samples(const scene::Scene& scene, const Substance& s) {
    const auto &T = scene.root().numbers("samples.temperature"), &p = scene.root().numbers("samples.pressure");
    if (T.size() != p.size())
        scene.refuse("samples.pressure", std::to_string(p.size()) + " pressures stand beside " + std::to_string(T.size()) + " temperatures",
                     "samples are pairs");
    const std::size_t n = T.size();
    PointSet set{"samples", T, std::vector<real>(n), {}};
    set.columns = {{"given_temperature", "K", T},
                   {"given_pressure", "Pa", p},
                   {"state", "", std::vector<real>(n)},
                   {"sublimation_pressure", "Pa", std::vector<real>(n)},
                   {"melting_pressure", "Pa", std::vector<real>(n)},
                   {"saturation_pressure", "Pa", std::vector<real>(n)},
                   {"liquid_density", "kg/m^3", std::vector<real>(n)},
                   {"vapour_density", "kg/m^3", std::vector<real>(n)},
                   {"heat_of_vaporisation", "J/kg", std::vector<real>(n)},
                   {"boiling_temperature", "K", std::vector<real>(n)},
                   {"enthalpy", "J/kg", std::vector<real>(n)},
                   {"temperature_of_enthalpy", "K", std::vector<real>(n)}};
    const auto put = [&](std::size_t column, std::size_t i, real value) { set.columns[column].values[i] = value; };
    for (std::size_t i = 0; i < n; ++i) {
        set.log_p[i] = std::log10(p[i]);
        try {
            put(2, i, static_cast<real>(s.state({T[i], p[i]})));
            const HeatCurve curve = s.heat_curve(p[i]);
            put(10, i, curve.enthalpy(T[i]));
            put(11, i, curve.temperature(set.columns[10].values[i]));
        } catch (const BadInput& error) {
            scene.refuse("samples", "sample " + std::to_string(i) + ": " + error.what());
        }
        put(3, i, pressure_at(s, Boundary::sublimation, T[i]));
        put(4, i, pressure_at(s, Boundary::melting, T[i]));
        const real boils = pressure_at(s, Boundary::saturation, T[i]);
        put(5, i, boils);
        if (boils > 0) {
            put(6, i, s.colder_density(Boundary::saturation, T[i]));
            put(7, i, s.warmer_density(Boundary::saturation, T[i]));
            put(8, i, s.latent_heat(Boundary::saturation, T[i]));
        }
        const real from = s.triple() ? s.triple()->p : 0;
        if (s.has(Boundary::saturation) && p[i] >= from && p[i] <= s.critical()->p) put(9, i, s.temperature(Boundary::saturation, p[i]));
    }
    sets_.push_back(std::move(set));
}

StepReport PhaseDiagram::step(real dt) {
    time_ += dt;
    return {.dt = dt};
}

FieldSet PhaseDiagram::fields() const {
    FieldSet set;
    set.grid = grid_;
    for (const Column& column : plane_) set.fields.push_back({column.name, column.unit, Where::cell, "", {column.values}});
    for (const PointSet& points : sets_) {
        set.fields.push_back({"position", "", Where::particle, points.name, {points.T, points.log_p}});
        for (const Column& column : points.columns)
            set.fields.push_back({column.name, column.unit, Where::particle, points.name, {column.values}});
    }
    return set;
}

std::size_t PhaseDiagram::bytes() const {
    std::size_t count = 0;
    for (const Column& column : plane_) count += column.values.size();
    for (const PointSet& points : sets_) {
        count += points.T.size() + points.log_p.size();
        for (const Column& column : points.columns) count += column.values.size();
    }
    return count * sizeof(real);
}

}  // namespace weir::studies
