#include "app/live/runner.hpp"

#include "core/parallel.hpp"

#include <algorithm>

#include <sys/resource.h>
#include <unistd.h>

namespace weir::live {

namespace {

constexpr double counted_seconds = 0.5;  // what the overlay's figures are means of

/// Of this thread and those that it starts, which the simulation's steps run on: where all processors are busy drawing comes first, and
/// steps get a third of what it gets, so that a window answers the brush however heavy the scene is.
constexpr int politeness = 5;

void step_behind_drawing() { setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), politeness); }

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

}  // namespace

Runner::Runner(Session& session, bool real_time, bool paused) : session_(session), real_time_(real_time), paused_(paused) {
    commands_.paused = paused;
    field_ = view::main_field(field_names(session.simulation().fields()));
    counted_from_ = clock::now();
    publish();
    thread_ = std::thread([this] { run(); });
}

Runner::~Runner() { stop(); }

void Runner::stop() {
    if (!thread_.joinable()) return;
    post([](SessionCommands& w) { w.quit = true; });
    thread_.join();
}

bool Runner::take(std::unique_ptr<Snapshot>& into) {
    const std::lock_guard lock(mutex_);
    if (!fresh_) return false;
    fresh_ = false;
    std::swap(into, ready_);
    if (!ready_) ready_ = std::make_unique<Snapshot>();
    return true;
}

void Runner::run() {
    step_behind_drawing();
    for (;;) {
        SessionCommands commands;
        {
            std::unique_lock lock(mutex_);
            const auto idle = [&] {
                const SessionCommands& w = commands_;
                return w.paused && w.single_steps == 0 && !w.reset && !w.checkpoint && !w.quit && w.changes.empty() && w.field.empty();
            };
            if (!paused_ && commands_.paused) {  // the last picture says so
                paused_ = true;
                lock.unlock();
                publish();
                lock.lock();
            }
            wake_.wait(lock, [&] { return !idle(); });
            if (real_time_ && ahead_ > 0 && !commands_.paused)
                wake_.wait_for(lock, std::chrono::duration<double>(ahead_), [&] { return commands_.quit; });
            commands = commands_;
            commands_.reset = commands_.checkpoint = false;
            commands_.changes.clear(), commands_.field.clear();
            if (!commands_.paused || commands_.single_steps > 0) commands_.touch.reset();
            if (commands_.single_steps > 0) --commands_.single_steps;
        }
        if (commands.quit) return;
        apply(std::move(commands));
    }
}

void Runner::apply(SessionCommands commands) {
    const bool was_paused = paused_;
    paused_ = commands.paused;
    if (was_paused && !paused_) paced_from_ = clock::now(), paced_time_ = 0;
    if (was_paused && !paused_) counted_from_ = clock::now(), counted_time_ = 0, counted_steps_ = 0, ahead_ = -1;
    if (!commands.field.empty()) field_ = commands.field;
    if (commands.reset) session_.reset(), failed_ = false, message_ = "restarted", before_.clear(), ahead_ = 0;
    for (const auto& change : commands.changes) try {
            session_.steer(change);
            message_ = change.key + " = " + change.value;
        } catch (const BadInput& refused) {
            message_ = refused.what();
        }
    if (commands.checkpoint) try {
            message_ = session_.checkpoint().string() + " is written";
        } catch (const std::exception& error) {
            message_ = error.what();
        }
    const bool steps = (!paused_ || commands.single_steps > 0) && !failed_ && !session_.simulation().finished();
    if (steps) session_.brush(commands.touch.value_or(commands.brush)), step();
    bool wanted = !steps;  // nothing moves: the change alone is shown
    {
        const std::lock_guard lock(mutex_);
        wanted = wanted || !fresh_ || paused_;
    }
    if (wanted) publish();
    if (!steps && !paused_) post([](SessionCommands& w) { w.paused = true; });  // the run has ended
}

void Runner::step() {
    const auto start = clock::now();
    const real before = session_.simulation().time();
    try {
        report_ = session_.step();
    } catch (const std::exception& failure) {
        failed_ = true;
        message_ = failure.what();
    }
    const double took = seconds(clock::now() - start), simulated = session_.simulation().time() - before;
    step_ms_ = 1e3 * took;
    counted_time_ += simulated;
    paced_time_ += simulated;
    ahead_ = paced_time_ - seconds(clock::now() - paced_from_);
    if (ahead_ < 0) paced_from_ = clock::now(), paced_time_ = 0;  // what is lost is not caught up with
    count();
}

/// Twice a second: simulated over real time, and what a step spends in each pass.
void Runner::count() {
    ++counted_steps_;
    const double real_seconds = seconds(clock::now() - counted_from_);
    if (real_seconds < counted_seconds) return;
    factor_ = counted_time_ / real_seconds;
    const auto& now = std::as_const(session_.simulation().solver()).passes().list();
    passes_.clear();
    for (const Pass& pass : now) {
        const auto was = std::find_if(before_.begin(), before_.end(), [&](const Pass& p) { return p.name == pass.name; });
        passes_.emplace_back(pass.name, 1e3 * (pass.seconds - (was == before_.end() ? 0 : was->seconds)) / counted_steps_);
    }
    std::sort(passes_.begin(), passes_.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    before_ = now;
    counted_from_ = clock::now();
    counted_time_ = 0, counted_steps_ = 0;
}

void Runner::publish() {
    const auto start = clock::now();
    const Simulation& simulation = session_.simulation();
    const FieldSet fields = simulation.fields();
    Snapshot& s = *back_;
    take_fields(fields, field_, s);
    s.fields = field_names(fields);
    s.time = simulation.time(), s.steps = simulation.steps(), s.report = report_;
    s.factor = factor_, s.step_ms = step_ms_, s.passes = passes_, s.paused = paused_, s.message = message_;
    const BrushForcing* forcing = simulation.solver().brush();
    s.has_brush = forcing != nullptr;
    if (forcing) s.brush_can = forcing->can;
    if (forcing && forcing->has(BrushKind::heat)) s.temperatures = temperatures_of(fields);
    if (simulation.finished()) s.message = "the run has ended: press r to restart";
    s.transfer_ms = transfer_ms_ = 1e3 * seconds(clock::now() - start);
    const std::lock_guard lock(mutex_);
    std::swap(back_, ready_);
    fresh_ = true;
}

}  // namespace weir::live
