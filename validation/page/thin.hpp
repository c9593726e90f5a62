// SVG as gnuplot writes it, without what no eye can see: points nearer to each other than a pixel, digits of a hundredth of one.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace weir::validation {

/// Lines keep every corner that is off by more than 0.5 px from the straight line drawn in its place (Douglas & Peucker 1973), and in
/// each column of a pixel the highest and lowest point; marks of one colour keep one in each square of 1.5 px.
std::string thin_svg(const std::string& svg);

/// A published plot as a figure of a page, its ids prefixed; a sentence where there is none.
std::string published_plot(const std::filesystem::path& svg, const std::string& prefix);

/// The text of an SVG as a figure of a page, its ids prefixed.
std::string plot_figure(const std::string& svg, std::string_view prefix);

/// An SVG to stand inside a page: no prolog, ids that begin with `prefix`, ink in the page's own colour and paper see-through.
std::string inline_svg(const std::string& svg, std::string_view prefix);

}  // namespace weir::validation
