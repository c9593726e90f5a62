// weir: simulates fluids and proves each number. Exit codes: 0 success, 1 a claim failed, 2 bad input, 3 numerical failure, 130
// interrupted, 143 terminated.
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/thread_count.hpp"
#include "output/machine.hpp"
#include "parallel/mpi/ranks.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

namespace {

std::string version_text() {
    const auto machine = weir::output::this_machine();
    return "weir " + machine.version + " (" + machine.commit + ", " + machine.compiler + ", " + machine.build +
           (machine.options.empty() ? "" : ", " + machine.options) + ')';
}

/// Throws BadInput, with the nearest command, where the first word is no command.
void require_command(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    std::vector<std::string> commands;
    for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
    if (std::find(commands.begin(), commands.end(), argv[1]) != commands.end()) return;
    throw weir::BadInput("weir has no command " + weir::scene::quote(argv[1]) + weir::scene::did_you_mean(argv[1], commands) + "\n    " +
                         weir::scene::known(commands) + "\n    weir COMMAND --help prints the options of one");
}

int run(int argc, char** argv) {
    int exit_code = weir::exit_success;
    CLI::App app("Fluid simulation by real-time methods, with verified accuracy and measured cost", "weir");
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
    require_command(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? weir::exit_success : weir::exit_bad_input;
    }
    return exit_code;
}

std::string complaint;  // the last

int complain(const char* text, int exit_code) {
    std::fprintf(stderr, "%s\n", text);
    complaint = text;
    return exit_code;
}

bool is_run(int argc, char** argv) { return argc > 1 && std::strcmp(argv[1], "run") == 0; }

/// What mpirun starts several times is one run; everything else would do its work as many times.
void join_ranks(int argc, char** argv) {
    if (weir::distributed::started_ranks() <= 1) return;
    if (is_run(argc, argv)) return weir::distributed::join();
    if (weir::distributed::started_rank() > 0) std::exit(weir::exit_bad_input);
    throw weir::BadInput("only weir run works in parallel (MPI): start any other command as one process");
}

/// What was printed has arrived, or the run has failed: a full disk is no success.
int flushed(int exit_code) {
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return exit_code;
    throw weir::OutputError(std::string("cannot write to standard output: ") + std::strerror(errno));
}

/// Threads that wait spin for a while, which is quicker than sleeping and starves the threads that they wait for on a busy machine: at most
/// so long as a pass between two waits takes. Ranks of one machine share its processors. libgomp reads its environment before main; what a
/// user has set stays. OpenBLAS, which libraries bring, starts threads of its own before main; weir uses none of them, and where memory is
/// scarce they wait for it for ever.
void bound_spinning(char** argv) {
    const int threads = std::getenv("OMP_NUM_THREADS") ? 0 : weir::distributed::threads_of_rank();
    const bool bounded = std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT"), quiet = std::getenv("OPENBLAS_NUM_THREADS");
    if (bounded && quiet && threads == 0) return;
    if (!bounded) setenv("GOMP_SPINCOUNT", "1000", 1);
    if (!quiet) setenv("OPENBLAS_NUM_THREADS", "1", 1);
    if (threads > 0) setenv("OMP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    execv("/proc/self/exe", argv);  // where that fails the run goes on as it is
}

/// A count of threads that libgomp would die of.
void require_threads() {
    const char* given = std::getenv("OMP_NUM_THREADS");
    if (given && omp_get_max_threads() > weir::most_threads)
        throw weir::BadInput(std::string("OMP_NUM_THREADS=") + given + ": expected a number of threads from 1 to " +
                             std::to_string(weir::most_threads));
}

/// Runs, and tells what went wrong.
int guarded_run(int argc, char** argv) {
    try {
        require_threads();
        join_ranks(argc, argv);
        return flushed(run(argc, argv));
    } catch (const weir::NumericalFailure& failure) {
        return complain(failure.what(), weir::exit_numerical_failure);
    } catch (const weir::BadInput& error) {
        return complain(error.what(), weir::exit_bad_input);
    } catch (const weir::OutputError& error) {
        return complain(error.what(), weir::exit_bad_input);
    } catch (const std::filesystem::filesystem_error& error) {  // a looped link, a folder that may not be read
        const std::string name = error.path1().empty() ? "" : error.path1().string() + ": ";
        return complain((name + error.code().message()).c_str(), weir::exit_bad_input);
    } catch (const std::system_error& error) {  // standard output is full or gone
        return complain((std::string("cannot write: ") + error.what()).c_str(), weir::exit_bad_input);
    } catch (const std::bad_alloc&) {
        return complain("not enough memory: reduce grid.cells", weir::exit_bad_input);
    } catch (const std::exception& error) {
        return complain((std::string("internal error of weir: ") + error.what()).c_str(), weir::exit_internal_error);
    }
}

}  // namespace

int main(int argc, char** argv) {
    bound_spinning(argv);
    const auto one = [&] {
        const int exit_code = guarded_run(argc, argv);
        weir::app::release_interrupts();
        return weir::distributed::leave(exit_code, complaint);
    };
    try {
        const int forked = is_run(argc, argv) ? weir::distributed::forked_ranks() : 1;
        return forked > 1 ? weir::distributed::run_on_forked_ranks(forked, one) : one();
    } catch (const weir::BadInput& error) {
        return complain(error.what(), weir::exit_bad_input);
    }
}
