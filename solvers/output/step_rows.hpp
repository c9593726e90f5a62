// A CSV file with one row per step, written during the run. Memory holds only a summary of each column.
#pragma once
#include "core/types.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace weir::output {

/// Of the finite values of a column.
struct ColumnSummary {
    std::string name;
    std::int64_t count = 0;
    real min = infinity, max = -infinity, sum = 0;
    void add(real value);
};

class StepRows {
public:
    /// columns: all except the first, which is the number of the step. Nothing is written before begin() or resume().
    StepRows(std::filesystem::path file, std::vector<std::string> columns);
    ~StepRows();

    /// Starts a new file.
    void begin();
    /// Keeps the rows up to step `last` of an earlier run's file and removes later ones; starts a new file where there is none of this
    /// kind. more_columns: the file may have additional columns at the end.
    void resume(std::int64_t last, bool more_columns = false);
    /// Appends a row and flushes it; NaN gives an empty cell. Throws OutputError.
    void add(std::int64_t step, std::span<const real> values);
    /// Appends a column; its cells in earlier rows are empty.
    void add_column(const std::string& name);

    std::int64_t count() const { return count_; }
    std::int64_t last_step() const { return last_step_; }
    const std::vector<ColumnSummary>& columns() const { return columns_; }

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::string head() const;
    void open(const char* mode);
    void write(const std::string& text);
    std::int64_t read(std::int64_t last, bool more_columns);
    bool take(const std::string& line, std::int64_t last);
    void summarize(std::int64_t step, std::span<const real> values);

    std::filesystem::path path_;
    std::unique_ptr<std::FILE, Close> file_;
    std::vector<ColumnSummary> columns_;
    std::int64_t count_ = 0, last_step_ = 0;
    std::vector<real> row_;  // the row being read
    std::string text_;       // of one row
};

}  // namespace weir::output
