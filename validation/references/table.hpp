// Tables of others: comma-separated values with '#' lines that say where they come from and one line of column names.
#pragma once
#include "core/types.hpp"
#include "validation/harness/curve.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

struct Table {
    std::string file;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;

    const std::string& text(std::size_t row, std::string_view column) const;
    real number(std::size_t row, std::string_view column) const;
    /// Rows in which `column` reads `value`.
    Table where(std::string_view column, std::string_view value) const;
    /// Two columns as points, in the order of the file.
    Curve curve(std::string_view x, std::string_view y, std::string label) const;
};

/// Throws BadInput, with the file's name, for what is missing, ragged or not a table.
Table read_table(const std::filesystem::path& file);

}  // namespace weir::validation
