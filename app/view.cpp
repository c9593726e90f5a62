// weir view RESULT: hands over to the program weir-view, which stands beside this one.
#include "app/commands.hpp"
#include "app/start_program.hpp"
#include "core/error.hpp"

#include <filesystem>

#include <unistd.h>

namespace weir::app {

void start_program(const std::string& called, const std::string& program, const std::vector<std::string>& arguments) {
    const auto path = std::filesystem::read_symlink("/proc/self/exe").parent_path() / program;
    if (!std::filesystem::exists(path))
        throw BadInput(
            "this weir was installed without the viewer: " + path.string() +
            " does not exist. It is built where VTK has a window system (Debian: libvtk9-dev); `weir picture` requires no window system");
    std::vector<char*> argv{const_cast<char*>(called.c_str())};
    for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(path.c_str(), argv.data());
    throw BadInput("cannot start " + path.string());
}

void add_view(CLI::App& app, int&) {
    CLI::App* view = app.add_subcommand("view", "Open the frames of a run in a window, or with --png draw one");
    view->prefix_command();
    view->set_help_flag();
    view->callback([view] { start_program("weir view", "weir-view", view->remaining()); });
}

}  // namespace weir::app
