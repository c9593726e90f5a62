// weir live SCENE: hands over to the program weir-live, which stands beside this one.
#include "app/commands.hpp"
#include "app/start_program.hpp"
#include "validation/report/command.hpp"

#include <filesystem>

namespace weir::app {

namespace {

/// What the user names: a path; or, where nothing stands there, a case.
std::string scene_named(const std::string& word) {
    const bool is_path = word.find_first_of("./=") != std::string::npos || word.starts_with('-');
    return is_path || std::filesystem::exists(word) ? word : validation::find_case_scene(word).string();
}

std::vector<std::string> with_scene(std::vector<std::string> words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i].starts_with('-')) {
            const bool flag =
                words[i] == "--fast" || words[i] == "--paused" || words[i] == "--json" || words[i] == "--help" || words[i] == "-h";
            if (!flag && words[i].find('=') == std::string::npos) ++i;  // its value
            continue;
        }
        words[i] = scene_named(words[i]);
        return words;
    }
    const auto one = validation::find_case_scene("pbf_drop");
    const auto cases = (std::filesystem::is_directory(one) ? one : one.parent_path()).parent_path();
    words.insert(words.end(), {"--report-table", (cases / "report_table").string()});
    return words;
}

}  // namespace

void add_live(CLI::App& app, int&) {
    CLI::App* live = app.add_subcommand("live", "Run a scene in a window with interactive forcing; the session is saved as a scene");
    live->prefix_command();
    live->set_help_flag();
    live->callback([live] { start_program("weir live", "weir-live", with_scene(live->remaining())); });
}

}  // namespace weir::app
