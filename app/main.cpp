// weir: simulates fluids and proves each number. Exit codes: 0 success, 1 a claim failed, 2 bad input, 3 numerical failure, 130
// interrupted, 143 terminated.
#include "app/commands.hpp"
#include "core/error.hpp"
#include "output/machine.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include <unistd.h>

namespace {

std::string version_text() {
    const auto machine = weir::output::this_machine();
    return "weir " + machine.version + " (" + machine.commit + ", " + machine.compiler + ", " + machine.build +
           (machine.options.empty() ? "" : ", " + machine.options) + ')';
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
    weir::app::add_movie(app, exit_code);
    weir::app::add_view(app, exit_code);
    weir::app::add_live(app, exit_code);
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

/// What was printed has arrived, or the run has failed: a full disk is no success.
int flushed(int exit_code) {
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return exit_code;
    throw weir::OutputError(std::string("cannot write to standard output: ") + std::strerror(errno));
}

/// Threads that wait spin for a while, which is quicker than sleeping and starves whoever they wait for where the machine is busy: at most
/// so long as a pass between two waits takes. libgomp reads its environment before main; what a user has set stays.
void bound_spinning(char** argv) {
    if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
    setenv("GOMP_SPINCOUNT", "20000", 1);
    execv("/proc/self/exe", argv);  // where that fails the run goes on as it is
}

}  // namespace

int main(int argc, char** argv) {
    bound_spinning(argv);
    try {
        return flushed(run(argc, argv));
    } catch (const weir::NumericalFailure& failure) {
        return complain(failure.what(), weir::exit_numerical_failure);
    } catch (const weir::BadInput& error) {
        return complain(error.what(), weir::exit_bad_input);
    } catch (const weir::OutputError& error) {
        return complain(error.what(), weir::exit_bad_input);
    } catch (const std::system_error& error) {  // standard output is full or gone
        return complain((std::string("cannot write: ") + error.what()).c_str(), weir::exit_bad_input);
    } catch (const std::bad_alloc&) {
        return complain("not enough memory: choose fewer cells", weir::exit_bad_input);
    } catch (const std::exception& error) {
        return complain((std::string("a mistake in weir itself: ") + error.what()).c_str(), 70);  // EX_SOFTWARE of sysexits.h
    }
}
