// weir describe [TOPIC]: what a scene may say, from the tables that its reader checks against.
#include "scene/describe.hpp"

#include "app/commands.hpp"
#include "core/error.hpp"
#include "sim/registry.hpp"

#include <cstdio>
#include <memory>

namespace weir::app {

void add_describe(CLI::App& app, int& exit_code) {
    auto topic = std::make_shared<std::string>();
    auto markdown = std::make_shared<bool>(false);
    CLI::App* describe = app.add_subcommand("describe", "Tell what a scene may say: about a solver, an effect, a key, a shape or a motion");
    describe->add_option("topic", *topic, "A name or a key, such as mac, buoyancy, time.cfl, sphere; without it: what there is");
    describe->add_flag("--markdown", *markdown, "The whole manual page, docs/scene.md");
    describe->callback([topic, markdown, &exit_code] {
        const std::string text = *markdown ? scene::manual(sim::schemas()) : scene::describe(*topic, sim::schemas());
        std::fputs(text.c_str(), stdout);
        exit_code = exit_success;
    });
}

}  // namespace weir::app
