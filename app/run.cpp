// weir run SCENE: simulates a scene and writes frames, probes and run.json.
#include "app/balance.hpp"
#include "app/commands.hpp"
#include "app/explain.hpp"
#include "app/interrupt.hpp"
#include "app/measured.hpp"
#include "app/owner.hpp"
#include "app/progress.hpp"
#include "app/run_folder.hpp"
#include "app/space.hpp"
#include "core/parallel.hpp"
#include "output/atomic_file.hpp"
#include "output/frames.hpp"
#include "output/run_log.hpp"
#include "parallel/communicator.hpp"
#include "rigid/remark.hpp"
#include "sim/frame_options.hpp"
#include "sim/loop.hpp"
#include "sim/memory_estimate.hpp"
#include "sim/probe_files.hpp"
#include "sim/registry.hpp"
#include "sim/run_id.hpp"
#include "sim/shares.hpp"
#include "validation/harness/generic_metrics.hpp"
#include "validation/report/command.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace weir::app {

namespace {

struct RunArguments {
    std::string scene, restart, out, backend;
    std::vector<std::string> set, measure;
    std::string reference;
    int threads = 0;
    std::int64_t checkpoint_every = 0;
    int planned_ranks = 0;
    bool quiet = false, explain = false, any_size = false;
};

/// The frames of a run; none, with a message, where this build cannot write their format.
std::optional<output::Frames> open_frames(const Simulation& simulation, const std::filesystem::path& folder, bool restarted) {
    const auto options = sim::frame_options(simulation.scene());
    if (const std::string& reason = sim::frames_unavailable(simulation.scene()); !reason.empty()) {
        by_first_rank([&] { std::fprintf(stderr, "%s: probes and run.json are written, frames are not\n", reason.c_str()); });
        return std::nullopt;
    }
    return restarted ? output::Frames::resume(folder, options, simulation.frame() + 1, simulation.time()) : output::Frames(folder, options);
}

/// What the system says of this process's memory [bytes]; 0 where it does not.
std::size_t memory_told(const std::string& wanted) {
    std::ifstream status("/proc/self/status");
    for (std::string key; status >> key; status.ignore(std::numeric_limits<std::streamsize>::max(), '\n'))
        if (std::size_t kilobytes = 0; key == wanted && status >> kilobytes) return 1024 * kilobytes;
    return 0;
}

/// What stands in memory and in no file, the most that has stood in memory, and how long other processes were busy.
output::RunLog::RankState state_of(const Simulation& simulation, std::size_t checkpoint) {
    return {simulation.solver().bytes(), memory_told("RssAnon:"), memory_told("VmHWM:"), checkpoint, communicator().busy_seconds()};
}

/// Where ranks have slept for a tenth of the run or more, because other processes were busy; else empty.
std::string busy_warning(const std::vector<output::RunLog::RankState>& ranks, const TimeSpent& spent) {
    double seconds = 0;
    for (const auto& rank : ranks) seconds = std::max(seconds, rank.busy_seconds);
    if (!communicator().several() || seconds < 0.1 * spent.stepping) return {};
    char text[300];
    std::snprintf(text, sizeof text,
                  "warning: for %.3g of %.3g s other processes occupied the processors, and the ranks yielded while waiting for messages: "
                  "fewer ranks, or one process, may be faster (ranks.busy_seconds in run.json)",
                  std::min(seconds, spent.stepping), spent.stepping);
    return text;
}

/// Of this machine's memory, which ranks share for all that is known here: so much may one process need that holds all. Ranks that hold
/// their own planes need it together, and at every cut what a step reads beyond it.
double memory_for_all(const scene::Scene& scene) {
    const double available = sim::available_memory(), ranks = communicator().ranks();
    const auto& kind = sim::kind_named(scene.solver());
    if (!communicator().several() || !kind.parallel.distributed_storage ||
        !kind.parallel.distributed_storage(scene, sim::shares_of(scene, communicator().ranks()).cut))
        return available / ranks;
    return available / (1 + ranks * sim::planes_near_cuts / scene.root().numbers("grid.cells").back());
}

/// Writes everything that a run leaves behind, and shows how it goes. In parallel all ranks write frames, and the first the rest; what is
/// looked at all look at.
class Recorder final : public sim::Watcher {
public:
    /// checkpoint: what was read of the one that is continued [bytes]; 0: none.
    /// earlier: the folder with the files of the run that is continued, where that is another one.
    Recorder(Simulation& simulation, const std::filesystem::path& folder, const std::string& run, std::size_t checkpoint,
             const std::filesystem::path& earlier, bool quiet)
        : simulation_(simulation),
          checkpoint_(checkpoint),
          balance_(simulation),
          quiet_(quiet),
          probes_(folder / "probes"),
          log_(folder / "run.json", simulation.scene(), run),
          progress_(simulation.time(), simulation.end_time(), quiet) {
        frames_ = open_frames(simulation, folder, checkpoint > 0);  // where that refuses the folder, all stays as it is
        tell_ranks(simulation, {}, {});
        log_.set_solver_bytes(simulation.solver().bytes());
        log_.set_warnings(simulation.warnings());
        told_ = simulation.warnings().size();
        by_first_rank([&] {
            checkpoint > 0 ? log_.steps().resume(simulation.steps()) : log_.steps().begin();
            write_log(output::RunStatus::running);  // where the disk fills later, there is a file that can still say so
            probes_.begin(simulation.probes(), earlier.empty() ? earlier : earlier / "probes");
        });
    }
    /// What is to be measured of the run: told in run.json at its end.
    void measure(Measured& measured) { measured_ = &measured; }
    void on_step(const Simulation& simulation, const StepReport& report, double seconds) override {
        if (measured_) measured_->on_step(report, seconds);
        spent_.stepping += seconds;
        balance_.on_step(simulation, report);
        const auto start = clock::now();
        by_first_rank([&] { tell_step(simulation, report, seconds); });
        if (!measured_) simulation_.release_probe_rows();  // what is measured at the end looks at all of them
        spent_.writing += seconds_since(start);
    }
    void on_frame(const Simulation& simulation) override {
        const auto start = clock::now();
        if (frames_) {
            const auto parts = simulation.solver().distributed_view();
            frames_->write(simulation.fields(), simulation.time());
        }
        by_first_rank([&] {
            probes_.update(simulation.probes());  // those of the start too
            // not more than a few per cent of the time goes into replacing it
            const auto now = clock::now();
            if (now - written_ > 20 * write_time_) write_log(output::RunStatus::running);
        });
        balance_.on_frame(simulation);
        spent_.writing += seconds_since(start);
    }
    void end(const Simulation& simulation, output::RunStatus status) {
        progress_.end();
        const auto sent = of_ranks(communicator().traffic());  // before what this takes
        const auto states = of_ranks(state_of(simulation, checkpoint_));
        tell_ranks(simulation, sent, states);
        if (measured_) log_.set_measured(measured_->values());
        const sim::BalanceOfRun balance = balance_.of_run(simulation);
        log_.set_balance(balance_json(balance, spent_));
        by_first_rank([&] {
            probes_.update(simulation.probes());
            log_.set_solver_bytes(simulation.solver().bytes());
            log_.set_warnings(simulation.warnings());
            write_log(status);
            if (!quiet_) std::fputs(balance_text(balance, spent_).c_str(), stdout);
            if (const std::string warning = busy_warning(states, spent_); !warning.empty()) std::fprintf(stderr, "%s\n", warning.c_str());
            for (const std::string& warning : balance.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
        });
    }
    /// The run broke off: that is said if nothing else can be written any more.
    void fail(const std::string& why) noexcept {
        progress_.end();
        if (communicator().rank() > 0) return;
        try {
            write_log(output::RunStatus::failed, why);
        } catch (const std::exception&) {
            log_.overwrite_status(output::RunStatus::failed, why);
        }
    }
    std::vector<std::filesystem::path> series() const { return frames_ ? frames_->series() : std::vector<std::filesystem::path>{}; }

private:
    using clock = std::chrono::steady_clock;
    static double seconds_since(clock::time_point start) { return std::chrono::duration<double>(clock::now() - start).count(); }
    void tell_ranks(const Simulation& simulation, const std::vector<Traffic>& sent, const std::vector<output::RunLog::RankState>& states) {
        if (!communicator().several()) return;
        const sim::Shares& shares = simulation.shares();
        using Storage = output::RunLog::Storage;
        const Storage storage = shares.shared == scene::Shared::by_particles ? Storage::particles
                                : simulation.solver().holds_own_planes()     ? Storage::planes
                                                                             : Storage::replicated;
        log_.set_ranks({communicator().ranks(), shares.cut, storage, shares.replicated_work, sent, states});
    }
    void tell_step(const Simulation& simulation, const StepReport& report, double seconds) {
        log_.steps().add(simulation.steps(), simulation.time(), report, simulation.solver().passes(), seconds);
        probes_.update(simulation.probes());  // as they come: a run that is killed leaves all that it measured
        progress_.show(simulation.time(), simulation.steps());
        for (; told_ < simulation.warnings().size(); ++told_) {
            progress_.end();
            std::fprintf(stderr, "%s\n", simulation.warnings()[told_].c_str());
        }
    }
    void write_log(output::RunStatus status, const std::string& failure = {}) {
        const auto start = clock::now();
        std::vector<std::string> names;
        for (const auto& path : series()) names.push_back(path.filename().string());
        log_.set_series(names);
        log_.set_status(status, failure);
        log_.write();
        written_ = clock::now();
        write_time_ = written_ - start;
    }
    Simulation& simulation_;
    std::size_t checkpoint_;
    sim::Balance balance_;
    TimeSpent spent_;
    bool quiet_;
    std::optional<output::Frames> frames_;
    sim::ProbeFiles probes_;
    output::RunLog log_;
    Progress progress_;
    Measured* measured_ = nullptr;
    std::size_t told_ = 0;  // warnings
    clock::time_point written_{};
    clock::duration write_time_{};
};

std::filesystem::path find_checkpoint(const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) return path;
    for (const auto& file : {sim::checkpoint_file(path), sim::last_good_file(path)})
        if (std::filesystem::exists(file)) return file;
    const bool has_earlier = std::filesystem::exists(earlier(sim::checkpoint_file(path)));
    throw BadInput(
        path.string() +
        " has no checkpoint to continue from: a checkpoint is written when a run is interrupted or fails, and with --checkpoint-every N" +
        (has_earlier ? "; " + earlier("checkpoint.weir").string() + " in this folder belongs to an earlier run" : ""));
}

/// Where --out says; else beside the checkpoint that is continued; else out/<name of the scene>.
std::filesystem::path output_folder(const RunArguments& arguments, const scene::Scene& scene) {
    if (!arguments.out.empty()) return arguments.out;
    if (!arguments.restart.empty()) return find_checkpoint(arguments.restart).parent_path();
    return std::filesystem::path("out") / sim::scene_name(scene);
}

/// A metric may look at every step, so a run is measured whole or not at all.
std::optional<Measured> measured_of(const RunArguments& arguments, Simulation& simulation) {
    if (arguments.measure.empty() && arguments.reference.empty()) return std::nullopt;
    if (arguments.measure.empty()) throw BadInput("--reference requires --measure: it names the reference of the metrics");
    if (!arguments.restart.empty()) throw BadInput("--measure requires a run from its start: leave out --restart");
    return std::optional<Measured>(std::in_place, simulation, arguments.measure, arguments.reference);
}

/// What was written, and how to see it.
void tell_results(const std::vector<std::filesystem::path>& series, const std::filesystem::path& folder, const scene::Scene& scene) {
    for (const auto& path : series) std::printf("%s\n", path.string().c_str());
    const auto viewers = output::frame_format(scene.text("output.format")).viewers;
    if (!series.empty() && viewers) std::printf("view it: %s\n", viewers(folder.string()).c_str());
}

/// A checkpoint at the end of its scene: there is nothing to continue.
int tell_finished(const Simulation& simulation) {
    std::fprintf(stderr, "the run has already reached its end at t = %.6g s; to continue: --set time.end=%.6g\n", simulation.end_time(),
                 2 * simulation.end_time());
    return exit_success;
}

/// The scene of the command line, or that of the checkpoint, with the overrides of the command line.
scene::Scene scene_of_run(const RunArguments& arguments, const Checkpoint* checkpoint) {
    std::vector<scene::Override> overrides;
    for (const auto& text : arguments.set) overrides.push_back(scene::to_override(text));
    if (!arguments.backend.empty()) overrides.push_back({"scheme.backend", '"' + arguments.backend + '"'});
    if (arguments.scene.empty() && !checkpoint)
        throw BadInput("weir run requires a scene (a file, a folder with a scene.toml, or the name of a case), or --restart");
    return arguments.scene.empty() ? scene_of(*checkpoint, overrides)
                                   : scene::read(validation::scene_named(arguments.scene), sim::schemas(), overrides);
}

void print_remarks(const Simulation& simulation) {
    for (const auto& effect : scene::idle_effects(simulation.scene(), sim::kind_named(simulation.scene().solver()).schema))
        std::fprintf(stderr, "%s: effect \"%s\" has strength zero: it has no effect but may cost time\n", simulation.scene().file().c_str(),
                     effect.c_str());
    if (const std::string remark = rigid::remark_on_density(simulation.scene()); !remark.empty())
        std::fprintf(stderr, "%s: %s\n", simulation.scene().file().c_str(), remark.c_str());
    for (const std::string& warning : simulation.warnings()) std::fprintf(stderr, "%s\n", warning.c_str());
}

int print_explanation(const RunArguments& arguments, Simulation& simulation) {
    const std::string space = check_space(simulation, output_folder(arguments, simulation.scene()), true);
    std::fputs((explain(simulation) + "a run writes " + space + explain_ranks(simulation)).c_str(), stdout);
    if (arguments.planned_ranks > 0) std::fputs(explain_planned_ranks(simulation.scene(), arguments.planned_ranks).c_str(), stdout);
    return exit_success;
}

int simulate(const RunArguments& arguments) {
    if (arguments.threads > 0) set_threads(arguments.threads);
    std::optional<Checkpoint> checkpoint;
    if (!arguments.restart.empty()) checkpoint = Checkpoint::read(find_checkpoint(arguments.restart));
    scene::Scene scene = scene_of_run(arguments, checkpoint ? &*checkpoint : nullptr);
    sim::require_ranks(scene, communicator().ranks());
    if (arguments.planned_ranks > 0) {
        if (!arguments.explain) throw BadInput("--ranks estimates a run in parallel (MPI): it requires --explain; mpirun -n N starts one");
        sim::require_ranks(scene, arguments.planned_ranks);
    }
    communicator().hold_whole(std::any_of(arguments.measure.begin(), arguments.measure.end(), validation::looks_at_whole_fields));
    if (!arguments.explain)
        sim::require_memory(scene, sim::registry(), sim::frames_unavailable(scene).empty() ? sim::Use::run_with_frames : sim::Use::run,
                            memory_for_all(scene));
    Simulation simulation(std::move(scene));
    if (checkpoint) simulation.restore(*checkpoint);
    print_remarks(simulation);
    if (arguments.explain) return print_explanation(arguments, simulation);
    const std::size_t restarted = checkpoint ? checkpoint->bytes_read() : 0;
    if (restarted > 0 && simulation.finished()) return tell_finished(simulation);
    const std::string continued = checkpoint ? sim::run_id_of(*checkpoint) : "";
    checkpoint.reset();  // the next one takes its place, and it its room on the disk
    const std::filesystem::path folder = output_folder(arguments, simulation.scene());
    const std::unique_ptr<output::FolderLock> lock = lock_folder(folder);
    const std::string space = check_space(simulation, folder, arguments.any_size);
    if (!arguments.quiet) std::fputs(space.c_str(), stdout);

    std::optional<Measured> measured = measured_of(arguments, simulation);
    const std::string run = restarted > 0 ? own_as_continued(folder, simulation.scene(), continued, simulation.steps())
                                          : own_as_new(folder, simulation.scene(), arguments.quiet);
    const std::filesystem::path earlier = restarted > 0 ? find_checkpoint(arguments.restart).parent_path() : "";
    Recorder recorder(simulation, folder, run, restarted, holds_run(earlier, continued) ? earlier : "", arguments.quiet);
    if (measured) recorder.measure(*measured);
    catch_interrupts(communicator().several());
    sim::LoopOptions options;
    options.folder = folder;
    options.run = run;
    options.checkpoint_every = arguments.checkpoint_every;
    options.restarted = restarted > 0;
    options.stop_requests = [] { return communicator().largest(interruptions()); };
    sim::Ending ending;
    try {
        ending = sim::run(simulation, recorder, options);
        recorder.end(simulation, ending == sim::Ending::finished ? output::RunStatus::finished : output::RunStatus::interrupted);
    } catch (const std::exception& failure) {
        recorder.fail(failure.what());
        throw;
    }
    if (simulation.steady())
        std::fprintf(stderr, "steady at t = %.6g s: all velocities change more slowly than time.stop_when_steady\n", simulation.time());
    if (!arguments.quiet) tell_results(recorder.series(), folder, simulation.scene());
    const bool finished = ending == sim::Ending::finished;
    if (finished && measured) std::fputs(measured->text().c_str(), stdout);
    if (finished) return exit_success;
    std::fprintf(stderr, "interrupted at step %lld; continue with: weir run --restart %s\n", static_cast<long long>(simulation.steps()),
                 folder.c_str());
    return communicator().largest(exit_interrupted());
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* run = app.add_subcommand("run", "Simulate a scene: frames, probes (.csv) and run.json");
    run->add_option("scene", arguments->scene, "A scene file, a folder with a scene.toml, or the name of a case (weir list cases)");
    run->add_option("--out", arguments->out, "Output folder (default: out/<name of the scene>)");
    run->add_option("--set", arguments->set, "Override a key: --set grid.cells=[64,64]; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    run->add_option("--threads", arguments->threads, "Number of threads; results do not depend on it")->check(CLI::Range(1, 1024));
    run->add_option("--backend", arguments->backend,
                    "threads[:isa], opencl[:N] (weir list devices) or reference: the same as --set scheme.backend=...");
    run->add_option("--measure", arguments->measure, "Print a metric of the finished run, as defined for cases; may be repeated")
        ->type_name("METRIC")
        ->allow_extra_args(false);
    run->add_option("--reference", arguments->reference, "Name of the reference for --measure, as in case.toml");
    run->add_option("--restart", arguments->restart, "Continue from a checkpoint, or from the one in an output folder, bit for bit");
    run->add_option("--checkpoint-every", arguments->checkpoint_every, "Save a checkpoint every N steps")->check(CLI::PositiveNumber);
    run->add_flag("--explain", arguments->explain,
                  "Print the requested solver and effects, the allocated fields and the cost per step; write nothing");
    run->add_option("--ranks", arguments->planned_ranks, "With --explain: number of MPI ranks; estimate their memory and messages")
        ->check(CLI::PositiveNumber);
    run->add_flag("--any-size", arguments->any_size, "Start even if the frames may not fit on the disk");
    run->add_flag("--quiet", arguments->quiet, "No progress bar, list of files or balance; warnings are still printed");
    run->callback([arguments, &exit_code] { exit_code = simulate(*arguments); });
}

}  // namespace weir::app
