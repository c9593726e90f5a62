// Every scene of every case, described in another way, gives the same physics (see properties.cpp). WEIR_METAMORPHIC=NAME runs the scenes
// whose name has this in it, and prints every difference.
#include "metamorphic/open_list.hpp"
#include "metamorphic/properties.hpp"
#include "metamorphic/small_scenes.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>

using namespace weir;
using namespace weir::metamorphic;

namespace {

struct Count {
    int equal = 0, alike = 0, open = 0, violated = 0;
    std::map<std::string, int> skipped;  // by reason
};

class Check {
public:
    explicit Check(bool all) : all_(all), open_(read_open_list(std::filesystem::path(WEIR_SOURCE_DIR) / "tests/metamorphic/open.txt")) {}

    void scene(const NamedScene& named) {
        Simulation simulation(named.scene);
        Snapshot state = run_steps(simulation, steps);
        Base base{named.scene, simulation.scene(), std::move(state), steps};
        base.noise = noise_of(base);
        if (all_) fmt::print("{} noise {:.2e}\n", named.name, base.noise);
        for (const Property& p : properties()) property(base, named.name, p);
    }

    void report() {
        fmt::print("{:12} {:>6} {:>6} {:>6} {:>6}  skipped\n", "property", "equal", "alike", "open", "fails");
        Count sum;
        for (const Property& p : properties()) {
            const Count& c = counts_[p.name];
            int skipped = 0;
            for (const auto& [why, n] : c.skipped) skipped += n;
            fmt::print("{:12} {:6} {:6} {:6} {:6}  {}", p.name, c.equal, c.alike, c.open, c.violated, skipped);
            for (const auto& [why, n] : c.skipped) fmt::print("; {} {}", n, why);
            fmt::print("\n");
            sum.equal += c.equal, sum.alike += c.alike, sum.open += c.open, sum.violated += c.violated;
        }
        fmt::print("{:12} {:6} {:6} {:6} {:6}\n", "all", sum.equal, sum.alike, sum.open, sum.violated);
        for (const OpenEntry& entry : open_)
            if (!entry.used && !all_)
                ADD_FAILURE() << "open.txt: \"" << entry.property << "\" in \"" << entry.scene
                              << "\" is a violation no longer: take it out";
    }

private:
    void property(const Base& base, const std::string& scene, const Property& p) {
        Count& count = counts_[p.name];
        try {
            const Outcome o = p.check(base);
            const std::string said = difference(o);
            if (all_) fmt::print("  {:12} {}\n", p.name, said);
            if (o.is_equal())
                ++count.equal;
            else if (o.is_alike())
                ++count.alike;
            else
                violated(count, p, scene, said);
        } catch (const Untransformable& why) {
            ++count.skipped[why.what()];
        } catch (const std::exception& wrong) {
            violated(count, p, scene, wrong.what());
        }
    }

    static std::string difference(const Outcome& o) {
        std::string said;
        if (o.equal_bound) said = fmt::format("{:.2e} of {} (at most {:.0e}) ", o.equal.value, o.equal.what, *o.equal_bound);
        if (o.alike_bound)
            said += fmt::format("alike: {:.2e} {} ({}), {:.2e} {} ({:.2g})", o.alike.kept.value, o.alike.kept.what, Outcome::kept_bound,
                                o.alike.moved.value, o.alike.moved.what, *o.alike_bound);
        return said;
    }

    void violated(Count& count, const Property& p, const std::string& scene, const std::string& said) {
        for (OpenEntry& entry : open_)
            if (entry.names(p.name, scene)) {
                ++entry.used, ++count.open;
                return;
            }
        ++count.violated;
        ADD_FAILURE() << scene << ", " << p.name << " (" << p.doc << "): " << said;
    }

    bool all_;
    std::vector<OpenEntry> open_;
    std::map<std::string, Count> counts_;
};

}  // namespace

TEST("what must not change does not, when a scene is moved, mirrored, turned, measured in other units or watched") {
    const char* only = std::getenv("WEIR_METAMORPHIC");
    Check check(only != nullptr);
    const auto scenes = small_scenes(std::filesystem::path(WEIR_SOURCE_DIR) / "cases");
    for (const auto& named : scenes)
        if (!only || named.name.find(only) != std::string::npos) check.scene(named);
    fmt::print("{} scenes\n", scenes.size());
    check.report();
}
