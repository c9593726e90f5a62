// ParaView's .pvd: a list of times and files, in the plain form written here.
#pragma once
#include "output/series_index.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace weir::output {

SeriesIndex pvd_index();
std::string series_text(const std::vector<SeriesEntry>& entries);
/// Throws BadInput when the file is not a series written by weir.
std::vector<SeriesEntry> read_series(const std::filesystem::path& pvd);

}  // namespace weir::output
