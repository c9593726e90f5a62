// weir describe [TOPIC]: what a scene may say, from the tables that its reader checks against; and what a substance is, in numbers.
#include "scene/describe.hpp"

#include "app/commands.hpp"
#include "core/error.hpp"
#include "sim/registry.hpp"
#include "thermo/scene_substance.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace weir::app {

namespace {

/// "substance water" asks for the numbers; a substance that a scene has to give them for is described like any other kind of thing.
std::string text_about(const std::vector<std::string>& topic) {
    if (topic.size() == 2 && topic[0] == "substance")
        return topic[1] == thermo::water()->name() ? thermo::describe(*thermo::water()) : scene::describe(topic[1], sim::schemas());
    std::string words;
    for (const auto& word : topic) words += (words.empty() ? "" : " ") + word;
    return scene::describe(words, sim::schemas());
}

}  // namespace

void add_describe(CLI::App& app, int& exit_code) {
    auto topic = std::make_shared<std::vector<std::string>>();
    auto markdown = std::make_shared<bool>(false);
    CLI::App* describe =
        app.add_subcommand("describe", "Describe what a scene may contain: a solver, an effect, a key, a shape, a motion or a substance");
    describe->add_option("topic", *topic,
                         "A name or a key, such as mac, buoyancy, time.cfl, sphere, substance water (default: an overview)");
    describe->add_flag("--markdown", *markdown, "Print the whole reference of scenes (docs/scene.md)");
    auto of_commands = std::make_shared<std::string>();
    describe->add_option("--commands", *of_commands, "Print the man page of the commands, or a completion script for bash")
        ->check(CLI::IsMember({"man", "bash"}));
    describe->callback([topic, markdown, of_commands, &app, &exit_code] {
        const std::string text = *of_commands == "man"    ? man_page(app)
                                 : *of_commands == "bash" ? bash_completion(app)
                                 : *markdown              ? scene::manual(sim::schemas())
                                                          : text_about(*topic);
        std::fputs(text.c_str(), stdout);
        exit_code = exit_success;
    });
}

}  // namespace weir::app
