// Every metric and every reference on scenes that they were not made for, as `weir run --measure M --reference R` may ask: each answers
// with a number, which may be NaN, or refuses with what is missing. Nothing else may be thrown, for that would be a mistake in weir itself.
#include "core/error.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "support/test.hpp"
#include "validation/harness/fitting.hpp"
#include "validation/harness/generic_metrics.hpp"
#include "validation/harness/runner.hpp"

#include <map>

namespace any_scene_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// The first variant of each solver in each case: what a metric or a reference reads of a scene hardly differs among the others.
/// Without error_bars, whose metrics run 70 scenes on ladders of grids: validate.error_bars does that.
struct Any {
    std::string name;
    Case plan;
    Variant variant;
};

std::vector<Any> scenes() {
    std::vector<Any> list;
    for (const auto& folder : find_cases(WEIR_SOURCE_DIR "/cases")) {
        const Case c = cut_short(read_case(folder, Size::ci), 2);
        if (c.name == "error_bars") continue;
        std::map<std::string, bool> seen;
        for (const Variant& v : c.variants)
            if (!std::exchange(seen[scene_of(v, 0, sim::schemas()).solver()], true)) list.push_back({c.name + " " + v.name, c, v});
    }
    return list;
}

/// What `call` throws that it may not; empty where it gives a number or refuses.
template <class F>
std::string wrongly_thrown(F&& call) {
    try {
        call();
    } catch (const BadInput&) {
    } catch (const NumericalFailure&) {
    } catch (const std::exception& other) {
        return other.what();
    }
    return "";
}

}  // namespace

TEST("every reference made from the scene of any case is made or refused") {
    std::map<std::string, std::string> wrong;  // one line a reference is enough
    for (const Any& any : scenes()) {
        const scene::Scene scene = scene_of(any.variant, 0, sim::schemas());
        for (const ReferenceKind& kind : references())
            if (const auto what = wrongly_thrown([&] { make_reference(kind.name, scene, any.plan.folder); }); !what.empty())
                wrong.emplace(kind.name, any.name + ": " + what);
    }
    for (const auto& [reference, what] : wrong) ADD_FAILURE() << reference << " on " << what;
}

TEST("every metric of a run of any case, two steps long, is a number or refused") {
    std::map<std::string, std::string> wrong;
    for (const Any& any : scenes()) {
        const scene::Scene scene = scene_of(any.variant, 0, sim::schemas());
        const Reference own = make_reference(any.variant.reference, scene, any.plan.folder), none;
        RunOptions options{.steps = 2};
        {
            Simulation start(scene);
            for (const Metric& m : metrics()) {
                if (!m.observe) continue;
                bool observes = false;
                const auto what =
                    wrongly_thrown([&] { fitting(m.name, [&] { return m.observe(start.fields(), start.scene(), 0); }), observes = true; });
                if (observes) options.observers.push_back(&m);
                if (!what.empty()) wrong.emplace(m.name, any.name + ", observed: " + what);
            }
        }
        const RunRecord record = run_scene(scene, options, sim::registry());
        for (const Metric& m : metrics())
            for (const Reference* reference : {&own, &none}) {
                if (const auto what = wrongly_thrown([&] { return m.measure ? measure(m.name, record, *reference) : 0; }); !what.empty())
                    wrong.emplace(m.name, any.name + ": " + what);
                if (const auto what =
                        wrongly_thrown([&] { return m.figure ? fitting(m.name, [&] { return m.figure(record, *reference); }) : Panel{}; });
                    !what.empty())
                    wrong.emplace(m.name, any.name + ", its figure: " + what);
            }
    }
    for (const auto& [metric, what] : wrong) ADD_FAILURE() << metric << " on " << what;
}

}  // namespace any_scene_tests
