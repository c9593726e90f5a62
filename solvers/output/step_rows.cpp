#include "output/step_rows.hpp"

#include "core/error.hpp"
#include "core/solver.hpp"
#include "output/atomic_file.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

namespace weir::output {

namespace {

constexpr real largest_whole = 9007199254740992;  // 2^53: whole numbers up to here are exact doubles

/// The shortest text that reads back as the same double; whole numbers without an exponent.
void append(std::string& to, real value) {
    char text[40];
    const bool whole = std::abs(value) < largest_whole && value == std::floor(value);
    const auto end = whole ? std::to_chars(text, text + sizeof text, static_cast<std::int64_t>(value)).ptr
                           : std::to_chars(text, text + sizeof text, value).ptr;
    to.append(text, end);
}

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    for (std::size_t at = 0; at <= line.size();) {
        const std::size_t end = std::min(line.find(',', at), line.size());
        cells.push_back(line.substr(at, end - at));
        at = end + 1;
    }
    return cells;
}

/// Reads a complete line; an incomplete one, left by a killed run, does not count.
bool next_line(std::ifstream& file, std::string& line) { return std::getline(file, line) && !file.eof(); }

}  // namespace

void ColumnSummary::add(real value) {
    if (!std::isfinite(value)) return;
    ++count;
    min = std::min(min, value), max = std::max(max, value), sum += value;
}

StepRows::StepRows(std::filesystem::path file, std::vector<std::string> columns) : path_(std::move(file)) {
    for (auto& name : columns) columns_.push_back({std::move(name)});
}

StepRows::~StepRows() = default;

std::string StepRows::head() const {
    std::string text = "step";
    for (const auto& column : columns_) text += ',' + column.name;
    return text + '\n';
}

void StepRows::open(const char* mode) {
    file_.reset(std::fopen(path_.c_str(), mode));
    if (!file_) throw OutputError("cannot write " + path_.string() + ": " + std::strerror(errno));
}

void StepRows::write(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
        throw OutputError("cannot write " + path_.string() + ": " + std::strerror(errno));
}

void StepRows::begin() {
    open("wb");
    write(head());
}

void StepRows::resume(std::int64_t last, bool more_columns) {
    const std::int64_t kept = read(last, more_columns);
    if (kept == 0) return begin();
    std::error_code failed;
    std::filesystem::resize_file(path_, static_cast<std::uintmax_t>(kept), failed);
    if (failed) throw OutputError("cannot write " + path_.string() + ": " + failed.message());
    open("ab");
}

/// Bytes of the file to keep; 0 where it is of another kind.
std::int64_t StepRows::read(std::int64_t last, bool more_columns) {
    std::ifstream file(path_, std::ios::binary);
    std::string line, own = head();
    own.pop_back();
    if (!next_line(file, line) || !(line == own || (more_columns && line.starts_with(own + ',')))) return 0;
    const auto names = cells_of(line);
    for (std::size_t i = columns_.size() + 1; i < names.size(); ++i) columns_.push_back({names[i]});
    std::int64_t kept = 0;
    do kept += static_cast<std::int64_t>(line.size()) + 1;
    while (next_line(file, line) && take(line, last));
    return kept;
}

/// Returns whether the line is a row of a step up to `last`; it is then added to the summary.
bool StepRows::take(const std::string& line, std::int64_t last) {
    const auto cells = cells_of(line);
    if (cells.size() != columns_.size() + 1) return false;
    std::int64_t step = 0;
    if (std::from_chars(cells[0].data(), cells[0].data() + cells[0].size(), step).ec != std::errc() || step > last || step <= last_step_)
        return false;
    row_.assign(columns_.size(), not_applicable);
    for (std::size_t i = 0; i < row_.size(); ++i) {
        const std::string& cell = cells[i + 1];
        if (!cell.empty() && std::from_chars(cell.data(), cell.data() + cell.size(), row_[i]).ec != std::errc()) return false;
    }
    summarize(step, row_);
    return true;
}

void StepRows::summarize(std::int64_t step, std::span<const real> values) {
    ++count_;
    last_step_ = step;
    for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i].add(values[i]);
}

void StepRows::add(std::int64_t step, std::span<const real> values) {
    text_ = std::to_string(step);
    for (const real value : values) {
        text_ += ',';
        if (!std::isnan(value)) append(text_, value);
    }
    text_ += '\n';
    write(text_);
    summarize(step, values);
}

void StepRows::add_column(const std::string& name) {
    columns_.push_back({name});
    if (count_ == 0) return begin();
    file_.reset();
    {
        NewFile wider(path_);
        std::ifstream rows(path_, std::ios::binary);
        std::string line;
        std::getline(rows, line);
        wider.write(head());
        while (next_line(rows, line)) wider.write(line + ",\n");
        wider.finish();
    }
    open("ab");
}

}  // namespace weir::output
