// weir view RESULT: hands over to the program weir-view, which stands beside this one.
#include "app/commands.hpp"
#include "core/error.hpp"

#include <filesystem>

#include <unistd.h>

namespace weir::app {

namespace {

[[noreturn]] void hand_over(const std::vector<std::string>& rest) {
    const auto viewer = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "weir-view";
    if (!std::filesystem::exists(viewer))
        throw BadInput("this weir has no viewer: " + viewer.string() +
                       " is not there. It is built where VTK has a window system (Debian: libvtk9-dev); `weir picture` draws without one");
    std::vector<char*> argv{const_cast<char*>("weir view")};
    for (const auto& argument : rest) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(viewer.c_str(), argv.data());
    throw BadInput("cannot start " + viewer.string());
}

}  // namespace

void add_view(CLI::App& app, int&) {
    CLI::App* view = app.add_subcommand("view", "Open the frames of a run in a window, or with --png draw one");
    view->prefix_command();
    view->set_help_flag();
    view->callback([view] { hand_over(view->remaining()); });
}

}  // namespace weir::app
