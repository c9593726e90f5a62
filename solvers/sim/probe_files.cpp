#include "sim/probe_files.hpp"

#include "core/error.hpp"
#include "output/series_index.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace weir::sim {

namespace {

/// Positions are comment lines above the header: plots skip them, and no second file is needed.
std::string head(const ProbeSeries& probe) {
    std::string text = "# probe " + probe.name + ", kind " + probe.kind + '\n';
    for (std::size_t i = 0; i < probe.positions.size(); ++i) {
        text += "# " + probe.columns[i] + " at";
        for (int a = 0; a < 3; ++a) text += ' ' + output::exact_text(probe.positions[i][a]);
        text += " m\n";
    }
    text += "t [s]";
    for (const auto& column : probe.columns) text += ',' + column;
    return text + '\n';
}

std::string rows(const ProbeSeries& probe, std::size_t from) {
    std::string text;
    for (std::size_t r = from; r < probe.times.size(); ++r) {
        text += output::exact_text(probe.times[r]);
        for (const real value : probe.values[r]) text += ',' + output::exact_text(value);
        text += '\n';
    }
    return text;
}

void append(const std::filesystem::path& path, const std::string& text, std::ios::openmode mode) {
    std::ofstream file(path, std::ios::binary | mode);
    file << text;
    if (!file.flush()) throw OutputError("cannot write " + path.string() + ": " + std::strerror(errno));
}

/// Bytes of the header and `count` rows; 0 where the file belongs to another probe or has fewer rows. An incomplete last row of a killed
/// run does not count.
std::uintmax_t bytes_of_rows(const std::filesystem::path& path, const std::string& head, std::int64_t count) {
    std::ifstream file(path, std::ios::binary);
    std::string there(head.size(), '\0');
    if (!file.read(there.data(), static_cast<std::streamsize>(there.size())) || there != head) return 0;
    std::uintmax_t bytes = head.size();
    std::string line;
    for (; count > 0 && std::getline(file, line) && !file.eof(); --count) bytes += line.size() + 1;
    return count > 0 ? 0 : bytes;
}

}  // namespace

/// Returns whether the file has exactly the rows that the series has released.
bool ProbeFiles::keeps_released(const ProbeSeries& probe, const std::filesystem::path& earlier) const {
    if (probe.released == 0) return false;
    const auto own = file_of(probe), other = earlier / own.filename();
    std::uintmax_t bytes = bytes_of_rows(own, head(probe), probe.released);
    std::error_code failed;
    if (bytes == 0 && !earlier.empty() && (bytes = bytes_of_rows(other, head(probe), probe.released)) > 0)
        std::filesystem::copy_file(other, own, std::filesystem::copy_options::overwrite_existing, failed);
    if (bytes == 0) return false;
    if (!failed) std::filesystem::resize_file(own, bytes, failed);
    if (failed) throw OutputError("cannot write " + own.string() + ": " + failed.message());
    return true;
}

void ProbeFiles::begin(const std::vector<ProbeSeries>& probes, const std::filesystem::path& earlier) {
    if (probes.empty()) return;
    std::error_code ignored;
    std::filesystem::create_directories(folder_, ignored);
    written_.clear();
    for (const ProbeSeries& probe : probes) {
        if (!keeps_released(probe, earlier)) append(file_of(probe), head(probe), std::ios::trunc);
        written_.push_back(probe.released);
    }
}

void ProbeFiles::update(const std::vector<ProbeSeries>& probes) {
    if (written_.size() != probes.size()) begin(probes);
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const std::int64_t all = probes[i].released + static_cast<std::int64_t>(probes[i].times.size());
        if (written_[i] == all) continue;
        append(file_of(probes[i]), rows(probes[i], static_cast<std::size_t>(written_[i] - probes[i].released)), std::ios::app);
        written_[i] = all;
    }
}

}  // namespace weir::sim
