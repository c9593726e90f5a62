#include "validation/references/table.hpp"

#include "core/error.hpp"
#include "core/words.hpp"

#include <algorithm>
#include <sstream>

namespace weir::validation {
namespace {

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (char c : line) {
        if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            cells.emplace_back();
        } else if (c != '\r') {
            cells.back() += c;
        }
    }
    return cells;
}

std::size_t column_of(const Table& t, std::string_view name) {
    const auto at = std::find(t.columns.begin(), t.columns.end(), name);
    if (at == t.columns.end()) throw BadInput(t.file + ": no column \"" + std::string(name) + "\"");
    return static_cast<std::size_t>(at - t.columns.begin());
}

}  // namespace

const std::string& Table::text(std::size_t row, std::string_view column) const { return rows.at(row).at(column_of(*this, column)); }

real Table::number(std::size_t row, std::string_view column) const {
    const std::string& cell = text(row, column);
    std::size_t read = 0;
    real value = 0;
    try {
        value = std::stod(cell, &read);
    } catch (const std::exception&) {
        read = 0;
    }
    if (read == 0 || read != cell.size()) throw BadInput(file + ": \"" + cell + "\" in column " + std::string(column) + " is not a number");
    return value;
}

Table Table::where(std::string_view column, std::string_view value) const {
    const std::size_t c = column_of(*this, column);
    Table some{file, columns, {}};
    for (const auto& row : rows)
        if (row[c] == value) some.rows.push_back(row);
    return some;
}

Curve Table::curve(std::string_view x, std::string_view y, std::string label) const {
    Curve c{.label = std::move(label), .x = {}, .y = {}, .points = true};
    for (std::size_t i = 0; i < rows.size(); ++i) c.x.push_back(number(i, x)), c.y.push_back(number(i, y));
    return c;
}

Table read_table(const std::filesystem::path& file) {
    std::istringstream in(bytes_of(file));
    Table table{file.string(), {}, {}};
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#' || line == "\r") continue;
        auto cells = split(line);
        if (table.columns.empty()) {
            table.columns = std::move(cells);
        } else if (cells.size() == table.columns.size()) {
            table.rows.push_back(std::move(cells));
        } else {
            throw BadInput(file.string() + ": \"" + line + "\" has " + std::to_string(cells.size()) + " cells, its columns are " +
                           std::to_string(table.columns.size()));
        }
    }
    if (table.rows.empty()) throw BadInput(file.string() + ": an empty table");
    return table;
}

}  // namespace weir::validation
