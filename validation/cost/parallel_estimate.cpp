#include "validation/cost/parallel_estimate.hpp"

#include "core/error.hpp"
#include "parallel/communicator.hpp"
#include "sim/shares.hpp"
#include "sim/simulation.hpp"
#include "sim/small_copy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>

#include <sched.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace weir::validation {
namespace {

constexpr int tries = 5, round_trips = 2000;
constexpr std::size_t large_message = std::size_t{1} << 22;
constexpr int most_ranks = 1024;  // of the table of weak scaling
constexpr int most_listed = 64;   // each by itself

/// What two processes share: whose turn it is, and a message.
struct Meeting {
    std::atomic<int> turn{0};
    unsigned char message[large_message];
};

/// Gives the turn back and waits for it again.
void pass_turn(Meeting& meeting, int self) {
    meeting.turn.store(1 - self, std::memory_order_release);
    while (meeting.turn.load(std::memory_order_acquire) != self) sched_yield();
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The other process: it answers each message, and takes the large ones in.
[[noreturn]] void answer(Meeting& meeting) {
    std::vector<unsigned char> taken(large_message);
    while (meeting.turn.load(std::memory_order_acquire) != 1) sched_yield();
    for (int i = 0; i < tries * (round_trips + 1); ++i) {
        if (i % (round_trips + 1) == round_trips) std::memcpy(taken.data(), meeting.message, large_message);
        if (i + 1 == tries * (round_trips + 1)) break;
        pass_turn(meeting, 1);
    }
    meeting.turn.store(0, std::memory_order_release);
    _exit(0);
}

/// Scope in which communicator() are those of a rank that exchanges nothing: for code that reads the number of ranks.
class DryRun {
public:
    DryRun(int rank, int ranks) { set_communicator(std::make_unique<Communicator>(rank, ranks)); }
    ~DryRun() { set_communicator(nullptr); }
    DryRun(const DryRun&) = delete;
    DryRun& operator=(const DryRun&) = delete;
};

int planes_of_scene(const scene::Scene& scene) { return static_cast<int>(scene.root().numbers("grid.cells").back()); }

/// An equal part, and the ghost particles within a kernel's reach of the subdomain boundaries, over all planes.
double part_of_particles(const scene::Scene& scene, int rank, int ranks) {
    const double cuts = rank == 0 || rank + 1 == ranks ? 1 : 2;
    return std::min(1.0, 1.0 / ranks + cuts * scene.number("scheme.support") / planes_of_scene(scene));
}

/// Where a rank between two others sends what this one has sent among `counted` ranks: with more ranks, as much, and all receive more.
std::vector<ModelStep> weak_scaling(const scene::Scene& scene, const ParallelEstimate& o, const RankTraffic& sent, int counted,
                                    double particles) {
    const double each = particles > 0 ? particles / o.ranks : static_cast<double>(planes_of_scene(scene)) / o.ranks;
    double cells = 1;
    for (const double n : scene.root().numbers("grid.cells")) cells *= n;
    const double units = particles > 0 ? each : cells / planes_of_scene(scene) * each;
    std::vector<ModelStep> list{{1, units * o.seconds_each, 0}};
    for (int ranks = 2; ranks <= most_ranks; ranks *= 2) {
        RankTraffic of_step = sent;
        of_step.received *= static_cast<double>(ranks) / counted;
        list.push_back(model_step(units * o.seconds_each, of_step, ranks, o.link));
    }
    return list;
}

/// The messages of a run's loop after each step: whether rank 0 could write, and whether a stop was requested.
void loop_of_run() {
    for (int i = 0; i < 2; ++i) communicator().largest(0);
}

struct Said {
    RankTraffic sent;
    double iterations;
};

RankTraffic per_step(const RankTraffic& all, int steps) {
    const auto mean = [&](const Traffic& t) { return Traffic{t.messages / steps, t.bytes / steps}; };
    return {mean(all.beside), mean(all.everywhere), all.rounds / steps, all.received / steps};
}

}  // namespace

Link measure_link() {
    void* shared = mmap(nullptr, sizeof(Meeting), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) throw OutputError("cannot measure the message latency: no shared memory");
    auto& meeting = *new (shared) Meeting;
    const pid_t other = fork();
    if (other < 0) throw OutputError("cannot measure the message latency: no second process could be started");
    if (other == 0) answer(meeting);
    Link link{infinity, 0, "through the shared memory of this machine, measured now"};
    std::vector<unsigned char> sent(large_message, 1);
    for (int i = 0; i < tries; ++i) {
        double start = now();
        for (int k = 0; k < round_trips; ++k) pass_turn(meeting, 0);
        link.latency = std::min(link.latency, (now() - start) / (2 * round_trips));
        start = now();
        std::memcpy(meeting.message, sent.data(), large_message);
        pass_turn(meeting, 0);
        link.bandwidth = std::max(link.bandwidth, static_cast<double>(large_message) / (now() - start));
    }
    waitpid(other, nullptr, 0);
    munmap(shared, sizeof(Meeting));
    return link;
}

CountedSteps count_messages(const scene::Scene& scene, int ranks, int first, int steps, const std::vector<scene::SolverKind>& kinds) {
    const auto ends = fork_ranks(ranks, [&](ForkedRanks& self) {
        Simulation simulation(scene, kinds);
        RankTraffic before;
        double iterations = 0;
        for (int step = 0; step < first + steps; ++step) {
            if (step == first) before = self.counts();
            const StepReport report = simulation.step();
            loop_of_run();
            if (step >= first) iterations += report.iterations;
        }
        const Said said{self.counts().since(before), iterations / steps};
        return std::string(reinterpret_cast<const char*>(&said), sizeof said);
    });
    if (const ForkedEnd* cause = cause_of_failure(ends))
        throw BadInput("the scene could not be tried on " + std::to_string(ranks) + " ranks: " + cause->said);
    CountedSteps counted;
    for (const ForkedEnd& end : ends) {
        Said said;
        std::memcpy(&said, end.said.data(), sizeof said);
        counted.sent.push_back(said.sent), counted.iterations = said.iterations;
    }
    return counted;
}

ModelStep model_step(double computing, const RankTraffic& sent, int ranks, const Link& link) {
    if (ranks == 1) return {1, computing, 0};
    const double hops = std::ceil(std::log2(ranks));
    const auto all = static_cast<double>(sent.everywhere.messages), beside = static_cast<double>(sent.rounds) - all;
    const double rounds = beside + hops * all;
    return {ranks, computing, rounds * link.latency + (static_cast<double>(sent.beside.bytes) + sent.received) / link.bandwidth};
}

namespace {

/// What is tried to count messages: the scene, or a copy with fewer cells where it is large.
struct Tried {
    scene::Scene scene;
    double area = 1;  // a plane of the scene's cells over one of the copy's
};

Tried tried_scene(const scene::Scene& scene, const CostEstimate& f, int ranks, const std::vector<scene::SolverKind>& kinds) {
    if (f.held.cells <= most_cells_tried) return {scene};
    Tried tried{sim::small_copy(scene, kinds, most_cells_tried, sim::Copy::similar)};
    if (tried.scene.root().numbers("grid.cells").back() < fewest_planes_tried * ranks) return {scene};
    double cells = 1;
    for (const double n : tried.scene.root().numbers("grid.cells")) cells *= n;
    tried.area = std::pow(f.held.cells / cells, (scene.dim() - 1.0) / scene.dim());
    return tried;
}

/// The same messages with larger planes. Collective communication is of sums and of coarse grids, whose sizes hardly depend on the planes.
RankTraffic wider(const RankTraffic& sent, double area) {
    const auto scaled = [&](const Traffic& t) { return Traffic{t.messages, std::llround(static_cast<double>(t.bytes) * area)}; };
    return {scaled(sent.beside), sent.everywhere, sent.rounds, sent.received};
}

}  // namespace

ParallelEstimate estimate_in_parallel(const scene::Scene& scene, const CostEstimate& f, int ranks, const std::optional<Link>& link,
                                      const std::vector<scene::SolverKind>& kinds) {
    sim::require_ranks(scene, ranks, kinds);
    const auto& kind = sim::kind_named(scene.solver(), kinds);
    const sim::Shares shares = sim::shares_of(scene, ranks, kind);
    ParallelEstimate o{.ranks = ranks,
                       .nothing_shared = ranks > 1 && shares.nothing_shared(),
                       .replicated_work = shares.replicated_work,
                       .link = link ? *link : measure_link(),
                       .seconds_each = 1e-3 * f.ms / f.count};
    o.cut = shares.cut;
    {
        const DryRun several(0, ranks);
        o.own_part = ranks > 1 && (kind.parallel.shared == scene::Shared::by_particles ||
                                   (kind.parallel.distributed_storage && kind.parallel.distributed_storage(scene, o.cut)));
    }
    const std::vector<double> parts = o.own_part && !o.cut.empty() ? sim::parts_of_planes(scene, kinds) : std::vector<double>{};
    for (int rank = 0; rank < ranks; ++rank) {
        o.bytes.push_back(!o.own_part      ? f.held.bytes
                          : !o.cut.empty() ? sim::bytes_of_rank(f.held.bytes, o.cut, rank, parts)
                                           : f.held.bytes * part_of_particles(scene, rank, ranks));
        o.surface_bytes.push_back(sim::surface_bytes_of_rank(scene, f.held, rank, ranks));
    }
    if (ranks == 1) return o;
    constexpr int first = 1, steps = 2;
    const Tried tried = tried_scene(scene, f, std::min(ranks, most_tried), kinds);
    const CountedSteps counted = count_messages(tried.scene, std::min(ranks, most_tried), first, steps, kinds);
    for (const RankTraffic& sent : counted.sent) o.sent.push_back(wider(per_step(sent, steps), tried.area));
    o.iterations = counted.iterations;
    if (tried.area != 1) o.tried = fmt::format("{}", fmt::join(tried.scene.root().numbers("grid.cells"), " x "));
    if (!o.nothing_shared)
        o.weak = weak_scaling(scene, o, o.sent[o.sent.size() / 2], static_cast<int>(o.sent.size()), f.particles ? f.count : 0);
    return o;
}

namespace {

std::string constants_text(const ParallelEstimate& o, const CostEstimate& f) {
    return fmt::format("  constants: {:.3g} ns per {} and step, from the rates above; {:.3g} us per message and {:.3g} GB/s {}\n",
                       1e9 * o.seconds_each, f.particles ? "particle" : "cell", 1e6 * o.link.latency, 1e-9 * o.link.bandwidth,
                       o.link.source);
}

std::string weak_text(const ParallelEstimate& o, const CostEstimate& f) {
    std::string s = f.particles ? "weak scaling, a model with the same number of particles per rank\n"
                                : "weak scaling, a model with the same number of planes per rank\n";
    for (const ModelStep& step : o.weak)
        s += fmt::format("  {:5} ranks  {:10.4g} ms computing  {:10.4g} ms communication  {:5.1f}%\n", step.ranks, 1e3 * step.computing,
                         1e3 * step.sending, 100 * step.efficiency());
    s += constants_text(o, f);
    if (!o.replicated_work.empty()) s += "  replicated work is counted as distributed: the true efficiency is lower\n";
    return s;
}

}  // namespace

std::string parallel_estimate_text(const ParallelEstimate& o, const CostEstimate& f, const scene::Scene& scene) {
    if (o.ranks == 1) return "1 rank: no partition, no messages\n";
    const bool planes = !o.cut.empty();
    std::string s =
        o.nothing_shared
            ? fmt::format("{} ranks: the domain cannot be partitioned, every rank computes all of it (replicated work)\n", o.ranks)
            : fmt::format("{} ranks, partitioned along {}, {}\n", o.ranks, scene.dim() == 2 ? "y" : "z",
                          planes ? "one slab per rank" : "the same number of particles per rank");
    s += fmt::format("  each rank stores {}{}{}\n",
                     !o.own_part ? "the whole grids"
                     : planes    ? "its slab and ghost planes"
                                 : "its own and ghost particles",
                     o.replicated_work.empty() ? "" : "; replicated work: ", scene::text_of(o.replicated_work));
    for (std::size_t rank = 0; rank < o.bytes.size(); ++rank) {
        const int r = static_cast<int>(rank);
        if (o.ranks > most_listed && r != 0 && r != o.ranks / 2 && r + 1 != o.ranks) continue;  // those at the ends, and one between
        s += fmt::format("  rank {:4}", r);
        if (planes) s += fmt::format("  planes {:5} to {:5}", o.cut.begin(r), o.cut.end(r, o.cut.planes()) - 1);
        s += fmt::format("  {:>10.4g} MB", o.bytes[rank] / 1e6);
        if (o.surface_bytes[rank] > 0) s += fmt::format(", {:.4g} MB additional for surface reconstruction", o.surface_bytes[rank] / 1e6);
        if (o.sent.size() == o.bytes.size())
            s += fmt::format("  {:6} messages {:>12} bytes per step", o.sent[rank].all().messages, o.sent[rank].all().bytes);
        s += "\n";
    }
    const int tried = static_cast<int>(o.sent.size());
    if (tried < o.ranks) {
        const Traffic sent = o.sent[o.sent.size() / 2].all();
        s += fmt::format("  a rank between two others sends {} messages, {} bytes per step, on {} ranks\n", sent.messages, sent.bytes,
                         tried);
    }
    s += fmt::format("  counted in steps 2 and 3 of {} on {} processes of this machine, {:.1f} iteration(s) per step{}\n",
                     o.tried.empty() ? "the scene" : "a copy with " + o.tried + " cells", tried, o.iterations,
                     o.tried.empty() ? "" : "; bytes between neighbours are scaled to its planes");
    return o.nothing_shared ? s : s + weak_text(o, f);
}

}  // namespace weir::validation
