#include "sim/probe_files.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

namespace weir::sim {

namespace {

std::string exact(real value) {
    char text[40];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// Positions stand in comment lines above the head: plots skip them, and a reader needs no second file.
std::string head(const ProbeSeries& probe) {
    std::string text = "# probe " + probe.name + ", kind " + probe.kind + '\n';
    for (std::size_t i = 0; i < probe.positions.size(); ++i) {
        text += "# " + probe.columns[i] + " at";
        for (int a = 0; a < 3; ++a) text += ' ' + exact(probe.positions[i][a]);
        text += " m\n";
    }
    text += "t [s]";
    for (const auto& column : probe.columns) text += ',' + column;
    return text + '\n';
}

std::string rows(const ProbeSeries& probe, std::size_t from) {
    std::string text;
    for (std::size_t r = from; r < probe.times.size(); ++r) {
        text += exact(probe.times[r]);
        for (const real value : probe.values[r]) text += ',' + exact(value);
        text += '\n';
    }
    return text;
}

}  // namespace

void ProbeFiles::update(const std::vector<ProbeSeries>& probes) {
    if (probes.empty()) return;
    const bool first = written_.empty();
    written_.resize(probes.size(), 0);
    std::error_code ignored;
    std::filesystem::create_directories(folder_, ignored);
    for (std::size_t i = 0; i < probes.size(); ++i) {
        if (!first && written_[i] == probes[i].times.size()) continue;
        const auto path = folder_ / (probes[i].name + ".csv");
        std::ofstream file(path, std::ios::binary | (first ? std::ios::trunc : std::ios::app));
        file << (first ? head(probes[i]) : "") << rows(probes[i], written_[i]);
        if (!file.flush()) throw OutputError("cannot write " + path.string() + ": " + std::strerror(errno));
        written_[i] = probes[i].times.size();
    }
}

}  // namespace weir::sim
