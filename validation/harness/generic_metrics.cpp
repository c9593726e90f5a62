// Norms and statistics by name. A name is subject.operation: a series if the run has one of that name, else a field.
#include "validation/harness/generic_metrics.hpp"

#include "scene/names.hpp"
#include "sim/owners.hpp"
#include "validation/harness/fitting.hpp"
#include "validation/harness/named_quantity.hpp"
#include "validation/metrics/samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

namespace weir::validation {
namespace {

struct Name {
    std::string subject, operation;
};

Name split(std::string_view name) {
    const auto dot = name.rfind('.');
    if (dot == std::string_view::npos) return {std::string(name), ""};
    return {std::string(name.substr(0, dot)), std::string(name.substr(dot + 1))};
}

/// Running sums of one norm; sums of several ranks may be added.
struct NormSum {
    Norm norm = Norm::linf;
    ExactSum sum{}, weight{};
    real most = 0;  // NaN if any value is
    void add(real value, real w) {
        const real a = std::abs(value);
        if (norm == Norm::linf) return see(a);
        weight.add(w);
        sum.add(w * (norm == Norm::l1 ? a : a * a));
    }
    void add(const NormSum& other) {
        norm = other.norm;
        sum.add(other.sum), weight.add(other.weight);
        see(other.most);
    }
    real mean() const {
        if (norm == Norm::linf) return most;
        const real all = weight.value();
        return all == 0 ? sum.value() : sum.value() / all;
    }

private:
    void see(real a) { most = (a > most || std::isnan(a)) && !std::isnan(most) ? a : most; }
};

struct Component {
    NormSum error, scale;
    void add(const Component& other) { error.add(other.error), scale.add(other.scale); }
};

/// f(x, weight, i) for each sample of one component where it lives: cell centres, faces, or particles, which weigh all the same. Of this
/// rank's own where each shows its part.
template <class F>
void for_each_sample_of(const RunRecord& run, const FieldView& view, int c, F&& f) {
    if (view.where != Where::particle)
        return for_each_sample(run.fields.grid, view.where == Where::face ? c : -1,
                               sim::own_planes(run.fields, view, static_cast<std::size_t>(c)), f);
    const FieldView& position = *run.fields.find(view.set, "position");
    const auto [first, last] = sim::own_entries(run.fields, view, static_cast<std::size_t>(c));
    for (std::size_t i = first; i < last; ++i) {
        Vec<3> x{};
        for (int a = 0; a < position.components(); ++a) x[a] = position.data[static_cast<std::size_t>(a)][i];
        f(x, 1.0, i);
    }
}

/// Sums over one component. Where the reference holds up to a constant, both means are taken out first.
template <class Exact>
Component component_error(const RunRecord& run, const Reference& reference, const FieldView& view, int c, Norm norm, Exact&& exact) {
    const auto& data = view.data[static_cast<std::size_t>(c)];
    const auto covered = [&](const Vec<3>& x) { return !reference.covers || reference.covers(x, run.time); };
    struct Means {
        real value, exact, weight;
    };
    ExactSums<Means> means;
    for_each_sample_of(run, view, c, [&](const Vec<3>& x, real w, std::size_t i) {
        if (covered(x)) means.add({w * data[i], w * exact(x), w});
    });
    const Means all = sim::sum_of_owners(run.fields, view, means).value();
    if (all.weight == 0) throw BadInput(fmt::format("the reference of \"{}\" covers no sample of the run", view.name));
    const bool keep = reference.up_to_a_constant.count(view.name) == 0;
    const real value_mean = keep ? 0 : all.value / all.weight, exact_mean = keep ? 0 : all.exact / all.weight;
    Component sums{{norm}, {norm}};
    for_each_sample_of(run, view, c, [&](const Vec<3>& x, real w, std::size_t i) {
        if (!covered(x)) return;
        const real truth = exact(x) - exact_mean;
        sums.error.add(data[i] - value_mean - truth, w);
        sums.scale.add(truth, w);
    });
    return sim::sum_of_owners(run.fields, view, sums);
}

real statistic(const Curve& s, const std::string& operation) {
    if (s.y.empty()) return std::nan("");
    for (const real y : s.y)
        if (std::isnan(y)) return std::nan("");  // min and max would step over it
    const real first = s.y.front(), last = s.y.back();
    if (operation.empty()) return last;
    if (operation == "max") return *std::max_element(s.y.begin(), s.y.end());
    if (operation == "min") return *std::min_element(s.y.begin(), s.y.end());
    if (operation == "mean") return std::accumulate(s.y.begin(), s.y.end(), 0.0) / static_cast<real>(s.y.size());
    if (operation == "change") return (last - first) / std::abs(first);
    real drift = 0;
    for (const real y : s.y) drift = std::max(drift, std::abs(y - first));
    return drift / std::abs(first);
}

const std::vector<std::string> series_operations = {"", "max", "min", "mean", "drift", "change"};
const std::vector<std::string> field_operations = {"l1", "l2", "linf", "l1_relative", "l2_relative", "linf_relative", "max"};

bool contains(const std::vector<std::string>& list, const std::string& what) {
    return std::find(list.begin(), list.end(), what) != list.end();
}

bool has_series(const RunRecord& run, const std::string& name) {
    try {
        run.series(name);
        return true;
    } catch (const BadInput&) {
        return false;
    }
}

/// The series of a quantity: of a probe, with or without "probe." before it, or of an integral.
std::string series_of(const NamedQuantity& quantity, const RunRecord& run) {
    return has_series(run, quantity.series) ? quantity.series : "probe." + quantity.series;
}

/// A quantity with a window or a statistic that metrics of cases have no word for: "right.height.max@0.8..", "front.time_of(>0.4)".
std::optional<NamedQuantity> named_quantity(std::string_view name, const RunRecord& run) {
    static const std::vector<std::string> more = {"end", "rms", "range", "time_of_max", "time_of_min", "period"};
    const bool only_here = name.find_first_of("@(") != std::string_view::npos;
    if (!only_here && !contains(more, split(name).operation)) return std::nullopt;
    NamedQuantity quantity = parse_quantity(name);
    if (quantity.is_vector()) throw BadInput(fmt::format("{} is no single number; weir plan compares curves and pictures", name));
    if (!has_series(run, series_of(quantity, run))) return std::nullopt;
    return quantity;
}

/// The unit of a probe's column, "height [m]": "m". "probe.NAME" is its first column, "probe.NAME.COLUMN" the one of that name.
std::string unit_of_probe(std::string_view name, const RunRecord& run) {
    name.remove_prefix(6);
    const auto dot = std::min(name.find('.'), name.size());
    const ProbeSeries& probe = run.probe(name.substr(0, dot));
    return std::string(name_and_unit(probe.columns.at(dot == name.size() ? 0 : probe.column_number(name.substr(dot + 1)))).second);
}

real largest(const RunRecord& run, std::string_view field) {
    const FieldView& view = run.field(field);
    NormSum most{Norm::linf};
    for (std::size_t c = 0; c < view.data.size(); ++c)
        for (const real v : sim::own_values(run.fields, view, c)) most.add(v, 1);
    return sim::sum_of_owners(run.fields, view, most).mean();
}

real field_metric(const Name& name, const RunRecord& run, const Reference& reference) {
    if (name.operation == "max") return largest(run, name.subject);
    const Norm norm = name.operation.starts_with("l1") ? Norm::l1 : name.operation.starts_with("l2") ? Norm::l2 : Norm::linf;
    const FieldError e = field_error(run, reference, name.subject, norm);
    return name.operation.ends_with("_relative") ? e.error / e.scale : e.error;
}

std::optional<real> cost(std::string_view name, const RunRecord& run) {
    if (name == "steps") return static_cast<real>(run.steps());
    if (name == "seconds") return run.seconds;
    if (name != "ns_per_cell_step") return std::nullopt;
    const auto& n = run.fields.grid.cells;
    return 1e9 * run.seconds / (static_cast<real>(run.steps()) * n[0] * n[1] * n[2]);
}

}  // namespace

FieldError field_error(const RunRecord& run, const Reference& reference, std::string_view field, Norm norm) {
    const FieldView& view = run.field(field);
    const std::string name(field);
    const bool scalar = view.components() == 1 && view.where != Where::face;
    const ScalarField* one = scalar ? &reference.scalar(name) : nullptr;
    const VectorField* many = scalar ? nullptr : &reference.vector(name);
    real error = 0, scale = 0;  // of the components: largest, or sum of means
    const auto join = [&](real& all, real mean) { all = norm != Norm::linf ? all + mean : mean > all || std::isnan(mean) ? mean : all; };
    for (int c = 0; c < view.components(); ++c) {
        const auto exact = [&](const Vec<3>& x) { return scalar ? (*one)(x, run.time) : (*many)(x, run.time)[c]; };
        const Component sums = component_error(run, reference, view, c, norm, exact);
        join(error, sums.error.mean()), join(scale, sums.scale.mean());
    }
    const auto finish = [&](real all) { return norm == Norm::l2 ? std::sqrt(all) : all; };
    return {finish(error), finish(scale)};
}

bool looks_at_whole_fields(std::string_view name) { return find_metric(name) != nullptr; }

const Metric* find_metric(std::string_view name) {
    for (const Metric& m : metrics())
        if (m.name == name) return &m;
    return nullptr;
}

Quantity quantity_of(std::string_view name) {
    if (const Metric* m = find_metric(name)) return m->quantity;
    const Name n = split(name);
    const bool error = n.operation.starts_with("l1") || n.operation.starts_with("l2") || n.operation.starts_with("linf") ||
                       n.operation == "drift" || n.subject == "divergence" || n.subject.starts_with("residual");
    return error ? Quantity::error : Quantity::value;
}

std::string unit_of(std::string_view name, const RunRecord& run) {
    if (const Metric* m = find_metric(name)) return m->unit;
    if (const auto quantity = named_quantity(name, run)) return unit_of(*quantity, unit_of(series_of(*quantity, run), run));
    if (name.starts_with("probe.") && has_series(run, std::string(name))) return unit_of_probe(name, run);
    const Name n = split(name);
    if (n.operation.ends_with("_relative") || n.operation == "drift" || n.operation == "change") return "";
    for (const Integral& i : run.integrals)
        if (i.name == n.subject || i.name == name) return i.unit;
    if (name == "seconds") return "s";
    if (const StepQuantity* quantity = find_step_quantity(n.subject)) return quantity->unit;
    const FieldView* f = run.fields.find(n.subject);
    return f ? f->unit : "";
}

real measure(std::string_view name, const RunRecord& run, const Reference& reference) {
    if (const Metric* m = find_metric(name); m && m->measure) return fitting(m->name, [&] { return m->measure(run, reference); });
    if (const auto c = cost(name, run)) return *c;
    if (has_series(run, std::string(name))) return statistic(run.series(name), "");  // an observed metric may have a dot in its name
    const Name n = split(name);
    if (contains(series_operations, n.operation) && has_series(run, n.subject)) return statistic(run.series(n.subject), n.operation);
    if (const auto quantity = named_quantity(name, run)) return statistic_of(run.series(series_of(*quantity, run)), *quantity);
    return field_metric(n, run, reference);
}

void check_metric(std::string_view name, const RunRecord& start, const Reference& reference) {
    if (find_metric(name) || cost(name, start)) return;
    if (has_series(start, std::string(name))) return;
    const Name n = split(name);
    if (contains(series_operations, n.operation) && has_series(start, n.subject)) return;
    if (named_quantity(name, start)) return;
    if (contains(field_operations, n.operation) && start.fields.find(n.subject)) {
        if (n.operation == "max") return;
        field_error(start, reference, n.subject, Norm::linf);
        return;
    }
    std::vector<std::string> known;
    for (const auto& f : start.fields.fields) known.push_back(f.name);
    for (const auto& i : start.integrals) known.push_back(i.name);
    for (const Metric& m : metrics()) known.push_back(m.name);
    throw BadInput(fmt::format("unknown metric \"{}\"{}; fields, integrals and metrics of this run: {}", name,
                               scene::did_you_mean(n.subject, known), fmt::join(known, ", ")));
}

}  // namespace weir::validation
