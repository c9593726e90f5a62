// weir: simulates fluids and proves each number. Exit codes: 0 success, 1 a claim failed, 2 bad input, 3 numerical failure, 130
// interrupted.
#include "app/commands.hpp"
#include "core/error.hpp"
#include "output/machine.hpp"

#include <cstdio>
#include <exception>
#include <new>

namespace {

std::string version_text() {
    const auto machine = weir::output::this_machine();
    return "weir " + machine.version + " (" + machine.commit + ", " + machine.compiler + ", " + machine.build + ')';
}

int run(int argc, char** argv) {
    int exit_code = weir::exit_success;
    CLI::App app("Fluid simulation: every real-time method, each proved and priced", "weir");
    app.set_version_flag("--version", version_text);
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::help);
    weir::app::add_run(app, exit_code);
    weir::app::add_validate(app, exit_code);
    weir::app::add_cost(app, exit_code);
    weir::app::add_plan(app, exit_code);
    weir::app::add_stability(app, exit_code);
    weir::app::add_report(app, exit_code);
    weir::app::add_picture(app, exit_code);
    weir::app::add_view(app, exit_code);
    weir::app::add_list(app, exit_code);
    weir::app::add_describe(app, exit_code);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? weir::exit_success : weir::exit_bad_input;
    }
    return exit_code;
}

int complain(const char* text, int exit_code) {
    std::fprintf(stderr, "%s\n", text);
    return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const weir::NumericalFailure& failure) {
        return complain(failure.what(), weir::exit_numerical_failure);
    } catch (const weir::BadInput& error) {
        return complain(error.what(), weir::exit_bad_input);
    } catch (const weir::OutputError& error) {
        return complain(error.what(), weir::exit_bad_input);
    } catch (const std::bad_alloc&) {
        return complain("not enough memory: choose fewer cells", weir::exit_bad_input);
    } catch (const std::exception& error) {
        return complain((std::string("a mistake in weir itself: ") + error.what()).c_str(), 70);  // EX_SOFTWARE of sysexits.h
    }
}
